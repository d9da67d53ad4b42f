//! Validation: scenes of experiments, with the measured values.

mod bottlenecks;
mod corridors;
mod data;
mod pictures;

use super::suite::Suite;

/// The scenes.
pub static VALIDATION: Suite = Suite {
    name: "validation",
    cases: &[&bottlenecks::CASES, &corridors::CASES, &data::CASES],
    data: &data::FILES,
    profiles: &["sph", "sf->sph", "rvo->sph", "walk+sph"],
    judges_means: true,
    sheets: pictures::sheets,
};
