//! Journeys: the places that agents visit one after the other, and how they choose between places.

mod lift;
mod place;
mod trip;

pub use lift::{Lift, Stop};
pub use place::{Door, Exit, Kind, Place, Queue, WaitingArea};
pub use trip::{Status, Trip};

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::geometry::Ring;
use crate::math::Vector;

/// The places and journeys of a scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Journeys {
    /// All places, numbered in this order.
    pub places: Vec<Place>,
    /// The journeys, numbered in this order.
    pub journeys: Vec<Journey>,
    /// Changes of places, by time.
    pub changes: Vec<Change>,
    /// Areas in which agents walk slower or faster.
    pub zones: Vec<Zone>,
    /// Lifts, for which agents wait in waiting areas.
    pub lifts: Vec<Lift>,
}

/// A sequence of stages. If the last stage is not an exit, agents stay there when they have finished it.
#[derive(Debug, Clone, PartialEq)]
pub struct Journey {
    /// Name in reports.
    pub name: String,
    /// Its stages, at least one.
    pub stages: Vec<JourneyStage>,
}

/// A stage of a journey: a visit to one of some places.
#[derive(Debug, Clone, PartialEq)]
pub struct JourneyStage {
    /// The agent's way of choosing.
    pub choice: Choice,
    /// The numbers of the places, at least one.
    pub places: Vec<u16>,
    /// The number of the level to which agents ride from there by a lift.
    pub to_level: Option<u16>,
}

impl JourneyStage {
    /// The places whose lines count for an agent bound for `chosen`: all places of the stage. With shares, only
    /// `chosen` counts, so that the shares hold; but an agent bound for an exit leaves by any exit of the stage that it
    /// crosses.
    pub fn passed(&self, chosen: u16, places: &[Place]) -> impl Iterator<Item = u16> {
        let is_drawn = matches!(self.choice, Choice::Shares(_));
        let is_exit = |place: u16| places[usize::from(place)].is_exit();
        let counts =
            move |&place: &u16| !is_drawn || place == chosen || (is_exit(chosen) && is_exit(place));
        self.places.iter().copied().filter(counts)
    }
}

/// How an agent chooses between places.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    /// The one with the shortest way.
    Nearest,
    /// The one that the agent expects to pass first.
    Quickest,
    /// At random, with these weights.
    Shares(Vec<f64>),
    /// The one that the fewest agents are bound for.
    Fewest,
}

impl Choice {
    /// The weight of place `k`, with shares.
    pub fn weight(&self, k: usize) -> Option<f64> {
        match self {
            Self::Shares(weights) => weights.get(k).copied(),
            _ => None,
        }
    }
}

/// A change of a place at a given time.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// The time of the change, seconds.
    pub at: f64,
    /// The number of the place.
    pub place: u16,
    /// The kind of the change.
    pub kind: ChangeKind,
}

/// The kind of a change of a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ChangeKind {
    /// An exit opens.
    Open,
    /// An exit closes: no agent can cross its line.
    Close,
    /// From now on, no agent waits here.
    Release,
}

/// An area in which agents walk slower or faster, or hurry.
#[derive(Debug, Clone, PartialEq)]
pub struct Zone {
    /// Name in reports.
    pub name: String,
    /// Where, corners in meters.
    pub area: Ring,
    /// The preferred speed is multiplied by this.
    pub speed_factor: f64,
    /// The least motivation of agents there, from 0 to 1.
    pub motivation: f64,
    /// When it acts, seconds.
    pub time: Range<f64>,
}

impl Journeys {
    /// The factor on the preferred speed at `p` at `time` seconds: the smallest of all zones there.
    pub fn speed_factor(&self, p: Vector, time: f64) -> f64 {
        let factors = self.zones_at(p, time).map(|zone| zone.speed_factor);
        factors.reduce(f64::min).unwrap_or(1.0)
    }

    /// The least motivation of agents at `p` at `time` seconds: the greatest of all zones there.
    pub fn motivation(&self, p: Vector, time: f64) -> f64 {
        self.zones_at(p, time)
            .map(|zone| zone.motivation)
            .fold(0.0, f64::max)
    }

    fn zones_at(&self, p: Vector, time: f64) -> impl Iterator<Item = &Zone> {
        let zones = self.zones.iter();
        zones.filter(move |zone| zone.time.contains(&time) && zone.area.contains(p))
    }

    /// The lift for which agents wait at a place, and the number of its stop there.
    pub fn lift_at(&self, place: u16) -> Option<(&Lift, usize)> {
        let mut lifts = self.lifts.iter();
        lifts.find_map(|lift| Some((lift, lift.stop_at(place)?)))
    }

    /// Whether there are doors.
    pub fn has_doors(&self) -> bool {
        let mut places = self.places.iter();
        places.any(|place| matches!(place.kind, Kind::Door(_)))
    }

    /// Whether agents go on trips, or pass doors.
    pub fn has_trips(&self) -> bool {
        !self.journeys.is_empty() || self.has_doors()
    }

    /// Whether some agents choose the quickest place.
    pub fn has_quickest(&self) -> bool {
        let mut stages = self.journeys.iter().flat_map(|journey| &journey.stages);
        stages.any(|stage| stage.choice == Choice::Quickest)
    }
}

impl Journey {
    /// Stage `k`; after the last stage, the last one.
    pub fn stage(&self, k: u16) -> &JourneyStage {
        &self.stages[usize::from(k).min(self.stages.len() - 1)]
    }
}
