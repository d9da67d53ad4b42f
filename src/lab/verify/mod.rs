//! Verification: small cases with known answers, from RiMEA 4.1.1, ISO 20414 and NIST TN 1822. The figures come from a
//! public verification suite and from scenario files of Vadere, not from the guidelines themselves.

mod iso;
pub mod rimea;
pub mod speeds;

use super::suite::Suite;

/// The cases. Their names are the numbers of RiMEA, or after `iso` those of ISO 20414 (and NIST TN 1822).
pub static VERIFICATION: Suite = Suite {
    name: "verification",
    cases: &[&rimea::CASES, &iso::CASES],
    data: &[],
    profiles: &["sph", "sf->sph", "rvo->sph"],
    judges_means: false,
    sheets: |_| Vec::new(),
};
