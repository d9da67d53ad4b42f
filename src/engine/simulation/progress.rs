//! How far journeys have come, and the state of their places.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::lifts::LiftState;
use super::stream::Stream;
use crate::journeys::Journeys;
use crate::math::Vector;
use crate::scene::Scene;

/// The number of agents that have begun each journey, and the state of each place.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// The number of agents that have begun each journey.
    pub begun: Vec<u32>,
    /// The state of each place.
    pub places: Vec<PlaceState>,
    /// The state of each lift.
    pub lifts: Vec<LiftState>,
    /// The number of agents that have left by an exit, and whose bodies still walk on.
    pub outside: u32,
    /// The number of changes of places so far.
    pub(super) changes: usize,
    /// The agents bound for each side of the openings of rooms.
    pub sides: Vec<Stream>,
    /// For each path map, the expected times from each side to its goal, seconds; empty if no agent walks there.
    pub(super) onward: Vec<Vec<f64>>,
    /// The largest flow per meter of all lines when they were last observed, P/(m s).
    pub(super) per_meter: f64,
}

impl Progress {
    /// Begins with all journeys and places that it lacks.
    pub(super) fn extend_to(&mut self, journeys: &Journeys) {
        self.begun.resize(journeys.journeys.len(), 0);
        let places = journeys.places.len();
        self.places.resize_with(places, PlaceState::default);
        self.lifts
            .resize_with(journeys.lifts.len(), LiftState::default);
    }

    /// Whether this progress fits `scene`.
    pub(super) fn fits(&self, scene: &Scene) -> bool {
        let journeys = &scene.journeys;
        let is_new = self.places.is_empty() && self.begun.is_empty();
        let counts = (self.places.len(), self.begun.len());
        let has_lifts = is_new || self.lifts.len() == journeys.lifts.len();
        self.changes <= journeys.changes.len()
            && has_lifts
            && (is_new || counts == (journeys.places.len(), journeys.journeys.len()))
    }
}

/// The state of a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceState {
    /// Whether agents can pass the exit, or wait in the waiting area.
    pub open: bool,
    /// The number of agents that have chosen it and have not yet passed it.
    pub bound: u32,
    /// How often agents have passed it.
    pub passed: u32,
    /// The ids of the agents that have passed it.
    pub people: BTreeSet<u32>,
    /// The total time that agents have waited here, seconds.
    pub waited: f64,
    /// The agents bound for it, and those that have passed it.
    pub stream: Stream,
    /// When the next agent may pass, seconds.
    pub ready: f64,
    /// The number of tickets given out for its queue.
    pub(super) tickets: u32,
    /// The largest number of agents that have stood in its queue at once.
    pub longest: u32,
    /// Which spots of the waiting area are taken.
    taken: Vec<bool>,
}

impl Default for PlaceState {
    fn default() -> Self {
        Self {
            open: true,
            bound: 0,
            passed: 0,
            people: BTreeSet::new(),
            waited: 0.0,
            stream: Stream::default(),
            ready: 0.0,
            tickets: 0,
            longest: 0,
            taken: Vec::new(),
        }
    }
}

impl PlaceState {
    /// Records that the agent with this id, which was bound for this place, passes it.
    pub(super) fn pass(&mut self, id: u32) {
        self.count(None, false);
        self.passed += 1;
        self.people.insert(id);
        self.stream.pass();
    }

    /// Counts an agent that is now bound for this place (`comes`), or no longer; the stream counts routes of known
    /// `length`, meters.
    pub(super) fn count(&mut self, length: Option<f64>, comes: bool) {
        self.bound = match comes {
            true => self.bound + 1,
            false => self.bound.saturating_sub(1),
        };
        if let Some(length) = length {
            self.stream.count(length, comes);
        }
    }

    /// Takes the first free one of `spots`, or the free one nearest to a point, and returns its index; if none is free,
    /// an index beyond the last spot.
    pub(super) fn free_spot(&mut self, spots: &[Vector], near: Option<Vector>) -> usize {
        self.taken.resize(self.taken.len().max(spots.len()), false);
        let mut free = (0..spots.len()).filter(|&k| !self.taken[k]);
        let spot = match near {
            None => free.next(),
            Some(p) => {
                let distance = |&k: &usize| (spots[k] - p).norm_squared();
                free.min_by(|a, b| distance(a).total_cmp(&distance(b)))
            }
        };
        let spot = spot.unwrap_or(spots.len());
        self.taken.resize(self.taken.len().max(spot + 1), true);
        self.taken[spot] = true;
        spot
    }

    /// The agent at a spot of the waiting area leaves it.
    pub(super) fn leave_spot(&mut self, spot: u32) {
        if let Some(taken) = self.taken.get_mut(spot as usize) {
            *taken = false;
        }
    }
}
