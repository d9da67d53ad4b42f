//! Verification: small cases with known answers, from RiMEA 4.1.1, ISO 20414 and NIST TN 1822.
//!
//! A [`Case`] names runs of the study `scenarios/studies/verification.json` and turns their results into [`Check`]s.
//! The figures come from a public verification suite and from scenario files of Vadere, not from the guidelines
//! themselves.

mod case;
mod check;
mod iso;
mod pictures;
mod report;
mod rimea;
mod speeds;
mod suite;

pub use case::{CASES, Case, PROFILES, Runs};
pub use check::{Check, Expected};
pub use report::{Finding, Report};
pub use suite::{chosen, verify};
