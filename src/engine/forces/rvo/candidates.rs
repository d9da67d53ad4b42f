//! Candidate velocities: drawn, compared with the preferred velocity, and sorted by their deviation from it.
//!
//! Plain form: `candidates` in `examples/paper.rs`.

use rand::RngCore;

use super::{Situation, floor};
use crate::math::{Vector, unit_vector};
use crate::pairs::prelude::*;
use crate::pairs::{
    LANES, Simd, dispatch, f64x8, first_lanes, level, mask32x8, mask64x8, u8x64, u32x8,
};

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

/// Candidates whose buckets are compared together.
const TOGETHER: usize = 64;

/// Candidate velocities, one array per quantity, padded to a multiple of [`LANES`] by candidates that are too fast.
#[derive(Debug, Clone, Default)]
pub struct Candidates {
    /// Distances from the current velocity, m/s.
    length: Vec<f64>,
    /// Directions, in units of 2⁻³² turns.
    turn: Vec<u32>,
}

impl Candidates {
    /// Fills up the last vector.
    fn pad(&mut self, count: usize) {
        let padded = count.next_multiple_of(LANES);
        self.length.truncate(count);
        self.length.resize(padded, f64::INFINITY);
        self.turn.resize(padded, 0);
    }
}

impl FromIterator<Candidate> for Candidates {
    fn from_iter<I: IntoIterator<Item = Candidate>>(all: I) -> Self {
        let all = all.into_iter();
        let (length, turn): (Vec<_>, Vec<_>) = all.map(|one| (one.length, one.turn)).unzip();
        let count = length.len();
        let mut candidates = Self { length, turn };
        candidates.pad(count);
        candidates
    }
}

/// Candidates drawn at random.
#[derive(Debug, Default)]
pub struct Draws {
    bytes: Vec<u8>,
    candidates: Candidates,
}

impl Draws {
    /// `count` draws: direction and distance from the current velocity are uniform, the distance up to 2 s_max. Leaves
    /// out draws that exceed s_max in every direction.
    pub fn draw(
        &mut self,
        count: u32,
        situation: &Situation,
        mut rng: impl RngCore,
    ) -> &Candidates {
        let count = count as usize;
        self.bytes.resize(count.next_multiple_of(LANES) * BYTES, 0);
        rng.fill_bytes(&mut self.bytes[..count * BYTES]);
        let kept = dispatch!(level(), simd => self.keep(simd, count, situation));
        self.candidates.pad(kept);
        &self.candidates
    }

    /// Moves the first `count` draws that are not too fast to the candidates, and returns their number.
    #[inline(always)]
    fn keep<S: Simd>(&mut self, simd: S, count: usize, situation: &Situation) -> usize {
        let farthest = situation.velocity.norm() + situation.max_speed;
        let per_step = 2.0 * situation.max_speed / f64::from(u32::MAX);
        let (farthest, per_step) = (f64x8::splat(simd, farthest), f64x8::splat(simd, per_step));
        let Candidates { length, turn } = &mut self.candidates;
        length.resize(self.bytes.len() / BYTES, 0.0);
        turn.resize(self.bytes.len() / BYTES, 0);
        let (mut kept, mut left) = (0, count);
        for draws in self.bytes.as_chunks::<BYTES>().0.as_chunks::<LANES>().0 {
            let (mut turns, mut steps) = ([0; LANES], [0.0; LANES]);
            for k in 0..LANES {
                let bits = u64::from_le_bytes(draws[k]);
                turns[k] = bits as u32;
                steps[k] = f64::from((bits >> 32) as u32);
            }
            let lengths = f64x8::from_slice(simd, &steps) * per_step;
            let is_drawn = first_lanes(left);
            let is_kept = lengths.simd_le(farthest).to_bitmask() & is_drawn;
            let turns = u32x8::from_slice(simd, &turns);
            let turns = turns.compress(mask32x8::from_bitmask(simd, is_kept));
            let lengths = lengths.compress(mask64x8::from_bitmask(simd, is_kept));
            lengths.store_slice(&mut length[kept..kept + LANES]);
            turns.store_slice(&mut turn[kept..kept + LANES]);
            kept += is_kept.count_ones() as usize;
            left = left.saturating_sub(LANES);
        }
        kept
    }
}

