//! The command line arguments, as typed.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{ArgGroup, Args, Parser, Subcommand};
use clap_complete::Shell;

use super::values::{
    every_frames, frame_rate, id, positive_seconds, recording, seconds, seed, threads,
};
use super::{accuracy, bench, measure, reproduce, stress, sweep};
use crate::scenario::{Preset, SHIPPED};

const EXAMPLES: &str = "\
Examples:
  sandbox evacuation --profile 'sf->sph' --set rest_density_max=6 --json
  sandbox crossing --profile rvo --save crossing.rrd
  sandbox concert --record-from 149 --save recordings/concert.rrd --force
  sandbox evacuation --trajectory evacuation.sqlite --trajectory evacuation.csv
  sandbox run my_station.json --until 60 --threads 2 --json
  sandbox run my_station.json --geometry station.geojson
  sandbox inspect evacuation --agent 17 --at 15 --json
  sandbox sweep study.json --threads 2
  sandbox bench scaling --largest 100000
  sandbox list --settings";

const SCHEMA_EXAMPLE: &str = "\
Example: sandbox schema > scenario.schema.json
Editors use it where a scenario has the key \"$schema\": \"scenario.schema.json\".";

/// Simulate, measure and inspect dense crowds (SPH crowds, van Toll et al. 2021).
#[derive(Parser)]
#[command(version, arg_required_else_help = true, after_help = EXAMPLES)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// 400 people leave a room through a narrow door (§6.1)
    #[command(
        after_help = "Example: sandbox evacuation --profile 'sf->sph' --set rest_density_max=6 --json"
    )]
    Evacuation(RunOptions),
    /// A crowd crosses a stream on its way to a narrow door (§6.2)
    #[command(after_help = "Example: sandbox crossing --profile rvo --save crossing.rrd")]
    Crossing(RunOptions),
    /// 10,000 people before a stage, and a shockwave (§6.3)
    #[command(
        after_help = "Example: sandbox concert --record-from 149 --save recordings/concert.rrd --force"
    )]
    Concert(RunOptions),
    /// 50,000 people stream over a square into the queues before ten gates (§7)
    #[command(after_help = "Example: sandbox plaza --until 30 --save plaza.rrd --record-every 25")]
    Plaza(RunOptions),
    /// Run a scenario file
    #[command(after_help = "Example: sandbox run my_station.json --until 60 --threads 2 --json")]
    Run {
        /// The scenario, JSON
        file: PathBuf,
        #[command(flatten)]
        options: RunOptions,
    },
    /// Go on with a run from a checkpoint, as if it had never stopped
    #[command(after_help = "Example: sandbox resume concert.checkpoint --json")]
    Resume(ResumeOptions),
    /// Lay open the forces on single agents at one moment
    #[command(after_help = "Example: sandbox inspect evacuation --agent 17 --at 15 --json")]
    Inspect(InspectOptions),
    /// Regenerate the paper's tables and figures (§6) beside the published ones
    #[command(
        after_help = format!("{}Example: sandbox reproduce table1 fig5 --seeds 3", reproduce::about())
    )]
    Reproduce(reproduce::ReproduceOptions),
    /// Measure how fast it is on this machine: a table, one JSON object, a picture
    #[command(after_help = format!("{}{}", bench::about(), bench::EXAMPLES))]
    Bench(bench::BenchOptions),
    /// Measure run time against error for every numerical choice: tables and work-precision diagrams
    #[command(after_help = format!("{}Example: sandbox accuracy relaxed wall --knob integrator", accuracy::about()))]
    Accuracy(accuracy::AccuracyOptions),
    /// Run hard cases, map the largest stable time step, measure jitter
    #[command(after_help = "Example: sandbox stress --quick")]
    Stress(stress::StressOptions),
    /// Print the JSON Schema of scenario files, by which editors complete and check them
    #[command(after_help = SCHEMA_EXAMPLE)]
    Schema,
    /// Run a scenario over a grid or list of settings and over seeds: a table, on many threads or machines
    #[command(after_help = sweep::EXAMPLE)]
    Sweep(sweep::SweepOptions),
    /// Measure densities, speeds and flows in trajectories, real or simulated (§8)
    #[command(
        after_help = "Example: sandbox measure run.sqlite --line 21,9.6,21,10.4 --region 15,8,19,12"
    )]
    Measure(measure::MeasureOptions),
    /// List the scenarios and profiles, or the settings that --set takes
    #[command(after_help = "Example: sandbox list --settings")]
    List {
        /// List what --set takes instead of the scenarios and profiles
        #[arg(long)]
        settings: bool,
    },
    /// Print what a shell needs to complete commands and options
    #[command(
        after_help = "Example: sandbox completions bash > ~/.local/share/bash-completion/completions/sandbox"
    )]
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the man page of the program, or write those of all subcommands too
    #[command(after_help = "Example: sandbox man --out ~/.local/share/man/man1")]
    Man {
        /// Write a page for the program and one for every subcommand into this folder instead
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Options that change a scenario and how it is computed.
#[derive(Args)]
pub struct SceneOptions {
    /// Profile of all agents that name none of their own: sf, rvo, sf+sph, rvo+sph, sph, sf->sph or rvo->sph (quote the arrow)
    #[arg(long, value_name = "NAME")]
    pub profile: Option<String>,
    /// Seed of all random numbers
    #[arg(long, allow_negative_numbers = true, value_parser = seed)]
    pub seed: Option<u64>,
    /// Numerics: the paper's, cheaper ones, or nearer to the model's own limit (see docs/accuracy.md)
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Preset::ALL.map(|(name, _)| name)))]
    pub preset: Option<String>,
    /// Δt_fine in seconds, or `auto`: the largest step at which the crowd is sure to come to rest
    #[arg(long, value_name = "SECS|auto")]
    pub time_step: Option<String>,
    /// A floor plan, WKT or GeoJSON in metres, in place of the scenario's walkable area and obstacles
    #[arg(long, value_name = "FILE")]
    pub geometry: Option<PathBuf>,
    /// Change a setting of the scenario (see `sandbox list --settings`); may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    #[command(flatten)]
    pub program: ProgramOptions,
}

