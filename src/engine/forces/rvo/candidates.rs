//! Candidate velocities: drawn, compared with the preferred velocity, and sorted by their deviation from it.

use rand::RngCore;

use super::Situation;
use crate::engine::math::{Vector, unit_vector};
use crate::engine::pairs::LANES;

/// A candidate velocity, relative to the current one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Candidate {
    /// Distance from the current velocity, m/s.
    pub length: f64,
    /// Direction, in units of 2⁻³² turns.
    pub turn: u32,
}

impl Candidate {
    /// The velocity in m/s, if the current one is `from`.
    #[inline(always)]
    pub fn velocity(self, from: Vector) -> Vector {
        from + unit_vector(self.turn) * self.length
    }
}

/// The bytes of a draw: four for the direction, four for the distance.
const BYTES: usize = 8;

/// Candidates drawn at random.
#[derive(Debug, Default)]
pub struct Draws {
    bytes: Vec<u8>,
    candidates: Vec<Candidate>,
}

impl Draws {
    /// `count` draws: direction and distance from the current velocity are uniform, the distance up to 2 s_max. Leaves
    /// out draws that exceed s_max in every direction.
    pub fn draw(
        &mut self,
        count: u32,
        situation: &Situation,
        mut rng: impl RngCore,
    ) -> &[Candidate] {
        let farthest = situation.velocity.norm() + situation.max_speed;
        let per_step = 2.0 * situation.max_speed / f64::from(u32::MAX);
        self.bytes.resize(count as usize * BYTES, 0);
        rng.fill_bytes(&mut self.bytes);
        let (draws, _) = self.bytes.as_chunks::<BYTES>();
        self.candidates.resize(draws.len(), Candidate::default());
        let mut kept = 0;
        for &draw in draws {
            let bits = u64::from_le_bytes(draw);
            let length = per_step * f64::from((bits >> 32) as u32);
            let turn = bits as u32;
            self.candidates[kept] = Candidate { length, turn };
            kept += usize::from(length <= farthest); // branchless: a branch would be unpredictable
        }
        &self.candidates[..kept]
    }
}

/// A candidate that is not too fast.
#[derive(Debug, Clone, Copy)]
pub struct Allowed {
    /// Its place among the candidates.
    pub number: u32,
    /// v′, m/s.
    pub velocity: Vector,
    /// |v′ − v^pref|, m/s.
    pub deviation: f64,
}

const NONE: Allowed = Allowed {
    number: 0,
    velocity: Vector::new(0.0, 0.0),
    deviation: 0.0,
};

/// Width in m/s of the buckets by which candidates are sorted, and their number. Candidates in a bucket are unordered;
/// the last bucket also holds all larger deviations.
const WIDTH: f64 = 0.1;
const BUCKETS: usize = 64;

/// Candidates sorted by their deviation.
#[derive(Debug, Default)]
pub struct Sorted {
    allowed: Vec<Allowed>,
    bucket_of: Vec<u8>,
    /// Indices in `allowed`, bucket by bucket.
    order: Vec<u32>,
    /// The end of each bucket in `order`.
    ends: Vec<u32>,
}

/// Eight candidates.
struct Eight {
    /// v′, m/s.
    x: [f64; LANES],
    y: [f64; LANES],
    /// |v′|², m²/s².
    squared: [f64; LANES],
    /// |v′ − v^pref|, m/s.
    deviation: [f64; LANES],
}

impl Eight {
    /// At most eight candidates. One loop over arrays, which the compiler turns into vectors.
    #[inline(always)]
    fn of(candidates: &[Candidate], situation: &Situation) -> Self {
        let (mut turn, mut length) = ([0; LANES], [0.0; LANES]);
        for (k, candidate) in candidates.iter().enumerate() {
            turn[k] = candidate.turn;
            length[k] = candidate.length;
        }
        let mut eight = Self {
            x: [0.0; LANES],
            y: [0.0; LANES],
            squared: [0.0; LANES],
            deviation: [0.0; LANES],
        };
        for k in 0..LANES {
            let candidate = Candidate {
                length: length[k],
                turn: turn[k],
            };
            let velocity = candidate.velocity(situation.velocity);
            eight.x[k] = velocity.x;
            eight.y[k] = velocity.y;
            eight.squared[k] = velocity.norm_squared();
            eight.deviation[k] = (velocity - situation.preferred_velocity).norm();
        }
        eight
    }
}

impl Sorted {
    /// Takes the candidates that are not too fast.
    #[inline(always)]
    pub fn take(&mut self, situation: &Situation, candidates: &[Candidate]) {
        let most = situation.max_speed * situation.max_speed;
        self.allowed.resize(candidates.len() + LANES, NONE);
        self.bucket_of.resize(candidates.len() + LANES, 0);
        let mut counts = [0_u32; BUCKETS];
        let (mut kept, mut number) = (0, 0);
        for some in candidates.chunks(LANES) {
            let eight = Eight::of(some, situation);
            for lane in 0..some.len() {
                let deviation = eight.deviation[lane];
                let bucket = ((deviation * (1.0 / WIDTH)) as usize).min(BUCKETS - 1);
                self.allowed[kept] = Allowed {
                    number,
                    velocity: Vector::new(eight.x[lane], eight.y[lane]),
                    deviation,
                };
                self.bucket_of[kept] = bucket as u8;
                let is_allowed = eight.squared[lane] <= most;
                counts[bucket] += u32::from(is_allowed);
                kept += usize::from(is_allowed);
                number += 1;
            }
        }
        self.sort(kept, counts);
    }

    #[inline(always)]
    fn sort(&mut self, kept: usize, counts: [u32; BUCKETS]) {
        let mut places = counts;
        let mut start = 0;
        for place in &mut places {
            start += std::mem::replace(place, start);
        }
        self.order.resize(kept, 0);
        for (k, &bucket) in (0..).zip(&self.bucket_of[..kept]) {
            let place = &mut places[usize::from(bucket)];
            self.order[*place as usize] = k;
            *place += 1;
        }
        self.ends.clear();
        self.ends.extend(places);
    }

    /// The candidates in the order of their buckets, each with a lower bound of the deviations of its bucket, m/s.
    pub fn iter(&self) -> impl Iterator<Item = (f64, impl Iterator<Item = &Allowed>)> {
        let mut start = 0;
        let buckets = self.ends.iter().enumerate();
        let buckets = buckets.map(move |(bucket, &end)| {
            let own = &self.order[start as usize..end as usize];
            start = end;
            (bucket as f64 * WIDTH, own)
        });
        let buckets = buckets.filter(|(_, own)| !own.is_empty());
        buckets.map(|(least, own)| (least, own.iter().map(|&k| &self.allowed[k as usize])))
    }
}
