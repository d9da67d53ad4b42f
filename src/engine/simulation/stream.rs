//! Streams of agents toward a line, that of a place or an opening: the number bound for it, by distance, and its flow.

use serde::{Deserialize, Serialize};

/// The flow through an opening is averaged over this time, seconds.
const OBSERVED: f64 = 15.0;
/// The flow that follows from the width counts as much as this time of observation, seconds.
const EXPECTED: f64 = 5.0;
/// The area before a line ends at this distance, meters.
pub(super) const BEFORE: f64 = 2.0;
/// The least flow that agents expect from observation, P/s.
const LEAST_FLOW: f64 = 0.05;
/// The width of the bins of distances in which agents are counted, meters.
const BIN: f64 = 0.1;
/// Bins are searched for people in stretches of this many.
const STRETCH: usize = 32;
/// Larger distances are clamped to this, meters.
const FARTHEST_BIN: f64 = 500.0;

/// The bin of a distance, meters.
fn bin_of(length: f64) -> usize {
    (length.min(FARTHEST_BIN) / BIN) as usize
}

/// The agents bound for a line, and those that have passed it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Stream {
    /// `nearer[k]` is the number of agents bound for it that are nearer than k bins.
    nearer: Vec<u32>,
    /// The number of agents that have passed it since the last second.
    passes: u32,
    /// The number that passed while a crowd stood before it, and how long one did, seconds. Both decay.
    passed: f64,
    crowded: f64,
}

impl Stream {
    /// Counts an agent `length` meters away that is now bound for the line (`comes`), or no longer bound for it.
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

    /// The number of agents bound for the line that are nearer to it than `length` meters.
    pub fn nearer_than(&self, length: f64) -> u32 {
        let last = self.nearer.last().copied().unwrap_or(0);
        self.nearer.get(bin_of(length)).copied().unwrap_or(last)
    }

    /// The time until all agents bound for the line that are nearer than `length` meters have passed it, seconds: they
    /// walk there at `speed`, and pass one after the other at a flow. An agent at that distance that walks no faster
    /// waits only in a queue.
    pub fn clear_after(&self, length: f64, speed: f64, flow: f64) -> f64 {
        let bins = bin_of(length).min(self.nearer.len().saturating_sub(1));
        let mut clear: f64 = 0.0;
        for first in (0..bins).step_by(STRETCH) {
            let counts = &self.nearer[first..=(first + STRETCH).min(bins)];
            let pairs = counts.iter().zip(&counts[1..]);
            // Most stretches are empty: no branch per bin.
            if !pairs.fold(false, |comes, (before, next)| comes | (next > before)) {
                continue;
            }
            for (bin, pair) in (first..).zip(counts.windows(2)) {
                if pair[1] > pair[0] {
                    let arrives = bin as f64 * BIN / speed;
                    clear = clear.max(arrives) + f64::from(pair[1] - pair[0]) / flow;
                }
            }
        }
        clear
    }

    /// The number of agents bound for the line.
    pub fn bound(&self) -> u32 {
        self.nearer_than(FARTHEST_BIN)
    }

    /// Records that an agent passes the line.
    pub(super) fn pass(&mut self) {
        self.passes += 1;
    }

    /// The flow that agents expect, P/s: that which follows from the width, `expected`, and more and more the one
    /// observed while a crowd stands before the line.
    pub fn flow(&self, expected: f64) -> f64 {
        let flow = (EXPECTED * expected + self.passed) / (EXPECTED + self.crowded);
        flow.max(LEAST_FLOW)
    }

    /// Once per second: counts the agents bound for the line at these distances again, meters.
    pub(super) fn recount(&mut self, lengths: &[f64]) {
        self.nearer.clear();
        for bin in lengths.iter().map(|&length| bin_of(length)) {
            self.nearer.resize(self.nearer.len().max(bin + 2), 0);
            self.nearer[bin + 1] += 1;
        }
        let mut sum = 0;
        for count in &mut self.nearer {
            sum += *count;
            *count = sum;
        }
    }

    /// Once per second: takes over the agents that have passed. With less than `crowd` agents before the line, they
    /// say nothing about its flow.
    pub(super) fn observe(&mut self, crowd: f64) {
        let keep = 1.0 - 1.0 / OBSERVED;
        self.passed *= keep;
        self.crowded *= keep;
        let passes = std::mem::take(&mut self.passes);
        if f64::from(self.nearer_than(BEFORE)) >= crowd {
            self.passed += f64::from(passes);
            self.crowded += 1.0;
        }
    }
}
