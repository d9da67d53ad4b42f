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
mod crowd;
mod debug;
mod error;
mod geometry;
mod layers;
mod measured;
mod read;
mod snapshot;
mod stats;
mod text;
mod writer;

pub use debug::DebugAgents;
pub use error::RecordingError;
pub use layers::METRES_PER_ACCELERATION;
pub use measured::{MeasuredPerson, MeasuredRecorder};
pub use read::Recording;

use std::path::{Path, PathBuf};
use std::time::Duration;

use rerun::log::ChunkBatcherConfig;
use rerun::{RecordingStream, RecordingStreamBuilder};

use crate::scene::Region;
use crate::simulation::{Event, Simulation};
use blueprint::{Content, Opening};
use debug::Debug;
use writer::Writer;

/// The viewer keeps its own settings per application.
const APPLICATION: &str = "sandbox";
const FRAME: &str = "frame";
const SIM_TIME: &str = "sim_time";

/// What a recording says and shows besides the simulation itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingOptions {
    /// What it is called in the viewer, for example the scenario's name.
    pub title: String,
    /// What it shows, in a line; may be empty.
    pub description: String,
    /// The scenario as text, in Markdown.
    pub document: String,
    /// The part of the plane that the crowd views show.
    pub view: Region,
    /// The time to look at first, seconds.
    pub opens_at: f64,
    /// The end of the run, as far as it is known; what is played first does not go beyond it.
    pub ends_at: f64,
    /// Who is laid open.
    pub debug: DebugAgents,
}

/// Writes a recording, frame by frame.
///
/// [`log`](Self::log) only copies; one thread makes rows of the copies, another compresses and
/// writes them.
pub struct Recorder {
    path: PathBuf,
    stream: RecordingStream,
    writer: Writer,
    debug: Debug,
    options: RecordingOptions,
    /// Has the time to look at first come?
    opened: bool,
    /// What the debug view shows.
    focus: Option<Region>,
    progress: Progress,
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
        let scene = simulation.scene();
        let stream = RecordingStreamBuilder::new(APPLICATION)
            .recording_id(format!("{}-seed{}", options.title, scene.seed))
            .batcher_config(batches())
            .save(path)?;
        stream.set_log_tick_enabled(false);
        stream.set_log_time_enabled(false);
        stream.send_recording_name(options.title.clone())?;
        let layers = layers::Layers::new(scene, &options.debug);
        blueprint::send(&stream, options, Opening::Empty, Content::Run)?;
        text::log_document(&stream, scene, options)?;
        geometry::log(&stream, scene, simulation.frame().agents)?;
        crowd::log_style(&stream)?;
        layers.log_style(&stream)?;
        stats::log_style(&stream)?;
        stream.flush_blocking()?;
        Ok(Self {
            path: path.to_owned(),
            writer: Writer::start(stream.clone(), layers)?,
            stream,
            debug: Debug::new(options.debug.clone()),
            options: options.clone(),
            opened: false,
            focus: None,
            progress: Progress::default(),
        })
    }

    /// Adds the current frame, which must be evaluated.
    ///
    /// Densities, and with them colours and debug agents, are in it if the frame has them (see
    /// [`Simulation::request_density_until`]).
    ///
    /// # Errors
    /// An earlier frame could not be written.
    pub fn log(
        &mut self,
        simulation: &Simulation,
        ms_per_frame: f64,
    ) -> Result<(), RecordingError> {
        let mut snapshot = self.writer.empty();
        snapshot.take(simulation, &self.debug);
        snapshot.ms_per_frame = Some(ms_per_frame);
        snapshot.evacuated = Some(self.progress.count_arrivals(simulation));
        snapshot.events = self.progress.new_events(simulation);
        snapshot.opens_here = !self.opened && snapshot.time >= self.options.opens_at;
        // A run may end before that time; then the debug view shows somebody who was there first.
        if snapshot.opens_here || self.focus.is_none() {
            self.focus = self.debug.focus(simulation).or(self.focus);
        }
        self.opened |= snapshot.opens_here;
        self.writer.write(snapshot)
    }

    /// Writes what is still in memory, closes the file and checks that it is whole.
    ///
    /// # Errors
    /// Something could not be written: the disk is full, for example.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        self.writer.finish()?;
        self.stream.flush_blocking()?;
        let opening = Opening::Whole(self.focus);
        blueprint::send(&self.stream, &self.options, opening, Content::Run)?;
        self.stream.flush_blocking()?;
        drop(self.stream); // Joins rerun's writer, which adds the footer and only logs its failure.
        read::check_footer(&self.path)
    }
}

/// How much of what the simulation reports is in the recording.
#[derive(Default)]
struct Progress {
    started: bool,
    events: usize,
    arrivals: usize,
    evacuated: usize,
}

impl Progress {
    fn count_arrivals(&mut self, simulation: &Simulation) -> usize {
        let arrivals = &simulation.outcome().arrivals;
        let new = arrivals[self.arrivals..].iter();
        self.evacuated += new.filter(|arrival| arrival.counted).count();
        self.arrivals = arrivals.len();
        self.evacuated
    }

    /// What happened since the last recorded frame, with times. What happened before a late start
    /// is left out: it would only stretch the time line.
    fn new_events(&mut self, simulation: &Simulation) -> Vec<(f64, Event)> {
        let clock = simulation.frame().clock;
        let events = simulation.events();
        let new = events[self.events..]
            .iter()
            .filter(|event| self.started || event.frame == clock.frame())
            .map(|event| (clock.time_at(event.frame), event.clone()))
            .collect();
        self.events = events.len();
        self.started = true;
        new
    }
}

/// Few, large chunks: the crowd's rows fill one by their size, all others by the passing of time.
fn batches() -> ChunkBatcherConfig {
    ChunkBatcherConfig {
        flush_tick: Duration::from_secs(5),
        ..ChunkBatcherConfig::DEFAULT
    }
}

fn set_time(stream: &RecordingStream, frame: i64, time: f64) {
    stream.set_time_sequence(FRAME, frame);
    stream.set_duration_secs(SIM_TIME, time);
}