/// A candidate that is not too fast.
#[derive(Debug, Clone, Copy)]
pub struct Allowed {
    /// v′, m/s.
    pub velocity: Vector,
    /// |v′ − v^pref|, m/s.
    pub deviation: f64,
}

/// Width in m/s of the buckets by which candidates are sorted, and their number. Candidates in a bucket are unordered;
/// the last bucket also holds all larger deviations.
const WIDTH: f64 = 0.1;
const BUCKETS: u8 = 64;

/// The bucket of candidates that are too fast; an even number, which [`floor`] keeps.
const TOO_FAST: u8 = 254;

/// Candidates sorted by their deviation, one array per quantity.
#[derive(Debug, Default)]
pub struct Sorted {
    /// v′, m/s.
    x: Vec<f64>,
    y: Vec<f64>,
    /// |v′ − v^pref|, m/s.
    deviation: Vec<f64>,
    /// Padded to a multiple of [`TOGETHER`].
    bucket: Vec<u8>,
}

impl Sorted {
    /// Takes the candidates that are not too fast. Two loops over arrays, which the compiler turns into vectors.
    #[inline(always)]
    pub fn take(&mut self, situation: &Situation, candidates: &Candidates) {
        let count = candidates.length.len();
        for values in [&mut self.x, &mut self.y, &mut self.deviation] {
            values.resize(count, 0.0);
        }
        self.bucket.resize(count, TOO_FAST);
        let (from, preferred) = (situation.velocity, situation.preferred_velocity);
        let most = situation.max_speed * situation.max_speed;
        let drawn = candidates.length.iter().zip(&candidates.turn);
        for ((x, y), (&length, &turn)) in self.x.iter_mut().zip(&mut self.y).zip(drawn) {
            let velocity = Candidate { length, turn }.velocity(from);
            (*x, *y) = (velocity.x, velocity.y);
        }
        let taken = self.deviation.iter_mut().zip(&mut self.bucket);
        for ((deviation, bucket), (&x, &y)) in taken.zip(self.x.iter().zip(&self.y)) {
            let velocity = Vector::new(x, y);
            *deviation = (velocity - preferred).norm();
            let own = (*deviation * (1.0 / WIDTH)).min(f64::from(BUCKETS - 1));
            let is_allowed = velocity.norm_squared() <= most;
            *bucket = floor(if is_allowed { own } else { f64::from(TOO_FAST) });
        }
        self.bucket
            .resize(count.next_multiple_of(TOGETHER), TOO_FAST);
    }

    /// The buckets in ascending order, each with a lower bound of its deviations, m/s.
    pub fn buckets() -> impl Iterator<Item = (u8, f64)> {
        (0..BUCKETS).map(|bucket| (bucket, f64::from(bucket) * WIDTH))
    }

    /// Appends the numbers of the candidates of a bucket to `found`, in ascending order.
    #[inline(always)]
    pub fn find<S: Simd>(&self, simd: S, bucket: u8, found: &mut Vec<u32>) {
        let (some, _) = self.bucket.as_chunks::<TOGETHER>();
        for (first, buckets) in (0..).step_by(TOGETHER).zip(some) {
            let own = u8x64::from_slice(simd, buckets).simd_eq(u8x64::splat(simd, bucket));
            let mut left = own.to_bitmask();
            while left != 0 {
                found.push(first + left.trailing_zeros());
                left &= left - 1;
            }
        }
    }

    /// A candidate by its number.
    #[inline(always)]
    pub fn allowed(&self, number: u32) -> Allowed {
        let k = number as usize;
        Allowed {
            velocity: Vector::new(self.x[k], self.y[k]),
            deviation: self.deviation[k],
        }
    }
}
