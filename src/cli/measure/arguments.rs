//! The options of `sandbox measure`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::cli::arguments::{PrintOptions, ProgramOptions, TrackOptions};
use crate::cli::documents::DocumentOptions;
use crate::cli::values::{
    CutOff, cut_off, frame_rate, length, line, moment, passages, positive_seconds, region, segments,
};
use analysis::crossing::{Line, Passages};
use engine::scene::Region;
use scenario::trajectories::endings;

#[derive(Args)]
pub struct MeasureOptions {
    #[arg(help = format!(
        "Trajectories ({}): JuPedSim's SQLite, HDF5 of the Pedestrian Dynamics Data Archive, CSV, or text (id frame x \
         y)",
        endings()
    ))]
    pub trajectory: PathBuf,
    /// Walkable area: DXF, GeoJSON, WKT or JuPedSim XML, or `none` for no walls [default: that of an SQLite or HDF5
    /// file, else none]
    #[arg(long, value_name = "FILE")]
    pub geometry: Option<PathBuf>,
    #[command(flatten)]
    pub tracks: TrackOptions,
    /// Frames per second [default: that of the file]
    #[arg(long, value_name = "N", value_parser = frame_rate)]
    pub fps: Option<f64>,
    /// Start measuring at this time, seconds; frame f is at f / fps
    #[arg(long, value_name = "SECS", allow_hyphen_values = true, value_parser = moment)]
    pub from: Option<f64>,
    /// Stop measuring after this time, seconds
    #[arg(long, value_name = "SECS", allow_hyphen_values = true, value_parser = moment)]
    pub until: Option<f64>,
    /// Support radius h of the kernel, meters
    #[arg(long, value_name = "METERS", default_value_t = 1.0, value_parser = length)]
    pub support_radius: f64,
    /// How the regions hidden by walls are integrated: exactly with overlaps once (union), exactly for each wall
    /// (exact), or at the paper's single points (representative)
    #[arg(
        long,
        value_name = "NAME",
        default_value = "union",
        value_parser = PossibleValuesParser::new(["union", "exact", "representative"])
    )]
    pub wall_method: String,
    /// Density assumed behind walls: the same as at the person's place, or the rest density as in the engine
    #[arg(
        long,
        value_name = "NAME",
        default_value = "same",
        value_parser = PossibleValuesParser::new(["same", "rest"])
    )]
    pub behind_walls: String,
    /// Largest rest density for --behind-walls rest, P/m²
    #[arg(long, value_name = "P/m²", default_value_t = 5.0, value_parser = length)]
    pub rest_density_max: f64,
    /// Time over which velocities are computed, half before and half after each frame, seconds [default: 10 frames]
    #[arg(long, value_name = "SECS", value_parser = positive_seconds)]
    pub speed_window: Option<f64>,
    /// Radius of the circle that limits each person's Voronoi cell, meters, or `none`: only walls limit cells
    #[arg(long, value_name = "METERS", default_value = "2", value_parser = cut_off)]
    pub voronoi_cutoff: CutOff,
    /// Edges per quarter of that circle, as `quad_segments` of PedPy's Cutoff
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = segments)]
    pub voronoi_segments: u32,
    /// Cell size of the mean fields, meters
    #[arg(long, value_name = "METERS", default_value_t = 0.25, value_parser = length)]
    pub cell: f64,
    /// Rectangle in which densities, speed and flow are measured; may be repeated [default: a fundamental diagram
    /// everywhere]
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, value_parser = region)]
    pub region: Vec<Region>,
    /// Measure the flow across this line; forward is from its left to its right; may be repeated
    #[arg(long, value_name = "X0,Y0,X1,Y1", allow_hyphen_values = true, value_parser = line)]
    pub line: Vec<Line>,
    /// Passages between which the flow across lines is also measured: parts of all passages, or numbers such as 10..90
    #[arg(long, value_name = "N..M", default_value = "10%..90%", value_parser = passages)]
    pub flow_of: Passages,
    /// Time between samples of exposure, level of service and crowd pressure, seconds
    #[arg(long, value_name = "SECS", default_value_t = 1.0, value_parser = positive_seconds)]
    pub sample_every: f64,
    /// Folder for the results [default: the file's name with -measured appended]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[command(flatten)]
    pub files: DocumentOptions,
    #[command(flatten)]
    pub print: PrintOptions,
    #[command(flatten)]
    pub program: ProgramOptions,
}
