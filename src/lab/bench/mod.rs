//! Benchmarks of the run time: four, each with a table, a JSON object and a picture. The package `experiments` has more
//! that use the same machinery.
//!
//! A benchmark repeats the same steps several times and reports the minimum, median and maximum time. Contenders take
//! turns within each repeat, so that other load on the machine affects all of them alike; ratios are taken turn by
//! turn. Scenes run through the public API.

mod benchmark;
mod crowd;
mod hall;
mod office;
mod plan;
mod report;
mod scaling;
mod skips;
mod stages;
mod threads;
pub mod timing;

pub use benchmark::{Benchmark, Measure};
pub use crowd::Crowd;
pub use plan::Plan;
pub use report::{Report, Timings, names};
pub use skips::{SKIPS, Skip, everything};
pub use stages::{Started, Stretch, begin};

/// The benchmarks of the program.
pub const BENCHMARKS: [Benchmark; 4] = [
    scaling::BENCHMARK,
    stages::BENCHMARK,
    threads::BENCHMARK,
    skips::BENCHMARK,
];
