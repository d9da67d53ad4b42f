//! `sandbox bench`: performance on this machine.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::arguments::PrintOptions;
use super::values::{repeats, threads};
use super::{Failure, talk, tell, use_threads};
use crate::lab::bench::{BENCHMARKS, Plan, files};
use crate::runs::outputs::{Manner, Outputs};

/// Examples of commands.
pub const EXAMPLES: &str = "\
Examples:
  sandbox bench scaling --largest 100000
  sandbox bench stages --out bench --force
  sandbox bench threads --repeats 15 --json
  sandbox bench skips --quick
  sandbox bench domains --largest 10000000
  sandbox bench compare --python peers/bin/python";

#[derive(Args)]
pub struct BenchOptions {
    /// The benchmark to run
    #[arg(value_parser = PossibleValuesParser::new(names()))]
    pub what: String,
    /// Write the results to this folder as JSON, SVG and PNG
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace existing results
    #[arg(long)]
    pub force: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
    /// Number of repeats of each measurement [default: 7, or 2 with --quick]
    #[arg(long, value_name = "N", value_parser = repeats)]
    pub repeats: Option<usize>,
    /// Small crowds and few steps; takes seconds and checks that the benchmark works, not the speed
    #[arg(long)]
    pub quick: bool,
    /// Number of threads, unless the benchmark varies it [default: all cores]
    #[arg(long, value_parser = threads)]
    pub threads: Option<usize>,
    #[command(flatten)]
    pub print: PrintOptions,
    /// scaling, domains, compare: size of the largest crowd
    #[arg(long, value_name = "AGENTS", default_value_t = 1_000_000, value_parser = clap::value_parser!(u32).range(1_000..))]
    pub largest: u32,
    /// compare: a Python interpreter with JuPedSim and RVO2 (pip install jupedsim pyrvo)
    #[arg(long, value_name = "PATH", default_value = "python3")]
    pub python: PathBuf,
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
    let found = BENCHMARKS
        .iter()
        .find(|benchmark| benchmark.name == options.what);
    let benchmark =
        found.ok_or_else(|| Failure::Input(format!("{}: no benchmark", options.what)))?;
    if let Some(folder) = &options.out {
        let mut outputs = Outputs::new(options.force);
        outputs.writes("--out", folder, Manner::Folder);
        for file in files(benchmark.name, folder) {
            outputs.writes("--out", &file, Manner::Beside);
        }
        outputs.check()?;
    }
    use_threads(options.threads)?;
    options.print.apply();
    let plan = Plan {
        repeats: options.repeats.unwrap_or(if options.quick { 2 } else { 7 }),
        quick: options.quick,
        largest: options.largest,
        python: options.python.clone(),
    };
    let report = benchmark.measure(&plan, &|text| talk(&format!("{}: {text}", benchmark.name)))?;
    let said = tell(options.json, || report.json(), || report.text());
    let Some(folder) = &options.out else {
        return said;
    };
    for path in report.save(folder)? {
        talk(&format!("note: {} written", path.display()));
    }
    said
}
