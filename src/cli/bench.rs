//! `sandbox bench`: how fast it is on this machine.

use std::path::Path;

use super::arguments::BenchOptions;
use super::{Failure, say, talk, use_threads};
use crate::bench::{BENCHMARKS, BenchError, Plan, Report, check_free, make_folder};

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
    if let Some(folder) = &options.out {
        if !options.force {
            check_free(benchmark.name, folder)?;
        }
        make_folder(folder)?;
    }
    use_threads(options.threads)?;
    let plan = Plan {
        repeats: options.repeats.unwrap_or(if options.quick { 2 } else { 7 }),
        quick: options.quick,
        largest: options.largest,
        python: options.python.clone(),
    };
    let report = benchmark.measure(&plan, &|text| talk(&format!("{}: {text}", benchmark.name)))?;
    // What was measured is told even if it cannot be kept.
    let saved = options
        .out
        .as_deref()
        .map_or(Ok(()), |folder| save(&report, folder));
    if options.json {
        say(format!("{}\n", report.json()))?;
    } else {
        say(report.text())?;
    }
    saved
}

fn save(report: &Report, folder: &Path) -> Result<(), Failure> {
    for path in report.save(folder)? {
        talk(&format!("note: {} written", path.display()));
    }
    if cfg!(not(feature = "plot")) {
        talk("note: no picture: this program was built without the feature `plot`");
    }
    Ok(())
}

impl From<BenchError> for Failure {
    fn from(error: BenchError) -> Self {
        match error {
            BenchError::Exists(_) => Self::Input(format!("--out {error}")),
            error => Self::Output(error.to_string()),
        }
    }
}
