//! Benchmarks: what they are called, and how they are run.

use super::plan::Plan;
use super::report::{Report, Timings};
use crate::error::LabError;

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
