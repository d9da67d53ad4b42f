//! The state of a place.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::bound::Stream;
use crate::math::Vector;

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
        self.bound = self.bound.saturating_sub(1);
        self.passed += 1;
        self.people.insert(id);
        self.stream.pass();
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
