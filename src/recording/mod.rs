//! A run for the Rerun viewer, as a file or while it goes on. The only place that names rerun.
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
mod file;
mod geometry;
mod layers;
mod read;
mod snapshot;
mod stats;
mod text;
mod viewer;
mod writer;

pub use debug::DebugAgents;
pub use error::RecordingError;
pub use layers::METRES_PER_ACCELERATION;
pub use read::Recording;
pub use viewer::{Address, AddressError, Viewer};

use std::path::{Path, PathBuf};
use std::time::Duration;

use rerun::log::ChunkBatcherConfig;
use rerun::sink::LogSink;
use rerun::{RecordingStream, RecordingStreamBuilder};

use crate::scene::Region;
use crate::simulation::{Event, Simulation};
use blueprint::Opening;
use debug::Debug;
use error::Cause;
use file::{Failure, FileSink};
use viewer::ViewerSink;
use writer::Writer;

/// The viewer keeps its own settings per application.
const APPLICATION: &str = "sandbox";
/// What a run that is killed loses at most, besides the last chunk under way.
const FILE_TICK: Duration = Duration::from_secs(1);
/// What a viewer lags behind.
const VIEWER_TICK: Duration = Duration::from_millis(100);
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

/// Where a recording goes: to a file, to a viewer, or to both.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Destination {
    /// A file, which replaces any there.
    pub file: Option<PathBuf>,
    /// A viewer that shows the run while it goes on.
    pub viewer: Option<Viewer>,
}

impl From<&Path> for Destination {
    fn from(path: &Path) -> Self {
        Self {
            file: Some(path.to_owned()),
            viewer: None,
        }
    }
}

/// Writes a recording, frame by frame.
///
/// [`log`](Self::log) only copies; one thread makes rows of the copies, another compresses and
/// writes them.
pub struct Recorder {
    file: Option<PathBuf>,
    /// What went wrong with the file.
    file_failure: Failure,
    /// What became of the viewer.
    viewer_failure: Failure,
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
    /// Begins a recording of `simulation`.
    ///
    /// # Errors
    /// The file cannot be written, or there is no viewer.
    pub fn create(
        to: impl Into<Destination>,
        simulation: &Simulation,
        options: &RecordingOptions,
    ) -> Result<Self, RecordingError> {
        let to = to.into();
        let viewer = to.viewer.as_ref().map(Viewer::connect).transpose()?;
        Self::begin(to.file.as_deref(), viewer, simulation, options)
            .map_err(|cause| RecordingError::unwritten(to.file.as_deref(), &cause))
    }

    fn begin(
        file: Option<&Path>,
        viewer: Option<ViewerSink>,
        simulation: &Simulation,
        options: &RecordingOptions,
    ) -> Result<Self, Cause> {
        let scene = simulation.scene();
        let mut builder = RecordingStreamBuilder::new(APPLICATION);
        let (mut tick, mut opening) = (FILE_TICK, Opening::Empty);
        let (mut file_failure, mut viewer_failure) = (Failure::default(), Failure::default());
        let mut sinks: Vec<Box<dyn LogSink>> = Vec::new();
        if let Some(path) = file {
            let sink = FileSink::create(path)?;
            file_failure = sink.failure();
            sinks.push(Box::new(sink));
        }
        if let Some(sink) = viewer {
            viewer_failure = sink.failure();
            sinks.push(Box::new(sink));
            (tick, opening) = (VIEWER_TICK, Opening::Live);
        } else {
            // In a viewer a second run of the same name would become part of the first.
            builder = builder.recording_id(format!("{}-seed{}", options.title, scene.seed));
        }
        let stream = builder.batcher_config(batches(tick)).set_sinks(sinks)?;
        stream.set_log_tick_enabled(false);
        stream.set_log_time_enabled(false);
        stream.send_recording_name(options.title.clone())?;
        let layers = layers::Layers::new(scene, &options.debug);
        blueprint::send(&stream, options, opening)?;
        text::log_document(&stream, scene, options)?;
        geometry::log(&stream, scene, simulation.frame().agents)?;
        crowd::log_style(&stream)?;
        layers.log_style(&stream)?;
        stats::log_style(&stream)?;
        stream.flush_blocking()?;
        Ok(Self {
            file: file.map(Path::to_owned),
            file_failure,
            viewer_failure,
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
        snapshot.ms_per_frame = ms_per_frame;
        snapshot.evacuated = self.progress.count_arrivals(simulation);
        snapshot.events = self.progress.new_events(simulation);
        snapshot.opens_here = !self.opened && snapshot.time >= self.options.opens_at;
        // A run may end before that time; then the debug view shows somebody who was there first.
        if snapshot.opens_here || self.focus.is_none() {
            self.focus = self.debug.focus(simulation).or(self.focus);
        }
        self.opened |= snapshot.opens_here;
        self.options.ends_at = snapshot.time;
        let written = self.writer.write(snapshot);
        written.map_err(|cause| RecordingError::unwritten(self.file.as_deref(), &cause))
    }

    /// Sends what is still in memory, closes the file and checks that it is whole.
    ///
    /// # Errors
    /// Something could not be written: the disk is full, for example. Else, the viewer has gone.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        let file = self.file.as_deref();
        let unwritten = |cause: &Cause| RecordingError::unwritten(file, cause);
        Self::end(&mut self.writer, &self.stream, &self.options, self.focus)
            .map_err(|cause| unwritten(&cause))?;
        drop(self.stream); // And with it the sinks; that of the file adds the index and waits for it.
        if let Some(reason) = self.file_failure.reason() {
            return Err(unwritten(&Cause::File(reason)));
        }
        file.map_or(Ok(()), read::check_footer)?;
        match self.viewer_failure.reason() {
            Some(reason) => Err(RecordingError::ViewerGone { reason }),
            None => Ok(()),
        }
    }

    /// Everything but the footer.
    fn end(
        writer: &mut Writer,
        stream: &RecordingStream,
        options: &RecordingOptions,
        focus: Option<Region>,
    ) -> Result<(), Cause> {
        writer.finish()?;
        stream.flush_blocking()?;
        blueprint::send(stream, options, Opening::Whole(focus))?;
        Ok(stream.flush_blocking()?)
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

/// The crowd's rows fill a chunk by their size, all others by the passing of so much time.
fn batches(flush_tick: Duration) -> ChunkBatcherConfig {
    ChunkBatcherConfig {
        flush_tick,
        ..ChunkBatcherConfig::DEFAULT
    }
}

fn set_time(stream: &RecordingStream, frame: u64, time: f64) {
    stream.set_time_sequence(FRAME, i64::try_from(frame).unwrap_or(i64::MAX));
    stream.set_duration_secs(SIM_TIME, time);
}
