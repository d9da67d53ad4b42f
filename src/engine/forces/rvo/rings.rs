//! Collision tests in single precision: the discs that a moving agent may meet before a given time.

use super::surroundings::{Limits, MovingDisc, Surroundings};
use crate::engine::math::Vector;
use crate::engine::pairs::prelude::*;
use crate::engine::pairs::{LANES, Simd, f32x8};

/// The number of rings, and the area of each ring over π, m²; the last ring is unbounded.
const RINGS: usize = 16;
const RING_AREA: f64 = 1.5;

/// A generous bound on single-precision rounding errors of lengths and speeds, relative to the largest ones.
const ROUNDING: f64 = 4e-6;

/// The first ring after each band; the discs of a band are read together, when the first of its rings is needed.
const BANDS: [usize; 3] = [2, 6, RINGS];

/// Discs sorted into rings around an agent by the distances of their centers, innermost ring first.
#[derive(Debug, Default)]
pub struct Rings {
    rings: [Ring; RINGS],
    /// The number of bands that have been read.
    bands: usize,
    discs: Vec<MovingDisc>,
    limits: Limits,
}

/// The discs of a ring.
#[derive(Debug, Default)]
struct Ring {
    len: usize,
    eights: Vec<Eight>,
}

/// Eight discs in single precision. Unused lanes hold a dummy disc. No test finds it certainly met; if one finds it
/// possibly met, disc 0 is checked once more.
#[derive(Debug, Clone, Copy)]
struct Eight {
    x: [f32; LANES],
    y: [f32; LANES],
    velocity_x: [f32; LANES],
    velocity_y: [f32; LANES],
    /// |offset|² − reach², m².
    gap: [f32; LANES],
    /// The numbers of the discs.
    discs: [u32; LANES],
}

const EMPTY: Eight = Eight {
    x: [0.0; LANES],
    y: [0.0; LANES],
    velocity_x: [0.0; LANES],
    velocity_y: [0.0; LANES],
    gap: [1.0; LANES],
    discs: [0; LANES],
};

/// Whether a ring begins farther away than `seen` meters.
fn is_beyond(ring: usize, seen: f64) -> bool {
    ring as f64 * RING_AREA * (1.0 - ROUNDING) > seen * seen
}

#[inline(always)]
fn splat<S: Simd>(simd: S, value: f64) -> f32x8<S> {
    f32x8::splat(simd, value as f32)
}

impl Ring {
    fn push(&mut self, number: u32, disc: &MovingDisc, squared: f64) {
        let lane = self.len % LANES;
        if lane == 0 {
            self.eights.push(EMPTY);
        }
        self.len += 1;
        if let Some(eight) = self.eights.last_mut() {
            eight.x[lane] = disc.offset.x as f32;
            eight.y[lane] = disc.offset.y as f32;
            eight.velocity_x[lane] = disc.velocity.x as f32;
            eight.velocity_y[lane] = disc.velocity.y as f32;
            eight.gap[lane] = (squared - disc.reach * disc.reach) as f32;
            eight.discs[lane] = number;
        }
    }
}

impl Rings {
    /// Removes all discs, and sets the limits of those that follow.
    pub fn begin(&mut self, limits: Limits) {
        for ring in &mut self.rings {
            ring.len = 0;
            ring.eights.clear();
        }
        self.bands = 0;
        self.discs.clear();
        self.limits = limits;
    }

    /// Reads the discs of all bands up to that of a ring.
    #[inline(always)]
    fn read(&mut self, ring: usize, surroundings: &impl Surroundings) {
        while self.bands == 0 || BANDS[self.bands - 1] <= ring {
            self.read_band(surroundings);
        }
    }

    #[inline(never)]
    fn read_band(&mut self, surroundings: &impl Surroundings) {
        let first = self.bands.checked_sub(1).map_or(0, |last| BANDS[last]);
        let next = BANDS[self.bands];
        self.bands += 1;
        let nearest = first as f64 * RING_AREA;
        let farthest = if next < RINGS {
            next as f64 * RING_AREA
        } else {
            f64::INFINITY
        };
        let known = self.discs.len();
        surroundings.read(nearest..farthest, &mut self.discs);
        for (k, disc) in self.discs.iter().enumerate().skip(known) {
            let squared = disc.offset.norm_squared();
            // Rounding must not put a disc into a ring that has been searched.
            let ring = ((squared * (1.0 / RING_AREA)) as usize).clamp(first, next - 1);
            self.rings[ring].push(k as u32, disc, squared);
        }
    }

    /// A disc by its number.
    pub fn disc(&self, number: u32) -> &MovingDisc {
        &self.discs[number as usize]
    }

