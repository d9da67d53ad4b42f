//! The cheapest candidate by branch and bound, with the answer of an exhaustive search.

use super::{MovingDisc, Situation, time_to_contact};
use crate::math::Vector;

/// Candidates whose deviations, in m/s, and discs whose gaps, in metres, differ by less than this are
/// in no order.
const DEVIATION_WIDTH: f64 = 0.05;
const GAP_WIDTH: f64 = 0.1;

/// Far more than rounding makes of gaps and times: it must never leave anybody out.
const ROUNDING: f64 = 1e-9;

/// Memory for searches one after the other.
#[derive(Debug, Default)]
pub struct Search {
    /// Candidates with their numbers and |v′ − v^pref|, by the latter.
    candidates: Buckets<(u32, f64, Vector)>,
    /// Discs by |offset| − reach.
    discs: Buckets<MovingDisc>,
}

impl Search {
    /// The cheapest of `candidates` (Eq. 20), the first of equals; zero if all are too fast.
    ///
    /// Candidates come in order of what they cost at least, until that is more than the best so far;
    /// discs in order of their gaps, until no later one could be met before the earliest contact found.
    pub fn best(
        &mut self,
        situation: &Situation,
        candidates: impl Iterator<Item = Vector>,
        collision_weight: f64,
    ) -> Vector {
        let max_squared = situation.max_speed * situation.max_speed;
        let slow = (0..).zip(candidates);
        let slow = slow.filter(|(_, candidate)| candidate.norm_squared() <= max_squared);
        let deviation = |candidate: Vector| (candidate - situation.preferred_velocity).norm();
        let deviating = slow.map(|(k, v)| (k, deviation(v), v));
        self.candidates
            .sort(DEVIATION_WIDTH, deviating.map(|slow| (slow.1, slow)));
        let discs = situation.discs.iter();
        self.discs
            .sort(GAP_WIDTH, discs.map(|d| (d.offset.norm() - d.reach, *d)));
        let fastest = situation.discs.iter().map(|d| d.velocity.norm_squared());
        let fastest = fastest.fold(0.0, f64::max).sqrt();

        let (mut best, mut first) = (Vector::zeros(), u32::MAX);
        let mut best_cost = f64::INFINITY;
        for (least, candidates) in self.candidates.iter() {
            if least > best_cost {
                break;
            }
            for &(k, deviation, candidate) in candidates {
                if deviation > best_cost {
                    continue;
                }
                // Agent i moves at 2v′ − v_i.
                let velocity = candidate * 2.0 - situation.velocity;
                let cost = |time: f64| deviation + collision_weight / time;
                let too_early = |time: f64| cost(time) > best_cost;
                let Some(time) = self.first_contact(situation, velocity, fastest, too_early) else {
                    continue;
                };
                if cost(time) < best_cost || k < first {
                    (best, first, best_cost) = (candidate, k, cost(time));
                }
            }
        }
        best
    }

    /// The earliest contact on the way at `velocity`, seconds, infinite if there is none; or `None` as
    /// soon as one is found that is too early.
    fn first_contact(
        &self,
        situation: &Situation,
        velocity: Vector,
        fastest: f64,
        too_early: impl Fn(f64) -> bool,
    ) -> Option<f64> {
        let approach = velocity.norm() + fastest;
        let mut first = f64::INFINITY;
        for (gap, discs) in self.discs.iter() {
            if gap > approach * first * (1.0 + ROUNDING) + ROUNDING {
                break;
            }
            for disc in discs {
                let time = time_to_contact(disc.offset, velocity - disc.velocity, disc.reach);
                if time < first {
                    first = time;
                    if too_early(first) {
                        return None;
                    }
                }
            }
        }
        for wall in &situation.walls {
            first = first.min(situation.time_to_wall(wall, velocity));
        }
        (!too_early(first)).then_some(first)
    }
}

/// Things sorted by a key, roughly: bucket by bucket, in no order within one.
#[derive(Debug)]
struct Buckets<T> {
    width: f64,
    arrivals: Vec<(u32, T)>,
    items: Vec<T>,
    /// Where each bucket ends in `items`.
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

/// The last one holds everything beyond.
const BUCKETS: usize = 64;

impl<T: Copy> Buckets<T> {
    /// Sorts things with their keys into buckets of a `width`.
    fn sort(&mut self, width: f64, things: impl Iterator<Item = (f64, T)>) {
        self.width = width;
        let per_width = 1.0 / width;
        let mut counts = [0_u32; BUCKETS];
        self.arrivals.clear();
        self.arrivals.extend(things.map(|(key, thing)| {
            let bucket = ((key * per_width) as usize).min(BUCKETS - 1);
            counts[bucket] += 1;
            (bucket as u32, thing)
        }));
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

    /// Every bucket that is not empty, with what its keys are at least.
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
