//! The options of `sandbox draw`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::cli::arguments::{SceneOptions, TrackOptions};
use crate::cli::values::{
    Width, dpi, frame_rate, millimeters, picture, positive_seconds, range, seconds, width,
};
use scenario::trajectories::endings;

#[derive(Args)]
pub struct DrawOptions {
    #[arg(
        value_name = "RUN",
        help = format!("A built-in scenario, a scenario file, trajectories ({}), or a recording (.rrd)", endings())
    )]
    pub run: String,
    #[command(flatten)]
    pub scene: SceneOptions,
    /// The picture (.svg, .png, .pdf), an animation (.gif, .png, .mp4, .webm), or a page (.html) of all of a recording
    /// or of trajectories [default: the run's name with .svg, in the working directory]
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
    /// Show the routes to an exit, waypoint, waiting area or queue, or to a point; may be repeated
    #[arg(long, value_name = "PLACE|X,Y", allow_hyphen_values = true)]
    pub paths: Vec<String>,
    /// Show the number of people out over time, by exit, and print the table: a scenario is run to its end
    #[arg(long, conflicts_with_all = ["at", "from", "color", "range", "trails", "field", "paths"])]
    pub egress: bool,
    /// Width of the picture in millimeters, or in pixels: 1200px [default: 180]
    #[arg(long, value_name = "MM|px", value_parser = width)]
    pub width: Option<Width>,
    /// Pixels per inch [default: 300, of animations 100]
    #[arg(long, value_name = "N", value_parser = dpi)]
    pub dpi: Option<f64>,
    /// For a column of a paper that is this wide, millimeters: without a title
    #[arg(long, value_name = "MM", conflicts_with = "width", value_parser = millimeters)]
    pub paper: Option<f64>,
    /// Put the Rerun viewer and the recording into a page, too: the folder of the Python package `rerun_notebook`
    /// 0.36.3
    #[arg(long, value_name = "DIR")]
    pub page_viewer: Option<PathBuf>,
    #[command(flatten)]
    pub tracks: TrackOptions,
    /// Frames per second of a trajectory file [default: that of the file]
    #[arg(long, value_name = "N", value_parser = frame_rate)]
    pub trajectory_fps: Option<f64>,
}
