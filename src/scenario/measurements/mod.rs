//! Measurements of a run: what a scenario's `measurements` ask for.
//!
//! A measurement is one file: its keys, as a scenario gives them, and how it observes frames and finds its values
//! ([`Measure`]). [`Measurement`] lists them all. Times are rounded to the nearest frame, so that every measurement is
//! due at any time step.

mod aim;
mod arrivals;
mod body_forces;
mod closest;
mod contacts;
mod crowd_pressure;
mod density;
mod egress;
mod exposure;
mod fence;
mod frame_time;
mod front;
mod integrity;
mod jitter;
mod line_flow;
mod mean;
mod metrics;
mod observed;
mod oscillation;
mod overview;
mod passages;
mod push;
mod quantity;
mod queue_lines;
mod queues;
mod running;
mod service_levels;
mod snapshot;
mod speed_by_density;
mod standing;
mod stuck;
mod unbalanced;
mod walks;
mod wall_forces;
mod wave;
mod window;

use std::fmt;

use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use arrivals::{Evacuated, FlowOfFirst, FlowUntil, Locked, Pauses, Uncounted};
pub use body_forces::BodyForces;
pub use closest::{Closest, closest};
pub use contacts::ContactsAt;
pub use crowd_pressure::CrowdPressure;
pub use density::Density;
pub use egress::{Egress, Left, times_to_leave};
pub use exposure::Exposure;
pub use frame_time::{FrameTime, StageTimes};
pub use front::{Front, FrontData, Reached};
pub use integrity::{Integrity, Watched};
pub use jitter::Jitter;
pub use line_flow::LineFlow;
pub use metrics::{Metric, Metrics};
pub use observed::Observed;
pub use oscillation::Oscillation;
pub use overview::HighestDensity;
pub use push::Push;
pub use quantity::Quantity;
pub use queue_lines::Outside;
pub use queues::LongestQueue;
pub use service_levels::ServiceLevels;
pub use snapshot::{Snapshot, SnapshotAt};
pub use speed_by_density::SpeedByDensity;
pub use standing::{GAP, SLOW};
pub use stuck::{HEADWAY, STUCK_AFTER, StuckGroup};
pub use unbalanced::Unbalanced;
pub use walks::{Walk, Walks};
pub use wall_forces::WallForces;
pub use wave::{Wave, WaveData};

use super::error::{Problem, Under};
use super::keys::places::journey_named;
use analysis::evaluated::Evaluated;
use engine::journeys::Journey;
use engine::simulation::Simulation;
use mean::Mean;
use running::{Running, started};

/// The keys of a measurement. They do not change during a run; what the measurement has seen is its `Seen`.
pub trait Measure: fmt::Debug + Clone + Send + Sync + 'static {
    /// What it has seen so far: the part of it that a checkpoint holds.
    type Seen: Default + Serialize + DeserializeOwned + Send + Sync + 'static;

    /// Checks relations between its keys; their ranges are checked by the schema.
    ///
    /// # Errors
    /// Keys contradict each other.
    fn check(&self) -> Result<(), Problem> {
        Ok(())
    }

    /// What it measures. The names are unique in a scenario.
    fn quantities(&self) -> Vec<Quantity> {
        Vec::new()
    }

    /// Where it observes people, by the keys that say so; nowhere in particular if it is empty.
    fn places(&self) -> Vec<(&'static str, Observed)>;

    /// What checks, notes, reports and pictures need to know about it.
    fn about(&self) -> About {
        About::default()
    }

    /// Observes an evaluated frame; called in every frame.
    fn observe(&self, _seen: &mut Self::Seen, _evaluated: &Evaluated) {}

    /// The values in the order of the quantities; `None` if there were no agents or too few arrivals, or if the run
    /// ended too early.
    fn values(&self, _seen: &Self::Seen, _simulation: &Simulation) -> Vec<Option<f64>> {
        Vec::new()
    }

    /// Data beside the values, with a name that is unique in a scenario.
    fn data(&self, _seen: &Self::Seen) -> Option<(String, Value)> {
        None
    }
}

