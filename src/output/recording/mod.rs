//! Records a run for the Rerun viewer, to a file or live. This is the only module that names rerun.
//!
//! One entity, `world/agents`, holds the whole crowd; static data is logged once. Positions are in meters with y up:
//! a static transform on `world` flips the picture, because the viewer's 2D views have y down. There are two
//! timelines, `frame` and `sim_time`.
//!
//! | entity | what |
//! |---|---|
//! | `world/geometry/{walls,obstacles,goals}` | static |
//! | `world/agents` | the crowd: positions, radii, density and speed colors, `agent:…` values |
//! | `world/debug/…` | the debug agents: kernels, hidden regions, wall points, forces |
//! | `stats/…` | time series |
//! | `info/scenario` | the scenario and a legend, as text |
//! | `log` | events: entries and pushes |

mod blueprint;
mod crowd;
mod debug;
mod error;
mod file;
mod geometry;
mod layers;
mod measured;
mod output;
mod read;
mod relay;
mod snapshot;
mod stats;
mod text;
mod viewer;
mod writer;

pub use debug::DebugAgents;
pub use error::RecordingError;
pub use layers::METERS_PER_ACCELERATION;
pub use measured::{MeasuredPerson, MeasuredRecorder};
pub use output::{Destination, check_enabled};
pub use read::Recording;
pub use viewer::{Address, AddressError, Viewer};

use rerun::RecordingStream;

use crate::engine::scene::Region;
use crate::engine::simulation::{Event, Simulation};
use blueprint::{Content, Opening};
use debug::Debug;
use error::Cause;
use output::{APPLICATION, Output};
use writer::Writer;

const FRAME: &str = "frame";
const SIM_TIME: &str = "sim_time";

/// What a recording says and shows in addition to the simulation itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingOptions {
    /// Its title in the viewer, for example the scenario's name.
    pub title: String,
    /// A one-line description; may be empty.
    pub description: String,
    /// The scenario as text, in Markdown.
    pub document: String,
    /// The part of the plane that the crowd views show.
    pub view: Region,
    /// The time that the viewer shows first, seconds.
    pub opens_at: f64,
    /// The end of the run as far as it is known; the loop that plays first does not go beyond it.
    pub ends_at: f64,
    /// The debug agents.
    pub debug: DebugAgents,
}

/// Writes a recording, frame by frame.
///
/// [`log`](Self::log) only copies; one thread turns the copies into rows, another compresses and writes them.
pub struct Recorder {
    output: Output,
    writer: Writer,
    debug: Debug,
    options: RecordingOptions,
    /// Whether the time to show first has been reached.
    opened: bool,
    /// Region of the debug view.
    focus: Option<Region>,
    progress: Progress,
}

impl Recorder {
    /// Begins a recording of `simulation`.
    ///
    /// # Errors
    /// The file cannot be written, or no viewer answers.
    pub fn create(
        to: impl Into<Destination>,
        simulation: &Simulation,
        options: &RecordingOptions,
    ) -> Result<Self, RecordingError> {
        let id = format!("{}-seed{}", options.title, simulation.scene().seed);
        let output = Output::open(&to.into(), &options.title, id)?;
        let begun = begin(&output, simulation, options);
        Ok(Self {
            writer: output.checked(begun)?,
            output,
            debug: Debug::new(options.debug.clone()),
            options: options.clone(),
            opened: false,
            focus: None,
            progress: Progress::default(),
        })
    }

    /// Adds the current frame, which must be evaluated.
    ///
    /// Densities, and with them colors and debug agents, are included if the frame has them (see
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
        // A run may end before that time; the debug view then shows an agent that was present earlier.
        if snapshot.opens_here || self.focus.is_none() {
            self.focus = self.debug.focus(simulation).or(self.focus);
        }
        self.opened |= snapshot.opens_here;
        self.options.ends_at = snapshot.time;
        self.output.checked(self.writer.write(snapshot))
    }

    /// Sends the buffered data, closes the file and checks that it is complete.
    ///
    /// # Errors
    /// Data could not be written, for example because the disk is full; or the viewer is gone or took no data for 2 s.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        let opening = Opening::Whole(self.focus);
        let ended = end(
            &mut self.writer,
            &self.output,
            &self.options,
            opening,
            Content::Run,
        );
        self.output.checked(ended)?;
        self.output.close()
    }
}

/// Logs the layout and the static data.
fn begin(
    output: &Output,
    simulation: &Simulation,
    options: &RecordingOptions,
) -> Result<Writer, Cause> {
    let (stream, scene) = (&output.stream, simulation.scene());
    let layers = layers::Layers::new(scene, &options.debug);
    let opening = if output.is_live() {
        Opening::Live
    } else {
        Opening::Empty
    };
    blueprint::send(stream, options, opening, Content::Run)?;
    text::log_document(stream, scene, options)?;
    geometry::log(stream, scene, simulation.frame().agents)?;
    crowd::log_style(stream)?;
    layers.log_style(stream)?;
    stats::log_style(stream)?;
    stream.flush_blocking()?;
    Writer::start(stream.clone(), layers)
}

/// Sends the buffered data, then the final layout.
fn end(
    writer: &mut Writer,
    output: &Output,
    options: &RecordingOptions,
    opening: Opening,
    content: Content,
) -> Result<(), Cause> {
    writer.finish()?;
    // The viewer cannot go to a time that it has not read yet.
    output.stream.flush_blocking()?;
    blueprint::send(&output.stream, options, opening, content)
}

/// How much of the simulation's reports has been recorded.
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

    /// The events since the last recorded frame, with times. Events before a late start are left out: they would only
    /// stretch the time line.
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

fn set_time(stream: &RecordingStream, frame: i64, time: f64) {
    stream.set_time_sequence(FRAME, frame);
    stream.set_duration_secs(SIM_TIME, time);
}
