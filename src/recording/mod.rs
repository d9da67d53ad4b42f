//! A run as a file for the Rerun viewer. The only place that names rerun.
//!
//! One entity holds the whole crowd, `world/agents`; what stands still is logged once. Positions are
//! metres with y up: a static transform on `world` turns the picture, since the viewer's 2D views
//! have y down. Two timelines, `frame` and `sim_time`.
//!
//! | entity | what |
//! |---|---|
//! | `world/geometry/{walls,obstacles,goals}` | static |
//! | `world/agents` | the crowd: positions, radii, both colourings, `agent:…` values |
//! | `world/debug/…` | some agents laid open: kernels, hidden regions, wall points, forces |
//! | `stats/…` | time series |
//! | `info/scenario` | the scenario and a legend, as text |
//! | `log` | entries and pushes |

mod blueprint;
mod colors;
mod crowd;
mod debug;
mod error;
mod geometry;
mod read;
mod stats;
mod text;

pub use debug::{DebugAgents, METRES_PER_ACCELERATION};
pub use error::RecordingError;
pub use read::Recording;

use std::path::{Path, PathBuf};

use rerun::{RecordingStream, RecordingStreamBuilder};

use crate::scene::Region;
use crate::simulation::Simulation;

/// The viewer keeps its own settings per application.
const APPLICATION: &str = "sandbox";
const FRAME: &str = "frame";
const SIM_TIME: &str = "sim_time";

/// What a recording says and shows besides the simulation itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingOptions {
    /// What it is called in the viewer, for example the scenario's name.
    pub title: String,
    /// The scenario as text, in Markdown.
    pub document: String,
    /// The part of the plane that the crowd views show.
    pub view: Region,
    /// The time to look at first, seconds.
    pub opens_at: f64,
    /// Who is laid open.
    pub debug: DebugAgents,
}

/// Writes a recording, frame by frame.
///
/// A background thread compresses and writes; [`log`](Self::log) only copies.
pub struct Recorder {
    path: PathBuf,
    stream: RecordingStream,
    options: RecordingOptions,
    crowd: crowd::Crowd,
    debug: debug::Debug,
    stats: stats::Stats,
    opened: bool,
}

impl Recorder {
    /// Begins a recording of `simulation` at `path`, replacing any file there.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(
        path: &Path,
        simulation: &Simulation,
        options: &RecordingOptions,
    ) -> Result<Self, RecordingError> {
        let seed = simulation.scene().seed;
        let stream = RecordingStreamBuilder::new(APPLICATION)
            .recording_id(format!("{}-seed{seed}", options.title))
            .enabled(true)
            .save(path)?;
        stream.set_log_tick_enabled(false);
        stream.set_log_time_enabled(false);
        stream.send_recording_name(options.title.clone())?;
        let debug = debug::Debug::new(simulation.scene(), options.debug.clone());
        blueprint::send(&stream, options, &debug, None)?;
        text::log_document(&stream, simulation.scene(), options)?;
        geometry::log(&stream, simulation.scene())?;
        crowd::log_style(&stream)?;
        debug.log_style(&stream)?;
        stats::log_style(&stream)?;
        stream.flush_blocking()?;
        Ok(Self {
            path: path.to_owned(),
            stream,
            options: options.clone(),
            crowd: crowd::Crowd::default(),
            debug,
            stats: stats::Stats::default(),
            opened: false,
        })
    }

    /// Adds the current frame, which must be evaluated.
    ///
    /// Densities, and with them colours and debug agents, are in it if the frame has them (see
    /// [`Simulation::request_density_until`]).
    ///
    /// # Errors
    /// The data are not what the file format expects.
    pub fn log(
        &mut self,
        simulation: &Simulation,
        ms_per_frame: f64,
    ) -> Result<(), RecordingError> {
        let clock = simulation.frame().clock;
        self.stats.log_events(&self.stream, simulation)?;
        set_time(&self.stream, clock.frame(), clock.time());
        self.crowd.log(&self.stream, simulation)?;
        self.debug.log(&self.stream, simulation)?;
        self.stats.log(&self.stream, simulation, ms_per_frame)?;
        if !self.opened && clock.time() >= self.options.opens_at {
            self.opened = true;
            let focus = self.debug.focus(simulation);
            if focus.is_some() {
                blueprint::send(&self.stream, &self.options, &self.debug, focus)?;
            }
        }
        Ok(())
    }

    /// Writes what is still in memory, closes the file and checks that it is whole.
    ///
    /// # Errors
    /// Something could not be written: the disk is full, for example.
    pub fn finish(self) -> Result<(), RecordingError> {
        let Self { path, stream, .. } = self;
        stream.flush_blocking()?;
        drop(stream); // Joins the writer, which adds the footer and only logs its failure.
        read::check_footer(&path)
    }
}

fn set_time(stream: &RecordingStream, frame: u64, time: f64) {
    stream.set_time_sequence(FRAME, i64::try_from(frame).unwrap_or(i64::MAX));
    stream.set_duration_secs(SIM_TIME, time);
}
