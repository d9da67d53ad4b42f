//! Options that several commands have, as typed.

use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use clap::{ArgGroup, Args};

use super::documents::DocumentOptions;
use super::failure::Failure;
use super::values::{
    self, dpi, every_frames, frame_rate, millimeters, positive_seconds, recording, seconds, seed,
    threads,
};
use lab::estimate::{Bound, Limits, Request, Sampling, Wanted};
use output::plot::Print;
use runs::outputs::Outputs;
use runs::store::Store;
use scenario::quote::shown;
use scenario::trajectories::{OnLevel, ReadOptions, UNITS, Unit};
use scenario::{Preset, Setting};

/// Options that change a scenario and how it is computed.
#[derive(Args)]
#[command(next_help_heading = "Scenario")]
pub struct SceneOptions {
    /// Default profile, for agents that name none; `sandbox list` says what each profile does (quote the arrow of
    /// `sf->sph`, or write sf-sph)
    #[arg(long, value_name = "NAME")]
    pub profile: Option<String>,
    #[command(flatten)]
    pub changes: ChangeOptions,
    /// Numerical settings: the paper's, cheaper ones, or more accurate ones (see docs/guide/estimate.md)
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Preset::names()))]
    pub preset: Option<String>,
    /// Time step Δt_fine in seconds, or `auto`: the largest step that is safely stable and keeps results (see
    /// longest_step_secs)
    #[arg(long, value_name = "SECS|auto")]
    pub time_step: Option<String>,
    /// A floor plan that replaces the scenario's walkable area and obstacles: DXF, GeoJSON, WKT or JuPedSim XML
    #[arg(long, value_name = "FILE")]
    pub geometry: Option<PathBuf>,
    #[command(flatten)]
    pub program: ProgramOptions,
}

/// How trajectory files are read.
#[derive(Args)]
pub struct TrackOptions {
    /// Unit of the coordinates in trajectory files [default: that of the file, else m]
    #[arg(long, value_parser = PossibleValuesParser::new(UNITS))]
    pub unit: Option<String>,
    /// Of a building, this level only
    #[arg(long, value_name = "NAME")]
    pub level: Option<String>,
}

impl TrackOptions {
    /// How to read a file whose frame rate the command line gives.
    pub fn reading(&self, fps: Option<f64>) -> ReadOptions {
        ReadOptions {
            unit: self.unit.as_deref().and_then(Unit::named),
            fps,
            level: self.level.clone().map_or(OnLevel::Only, OnLevel::Named),
        }
    }
}

/// The random numbers and the settings of scenarios.
#[derive(Args)]
pub struct ChangeOptions {
    /// Seed of all random numbers
    #[arg(long, allow_negative_numbers = true, value_parser = seed)]
    pub seed: Option<u64>,
    /// Change a setting of the scenario (see `sandbox list --settings`); may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl ChangeOptions {
    /// The settings of `--set`.
    pub fn settings(&self) -> Result<Vec<Setting>, Failure> {
        self.set.iter().map(|text| setting(text)).collect()
    }
}

/// The setting of `--set`.
pub fn setting(text: &str) -> Result<Setting, Failure> {
    text.parse()
        .map_err(|error| Failure::Input(format!("--set {}: {error}", shown(text))))
}

/// What becomes of existing files in the folder for the results of many runs.
#[derive(Args)]
pub struct ReplaceOptions {
    /// Replace existing files with the results' names in a folder that does not belong to a study
    #[arg(long)]
    pub force: bool,
}

impl ReplaceOptions {
    /// The outputs of a command whose results are in `folder`.
    pub fn outputs(&self, folder: &Path) -> Outputs {
        Outputs::new(self.force || Store::at(folder).is_begun())
    }
}

/// Options of computing and reporting.
#[derive(Args, Clone, Copy)]
#[command(next_help_heading = "Program")]
pub struct ProgramOptions {
    /// Number of threads; the results do not depend on it [default: all cores]
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
#[command(next_help_heading = "Run")]
pub struct OutputOptions {
    /// Time at which the run ends, seconds [default: the scenario's duration]
    #[arg(long, value_name = "SECS", allow_negative_numbers = true, value_parser = seconds)]
    pub until: Option<f64>,
    /// Also print the computing time of each stage of a frame
    #[arg(long, short)]
    pub verbose: bool,
    #[command(flatten)]
    pub files: DocumentOptions,
    #[command(flatten)]
    pub record: RecordOptions,
    #[command(flatten)]
    pub trajectory: TrajectoryOptions,
    #[command(flatten)]
    pub checkpoint: CheckpointOptions,
}

/// Options of checkpoints.
#[derive(Args)]
#[command(next_help_heading = "Checkpoints")]
pub struct CheckpointOptions {
    /// Write checkpoints to this file, each replacing the previous one; a run shorter than the interval writes one at
    /// its end
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Simulated seconds between checkpoints
    #[arg(long, value_name = "SECS", default_value_t = 10.0, requires = "checkpoint", value_parser = positive_seconds)]
    pub checkpoint_every: f64,
}

/// Options of recordings and pages.
#[derive(Args)]
#[command(next_help_heading = "Recording and live view")]
#[command(group(ArgGroup::new("record").multiple(true).args(["save", "spawn", "connect"])))]
pub struct RecordOptions {
    /// Write a recording for the Rerun viewer (.rrd) or a page for any browser (.html); may be given once for each
    #[arg(long, value_name = "FILE", value_parser = recording())]
    pub save: Vec<PathBuf>,
    /// Put the Rerun viewer and the recording into the page, too: the folder of the Python package `rerun_notebook`
    /// 0.36.3
    #[arg(long, value_name = "DIR", requires = "save")]
    pub page_viewer: Option<PathBuf>,
    /// Show the run live in a Rerun viewer; starts one if none is running
    #[arg(long)]
    pub spawn: bool,
    /// Show the run live in the viewer at this address: rerun+http://HOST:PORT/proxy, or HOST:PORT
    #[arg(long, value_name = "URL", conflicts_with = "spawn")]
    pub connect: Option<String>,
    /// Record every N-th frame, and the last one
    #[arg(long, value_name = "N", default_value_t = 5, requires = "record", value_parser = every_frames)]
    pub record_every: u64,
    /// Start recording at this time, seconds
    #[arg(
        long,
        value_name = "SECS",
        default_value_t = 0.0,
        requires = "record",
        allow_negative_numbers = true,
        value_parser = seconds
    )]
    pub record_from: f64,
    /// Agents whose forces the recording shows: ids, all or none [default: the scenario's choice]
    #[arg(
        long,
        value_name = "17,42|all|none",
        requires = "record",
        conflicts_with = "debug_region"
    )]
    pub debug_agents: Option<String>,
    /// Show the forces on the agents that are in this rectangle in each recorded frame
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
#[command(next_help_heading = "Trajectories")]
pub struct TrajectoryOptions {
    /// Write the trajectories: .sqlite or .db for JuPedSim and PedPy, .txt, or .csv with all quantities; may be
    /// repeated
    #[arg(long = "trajectory", value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Frames per second of the trajectories; must divide the simulation's frame rate
    #[arg(
        long = "trajectory-fps",
        value_name = "N",
        default_value_t = 10.0,
        requires = "files",
        value_parser = frame_rate
    )]
    pub fps: f64,
}

