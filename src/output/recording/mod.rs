//! Records a run for the Rerun viewer, to a file or live. This is the only module that names rerun.
//!
//! One entity, `world/agents`, holds the whole crowd; static data is logged once. Positions are in meters with y up:
//! a static transform on `world` flips the picture, because the viewer's 2D views have y down. There are two
//! timelines, `frame` and `sim_time`.
//!
//! | entity | what |
//! |---|---|
//! | `world/geometry/{walls,obstacles,goals}` | static |
//! | `world/geometry/{exits,waypoints,waiting_areas,queues,queue_spots,zones,entrances,names}` | static |
//! | `world/geometry/measured_{regions,lines}` | static; where a crowd was measured |
//! | `world/wall_forces` | walls colored by the force on them, if the run measures it |
//! | `world/ways/…` | the lengths of the ways to each place and goal as an image, hidden at first |
//! | `world/agents` | the crowd: positions, radii, density and speed colors, `agent:…` values |
//! | `world/debug/…` | the debug agents: kernels, hidden regions, wall points, forces, ways |
//! | `stats/…` | time series; those of places are in `stats/places` |
//! | `info/scenario` | the scenario and a legend, as text |
//! | `log` | events: entries and pushes |

mod blueprint;
mod crowd;
mod debug;
mod error;
mod file;
mod geometry;
mod layers;
mod marked;
mod measured;
mod output;
mod places;
mod read;
mod relay;
mod session;
mod snapshot;
mod stats;
mod text;
mod viewer;
mod wall_forces;
mod writer;

pub use debug::DebugAgents;
pub use error::RecordingError;
pub use layers::METERS_PER_ACCELERATION;
pub use marked::Marked;
pub use measured::{MeasuredPerson, MeasuredRecorder};
pub use output::{Destination, check_enabled};
pub use read::{Recorded, RecordedCrowd};
pub use viewer::{Address, AddressError, Viewer};

use rerun::RecordingStream;

use crate::analysis::wall_forces::Outlines;
use crate::engine::scene::Region;
use crate::engine::simulation::Simulation;
use blueprint::{Content, Journeys};
use output::{APPLICATION, Output};
use session::Session;
use snapshot::Snapshot;

const FRAME: &str = "frame";
const SIM_TIME: &str = "sim_time";

/// The texts and views of a recording, in addition to the simulation itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingOptions {
    /// Its identity: the viewer merges recordings with the same one.
    pub id: String,
    /// Its title in the viewer, for example the scenario's name and the settings that differ from its file.
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
    /// The mass of an average person, kg, if walls are colored by the force on them.
    pub body_mass: Option<f64>,
}

/// Writes a recording, frame by frame.
///
/// [`log`](Self::log) only copies; one thread turns the copies into rows, another compresses and writes them.
pub struct Recorder {
    session: Session,
    /// Whether the time to show first has been reached.
    opened: bool,
    /// Region of the debug view.
    focus: Option<Region>,
    /// Cells of the walls, if they are colored by force.
    outlines: Option<Outlines>,
    /// Number of events that were recorded or left out; `None` before the first frame.
    events: Option<usize>,
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
        let output = Output::open(&to.into(), &options.title, options.id.clone())?;
        let (scene, agents) = (simulation.scene(), simulation.frame().agents);
        let log_own = |stream: &RecordingStream| {
            text::log_run(stream, scene, options)?;
            geometry::log(stream, scene, agents)?;
            stats::log_entrances(stream, scene)?;
            places::log(stream, scene)?;
            places::log_ways(stream, scene)?;
            places::log_series(stream, scene)?;
            if options.body_mass.is_some() {
                wall_forces::log_style(stream)?;
            }
            layers::begin(stream, scene, &options.debug)
        };
        let content = Content::Run(Journeys {
            begin: !scene.journeys.places.is_empty(),
            fields: places::fields(scene),
            wall_forces: options.body_mass.is_some(),
        });
        Ok(Self {
            session: Session::begin(output, options.clone(), content, log_own)?,
            opened: false,
            focus: None,
            outlines: (options.body_mass).map(|_| Outlines::new(&scene.walls)),
            events: None,
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
        let options = &mut self.session.options;
        let mut snapshot = Snapshot::of(simulation, &options.debug);
        snapshot.ms_per_frame = Some(ms_per_frame);
        if let (Some(outlines), Some(mass)) = (&self.outlines, options.body_mass) {
            snapshot.wall_forces = Some(wall_forces::parts(outlines, simulation, mass));
        }
        let arrivals = simulation.outcome().arrivals.iter();
        snapshot.evacuated = Some(arrivals.filter(|arrival| arrival.counted).count());
        let (clock, events) = (simulation.frame().clock, simulation.events());
        let before = self.events.replace(events.len());
        let new = events[before.unwrap_or(0)..].iter();
        // Events before a late start are left out: they would only stretch the time line.
        let new = new.filter(|event| before.is_some() || event.frame == clock.frame());
        let new = new.map(|event| (clock.time_at(event.frame), event.clone()));
        snapshot.events = new.collect();
        snapshot.opens_here = !self.opened && snapshot.time >= options.opens_at;
        // A run may end before that time; the debug view then shows an agent that was present earlier.
        if snapshot.opens_here || self.focus.is_none() {
            self.focus = options.debug.focus(simulation).or(self.focus);
        }
        self.opened |= snapshot.opens_here;
        options.ends_at = snapshot.time;
        self.session.write(snapshot)
    }

    /// Sends the buffered data, closes the file and checks that it is complete.
    ///
    /// # Errors
    /// Data could not be written, for example because the disk is full; or the viewer is gone or took no data for 2 s.
    pub fn finish(self) -> Result<(), RecordingError> {
        self.session.finish(self.focus)
    }
}

fn set_time(stream: &RecordingStream, frame: i64, time: f64) {
    stream.set_time_sequence(FRAME, frame);
    stream.set_duration_secs(SIM_TIME, time);
}
