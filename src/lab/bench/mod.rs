//! Benchmarks of the run time: six, each with a table, a JSON object and a picture.
//!
//! A benchmark repeats the same steps several times and reports the minimum, median and maximum time. Contenders take
//! turns within each repeat, so that other load on the machine affects all of them alike; ratios are taken turn by
//! turn. Scenes run through the public API.

mod compare;
mod crowd;
mod domains;
mod hall;
mod pictures;
mod report;
mod scaling;
mod skips;
mod stages;
mod threads;
mod timing;

pub use crowd::Crowd;
pub use report::{Report, files};
pub use skips::{SKIPS, Skip, everything};
pub use timing::{Contender, alternate};
pub(crate) use timing::{ms_per_frame, pool};

use std::path::PathBuf;

use crate::engine::pairs::Vectors;
use crate::lab::error::LabError;
use crate::lab::machine::Machine;
use report::Findings;

/// How much to measure.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// How often the same steps are repeated.
    pub repeats: usize,
    /// Small crowds and few steps: a check that everything works; the times are meaningless.
    pub quick: bool,
    /// The largest crowd of `scaling`, `domains` and `compare`.
    pub largest: u32,
    /// The Python interpreter in which `compare` looks for other engines.
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
    /// `usual`, or `few` if the plan is quick.
    fn choose<T>(&self, usual: T, few: T) -> T {
        if self.quick { few } else { usual }
    }

    /// The number of frames in which `agents` agents take about `agent_frames` steps together, between two limits.
    fn frames(&self, agents: u32, agent_frames: u64, [fewest, most]: [u64; 2]) -> u64 {
        let usual = (agent_frames / u64::from(agents)).clamp(fewest, most);
        self.choose(usual, 5)
    }
}

/// Runs a benchmark, and reports its progress.
type Measure = fn(&Plan, &dyn Fn(&str)) -> Result<Findings, LabError>;

/// A benchmark.
pub struct Benchmark {
    /// Its name on the command line.
    pub name: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    run: Measure,
}

impl Benchmark {
    /// Runs the benchmark, and reports its progress with `say`.
    ///
    /// # Errors
    /// A simulation fails, or another program stops.
    pub fn measure(&self, plan: &Plan, say: &dyn Fn(&str)) -> Result<Report, LabError> {
        Ok(Report {
            benchmark: self.name,
            about: self.about,
            findings: (self.run)(plan, say)?,
            machine: Machine::here(),
            vectors: Vectors::here(),
            threads: rayon::current_num_threads(),
            repeats: plan.repeats,
            quick: plan.quick,
        })
    }
}

/// All benchmarks.
pub const BENCHMARKS: [Benchmark; 6] = [
    scaling::BENCHMARK,
    stages::BENCHMARK,
    threads::BENCHMARK,
    skips::BENCHMARK,
    compare::BENCHMARK,
    domains::BENCHMARK,
];
