//! `sandbox bench`: how fast it is on this machine.

use super::arguments::BenchOptions;
use super::{Failure, say, use_threads};
use crate::bench::{BENCHMARKS, BenchError, Plan, check_free};

/// What can be measured.
pub fn names() -> Vec<&'static str> {
    BENCHMARKS.iter().map(|benchmark| benchmark.name).collect()
}

/// What can be measured, with a line about each.
pub fn about() -> String {
    let lines = BENCHMARKS.iter();
    lines
        .map(|benchmark| format!("  {:<8} {}\n", benchmark.name, benchmark.about))
        .collect()
}

pub fn run(options: &BenchOptions) -> Result<(), Failure> {
    let found = BENCHMARKS
        .iter()
        .find(|benchmark| benchmark.name == options.what);
    let benchmark =
        found.ok_or_else(|| Failure::Input(format!("{}: no benchmark", options.what)))?;
    if let Some(folder) = options.out.as_ref().filter(|_| !options.force) {
        check_free(benchmark.name, folder)?;
    }
    use_threads(options.threads)?;
    let plan = Plan {
        repeats: options.repeats.unwrap_or(if options.quick { 2 } else { 7 }),
        quick: options.quick,
        largest: options.largest,
        python: options.python.clone(),
    };
    let report = benchmark.measure(&plan, &|text| eprintln!("{}: {text}", benchmark.name))?;
    if let Some(folder) = &options.out {
        for path in report.save(folder)? {
            eprintln!("note: {} written", path.display());
        }
        if cfg!(not(feature = "plot")) {
            eprintln!("note: no picture: this program was built without the feature `plot`");
        }
    }
    if options.json {
        say(&format!("{}\n", report.json()))
    } else {
        say(&report.text())
    }
}

impl From<BenchError> for Failure {
    fn from(error: BenchError) -> Self {
        match error {
            BenchError::Exists(_) => Self::Input(format!("--out {error}")),
            error => Self::Output(error.to_string()),
        }
    }
}
