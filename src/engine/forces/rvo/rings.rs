//! Collision tests in single precision: the discs that a moving agent may meet before a given time.

use super::discs::{Discs, Packed};
use super::surroundings::{Limits, Surroundings};
use crate::math::Vector;
use crate::pairs::prelude::*;
use crate::pairs::{LANES, Simd, f32x8, first_lanes};

/// The number of rings, and the squared distances at which they begin, m²; the last ring is unbounded.
const RINGS: usize = 4;
const BEGINS: [f64; RINGS] = [0.0, 1.0, 3.0, 9.0];

/// A generous bound on single-precision rounding errors of lengths and speeds, relative to the largest ones.
const ROUNDING: f64 = 4e-6;

/// Discs in rings around an agent by the distances of their centers. A ring is read when it is first needed.
#[derive(Debug, Default)]
pub struct Rings {
    eights: Vec<Packed>,
    /// The end of each ring that has been read in `eights`.
    ends: [usize; RINGS],
    /// The number of rings that have been read.
    known: usize,
    limits: Limits,
    /// The discs of the ring that is being read.
    discs: Discs,
}

#[inline(always)]
fn splat<S: Simd>(simd: S, value: f64) -> f32x8<S> {
    f32x8::splat(simd, value as f32)
}

impl Rings {
    /// Removes all discs, and sets the limits of those that follow.
    pub fn begin(&mut self, limits: Limits) {
        self.eights.clear();
        self.known = 0;
        self.limits = limits;
    }

    /// Whether an agent reaches into a ring, or beyond it, before the time `before` (seconds).
    #[inline(always)]
    pub fn reaches<S: Simd>(&self, ring: usize, way: &Way<S>, before: f64) -> bool {
        let seen = way.fastest * before + self.limits.longest_reach;
        ring < RINGS && BEGINS[ring] * (1.0 - ROUNDING) <= seen * seen
    }

    /// The discs of a ring, which is read if it is not known.
    #[inline(always)]
    fn discs<S: Simd>(
        &mut self,
        simd: S,
        ring: usize,
        surroundings: &impl Surroundings,
    ) -> &[Packed] {
        while self.known <= ring {
            self.read(simd, surroundings);
        }
        let start = if ring == 0 { 0 } else { self.ends[ring - 1] };
        &self.eights[start..self.ends[ring]]
    }

    /// Reads the discs of the next ring.
    #[inline(never)]
    fn read<S: Simd>(&mut self, simd: S, surroundings: &impl Surroundings) {
        let ring = self.known;
        let next = BEGINS.get(ring + 1).copied();
        let squared = BEGINS[ring]..next.unwrap_or(f64::INFINITY);
        let Self { discs, eights, .. } = self;
        simd.vectorize(
            #[inline(always)]
            || {
                surroundings.read(simd, squared, discs);
                discs.pack(eights);
            },
        );
        self.ends[ring] = self.eights.len();
        self.known += 1;
    }

    /// The way of an agent at a velocity, m/s, on which contacts are certain not to appear later, or earlier.
    #[inline(always)]
    pub fn way<S: Simd>(&self, simd: S, velocity: Vector, appear: Appear) -> Way<S> {
        let rounding = match appear {
            Appear::Later => ROUNDING,
            Appear::Earlier => -ROUNDING,
        };
        Way::new(simd, &self.limits, velocity, rounding)
    }

    /// Whether a disc is certainly met on a way before the time `before` (seconds).
    #[inline(always)]
    pub fn certainly_met<S: Simd>(
        &mut self,
        simd: S,
        surroundings: &impl Surroundings,
        way: &Way<S>,
        before: f64,
    ) -> bool {
        let mut ring = 0;
        while self.reaches(ring, way, before) {
            // The whole ring before the branch: at which eight a candidate fails is unpredictable.
            let mut lowest = splat(simd, 0.0);
            let latest = way.latest(simd, before);
            for eight in self.discs(simd, ring, surroundings) {
                lowest = lowest.min(way.lowest(simd, eight, latest));
            }
            if lowest.simd_lt(splat(simd, 0.0)).any_true() {
                return true;
            }
            ring += 1;
        }
        false
    }

    /// Calls `meet` for each disc of a ring that is met on a way before the time `before` (seconds), and possibly for
    /// others, with its number and `before`. `meet` returns the new `before`, or `None` to stop.
    #[inline(always)]
    pub fn each_perhaps_met<S: Simd>(
        &mut self,
        simd: S,
        (ring, surroundings): (usize, &impl Surroundings),
        way: &Way<S>,
        mut before: f64,
        meet: impl Fn(u32, f64) -> Option<f64>,
    ) -> Option<f64> {
        for eight in self.discs(simd, ring, surroundings) {
            // Not `simd_lt`: a NaN counts as possibly met.
            let apart = way.lowest(simd, eight, way.latest(simd, before));
            let apart = apart.simd_gt(splat(simd, 0.0));
            let mut met = !apart.to_bitmask() & first_lanes(LANES);
            while met != 0 {
                before = meet(eight.number[met.trailing_zeros() as usize], before)?;
                met &= met - 1;
            }
        }
        Some(before)
    }
}

/// In which direction contacts may be wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Appear {
    /// They never appear too early.
    Later,
    /// They never appear too late.
    Earlier,
}

/// The agent's motion at a given velocity, with allowances for rounding.
#[derive(Clone, Copy)]
pub struct Way<S: Simd> {
    x: f32x8<S>,
    y: f32x8<S>,
    /// Allowances added to |offset|² − reach² (m²), offset · w (m²/s) and |w|² (m²/s²), at relative velocity w.
    gap: f32x8<S>,
    approach: f32x8<S>,
    squared: f32x8<S>,
    /// The highest relative speed, m/s.
    fastest: f64,
    rounding: f64,
}

impl<S: Simd> Way<S> {
    /// `rounding` is relative to the largest lengths and speeds. If positive it makes contacts appear later, if
    /// negative earlier.
    #[inline(always)]
    fn new(simd: S, limits: &Limits, velocity: Vector, rounding: f64) -> Self {
        let fastest = velocity.norm() + limits.highest_speed;
        let length = rounding * limits.farthest;
        Self {
            x: splat(simd, velocity.x),
            y: splat(simd, velocity.y),
            gap: splat(simd, length * limits.farthest),
            approach: splat(simd, -length * fastest),
            squared: splat(simd, rounding * fastest * fastest),
            fastest,
            rounding,
        }
    }

    #[inline(always)]
    fn latest(&self, simd: S, before: f64) -> f32x8<S> {
        splat(simd, before * (1.0 - self.rounding))
    }

    /// The minimum of F(t) = |offset − w t|² − reach² for 0 ≤ t ≤ `latest`: negative if there is a contact.
    #[inline(always)]
    fn lowest(&self, simd: S, discs: &Packed, latest: f32x8<S>) -> f32x8<S> {
        let wx = self.x - f32x8::from_slice(simd, &discs.velocity_x);
        let wy = self.y - f32x8::from_slice(simd, &discs.velocity_y);
        let x = f32x8::from_slice(simd, &discs.x);
        let y = f32x8::from_slice(simd, &discs.y);
        let gap = f32x8::from_slice(simd, &discs.gap) + self.gap;
        let zero = splat(simd, 0.0);
        let approach = x.mul_add_precise(wx, y.mul_add_precise(wy, self.approach));
        let approach = approach.max(zero);
        let squared = wx
            .mul_add_precise(wx, wy.mul_add_precise(wy, self.squared))
            .max(zero);
        let time = (approach / squared).min(latest);
        gap - (approach + approach - squared * time) * time
    }
}
