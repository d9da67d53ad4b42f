//! Validation: scenes of experiments, with what was measured there.

mod bottlenecks;
mod corridors;
mod pictures;

use super::suite::Suite;

/// The scenes.
pub static VALIDATION: Suite = Suite {
    name: "validation",
    cases: &[&bottlenecks::CASES, &corridors::CASES],
    profiles: &["sph", "sf->sph", "rvo->sph"],
    judges_means: true,
    sheets: pictures::sheets,
};
