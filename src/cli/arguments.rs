//! The options of commands that run scenarios, as typed.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{ArgGroup, Args};

use super::values::{
    Width, dpi, every_frames, frame_rate, id, millimeters, picture, positive_seconds, range,
    recording, seconds, seed, threads, width,
};
use crate::output::plot::Print;
use crate::scenario::Preset;

/// Options that change a scenario and how it is computed.
#[derive(Args)]
#[command(next_help_heading = "Scenario")]
pub struct SceneOptions {
    /// Default profile, for agents that name none; `sandbox list` says what each profile does (quote the arrow of
    /// `sf->sph`, or write sf-sph)
    #[arg(long, value_name = "NAME")]
    pub profile: Option<String>,
    /// Seed of all random numbers
    #[arg(long, allow_negative_numbers = true, value_parser = seed)]
    pub seed: Option<u64>,
    /// Numerical settings: the paper's, cheaper ones, or more accurate ones (see docs/accuracy.md)
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(Preset::names()))]
    pub preset: Option<String>,
    /// Time step Δt_fine in seconds, or `auto`: the largest step that is safely stable and keeps results (see
    /// longest_step_secs)
    #[arg(long, value_name = "SECS|auto")]
    pub time_step: Option<String>,
    /// A floor plan that replaces the scenario's walkable area and obstacles: WKT, GeoJSON or JuPedSim XML
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

/// Options of recordings.
#[derive(Args)]
#[command(next_help_heading = "Recording and live view")]
#[command(group(ArgGroup::new("record").multiple(true).args(["save", "spawn", "connect"])))]
pub struct RecordOptions {
    /// Write a recording for the Rerun viewer
    #[arg(long, value_name = "FILE.rrd", value_parser = recording())]
    pub save: Option<PathBuf>,
    /// Show the run live in a Rerun viewer; starts one if none is running
    #[arg(long)]
    pub spawn: bool,
    /// Show the run live in the viewer at this address: rerun+http://HOST:PORT/proxy, or HOST:PORT
    #[arg(long, value_name = "URL", conflicts_with = "spawn")]
    pub connect: Option<String>,
    /// Record every N-th frame
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

#[derive(Args)]
pub struct InspectOptions {
    /// A built-in scenario or a scenario file
    #[arg(value_name = "SCENARIO_OR_FILE")]
    pub scenario: String,
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Id of an agent; may be repeated
    #[arg(long, value_name = "ID", required_unless_present = "all", value_parser = id)]
    pub agent: Vec<u32>,
    /// Inspect every agent
    #[arg(long, conflicts_with = "agent")]
    pub all: bool,
    /// The moment, seconds; at 0 no agent has moved yet
    #[arg(long, value_name = "SECS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = seconds)]
    pub at: f64,
    /// Also write this moment as a recording for the Rerun viewer
    #[arg(long, value_name = "FILE.rrd", value_parser = recording())]
    pub save: Option<PathBuf>,
}

#[derive(Args)]
pub struct DrawOptions {
    /// A built-in scenario, a scenario file, trajectories (.sqlite, .txt, .csv), or a recording (.rrd)
    #[arg(value_name = "RUN")]
    pub run: String,
    #[command(flatten)]
    pub scene: SceneOptions,
    /// The picture (.svg, .png, .pdf), or an animation (.gif, .png, .mp4, .webm) [default: the run's name with .svg,
    /// in the working directory]
    #[arg(short, long, value_name = "FILE", value_parser = picture())]
    pub out: Option<PathBuf>,
    /// The moment, seconds; at 0 no agent has moved yet
    #[arg(long, value_name = "SECS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = seconds)]
    pub at: f64,
    /// The first moment of an animation, seconds
    #[arg(
        long,
        value_name = "SECS",
        requires = "to",
        conflicts_with = "at",
        allow_negative_numbers = true,
        value_parser = seconds
    )]
    pub from: Option<f64>,
    /// The end of an animation, seconds
    #[arg(long, value_name = "SECS", requires = "from", allow_negative_numbers = true, value_parser = seconds)]
    pub to: Option<f64>,
    /// Frames of an animation per second
    #[arg(long, value_name = "N", default_value_t = 25.0, requires = "from", value_parser = frame_rate)]
    pub fps: f64,
    /// Color agents by density, speed, pressure or another quantity; none: by what they do [default: density, or
    /// none if the scenario measures forces on walls, which are colored then]
    #[arg(long, value_name = "COLUMN", conflicts_with_all = ["field", "paths"])]
    pub color: Option<String>,
    /// The values with the first and the last color [default: the scenario's view.density_range and
    /// view.speed_range; of other quantities the 1st and 99th percentile of the first picture]
    #[arg(long, value_name = "FROM,TO", allow_hyphen_values = true, value_parser = range)]
    pub range: Option<[f64; 2]>,
    /// Show the paths of the last seconds
    #[arg(long, value_name = "SECS", value_parser = positive_seconds)]
    pub trails: Option<f64>,
    /// Show a field below the agents, by the SPH kernel
    #[arg(
        long,
        value_name = "NAME",
        conflicts_with = "paths",
        value_parser = PossibleValuesParser::new(["density", "speed"])
    )]
    pub field: Option<String>,
    /// Show the ways to an exit, waypoint, waiting area or queue, or to a point; may be repeated
    #[arg(long, value_name = "PLACE|X,Y", allow_hyphen_values = true)]
    pub paths: Vec<String>,
    /// Width of the picture in millimeters, or in pixels: 1200px [default: 180]
    #[arg(long, value_name = "MM|px", value_parser = width)]
    pub width: Option<Width>,
    /// Pixels per inch [default: 300, of animations 100]
    #[arg(long, value_name = "N", value_parser = dpi)]
    pub dpi: Option<f64>,
    /// For a column of a paper that is this wide, millimeters: without a title
    #[arg(long, value_name = "MM", conflicts_with = "width", value_parser = millimeters)]
    pub paper: Option<f64>,
    /// Unit of the coordinates in a trajectory file [default: that of the file, else m]
    #[arg(long, value_parser = PossibleValuesParser::new(["m", "cm"]))]
    pub unit: Option<String>,
    /// Frames per second of a trajectory file [default: that of the file]
    #[arg(long, value_name = "N", value_parser = frame_rate)]
    pub trajectory_fps: Option<f64>,
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
        let print = self.paper.map_or_else(Print::default, Print::paper);
        let print = Print {
            dpi: self.dpi.unwrap_or(print.dpi),
            ..print
        };
        print.for_all_sheets();
    }
}
