//! Branch and bound for the cheapest candidate; gives the same result as an exhaustive search.
//!
//! Plain form, the exhaustive search: `rvo_acceleration` in `examples/paper.rs`.

use super::candidates::{Candidates, Sorted};
use super::rings::{Appear, Rings};
use super::surroundings::Surroundings;
use super::{Situation, time_to_contact};
use crate::math::Vector;
use crate::pairs::{Simd, dispatch, level};

/// Safety margin far above the rounding errors of deviations and times, so that no bound excludes a candidate
/// that could be best.
const ROUNDING: f64 = 1e-9;

/// Buffers, reused from search to search.
#[derive(Debug, Default)]
pub struct Search {
    candidates: Sorted,
    rings: Rings,
    /// The numbers of the candidates of a bucket.
    numbers: Vec<u32>,
}

/// The cheapest candidate so far.
struct Best {
    velocity: Vector,
    number: u32,
    cost: f64,
}

impl Best {
    fn none() -> Self {
        Self {
            velocity: Vector::zeros(),
            number: u32::MAX,
            cost: f64::INFINITY,
        }
    }
}

impl Search {
    /// The cheapest of `candidates` (Eq. 20), or the first of several with equal costs. Zero if all are too fast.
    ///
    /// Candidates are visited in order of their deviation from the preferred velocity, until it exceeds the best cost
    /// found. The best cost minus the deviation gives a time before which a contact makes the candidate too expensive:
    /// this rejects most candidates after testing the nearest discs, eight at a time. For the others the first contact
    /// is searched from the innermost ring outward, until discs farther away cannot be met before the earliest contact
    /// found. Discs are read from the surroundings only as far as these searches go.
    pub fn best(
        &mut self,
        situation: &Situation,
        surroundings: &impl Surroundings,
        candidates: &Candidates,
        collision_weight: f64,
    ) -> Vector {
        dispatch!(level(), simd => {
            self.best_by(simd, (situation, surroundings), candidates, collision_weight)
        })
    }

    #[inline(always)]
    fn best_by<S: Simd>(
        &mut self,
        simd: S,
        (situation, surroundings): (&Situation, &impl Surroundings),
        candidates: &Candidates,
        collision_weight: f64,
    ) -> Vector {
        let Self {
            candidates: sorted,
            numbers,
            rings,
        } = self;
        sorted.take(situation, candidates);
        rings.begin(surroundings.limits());
        let mut best = Best::none();
        for (bucket, least) in Sorted::buckets() {
            if least * (1.0 - ROUNDING) - ROUNDING > best.cost {
                break;
            }
            numbers.clear();
            sorted.find(simd, bucket, numbers);
            for &number in numbers.iter() {
                let candidate = sorted.allowed(number);
                let deviation = candidate.deviation;
                if deviation > best.cost {
                    continue;
                }
                // Agent i moves at 2v′ − v_i.
                let velocity = candidate.velocity * 2.0 - situation.velocity;
                // After rounding, a cost this close to the best may be equal to it.
                let left = best.cost - deviation + f64::EPSILON * best.cost;
                let latest = collision_weight / left * (1.0 - ROUNDING);
                let way = rings.way(simd, velocity, Appear::Later);
                if rings.certainly_met(simd, surroundings, &way, latest) {
                    continue;
                }
                let cost = |time: f64| deviation + collision_weight / time;
                let bound = best.cost;
                let search = Contact {
                    situation,
                    surroundings,
                    velocity,
                    too_early: |time: f64| cost(time) > bound,
                };
                let Some(time) = search.first(simd, rings) else {
                    continue;
                };
                if cost(time) < best.cost || number < best.number {
                    best = Best {
                        velocity: candidate.velocity,
                        number,
                        cost: cost(time),
                    };
                }
            }
        }
        best.velocity
    }
}

/// The search for the earliest contact of an agent that moves at `velocity`, m/s.
struct Contact<'a, D, E> {
    situation: &'a Situation,
    surroundings: &'a D,
    velocity: Vector,
    /// Whether a contact at this time, in seconds, is so early that the search can stop.
    too_early: E,
}

impl<D: Surroundings, E: Fn(f64) -> bool> Contact<'_, D, E> {
    /// The time of the earliest contact, seconds; infinite if there is none. Returns `None` as soon as a contact is
    /// found that is too early.
    #[inline(always)]
    fn first<S: Simd>(&self, simd: S, rings: &mut Rings) -> Option<f64> {
        let walls = self.situation.walls.iter();
        let walls = walls.map(|wall| self.situation.time_to_wall(wall, self.velocity));
        let mut first = walls.fold(f64::INFINITY, f64::min);
        if (self.too_early)(first) {
            return None;
        }
        let way = rings.way(simd, self.velocity, Appear::Earlier);
        let mut ring = 0;
        while rings.reaches(ring, &way, first) {
            let meet = |number: u32, first: f64| {
                let disc = self.surroundings.disc(number);
                let velocity = self.velocity - disc.velocity;
                let first = first.min(time_to_contact(disc.offset, velocity, disc.reach));
                (!(self.too_early)(first)).then_some(first)
            };
            first = rings.each_perhaps_met(simd, (ring, self.surroundings), &way, first, meet)?;
            ring += 1;
        }
        Some(first)
    }
}
