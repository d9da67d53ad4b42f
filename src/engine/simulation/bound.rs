//! The number of agents bound for each place, by distance.

use super::{Crowd, PlaceState};
use crate::engine::journeys::Status;
use crate::engine::scene::Scene;

/// The flow through a place is observed over this time, seconds.
const OBSERVED: f64 = 10.0;
/// The width of the bins of distances in which agents are counted, meters.
const BIN: f64 = 0.5;
/// Larger distances are clamped to this, meters.
const FARTHEST_BIN: f64 = 500.0;

/// The bin of a distance, meters.
fn bin_of(length: f64) -> usize {
    (length.min(FARTHEST_BIN) / BIN) as usize
}

impl PlaceState {
    /// Counts an agent `length` meters away that is now bound for this place (`comes`), or no longer bound for it.
    pub(super) fn count(&mut self, length: f64, comes: bool) {
        let bin = bin_of(length);
        let last = self.nearer.last().copied().unwrap_or(0);
        self.nearer.resize(self.nearer.len().max(bin + 2), last);
        for count in &mut self.nearer[bin + 1..] {
            *count = if comes {
                *count + 1
            } else {
                count.saturating_sub(1)
            };
        }
    }

    /// The number of agents bound for this place that are nearer to it than `length` meters.
    pub(super) fn nearer_than(&self, length: f64) -> u32 {
        let last = self.nearer.last().copied().unwrap_or(0);
        self.nearer.get(bin_of(length)).copied().unwrap_or(last)
    }
}

/// Once per second: counts the agents bound for each place by distance, and forgets old passes.
pub(super) fn count(crowd: &mut Crowd, scene: &Scene) {
    let clock = &crowd.clock;
    let before = clock
        .frame()
        .saturating_sub(u64::from(clock.coarse_every()));
    let is_due = clock.frame() == 0 || clock.time().floor() > clock.time_at(before).floor();
    if !is_due || !scene.journeys.has_quickest() {
        return;
    }
    let oldest = clock.time() - OBSERVED;
    for state in &mut crowd.progress.places {
        state.recent.retain(|&frame| clock.time_at(frame) > oldest);
        state.nearer.clear();
    }
    let agents = &crowd.agents;
    for (trip, route) in agents.trip.iter().zip(&agents.route) {
        let (Some(trip), Some(route)) = (trip, route) else {
            continue;
        };
        let is_bound = matches!(trip.status, Status::Walking | Status::Queued { .. });
        if !is_bound {
            continue;
        }
        let bin = bin_of(route.length());
        let nearer = &mut crowd.progress.places[usize::from(trip.place)].nearer;
        nearer.resize(nearer.len().max(bin + 2), 0);
        nearer[bin + 1] += 1;
    }
    for state in &mut crowd.progress.places {
        let mut sum = 0;
        for count in &mut state.nearer {
            sum += *count;
            *count = sum;
        }
    }
}
