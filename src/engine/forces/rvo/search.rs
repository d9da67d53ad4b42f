//! Branch and bound for the cheapest candidate; gives the same result as an exhaustive search.

use super::rings::Rings;
use super::{Candidate, Situation, time_to_contact};
use crate::engine::math::Vector;

/// Width in m/s of the buckets by which candidates are sorted; candidates in a bucket are unordered.
const WIDTH: f64 = 0.1;

/// Safety margin far above the rounding errors of deviations and times, so that no bound excludes a candidate
/// that could be best.
const ROUNDING: f64 = 1e-9;

/// Buffers, reused from search to search.
#[derive(Debug, Default)]
pub struct Search {
    /// Candidates with their numbers, sorted by a lower bound of their deviation from the preferred velocity.
    candidates: Buckets<(u32, Candidate)>,
    /// Velocities of the current bucket with their numbers, m/s.
    velocities: Vec<(u32, Vector)>,
    rings: Rings,
    /// Indices of discs.
    perhaps: Vec<u32>,
}

impl Search {
    /// The cheapest of `candidates` (Eq. 20), or the first of several with equal costs. Zero if all are too fast.
    ///
    /// Candidates are visited in order of a lower bound of their cost, | |v′ − v| − |v^pref − v| |, until it exceeds
    /// the best cost found. The bound does not depend on the direction of v′ − v. The best cost minus the deviation
    /// gives a time before which a contact makes the candidate too expensive: this rejects most candidates after
    /// testing the nearest discs, eight at a time. For the others the first contact is searched from the innermost
    /// ring outward, until discs farther away cannot be met before the earliest contact found.
    pub fn best(
        &mut self,
        situation: &Situation,
        candidates: &[Candidate],
        collision_weight: f64,
    ) -> Vector {
        self.sort(situation, candidates);
        let Self {
            candidates: sorted,
            rings,
            perhaps,
            velocities,
        } = self;
        let max_squared = situation.max_speed * situation.max_speed;
        let (mut best, mut first) = (Vector::zeros(), u32::MAX);
        let mut best_cost = f64::INFINITY;
        for (least, candidates) in sorted.iter() {
            if least - ROUNDING > best_cost {
                break;
            }
            // Compute all velocities of the bucket first, so that none waits for the test of another.
            velocities.clear();
            velocities.extend(
                candidates
                    .iter()
                    .map(|(k, candidate)| (*k, candidate.velocity(situation.velocity))),
            );
            for &(k, candidate) in velocities.iter() {
                if candidate.norm_squared() > max_squared {
                    continue;
                }
                let deviation = (candidate - situation.preferred_velocity).norm();
                if deviation > best_cost {
                    continue;
                }
                // Agent i moves at 2v′ − v_i.
                let velocity = candidate * 2.0 - situation.velocity;
                // After rounding, a cost this close to the best may be equal to it.
                let left = best_cost - deviation + f64::EPSILON * best_cost;
                let latest = collision_weight / left;
                if rings.certainly_met(velocity, latest * (1.0 - ROUNDING)) {
                    continue;
                }
                let cost = |time: f64| deviation + collision_weight / time;
                let too_early = |time: f64| cost(time) > best_cost;
                let Some(time) = first_contact(situation, rings, perhaps, velocity, too_early)
                else {
                    continue;
                };
                if cost(time) < best_cost || k < first {
                    (best, first, best_cost) = (candidate, k, cost(time));
                }
            }
        }
        best
    }

    /// Sorts the candidates by a lower bound of their deviation, and the discs into rings.
    fn sort(&mut self, situation: &Situation, candidates: &[Candidate]) {
        let preferred = (situation.preferred_velocity - situation.velocity).norm();
        let numbered = (0..).zip(candidates.iter().copied());
        let bounded =
            numbered.map(|(k, candidate)| ((candidate.length - preferred).abs(), (k, candidate)));
        self.candidates.sort(WIDTH, bounded);
        self.rings.sort(&situation.discs);
    }
}

/// The time in seconds of the earliest contact when moving at `velocity`, infinite if there is none. Returns
/// `None` as soon as a contact is found that is too early. `rings` holds the discs of the situation.
fn first_contact(
    situation: &Situation,
    rings: &Rings,
    perhaps: &mut Vec<u32>,
    velocity: Vector,
    too_early: impl Fn(f64) -> bool,
) -> Option<f64> {
    let walls = situation.walls.iter();
    let walls = walls.map(|wall| situation.time_to_wall(wall, velocity));
    let mut first = walls.fold(f64::INFINITY, f64::min);
    if too_early(first) {
        return None;
    }
    let mut ring = 0;
    while ring < rings.within(velocity, first) {
        rings.perhaps_met(ring, velocity, first, perhaps);
        for &k in perhaps.iter() {
            let disc = &situation.discs[k as usize];
            let time = time_to_contact(disc.offset, velocity - disc.velocity, disc.reach);
            if time < first {
                first = time;
                if too_early(first) {
                    return None;
                }
            }
        }
        ring += 1;
    }
    Some(first)
}

/// Items sorted by key into buckets, unordered within a bucket.
#[derive(Debug)]
struct Buckets<T> {
    width: f64,
    arrivals: Vec<(u32, T)>,
    items: Vec<T>,
    /// The end of each bucket in `items`.
    ends: Vec<u32>,
}

impl<T> Default for Buckets<T> {
    fn default() -> Self {
        Self {
            width: 1.0,
            arrivals: Vec::new(),
            items: Vec::new(),
            ends: Vec::new(),
        }
    }
}

/// Number of buckets. The last one also holds all larger keys.
const BUCKETS: usize = 64;

impl<T: Copy> Buckets<T> {
    /// Sorts pairs of a key and an item into buckets of width `width`.
    fn sort(&mut self, width: f64, things: impl Iterator<Item = (f64, T)>) {
        self.width = width;
        let per_width = 1.0 / width;
        let mut counts = [0_u32; BUCKETS];
        self.arrivals.clear();
        for (key, thing) in things {
            let bucket = ((key * per_width) as usize).min(BUCKETS - 1);
            counts[bucket] += 1;
            self.arrivals.push((bucket as u32, thing));
        }
        let mut start = 0;
        for count in &mut counts {
            start += std::mem::replace(count, start);
        }
        let mut places = counts;
        self.items.clear();
        self.items
            .extend(self.arrivals.iter().map(|&(_, thing)| thing));
        for &(bucket, thing) in &self.arrivals {
            let place = &mut places[bucket as usize];
            self.items[*place as usize] = thing;
            *place += 1;
        }
        self.ends.clear();
        self.ends.extend(places);
    }

    /// The non-empty buckets, each with a lower bound of its keys.
    fn iter(&self) -> impl Iterator<Item = (f64, &[T])> {
        let mut start = 0;
        self.ends
            .iter()
            .enumerate()
            .filter_map(move |(bucket, &end)| {
                let things = &self.items[start as usize..end as usize];
                start = end;
                (!things.is_empty())
                    .then_some((bucket as f64 * self.width * (1.0 - ROUNDING), things))
            })
    }
}