/// Results, and the errors that they may have.
#[derive(Args)]
#[command(group(ArgGroup::new("asked").multiple(true).args(["errors", "bounds"])))]
pub struct ErrorOptions {
    /// A result, and the error that it may have: half the width of its confidence interval, in percent of the value or
    /// in its unit; may be repeated. In a study: of each combination of settings, which then has as many runs as this
    /// error needs
    #[arg(long = "error", value_name = "RESULT=ERROR")]
    pub errors: Vec<Wanted>,
    /// A result, and the share of runs that shall be at most a bound (below 50%: that shall be below, while the others
    /// are at least the bound); may be repeated. It makes as many runs as this needs: 59 for 95%
    #[arg(long = "bound", value_name = "RESULT=SHARE")]
    pub bounds: Vec<Bound>,
    /// The runs that bounds are made of: `imo`: 50 runs of 10 populations, as in IMO's guidelines on evacuation
    /// analysis [default: as many as the bound needs]
    #[arg(long, value_name = "imo", requires = "bounds", value_parser = PossibleValuesParser::new(["imo"]))]
    pub runs: Option<String>,
    /// The probability that an interval holds the value, or that a bound holds, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 95.0, requires = "asked", value_parser = values::confidence)]
    pub confidence: f64,
    /// The most runs, at all time steps together
    #[arg(long, value_name = "N", default_value_t = 500, requires = "asked", value_parser = values::runs)]
    pub most_runs: usize,
    /// The time after which no more runs begin, minutes [default: no limit]
    #[arg(long, value_name = "MINUTES", requires = "asked", value_parser = values::minutes)]
    pub most_minutes: Option<f64>,
}

impl ErrorOptions {
    /// Whether anything is asked for.
    pub fn is_given(&self) -> bool {
        !self.errors.is_empty() || !self.bounds.is_empty()
    }

    /// What is asked for.
    pub fn request(&self) -> Request {
        Request {
            wanted: self.errors.clone(),
            bounds: self.bounds.clone(),
            sampling: match self.runs {
                Some(_) => Sampling::Imo,
                None => Sampling::Seeds,
            },
            confidence: self.confidence / 100.0,
            limits: Limits {
                runs: self.most_runs,
                secs: self.most_minutes.map(|minutes| 60.0 * minutes),
            },
        }
    }
}

/// How pictures of results are printed.
#[derive(Args)]
pub struct PrintOptions {
    /// Draw pictures for a column of a paper that is this wide, millimeters: without titles, as SVG, PNG and PDF
    #[arg(long, value_name = "MM", value_parser = millimeters)]
    pub paper: Option<f64>,
    /// Pixels per inch of PNG files [default: 300 with --paper, else 150]
    #[arg(long, value_name = "N", value_parser = dpi)]
    pub dpi: Option<f64>,
}

impl PrintOptions {
    /// Prints all pictures of the program like this.
    pub fn apply(&self) {
        let plain = self.paper.map_or_else(Print::default, Print::paper);
        let print = Print {
            dpi: self.dpi.unwrap_or(plain.dpi),
            ..plain
        };
        print.for_all_sheets();
    }
}

/// The environment variables from which rayon takes the number of threads, in this order.
const THREADS: [&str; 2] = ["RAYON_NUM_THREADS", "RAYON_RS_NUM_CPUS"];

/// Sets the number of rayon's threads: `threads`, else the environment's number, else all cores. Call it before
/// anything that may compute in parallel.
pub fn use_threads(threads: Option<usize>) -> Result<(), Failure> {
    let given = THREADS.into_iter().find_map(|name| {
        let text = std::env::var(name).ok().filter(|text| !text.is_empty())?;
        Some((name, text))
    });
    let (source, threads) = match (threads, given) {
        (Some(threads), _) => ("--threads", threads),
        (None, Some((name, text))) => match values::threads(&text) {
            Ok(threads) => (name, threads),
            Err(error) => {
                let reason = format!("{name}={text} in the environment: {error}");
                return Err(Failure::Input(reason));
            }
        },
        (None, None) => return Ok(()),
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::Output(format!("{source} {threads}: {error}")))
}