/// What checks, notes, reports and pictures need to know about a measurement.
#[derive(Debug, Clone, Default)]
pub struct About {
    /// The time until which it needs densities, seconds.
    pub density_until: Option<f64>,
    /// The key and the name of the journey that it asks for.
    pub journey: Option<(&'static str, String)>,
    /// Its key, if it reports the largest forces from the start of the run on.
    pub peaks_from_start: Option<&'static str>,
    /// When it samples, and the lowest frequency that it is to show, rad/s, if it measures a spectrum.
    pub spectrum: Option<(window::Samples, f64)>,
    /// The mass of an average person, kg, if it measures forces on walls.
    pub mass_on_walls: Option<f64>,
    /// Whether it compares with thresholds of the literature.
    pub has_thresholds: bool,
}

impl About {
    /// A measurement that needs densities until a time, seconds.
    fn with_density_until(secs: f64) -> Self {
        Self {
            density_until: Some(secs),
            ..Self::default()
        }
    }
}

/// A measurement of a scenario.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Measurement {
    /// Mean and standard deviation of the density.
    Density(Density),
    /// Flow of the first arrivals.
    FlowOfFirst(FlowOfFirst),
    /// Flow of the arrivals until a given time.
    FlowUntil(FlowUntil),
    /// How long people on journeys take to leave.
    Egress(Egress),
    /// Number of counted arrivals.
    Evacuated(Evacuated),
    /// Number of arrivals that are not counted.
    Uncounted(Uncounted),
    /// Long gaps between arrivals, and the flow without them.
    Pauses(Pauses),
    /// Whether the flow ended before enough agents arrived.
    Locked(Locked),
    /// All agents at one time.
    Snapshot(SnapshotAt),
    /// Speed, amplitude and reflection of a wave along x.
    Wave(Wave),
    /// How far and how fast a start or a push runs through a crowd.
    Front(Front),
    /// How fast, how far and how strongly a push runs through a row of people.
    Push(Push),
    /// Spectrum of the mean velocities in boxes: frequency and spin of collective oscillations.
    Oscillation(Oscillation),
    /// Contacts between agents at one time.
    Contacts(ContactsAt),
    /// Kinetic energy of a crowd that should rest.
    Jitter(Jitter),
    /// The smallest distance between the centers of two agents.
    Closest(Closest),
    /// Agents through walls, numbers that are not finite, and speeds.
    Integrity(Integrity),
    /// Mean speed by density.
    SpeedByDensity(SpeedByDensity),
    /// What each agent walks; density, speed and flow in a region.
    Walks(Walks),
    /// The flow across a line, with density and speed before it.
    LineFlow(LineFlow),
    /// How long people are in dense crowds and stand.
    Exposure(Exposure),
    /// How much room people have, by Fruin.
    ServiceLevels(ServiceLevels),
    /// Density times variance of the velocities.
    CrowdPressure(CrowdPressure),
    /// People whose lean has reached its limit.
    Unbalanced(Unbalanced),
    /// Forces on people, N.
    BodyForces(BodyForces),
    /// Forces on walls, N/m.
    WallForces(WallForces),
    /// Computing time by stage.
    FrameTime(FrameTime),
}

impl Measurement {
    /// This measurement before the first frame.
    fn started(&self) -> Box<dyn Running> {
        match self {
            Self::Density(keys) => started(keys),
            Self::FlowOfFirst(keys) => started(keys),
            Self::FlowUntil(keys) => started(keys),
            Self::Egress(keys) => started(keys),
            Self::Evacuated(keys) => started(keys),
            Self::Uncounted(keys) => started(keys),
            Self::Pauses(keys) => started(keys),
            Self::Locked(keys) => started(keys),
            Self::Snapshot(keys) => started(keys),
            Self::Wave(keys) => started(keys),
            Self::Front(keys) => started(keys),
            Self::Push(keys) => started(keys),
            Self::Oscillation(keys) => started(keys),
            Self::Contacts(keys) => started(keys),
            Self::Jitter(keys) => started(keys),
            Self::Closest(keys) => started(keys),
            Self::Integrity(keys) => started(keys),
            Self::SpeedByDensity(keys) => started(keys),
            Self::Walks(keys) => started(keys),
            Self::LineFlow(keys) => started(keys),
            Self::Exposure(keys) => started(keys),
            Self::ServiceLevels(keys) => started(keys),
            Self::CrowdPressure(keys) => started(keys),
            Self::Unbalanced(keys) => started(keys),
            Self::BodyForces(keys) => started(keys),
            Self::WallForces(keys) => started(keys),
            Self::FrameTime(keys) => started(keys),
        }
    }

    /// Where it observes people, by the keys that say so.
    pub(super) fn places(&self) -> Vec<(&'static str, Observed)> {
        self.started().places()
    }

    /// What checks, notes, reports and pictures need to know about it.
    pub fn about(&self) -> About {
        self.started().about()
    }

    /// The names of its values.
    pub fn names(&self) -> Vec<String> {
        let quantities = self.quantities().into_iter();
        quantities.map(|quantity| quantity.name).collect()
    }

    /// What it measures.
    pub fn quantities(&self) -> Vec<Quantity> {
        self.started().quantities()
    }
}

/// Is the current frame due? Between two times, one frame per `every_secs` is due, or every frame if frames are longer
/// than that.
fn is_due(simulation: &Simulation, times_secs: [f64; 2], every_secs: f64) -> bool {
    let clock = simulation.frame().clock;
    let [first, last] = times_secs.map(|time| clock.frame_at(time));
    let every = clock.frame_at(every_secs).max(1);
    let now = clock.frame();
    (first..=last).contains(&now) && (now - first).is_multiple_of(every)
}

/// Checks the keys of all measurements, that their journeys are among `journeys`, and that no two have the same names.
///
/// # Errors
/// The first problem, with its place.
pub(super) fn check(given: &[Measurement], journeys: &[Journey]) -> Result<(), Problem> {
    let mut names = std::collections::BTreeSet::new();
    for (k, measurement) in given.iter().enumerate() {
        let place = format!("measurements[{k}]");
        let running = measurement.started();
        running.check().under(&place)?;
        if let Some((key, name)) = running.about().journey {
            journey_named(journeys, &name).under(key).under(&place)?;
        }
        let data = running.data().map(|(name, _)| name);
        for name in measurement.names().into_iter().chain(data) {
            if let Some(name) = names.replace(name) {
                let reason = format!("`{name}` is already measured; remove one");
                return Err(Problem::new(place, reason));
            }
        }
    }
    Ok(())
}
