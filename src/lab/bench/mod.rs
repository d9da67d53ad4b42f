//! How fast it is: five benchmarks, each a table, a JSON object and a picture.
//!
//! A benchmark takes the same steps several times and gives the least, the middle and the greatest
//! time. What is compared takes turns within each repeat, so that whatever else the machine does hits
//! all alike; ratios are taken turn by turn. A scene is run through the public API, as anybody would.

mod compare;
mod crowd;
mod error;
mod machine;
mod pictures;
mod report;
mod scaling;
mod skips;
mod spread;
mod stages;
mod threads;
mod timing;

pub use crowd::{Aim, Crowd};
pub use error::BenchError;
pub use machine::{Machine, Memory, main_memory};
pub use report::{Findings, Report, Setting, files};
pub use skips::{SKIPS, Skip, everything};
pub use spread::{Spread, ratios};
pub use timing::{Contender, alternate};
pub(crate) use timing::{ms_per_frame, pool};

use std::path::PathBuf;

/// How much is to be measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// How often the same steps are taken.
    pub repeats: usize,
    /// Small crowds and few steps: whether it works, not how fast it is.
    pub quick: bool,
    /// The largest crowd of `scaling`.
    pub largest: u32,
    /// The Python that `compare` asks for JuPedSim.
    pub python: PathBuf,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            repeats: 7,
            quick: false,
            largest: 1_000_000,
            python: PathBuf::from("python3"),
        }
    }
}

impl Plan {
    /// `usual`, or `few` if it is to be quick.
    fn choose<T>(&self, usual: T, few: T) -> T {
        if self.quick { few } else { usual }
    }
}

/// Measures something, and says on the way what it is at.
type Measure = fn(&Plan, &dyn Fn(&str)) -> Result<Findings, BenchError>;

/// Something to measure.
pub struct Benchmark {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it measures, in a line.
    pub about: &'static str,
    run: Measure,
}

impl Benchmark {
    /// Measures it, and says on the way what it is at.
    ///
    /// # Errors
    /// A crowd cannot go on, or another program stopped.
    pub fn measure(&self, plan: &Plan, say: &dyn Fn(&str)) -> Result<Report, BenchError> {
        Ok(Report {
            name: self.name,
            about: self.about,
            setting: Setting::of(plan),
            findings: (self.run)(plan, say)?,
        })
    }
}

/// Everything that can be measured.
pub const BENCHMARKS: [Benchmark; 5] = [
    scaling::BENCHMARK,
    stages::BENCHMARK,
    threads::BENCHMARK,
    skips::BENCHMARK,
    compare::BENCHMARK,
];
