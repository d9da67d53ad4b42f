//! Benchmarks, and the amount of their work.

use super::report::{Report, Timings};
use crate::error::LabError;

/// The amount of work of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The number of repetitions of the same steps.
    pub repeats: usize,
    /// Small crowds and few steps: a check that everything works; the times are meaningless.
    pub quick: bool,
    /// The largest crowd of benchmarks that measure several sizes.
    pub largest: u32,
}

impl Plan {
    /// `usual`, or `few` if the plan is quick.
    pub fn choose<T>(&self, usual: T, few: T) -> T {
        if self.quick { few } else { usual }
    }

    /// The number of frames in which `agents` agents take about `agent_frames` steps together, between two limits.
    pub fn frames(&self, agents: u32, agent_frames: u64, [fewest, most]: [u64; 2]) -> u64 {
        let usual = (agent_frames / u64::from(agents)).clamp(fewest, most);
        self.choose(usual, 5)
    }
}

/// Runs a benchmark, and reports its progress.
pub type Measure = fn(&Plan, &dyn Fn(&str)) -> Result<Timings, LabError>;

/// A benchmark.
pub struct Benchmark {
    /// Its name on the command line.
    pub name: &'static str,
    /// A description, in one line.
    pub about: &'static str,
    /// Its measurements.
    pub run: Measure,
}

impl Benchmark {
    /// Runs the benchmark, and reports its progress with `say`.
    ///
    /// # Errors
    /// A simulation fails, or another program stops.
    pub fn measure(&self, plan: &Plan, say: &dyn Fn(&str)) -> Result<Report, LabError> {
        let findings = (self.run)(plan, say)?;
        Ok(Report::of(self.name, self.about, plan, findings))
    }
}
