//! The commands, as typed.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand};
use clap_complete::Shell;

use super::arguments::{ResumeOptions, RunOptions};
use super::update::UpdateOptions;
use super::values::generated;
use super::{
    accuracy, bench, calibrate, compare, convert, draw, estimate, inspect, measure, page, report,
    reproduce, stress, studio, suite, sweep,
};

const EXAMPLES: &str = "\
Examples:
  sandbox evacuation --profile 'sf->sph' --set rest_density_max=6 --json
  sandbox crossing --profile rvo --save crossing.rrd
  sandbox concert --record-from 149 --save recordings/concert.rrd --force
  sandbox evacuation --trajectory evacuation.sqlite --trajectory evacuation.csv
  sandbox run my_station.json --until 60 --threads 2 --json
  sandbox run my_station.json --geometry station.geojson
  sandbox inspect evacuation --agent 17 --at 15 --json
  sandbox draw my_station.json --paths 'east exit' --out routes.png
  sandbox report my_station.json --out station.pdf
  sandbox run my_station.json --save my_station.html
  sandbox sweep study.json --threads 2
  sandbox bench scaling --largest 100000
  sandbox list --settings";

const LIST_EXAMPLES: &str = "\
Examples:
  sandbox list --settings
  sandbox list --settings --update docs/reference/settings.md
  sandbox list --schema > scenario.schema.json
Editors use the schema where a scenario has the key \"$schema\": \"scenario.schema.json\".";

const DRAW_EXAMPLES: &str = "\
Examples:
  sandbox draw scenarios/station.json -o station.png
  sandbox draw evacuation.rrd -o evacuation.html";

const CONVERT_EXAMPLES: &str = "\
Examples:
  sandbox convert station.xml -o station.json
  sandbox convert scenarios/station.json -o station.geojson";

const GENERATE_EXAMPLES: &str = "\
Examples:
  sandbox generate bash > ~/.local/share/bash-completion/completions/sandbox
  sandbox generate man --out ~/.local/share/man/man1";

