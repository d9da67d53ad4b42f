//! The `experiments` program: its commands, with the options of `sandbox bench` where they apply.

#![warn(clippy::unwrap_used)]

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};
use experiments::{compare, domains, symmetric, walls};
use sandbox::cli::{Failure, PrintOptions, ResultOptions, TimingOptions, UpdateOptions, main_of};

/// Repeat finished experiments
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[command(
        about = domains::BENCHMARK.about,
        after_help = "Example: cargo run --release -p experiments -- domains --largest 10000000"
    )]
    Domains(TimingOptions),
    #[command(
        about = compare::ABOUT,
        after_help = "Example: cargo run --release -p experiments -- compare --python peers/bin/python"
    )]
    Compare(CompareOptions),
    #[command(about = symmetric::BENCHMARK.about)]
    Symmetric(TimingOptions),
    #[command(
        about = walls::ABOUT,
        after_help = "Example: cargo run --release -p experiments -- walls --update docs/reference/tables/accuracy.md",
        mut_arg("out", |out| out.help("Write the results to this folder as Markdown, CSV, JSON, SVG and PNG"))
    )]
    Walls(WallOptions),
}

#[derive(Args)]
struct CompareOptions {
    #[command(flatten)]
    timing: TimingOptions,
    /// A Python interpreter with JuPedSim and RVO2 (pip install jupedsim pyrvo)
    #[arg(long, value_name = "PATH", default_value = "python3")]
    python: PathBuf,
}

#[derive(Args)]
struct WallOptions {
    #[command(flatten)]
    results: ResultOptions,
    /// Few places and few repeats; takes seconds and checks that the measurement works, not the speed
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    print: PrintOptions,
    #[command(flatten)]
    document: UpdateOptions,
}

fn main() -> ExitCode {
    ExitCode::from(main_of(std::env::args_os(), |arguments: Arguments| {
        run(&arguments.command)
    }))
}

fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Domains(options) => {
            let benchmark = domains::BENCHMARK;
            options.run(benchmark.name, |plan, say| benchmark.measure(plan, say))
        }
        Command::Symmetric(options) => {
            let benchmark = symmetric::BENCHMARK;
            options.run(benchmark.name, |plan, say| benchmark.measure(plan, say))
        }
        Command::Compare(CompareOptions { timing, python }) => timing
            .run(compare::NAME, |plan, say| {
                compare::measure(plan, python, say)
            }),
        Command::Walls(options) => measure_walls(options),
    }
}

fn measure_walls(options: &WallOptions) -> Result<(), Failure> {
    let WallOptions {
        results,
        quick,
        print,
        document,
    } = options;
    results.check(walls::files)?;
    document.check(results.out.as_deref(), &[walls::TABLES])?;
    print.apply();
    let report = walls::measure(*quick);
    let (json, text) = (|| report.json(), || report.markdown());
    results.give(json, text, |folder| report.save(folder))?;
    document.put([(walls::TABLES, report.markdown())])
}