    /// Whether a disc is certainly met at `velocity` (m/s) before the time `before` (seconds).
    #[inline(always)]
    pub fn certainly_met<S: Simd>(
        &mut self,
        simd: S,
        surroundings: &impl Surroundings,
        velocity: Vector,
        before: f64,
    ) -> bool {
        let way = Way::new(simd, &self.limits, velocity, before, ROUNDING);
        for number in 0..RINGS {
            if is_beyond(number, way.seen) {
                return false;
            }
            self.read(number, surroundings);
            // The whole ring before the branch: at which eight a candidate fails is unpredictable.
            let mut lowest = splat(simd, 0.0);
            for eight in &self.rings[number].eights {
                lowest = lowest.min(way.lowest(simd, eight));
            }
            if lowest.simd_lt(splat(simd, 0.0)).any_true() {
                return true;
            }
        }
        false
    }

    /// Whether a disc of a ring or of one beyond may be met at `velocity` (m/s) before the time `before` (seconds).
    #[inline(always)]
    pub fn may_meet(&self, ring: usize, velocity: Vector, before: f64) -> bool {
        ring < RINGS && !is_beyond(ring, self.limits.seen(velocity, before))
    }

    /// Replaces `found` by the numbers of all discs of a ring that are met at a velocity (m/s) before a time (seconds),
    /// and possibly others.
    #[inline(always)]
    pub fn perhaps_met<S: Simd>(
        &mut self,
        simd: S,
        ring: usize,
        (velocity, before): (Vector, f64),
        surroundings: &impl Surroundings,
        found: &mut Vec<u32>,
    ) {
        found.clear();
        self.read(ring, surroundings);
        let way = Way::new(simd, &self.limits, velocity, before, -ROUNDING);
        for eight in &self.rings[ring].eights {
            // Not `simd_lt`: a NaN counts as possibly met.
            let apart = way.lowest(simd, eight).simd_gt(splat(simd, 0.0));
            let mut met = !apart.to_bitmask() & ((1 << LANES) - 1);
            while met != 0 {
                found.push(eight.discs[met.trailing_zeros() as usize]);
                met &= met - 1;
            }
        }
    }
}

impl Limits {
    /// The distance of centers, in meters, beyond which no disc is met before the time `before` (seconds).
    #[inline(always)]
    fn seen(&self, velocity: Vector, before: f64) -> f64 {
        (velocity.norm() + self.highest_speed) * before + self.longest_reach
    }
}

/// The agent's motion at a given velocity, with allowances for rounding.
#[derive(Clone, Copy)]
struct Way<S: Simd> {
    x: f32x8<S>,
    y: f32x8<S>,
    before: f32x8<S>,
    /// Allowances added to |offset|² − reach² (m²), offset · w (m²/s) and |w|² (m²/s²), at relative velocity w.
    gap: f32x8<S>,
    approach: f32x8<S>,
    squared: f32x8<S>,
    /// The distance of centers, in meters, beyond which no disc is met.
    seen: f64,
}

impl<S: Simd> Way<S> {
    /// `rounding` is relative to the largest lengths and speeds. If positive it makes contacts appear later, if
    /// negative earlier.
    #[inline(always)]
    fn new(simd: S, limits: &Limits, velocity: Vector, before: f64, rounding: f64) -> Self {
        let fastest = velocity.norm() + limits.highest_speed;
        let length = rounding * limits.farthest;
        Self {
            x: splat(simd, velocity.x),
            y: splat(simd, velocity.y),
            before: splat(simd, before * (1.0 - rounding)),
            gap: splat(simd, length * limits.farthest),
            approach: splat(simd, -length * fastest),
            squared: splat(simd, rounding * fastest * fastest),
            seen: limits.seen(velocity, before),
        }
    }

    /// The minimum of F(t) = |offset − w t|² − reach² for 0 ≤ t ≤ `before`: negative if there is a contact.
    #[inline(always)]
    fn lowest(&self, simd: S, eight: &Eight) -> f32x8<S> {
        let wx = self.x - f32x8::from_slice(simd, &eight.velocity_x);
        let wy = self.y - f32x8::from_slice(simd, &eight.velocity_y);
        let x = f32x8::from_slice(simd, &eight.x);
        let y = f32x8::from_slice(simd, &eight.y);
        let gap = f32x8::from_slice(simd, &eight.gap) + self.gap;
        let zero = splat(simd, 0.0);
        let approach = x.mul_add(wx, y.mul_add(wy, self.approach)).max(zero);
        let squared = wx.mul_add(wx, wy.mul_add(wy, self.squared)).max(zero);
        let time = (approach / squared).min(self.before);
        gap - (approach + approach - squared * time) * time
    }
}