/// Simulate, measure and inspect dense crowds (SPH crowds, van Toll et al. 2021)
#[derive(Parser)]
#[command(version, arg_required_else_help = true, after_help = EXAMPLES)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Run the evacuation: 400 people leave a room through a narrow door (§6.1)
    #[command(
        after_help = "Example: sandbox evacuation --profile 'sf->sph' --set rest_density_max=6 --json"
    )]
    Evacuation(RunOptions),
    /// Run the crossing: a crowd crosses a stream on its way to a narrow door (§6.2)
    #[command(after_help = "Example: sandbox crossing --profile rvo --save crossing.rrd")]
    Crossing(RunOptions),
    /// Run the concert: 10,000 people before a stage, and a shockwave (§6.3)
    #[command(
        after_help = "Example: sandbox concert --record-from 149 --save recordings/concert.rrd --force"
    )]
    Concert(RunOptions),
    /// Run the plaza: 50,000 people cross a square to the queues before ten gates (§7)
    #[command(after_help = "Example: sandbox plaza --until 30 --save plaza.rrd --record-every 25")]
    Plaza(RunOptions),
    /// Run a scenario: a file, or a built-in one by its name
    #[command(after_help = "Example: sandbox run my_station.json --until 60 --threads 2 --json")]
    Run {
        /// The scenario, a JSON file (`-`: the standard input) or one of JuPedSim's web app (.zip); or the name of a
        /// built-in one
        file: PathBuf,
        #[command(flatten)]
        options: RunOptions,
    },
    /// Resume a run from a checkpoint, with the same results as without interruption
    #[command(after_help = "Example: sandbox resume concert.checkpoint --json")]
    Resume(ResumeOptions),
    /// Print every force on single agents at one moment
    #[command(after_help = "Example: sandbox inspect evacuation --agent 17 --at 15 --json")]
    Inspect(inspect::InspectOptions),
    /// Draw a scenario, trajectories or a recording: as a picture, as an animation, or as a page that plays in any
    /// browser
    #[command(
        after_help = DRAW_EXAMPLES
    )]
    Draw(draw::DrawOptions),
    /// Write a floor plan or a scenario as a scenario in JSON, or its floor and places as GeoJSON
    #[command(after_help = CONVERT_EXAMPLES)]
    Convert(convert::ConvertOptions),
    /// Write the document that is handed in with a run or a study: plan, results with definitions, pictures, limits
    #[command(after_help = report::EXAMPLES)]
    Report(report::ReportOptions),
    /// Draw a floor, play it, and intervene while it runs, in the browser of this machine
    #[command(after_help = studio::EXAMPLES)]
    Studio(studio::StudioOptions),
    /// Make a page of a recording or of trajectories: the same as `draw RUN -o FILE.html`
    #[command(
        hide = true,
        after_help = "Example: sandbox page evacuation.rrd --out evacuation.html"
    )]
    Page(page::PageOptions),
    /// Regenerate the paper's tables and figures (§6) and compare them with the published ones
    #[command(
        after_help = format!("{}Example: sandbox reproduce table1 fig5 --seeds 3", reproduce::about()),
        mut_arg("out", |out| out.required(false).default_value("reproduction"))
    )]
    Reproduce(reproduce::ReproduceOptions),
    /// Measure performance on this machine: a table, a JSON object, pictures
    #[command(after_help = format!("{}{}", bench::about(), bench::EXAMPLES))]
    Bench(bench::BenchOptions),
    /// Measure run time against error for each numerical choice: tables and work-precision diagrams
    #[command(
        after_help = format!("{}Example: sandbox accuracy relaxed wall --choice integrator", accuracy::about()),
        mut_arg("out", |out| out.required(false).default_value("accuracy"))
    )]
    Accuracy(accuracy::AccuracyOptions),
    /// Run hard cases, map the largest stable time step, measure jitter
    #[command(
        after_help = "Example: sandbox stress --quick",
        mut_arg("out", |out| out.required(false).default_value("stress"))
    )]
    Stress(stress::StressOptions),
    /// Run verification cases of RiMEA, ISO 20414 and NIST: tables and pictures
    #[command(
        after_help = format!(
            "{}Example: sandbox verify 12 iso6 --seeds 3",
            suite::about(suite::VERIFICATION)
        ),
        mut_arg("out", |out| out.required(false).default_value("verification")),
        mut_arg("seed", |seed| seed.help(suite::FIRST_SEED)),
        mut_arg("set", |set| set.help(suite::EVERY_SCENE))
    )]
    Verify(suite::VerifyOptions),
    /// Compare scenes of experiments with what was measured there: tables and pictures
    #[command(
        after_help = format!("{}Example: sandbox validate door --seeds 3", suite::about(suite::VALIDATION)),
        mut_arg("out", |out| out.required(false).default_value("validation")),
        mut_arg("seed", |seed| seed.help(suite::FIRST_SEED)),
        mut_arg("set", |set| set.help(suite::EVERY_SCENE))
    )]
    Validate(suite::ValidateOptions),
    /// Search for parameters with which scenes come close to what was measured there
    #[command(after_help = calibrate::EXAMPLE)]
    Calibrate(calibrate::CalibrateOptions),
    /// Print the JSON Schema of scenario files: the same as `list --schema`
    #[command(hide = true)]
    Schema,
    /// Run a scenario over a grid or list of settings and over seeds, on many threads or machines
    #[command(after_help = sweep::EXAMPLE)]
    Sweep(sweep::SweepOptions),
    /// Compute results with the errors asked for: chooses time steps and numbers of runs
    #[command(after_help = estimate::EXAMPLES)]
    Estimate(estimate::EstimateOptions),
    /// Measure densities, speeds and flows in trajectories, real or simulated (§8)
    #[command(
        after_help = "Example: sandbox measure run.sqlite --line 21,9.6,21,10.4 --region 15,8,19,12"
    )]
    Measure(measure::MeasureOptions),
    /// List what differs between two results: in settings and measurements, or between two trajectory files
    #[command(after_help = "Example: sandbox compare one.json other.json")]
    Compare(compare::CompareOptions),
    /// List the built-in scenarios and the profiles, the settings that --set takes, what measurements measure, or the
    /// JSON Schema of scenario files
    #[command(after_help = LIST_EXAMPLES)]
    List {
        /// List the settings that --set takes and the keys of nested objects, with meaning, unit, default and range
        #[arg(long)]
        settings: bool,
        /// List what the measurements of scenarios measure: names, units and definitions of their values
        #[arg(long, conflicts_with = "settings")]
        measurements: bool,
        /// Print the JSON Schema of scenario files, for completion and checks in editors
        #[arg(long, conflicts_with_all = ["settings", "measurements", "update"])]
        schema: bool,
        #[command(flatten)]
        document: UpdateOptions,
        /// Print one JSON object instead of text
        #[arg(long)]
        json: bool,
    },
    /// Print a shell completion script or the man page, or write the man pages of all commands
    #[command(after_help = GENERATE_EXAMPLES)]
    Generate {
        /// A shell, or `man`
        #[arg(value_parser = PossibleValuesParser::new(generated()))]
        what: String,
        /// With `man`: write the pages of the program and of all commands to this folder instead
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Print a shell completion script: the same as `generate SHELL`
    #[command(
        hide = true,
        after_help = "Example: sandbox completions bash > ~/.local/share/bash-completion/completions/sandbox"
    )]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the man page, or write the pages of all subcommands: the same as `generate man`
    #[command(
        hide = true,
        after_help = "Example: sandbox man --out ~/.local/share/man/man1"
    )]
    Man {
        /// Write the pages of the program and of all subcommands to this folder instead
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}
