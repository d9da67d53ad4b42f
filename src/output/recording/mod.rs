//! Records a run for the Rerun viewer, to a file or live. This is the only module that names rerun.
//!
//! One entity, `world/agents`, holds the whole crowd; static data is logged once. Positions are in meters with y up:
//! a static transform on `world` flips the picture, because the viewer's 2D views have y down. There are two
//! timelines, `frame` and `sim_time`.
//!
//! | entity | what |
//! |---|---|
//! | `world/geometry/{walls,obstacles,goals}` | static |
//! | `world/geometry/{exits,waypoints,waiting_areas,queues,queue_spots,zones,entrances}` | static |
//! | `world/geometry/names`, `world/geometry/…/names` | the names of places and rooms, and of what else is shown |
//! | `world/geometry/measured_{regions,lines}` | static; where a crowd was measured |
//! | `world/geometry/{sources,pushes,measured}` | outlines, static |
//! | `world/legend/{density,speed}` | color bars, static |
//! | `world/wall_forces` | walls colored by the force on them, if the run measures it |
//! | `world/waits` | openings colored by the time that the last agent bound for them waits, if routes are chosen by time |
//! | `world/leans` | lines from the legs of people to their bodies, colored by the lean, if a profile has legs |
//! | `world/routes/…` | the lengths of the routes to each place and goal as an image, hidden at first |
//! | `building/LEVEL/…` | of a building: the levels at their heights in three dimensions, and the people on them |
//! | `world/agents` | the crowd: positions, radii, density and speed colors, `agent:…` values |
//! | `world/debug/…` | the debug agents: kernels, hidden regions, wall points, forces, routes |
//! | `focus/ID/…` | a followed agent in its own frame, with its forces as arrows and as time series |
//! | `stats/…` | time series; those of places are in `stats/places` |
//! | `info/scenario` | the scenario and a legend, as text |
//! | `info/{results,report}` | the results of the run, as text and as JSON, once it has ended |
//! | `info/agents/ID` | the numbers of an agent, in the recording of a single moment |
//! | `log` | events: entries, exits, pushes, arrivals, the end |
//!
//! `scene` has the static data, `frame` the data of each frame, and `debug` the data of the debug agents. `layout`
//! arranges the views, and `stream` sends everything to a file or a viewer.

mod arrangement;
mod building;
mod debug;
mod draw;
mod error;
mod frame;
mod layout;
mod measured;
mod options;
mod read;
mod scene;
mod session;
mod stream;
mod text;

pub use debug::arrows::arrow_length;
pub use debug::{DebugAgents, force_terms, forces_on};
pub use error::RecordingError;
pub use measured::{MeasuredPerson, MeasuredRecorder};
pub use options::RecordingOptions;
pub use read::{Recorded, RecordedCrowd};
pub use scene::markers::Marked;
pub use stream::viewer::{Address, AddressError, Viewer};
pub use stream::{Destination, check_enabled};

use rerun::RecordingStream;

use crate::drawing::{self, Drawing};
use crate::events::{Events, Line};
use crate::scenery;
use analysis::wall_forces::Outlines;
use building::Building;
use debug::focus::Focus;
use debug::follow::{Follow, Moment};
use debug::{arrows, layers, moment};
use engine::clock::Clock;
use engine::simulation::Simulation;
use frame::colored_lines::{self, ColoredLines, LEANS, WAITS, WALL_FORCES};
use frame::crowd::Maps;
use frame::{Snapshot, stats};
use layout::{Content, Kind};
use scene::{obstacles, routes};
use session::{Debug, Session};
use stream::Output;

