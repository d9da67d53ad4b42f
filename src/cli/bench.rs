//! `sandbox bench`: performance on this machine.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::arguments::{PrintOptions, use_threads};
use super::documents::{DocumentOptions, add_folder};
use super::failure::Failure;
use super::terminal::talk;
use super::values::{repeats, threads};
use lab::bench::{BENCHMARKS, Plan, Report};
use lab::error::LabError;
use output::document::{Findings, Names};
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
    /// Write the results to this folder as Markdown, JSON, CSV and pictures
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub files: DocumentOptions,
    /// Replace existing results
    #[arg(long)]
    pub force: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

impl ResultOptions {
    /// Checks that files called `names` can be written.
    ///
    /// # Errors
    /// A file cannot be written, or exists already and may not be replaced.
    pub fn check(&self, names: &Names) -> Result<(), Failure> {
        let mut outputs = Outputs::new(self.force);
        if let Some(folder) = &self.out {
            outputs.writes("--out", folder, Manner::Folder);
            add_folder(&mut outputs, folder, names);
        }
        self.files.add_to(&mut outputs, names);
        Ok(outputs.check()?)
    }

    /// Gives the results on the terminal, in the folder and in files.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn give(&self, findings: &Findings) -> Result<(), Failure> {
        self.files.give(findings, self.json, self.out.as_deref())
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
        self.results.check(&lab::bench::names(name))?;
        use_threads(self.threads)?;
        self.print.apply();
        let plan = Plan {
            repeats: self.repeats.unwrap_or(if self.quick { 2 } else { 7 }),
            quick: self.quick,
            largest: self.largest,
        };
        let report = measure(&plan, &|text| talk(&format!("{name}: {text}")))?;
        self.results.give(&report.findings()?)
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
    let named = benchmarks.find(|benchmark| benchmark.name == options.what);
    let unknown = || Failure::Input(format!("{}: no benchmark", options.what));
    let benchmark = named.ok_or_else(unknown)?;
    let timing = &options.timing;
    timing.run(benchmark.name, |plan, say| benchmark.measure(plan, say))
}