/// Options of computing and reporting.
#[derive(Args)]
pub struct ProgramOptions {
    /// Threads to compute on; the results do not depend on it [default: all cores]
    #[arg(long, value_parser = threads)]
    pub threads: Option<usize>,
    /// Replace existing output files
    #[arg(long)]
    pub force: bool,
    /// Print one JSON object instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Args)]
pub struct RunOptions {
    #[command(flatten)]
    pub scene: SceneOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

#[derive(Args)]
pub struct ResumeOptions {
    /// The checkpoint
    pub file: PathBuf,
    #[command(flatten)]
    pub program: ProgramOptions,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// The length of a run and its output files.
#[derive(Args)]
pub struct OutputOptions {
    /// Stop at this time, seconds [default: the scenario's]
    #[arg(long, value_name = "SECS", allow_negative_numbers = true, value_parser = seconds)]
    pub until: Option<f64>,
    #[command(flatten)]
    pub record: RecordOptions,
    #[command(flatten)]
    pub trajectory: TrajectoryOptions,
    #[command(flatten)]
    pub checkpoint: CheckpointOptions,
}

/// Options of checkpoints.
#[derive(Args)]
pub struct CheckpointOptions {
    /// Write checkpoints to this file, each in place of the one before, and one at the end of a run that has none
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Every so many simulated seconds
    #[arg(long, value_name = "SECS", default_value_t = 10.0, requires = "checkpoint", value_parser = positive_seconds)]
    pub checkpoint_every: f64,
}

/// Options of recordings.
#[derive(Args)]
#[command(group(ArgGroup::new("record").multiple(true).args(["save", "spawn", "connect"])))]
pub struct RecordOptions {
    /// Write a recording for the Rerun viewer
    #[arg(long, value_name = "FILE.rrd", value_parser = recording())]
    pub save: Option<PathBuf>,
    /// Show the run in a Rerun viewer while it goes on; starts one if none is there
    #[arg(long)]
    pub spawn: bool,
    /// Show the run in the viewer that listens there: rerun+http://HOST:PORT/proxy, or HOST:PORT
    #[arg(long, value_name = "URL", conflicts_with = "spawn")]
    pub connect: Option<String>,
    /// Record every so many frames
    #[arg(long, value_name = "FRAMES", default_value_t = 5, requires = "record", value_parser = every_frames)]
    pub record_every: u64,
    /// Record from this time on, seconds
    #[arg(long, value_name = "SECS", default_value_t = 0.0, requires = "record", allow_negative_numbers = true, value_parser = seconds)]
    pub record_from: f64,
    /// Lay these agents open in the recording: ids, all or none [default: the scenario's choice]
    #[arg(
        long,
        value_name = "17,42|all|none",
        requires = "record",
        conflicts_with = "debug_region"
    )]
    pub debug_agents: Option<String>,
    /// Lay open the agents that are in this rectangle at each recorded frame
    #[arg(
        long,
        value_name = "X0,Y0,X1,Y1",
        requires = "record",
        allow_hyphen_values = true
    )]
    pub debug_region: Option<String>,
}

/// Options of trajectory files.
#[derive(Args)]
pub struct TrajectoryOptions {
    /// Write everybody's trajectory: .sqlite or .db for JuPedSim and PedPy, .txt, or .csv with every quantity; may be repeated
    #[arg(long = "trajectory", value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Frames per second of the trajectories; must divide the simulation's
    #[arg(long = "trajectory-fps", value_name = "N", default_value_t = 10.0, requires = "files", value_parser = frame_rate)]
    pub fps: f64,
}

#[derive(Args)]
pub struct InspectOptions {
    /// A scenario by name, or a scenario file
    #[arg(value_name = "SCENARIO_OR_FILE")]
    pub scenario: String,
    #[command(flatten)]
    pub scene: SceneOptions,
    /// The agent's id; may be repeated
    #[arg(long, value_name = "ID", required_unless_present = "all", value_parser = id)]
    pub agent: Vec<u32>,
    /// Inspect every agent
    #[arg(long, conflicts_with = "agent")]
    pub all: bool,
    /// The moment, seconds; 0 is the scenario's start, nobody moved
    #[arg(long, value_name = "SECS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = seconds)]
    pub at: f64,
    /// Write the same as a recording for the Rerun viewer
    #[arg(long, value_name = "FILE.rrd", value_parser = recording())]
    pub save: Option<PathBuf>,
}

/// The source of a scenario.
pub enum Source {
    Shipped(&'static str),
    File(PathBuf),
}

impl Source {
    /// The built-in scenario of that name, else a file.
    pub fn named(text: &str) -> Self {
        let names = SHIPPED.iter().map(|shipped| shipped.name);
        match names.into_iter().find(|&name| name == text) {
            Some(name) => Self::Shipped(name),
            None => Self::File(PathBuf::from(text)),
        }
    }
}