/// Writes a recording, frame by frame.
///
/// [`log`](Self::log) only copies; one thread turns the copies into rows, another compresses and writes them.
pub struct Recorder {
    session: Session,
    follow: Follow,
    /// The moment to show first.
    moment: Moment,
    /// Cells of the walls, if they are colored by force.
    outlines: Option<Outlines>,
    events: Events,
    /// How the levels of a building lie.
    drawing: Option<Drawing>,
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
        Self::begin(&to.into(), simulation, options, Kind::Run)
    }

    fn begin(
        to: &Destination,
        simulation: &Simulation,
        options: &RecordingOptions,
        kind: Kind,
    ) -> Result<Self, RecordingError> {
        let output = Output::open(to, options)?;
        let follow = Follow::new(&options.debug);
        let names = follow.names();
        let scene = simulation.scene();
        let drawing = Drawing::of(scene);
        let drawn = drawing::drawn(scene, drawing.as_ref());
        let layers: [(&'static ColoredLines, bool); 3] = [
            (&WAITS, scene.by_time() && scene.rooms().is_some()),
            (&WALL_FORCES, options.body_mass.is_some()),
            (&LEANS, colored_lines::have_legs(simulation)),
        ];
        let shown = layers.into_iter().filter(|(_, has)| *has);
        let lines: Vec<_> = shown.map(|(layer, _)| layer).collect();
        let log_own = |stream: &RecordingStream| {
            let document = text::of_run(stream, scene, options)?;
            scene::log(stream, simulation, (&drawn, drawing.as_ref()), options)?;
            stats::log_places(stream, scene)?;
            for layer in &lines {
                layer.log_style(stream)?;
            }
            let terms = arrows::acting(scene);
            let all = names.iter();
            let focuses = all.map(|name| Focus::begin(stream, name.clone(), &terms));
            let debug = Debug {
                layers: layers::begin(stream, scene, &options.debug)?,
                focuses: focuses.collect::<Result<_, _>>()?,
                building: scene
                    .levels
                    .clone()
                    .map(|levels| Building::begin(stream, levels, Maps::new(options)))
                    .transpose()?,
            };
            Ok((document, debug))
        };
        let content = Content {
            has_journeys: !scene.journeys.places.is_empty(),
            has_stages: scenery::has_stages(scene),
            has_waiting: stats::has_waiting(scene),
            fields: routes::entities(&drawn),
            has_levels: drawing.is_some(),
            lines: lines.clone(),
            followed: names.clone(),
            ..Content::new(kind, obstacles::has_outside(scene.walls.obstacles()))
        };
        Ok(Self {
            session: Session::begin(output, options.clone(), content, log_own)?,
            follow,
            moment: Moment::new(options.opens_at),
            outlines: (options.body_mass).map(|_| Outlines::new(&scene.walls)),
            events: Events::new(options.entering),
            drawing,
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
        let snapshot = self.snapshot(simulation, ms_per_frame);
        self.session.write(snapshot)
    }

    fn snapshot(&mut self, simulation: &Simulation, ms_per_frame: f64) -> Snapshot {
        let options = &mut self.session.options;
        let time = simulation.frame().clock.time();
        let opens_here = self.moment.is_asked(time);
        self.follow.update(simulation, &options.debug, opens_here);
        let shown = (&options.debug, &self.follow.ids()[..]);
        let mut snapshot = Snapshot::of(simulation, shown, self.drawing.as_ref());
        snapshot.ms_per_frame = Some(ms_per_frame);
        if let (Some(outlines), Some(mass)) = (&self.outlines, options.body_mass) {
            let drawing = self.drawing.as_ref();
            let parts = colored_lines::wall_forces(outlines, (simulation, mass), drawing);
            snapshot.lines.push((&WALL_FORCES, parts));
        }
        snapshot.events = self.events.new_lines(simulation);
        snapshot.evacuated = Some(self.events.evacuated);
        self.moment.update(&snapshot);
        options.ends_at = time;
        snapshot
    }

    /// Adds a line to the log of events, for example on the end of the run, at the clock's current time.
    ///
    /// # Errors
    /// An earlier frame could not be written.
    pub fn note(&mut self, clock: &Clock, text: &str) -> Result<(), RecordingError> {
        let at = (clock.frame().cast_signed(), clock.time());
        self.session.note(vec![Line::info(at, text.to_owned())])
    }

    /// Checks that the viewer, if there is one, still takes data. A run goes on without it.
    ///
    /// # Errors
    /// It is gone, or took no data for 2 s.
    pub fn check_viewer(&self) -> Result<(), RecordingError> {
        self.session.check_viewer()
    }

    /// Adds the results of the run, in words and as JSON.
    ///
    /// # Errors
    /// An earlier frame could not be written.
    pub fn results(&mut self, text: &str, json: &str) -> Result<(), RecordingError> {
        let log = |stream: &RecordingStream| text::log_results(stream, text, json);
        self.session.log_static(log)
    }

    /// Sends the buffered data, closes the file and checks that it is complete.
    ///
    /// # Errors
    /// Data could not be written, for example because the disk is full; or the viewer is gone or took no data for 2 s.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        let found = self.moment.at;
        if let Some(at) = found {
            // A click on this line goes there.
            let line = Line::info(at, "Look here first.".to_owned());
            self.session.note(vec![line])?;
        }
        self.session
            .finish(found.map(|(_, time)| time), self.moment.view)
    }
}

/// Records one evaluated frame: the debug agents, each in the middle of a view of its own, beside a table of its
/// numbers. More than a dozen have neither.
///
/// # Errors
/// The file cannot be written, or no viewer answers.
pub fn record_moment(
    to: impl Into<Destination>,
    simulation: &Simulation,
    options: &RecordingOptions,
) -> Result<(), RecordingError> {
    let mut recorder = Recorder::begin(&to.into(), simulation, options, Kind::Moment)?;
    let snapshot = recorder.snapshot(simulation, 0.0);
    let open = snapshot.followed.iter().flatten();
    let followed: Vec<_> = open.map(|&k| &snapshot.open[k]).collect();
    recorder.session.log_static(|stream| {
        let mut agents = followed.iter();
        agents.try_for_each(|agent| moment::log(stream, agent))
    })?;
    recorder.session.write(snapshot)?;
    recorder.finish()
}
