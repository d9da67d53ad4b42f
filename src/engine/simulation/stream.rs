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
/// Larger distances are clamped to this, meters.
const FARTHEST_BIN: f64 = 500.0;

/// The bin of a distance, meters.
fn bin_of(length: f64) -> usize {
    (length.min(FARTHEST_BIN) / BIN) as usize
}

/// The numbers of agents by distance.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<u32>", into = "Vec<u32>")]
struct Nearer {
    /// `counts[k]` is the number of agents that are nearer than k bins.
    counts: Vec<u32>,
    /// The bins with agents, ascending: few of all.
    occupied: Vec<u32>,
}

impl From<Vec<u32>> for Nearer {
    fn from(counts: Vec<u32>) -> Self {
        let mut nearer = Self {
            counts,
            occupied: Vec::new(),
        };
        nearer.find_occupied(0);
        nearer
    }
}

impl From<Nearer> for Vec<u32> {
    fn from(nearer: Nearer) -> Self {
        nearer.counts
    }
}

impl Nearer {
    /// Finds the bins with agents again, from bin `first` on.
    fn find_occupied(&mut self, first: usize) {
        let kept = self.occupied.partition_point(|&bin| (bin as usize) < first);
        self.occupied.truncate(kept);
        let counts = self.counts.get(first..).unwrap_or_default();
        let pairs = (first as u32..).zip(counts.windows(2));
        let occupied = pairs.filter(|(_, pair)| pair[1] > pair[0]);
        self.occupied.extend(occupied.map(|(bin, _)| bin));
    }
}

/// The agents bound for a line, and those that have passed it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Stream {
    /// The agents bound for it.
    nearer: Nearer,
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
        let counts = &mut self.nearer.counts;
        let last = counts.last().copied().unwrap_or(0);
        counts.resize(counts.len().max(bin + 2), last);
        for count in &mut counts[bin + 1..] {
            *count = if comes {
                *count + 1
            } else {
                count.saturating_sub(1)
            };
        }
        self.nearer.find_occupied(bin);
    }

    /// The number of agents bound for the line that are nearer to it than `length` meters.
    pub fn nearer_than(&self, length: f64) -> u32 {
        let counts = &self.nearer.counts;
        let last = counts.last().copied().unwrap_or(0);
        counts.get(bin_of(length)).copied().unwrap_or(last)
    }

    /// The time until all agents bound for the line that are nearer than `length` meters have passed it, seconds: they
    /// walk there at `speed`, and pass one after the other at a flow. An agent at that distance that walks no faster
    /// waits only in a queue.
    pub fn clear_after(&self, length: f64, speed: f64, flow: f64) -> f64 {
        let Nearer { counts, occupied } = &self.nearer;
        let (farthest, mut clear) = (bin_of(length), 0.0_f64);
        for bin in occupied.iter().map(|&bin| bin as usize) {
            if bin >= farthest {
                break;
            }
            let arrives = bin as f64 * BIN / speed;
            clear = clear.max(arrives) + f64::from(counts[bin + 1] - counts[bin]) / flow;
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
        let counts = &mut self.nearer.counts;
        counts.clear();
        for bin in lengths.iter().map(|&length| bin_of(length)) {
            counts.resize(counts.len().max(bin + 2), 0);
            counts[bin + 1] += 1;
        }
        let mut sum = 0;
        for count in counts {
            sum += *count;
            *count = sum;
        }
        self.nearer.find_occupied(0);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The time until a line is clear, by a walk over all bins.
    fn walked(stream: &Stream, length: f64, speed: f64, flow: f64) -> f64 {
        let counts = &stream.nearer.counts;
        let pairs = counts.windows(2).take(bin_of(length)).enumerate();
        pairs.fold(0.0_f64, |clear, (bin, pair)| match pair[1] > pair[0] {
            true => clear.max(bin as f64 * BIN / speed) + f64::from(pair[1] - pair[0]) / flow,
            false => clear,
        })
    }

    #[test]
    fn occupied_bins_give_the_bits_of_a_walk_over_all_bins() {
        let mut stream = Stream::default();
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005) + 1_442_695_040_888_963_407;
            (seed >> 40) as f64 / (1_u64 << 24) as f64
        };
        for k in 0..2000 {
            // Agents leave from other distances than those at which they were counted.
            match k % 97 {
                0 => {
                    let lengths: Vec<f64> = (0..k % 60).map(|_| 90.0 * random()).collect();
                    stream.recount(&lengths);
                }
                _ => stream.count(100.0 * random(), random() < 0.5),
            }
            let (length, speed, flow) = (120.0 * random(), 0.3 + random(), 0.2 + random());
            let [own, other] = [
                stream.clear_after(length, speed, flow),
                walked(&stream, length, speed, flow),
            ];
            assert_eq!(own.to_bits(), other.to_bits(), "{own} and {other}");
            let counts = Vec::from(stream.nearer.clone());
            assert_eq!(Nearer::from(counts), stream.nearer);
        }
    }
}
