//! The `experiments` program: its commands, with the options of `sandbox bench` where they apply.

#![warn(clippy::unwrap_used)]

use std::path::PathBuf;
use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, value_parser};
use experiments::costs::{COSTS, costs};
use experiments::intervals::{COVERAGE, KNOWLEDGE, Pool, coverage, knowledge, scenes};
use experiments::{compare, domains, physics, symmetric, walls};
use sandbox::cli::{
    CaseOptions, ErrorOptions, Failure, PrintOptions, ResultOptions, TimingOptions, UpdateOptions,
    Watch, main_of,
};
use sandbox::lab::reproduce::{Product, reproduce};
use sandbox::output::document::Names;

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
    /// How often do the intervals of `sandbox estimate` hold the value? (some hours)
    #[command(
        after_help = "Example: cargo run --release -p experiments -- coverage gate bend --seeds 60 --out DIR"
    )]
    Coverage(CoverageOptions),
    /// Open questions of crowd physics: crowds of the model in situations with known experiments (hours)
    #[command(
        after_help = "Example: cargo run --release -p experiments -- physics start-waves --out DIR"
    )]
    Physics(PhysicsOptions),
    /// What would the errors that `sandbox estimate` reaches in rows of Table 1 cost with presets? (minutes)
    #[command(
        after_help = "Example: cargo run --release -p experiments -- costs --error flow_per_s=3% --out DIR",
        mut_arg("errors", |errors| errors.required(true))
    )]
    Costs(CostOptions),
    /// What does `sandbox estimate` know before the first run? Its JSON ships with the program (an hour)
    Knowledge(CaseOptions),
}

#[derive(Args)]
struct PhysicsOptions {
    /// The questions
    #[arg(required = true, value_parser = PossibleValuesParser::new(physics::PRODUCTS.map(|product| product.name)))]
    questions: Vec<String>,
    #[command(flatten)]
    cases: CaseOptions,
}

#[derive(Args)]
struct CostOptions {
    #[command(flatten)]
    error: ErrorOptions,
    #[command(flatten)]
    cases: CaseOptions,
}

#[derive(Args)]
struct CoverageOptions {
    /// The scenes [default: all]
    #[arg(value_name = "SCENE", value_parser = PossibleValuesParser::new(scenes()))]
    scenes: Vec<String>,
    /// Few runs and estimates; a check that everything works
    #[arg(long)]
    quick: bool,
    /// Number of runs at each step in the pools [default: 300]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(2..=1000))]
    seeds: Option<u32>,
    #[command(flatten)]
    cases: CaseOptions,
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
        Command::Coverage(options) => count_intervals(options),
        Command::Physics(options) => answer(&options.questions, &options.cases),
        Command::Costs(CostOptions { error, cases }) => {
            let store = cases.store(&[COSTS], &Names::new(COSTS, &[COSTS], &[COSTS]))?;
            cases.give(&costs(&error.request(), &store, &Watch::new())?)
        }
        Command::Knowledge(cases) => {
            let store = cases.store(&[KNOWLEDGE], &Names::new(KNOWLEDGE, &[KNOWLEDGE], &[]))?;
            cases.give(&knowledge(&store, &Watch::new())?.findings()?)
        }
    }
}

/// Computes the products of these questions of physics.
fn answer(questions: &[String], cases: &CaseOptions) -> Result<(), Failure> {
    let is_asked = |product: &&Product| questions.iter().any(|name| name == product.name);
    let products: Vec<&Product> = physics::PRODUCTS.into_iter().filter(is_asked).collect();
    let names: Vec<&str> = products.iter().map(|product| product.name).collect();
    let files: Vec<Names> = products.iter().map(|product| product.names()).collect();
    let store = cases.store(&names, &Names::joined("physics", &files))?;
    let found = reproduce(&products, 1, &store, &Watch::new())?;
    found.iter().try_for_each(|one| cases.give(one))
}

fn count_intervals(options: &CoverageOptions) -> Result<(), Failure> {
    let usual = match options.quick {
        true => Pool::QUICK,
        false => Pool::WHOLE,
    };
    let pool = Pool {
        seeds: options.seeds.map_or(usual.seeds, |seeds| seeds as usize),
        ..usual
    };
    let cases = &options.cases;
    let store = cases.store(&[COVERAGE], &Names::new(COVERAGE, &[COVERAGE], &[]))?;
    cases.give(&coverage(&options.scenes, pool, &store, &Watch::new())?.findings()?)
}

fn measure_walls(options: &WallOptions) -> Result<(), Failure> {
    let WallOptions {
        results,
        quick,
        print,
        document,
    } = options;
    results.check(&Names::new(walls::NAME, &[walls::NAME], &[walls::NAME]))?;
    document.check(results.out.as_deref(), &[walls::TABLES])?;
    print.apply();
    let findings = walls::measure(*quick).findings()?;
    results.give(&findings)?;
    document.put(findings.document.parts(walls::TABLES))
}
