//! `sandbox bench`: performance on this machine.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::Value;

use super::arguments::{PrintOptions, use_threads};
use super::failure::Failure;
use super::terminal::{talk, tell};
use super::values::{repeats, threads};
use lab::bench::{BENCHMARKS, Plan, Report, files};
use lab::error::LabError;
use runs::outputs::{Manner, Outputs};

/// Examples of commands.
pub const EXAMPLES: &str = "\
Examples:
  sandbox bench scaling --largest 100000
  sandbox bench stages --out bench --force
  sandbox bench threads --repeats 15 --json
  sandbox bench skips --quick";

#[derive(Args)]
pub struct BenchOptions {
    /// The benchmark to run
    #[arg(value_parser = PossibleValuesParser::new(names()))]
    pub what: String,
    #[command(flatten)]
    pub timing: TimingOptions,
}

/// Where the results of a measurement go.
#[derive(Args)]
pub struct ResultOptions {
    /// Write the results to this folder as JSON, SVG and PNG
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace existing results
    #[arg(long)]
    pub force: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

impl ResultOptions {
    /// Checks that the files of the results can be written. `files` are their paths in the folder.
    ///
    /// # Errors
    /// A file cannot be written, or exists already and may not be replaced.
    pub fn check(&self, files: impl FnOnce(&Path) -> Vec<PathBuf>) -> Result<(), Failure> {
        let Some(folder) = &self.out else {
            return Ok(());
        };
        let mut outputs = Outputs::new(self.force);
        outputs.writes("--out", folder, Manner::Folder);
        for file in files(folder) {
            outputs.writes("--out", &file, Manner::Beside);
        }
        Ok(outputs.check()?)
    }

    /// Prints the results, as JSON or as text, and saves them to the folder; `save` returns the paths.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn give(
        &self,
        json: impl FnOnce() -> Value,
        text: impl FnOnce() -> String,
        save: impl FnOnce(&Path) -> Result<Vec<PathBuf>, LabError>,
    ) -> Result<(), Failure> {
        let said = tell(self.json, json, text);
        let Some(folder) = &self.out else {
            return said;
        };
        for path in save(folder)? {
            talk(&format!("note: {} written", path.display()));
        }
        said
    }
}

/// Options of a benchmark.
#[derive(Args)]
pub struct TimingOptions {
    #[command(flatten)]
    results: ResultOptions,
    /// Number of repeats of each measurement [default: 7, or 2 with --quick]
    #[arg(long, value_name = "N", value_parser = repeats)]
    repeats: Option<usize>,
    /// Small crowds and few steps; takes seconds and checks that the benchmark works, not the speed
    #[arg(long)]
    quick: bool,
    /// Number of threads, unless the benchmark varies it [default: all cores]
    #[arg(long, value_parser = threads)]
    threads: Option<usize>,
    #[command(flatten)]
    print: PrintOptions,
    /// Size of the largest crowd, if the benchmark measures several sizes
    #[arg(
        long,
        value_name = "AGENTS",
        default_value_t = 1_000_000,
        value_parser = clap::value_parser!(u32).range(1_000..)
    )]
    largest: u32,
}

impl TimingOptions {
    /// Runs the benchmark `name` and gives its results. `measure` gets the plan, and a function that prints progress.
    ///
    /// # Errors
    /// A file cannot be written, or the benchmark fails.
    pub fn run(
        &self,
        name: &str,
        measure: impl FnOnce(&Plan, &dyn Fn(&str)) -> Result<Report, LabError>,
    ) -> Result<(), Failure> {
        self.results.check(|folder| files(name, folder))?;
        use_threads(self.threads)?;
        self.print.apply();
        let plan = Plan {
            repeats: self.repeats.unwrap_or(if self.quick { 2 } else { 7 }),
            quick: self.quick,
            largest: self.largest,
        };
        let report = measure(&plan, &|text| talk(&format!("{name}: {text}")))?;
        let (json, text) = (|| report.json(), || report.text());
        self.results.give(json, text, |folder| report.save(folder))
    }
}

/// The names of all benchmarks.
pub fn names() -> Vec<&'static str> {
    BENCHMARKS.iter().map(|benchmark| benchmark.name).collect()
}

/// All benchmarks, each with a line about it.
pub fn about() -> String {
    let lines = BENCHMARKS.iter();
    lines
        .map(|benchmark| format!("  {:<8} {}\n", benchmark.name, benchmark.about))
        .collect()
}

pub fn run(options: &BenchOptions) -> Result<(), Failure> {
    let mut benchmarks = BENCHMARKS.iter();
    let benchmark = benchmarks.find(|benchmark| benchmark.name == options.what);
    let unknown = || Failure::Input(format!("{}: no benchmark", options.what));
    let benchmark = benchmark.ok_or_else(unknown)?;
    let timing = &options.timing;
    timing.run(benchmark.name, |plan, say| benchmark.measure(plan, say))
}
