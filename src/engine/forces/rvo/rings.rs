//! Collision tests in single precision: the discs that a moving agent may meet before a given time.

use crate::engine::math::Vector;
use crate::engine::pairs::prelude::*;
use crate::engine::pairs::{LANES, Level, Simd, dispatch, f32x8};

/// A moving disc, relative to agent i.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingDisc {
    /// r_j − r_i, meters.
    pub offset: Vector,
    /// v_j, m/s.
    pub velocity: Vector,
    /// D_i + D_j, meters.
    pub reach: f64,
}

/// The number of rings, and the area of each ring over π, m²; the last ring is unbounded.
const RINGS: usize = 16;
const RING_AREA: f64 = 1.5;

/// A generous bound on single-precision rounding errors of lengths and speeds, relative to the largest ones.
const ROUNDING: f64 = 4e-6;

/// Discs sorted into rings around an agent by the distances of their centers, innermost ring first.
#[derive(Debug, Default)]
pub struct Rings {
    rings: [Ring; RINGS],
    ring_of: Vec<u8>,
    /// The numbers of the discs, ring by ring; the last eight of each ring is padded with zeros.
    members: Vec<u32>,
    eights: Vec<Eight>,
    /// The greatest D_i + D_j, meters, and the highest speed, m/s.
    longest_reach: f64,
    highest_speed: f64,
    /// The distance of the farthest center, meters.
    farthest: f64,
}

/// The maxima over some discs.
#[derive(Default)]
struct Longest {
    reach: f64,
    speed_squared: f64,
    offset_squared: f64,
}

impl Longest {
    #[inline]
    fn take(&mut self, disc: &MovingDisc, offset_squared: f64) {
        let greater = |a: f64, b: f64| if b > a { b } else { a }; // no NaNs here
        self.reach = greater(self.reach, disc.reach);
        self.speed_squared = greater(self.speed_squared, disc.velocity.norm_squared());
        self.offset_squared = greater(self.offset_squared, offset_squared);
    }
}

/// The position of a ring's discs.
#[derive(Debug, Default, Clone, Copy)]
struct Ring {
    /// The index of its first eight.
    start: usize,
    /// The number of discs.
    len: usize,
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
}

const NOBODY: Eight = Eight {
    x: [0.0; LANES],
    y: [0.0; LANES],
    velocity_x: [0.0; LANES],
    velocity_y: [0.0; LANES],
    gap: [1.0; LANES],
};

/// Whether a ring begins farther away than `seen` meters.
fn is_beyond(ring: usize, seen: f64) -> bool {
    ring as f64 * RING_AREA * (1.0 - ROUNDING) > seen * seen
}

#[inline(always)]
fn splat<S: Simd>(simd: S, value: f64) -> f32x8<S> {
    f32x8::splat(simd, value as f32)
}

impl Rings {
    /// Sorts `discs` into rings.
    pub fn sort(&mut self, discs: &[MovingDisc]) {
        let mut counts = [0; RINGS];
        let mut longest = Longest::default();
        self.ring_of.clear();
        for disc in discs {
            let squared = disc.offset.norm_squared();
            let ring = ((squared * (1.0 / RING_AREA)) as usize).min(RINGS - 1);
            counts[ring] += 1;
            self.ring_of.push(ring as u8);
            longest.take(disc, squared);
        }
        self.longest_reach = longest.reach;
        self.highest_speed = longest.speed_squared.sqrt();
        self.farthest = longest.offset_squared.sqrt();
        let mut end = 0;
        for (ring, len) in self.rings.iter_mut().zip(counts) {
            *ring = Ring { start: end, len };
            end += len.div_ceil(LANES);
        }
        self.place(discs, end);
    }

    /// Puts every disc into its ring; `eights` is the number of eights in all rings.
    fn place(&mut self, discs: &[MovingDisc], eights: usize) {
        self.eights.clear();
        self.eights.resize(eights, NOBODY);
        self.members.clear();
        self.members.resize(eights * LANES, 0);
        let mut places = self.rings.map(|ring| ring.start * LANES);
        for ((k, disc), &ring) in (0..).zip(discs).zip(&self.ring_of) {
            let place = places[usize::from(ring)];
            places[usize::from(ring)] += 1;
            self.members[place] = k;
            let (eight, lane) = (&mut self.eights[place / LANES], place % LANES);
            eight.x[lane] = disc.offset.x as f32;
            eight.y[lane] = disc.offset.y as f32;
            eight.velocity_x[lane] = disc.velocity.x as f32;
            eight.velocity_y[lane] = disc.velocity.y as f32;
            eight.gap[lane] = (disc.offset.norm_squared() - disc.reach * disc.reach) as f32;
        }
    }

    /// Whether a disc is certainly met at `velocity` (m/s) before the time `before` (seconds).
    pub fn certainly_met(&self, velocity: Vector, before: f64) -> bool {
        dispatch!(Level::new(), simd => self.certainly_met_by(simd, velocity, before))
    }

    #[inline(always)]
    fn certainly_met_by<S: Simd>(&self, simd: S, velocity: Vector, before: f64) -> bool {
        let way = Way::new(simd, self, velocity, before, ROUNDING);
        for (number, ring) in self.rings.iter().enumerate() {
            if is_beyond(number, way.seen) {
                return false;
            }
            for eight in self.eights(ring) {
                if way.lowest(simd, eight).simd_lt(splat(simd, 0.0)).any_true() {
                    return true;
                }
            }
        }
        false
    }

    /// The number of rings, from the innermost, whose discs may be met at `velocity` (m/s) before the time `before`
    /// (seconds).
    pub fn within(&self, velocity: Vector, before: f64) -> usize {
        let seen = self.seen(velocity, before);
        (0..RINGS)
            .take_while(|&ring| !is_beyond(ring, seen))
            .count()
    }

    /// Replaces `found` by the numbers of all discs of a ring that are met at `velocity` (m/s) before the time
    /// `before` (seconds), and possibly others.
    pub fn perhaps_met(&self, ring: usize, velocity: Vector, before: f64, found: &mut Vec<u32>) {
        found.clear();
        let ring = &self.rings[ring];
        dispatch!(Level::new(), simd => self.perhaps_met_by(simd, ring, velocity, before, found));
    }

    #[inline(always)]
    fn perhaps_met_by<S: Simd>(
        &self,
        simd: S,
        ring: &Ring,
        velocity: Vector,
        before: f64,
        found: &mut Vec<u32>,
    ) {
        let way = Way::new(simd, self, velocity, before, -ROUNDING);
        let members = &self.members[ring.start * LANES..];
        for (eight, members) in self.eights(ring).iter().zip(members.chunks(LANES)) {
            // Not `simd_lt`: a NaN counts as possibly met.
            let apart = way.lowest(simd, eight).simd_gt(splat(simd, 0.0));
            let mut met = !apart.to_bitmask() & ((1 << LANES) - 1);
            while met != 0 {
                found.push(members[met.trailing_zeros() as usize]);
                met &= met - 1;
            }
        }
    }

    fn eights(&self, ring: &Ring) -> &[Eight] {
        &self.eights[ring.start..ring.start + ring.len.div_ceil(LANES)]
    }

    /// The distance of centers, in meters, beyond which no disc is met before the time `before` (seconds).
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
    fn new(simd: S, rings: &Rings, velocity: Vector, before: f64, rounding: f64) -> Self {
        let fastest = velocity.norm() + rings.highest_speed;
        let length = rounding * rings.farthest;
        Self {
            x: splat(simd, velocity.x),
            y: splat(simd, velocity.y),
            before: splat(simd, before * (1.0 - rounding)),
            gap: splat(simd, length * rings.farthest),
            approach: splat(simd, -length * fastest),
            squared: splat(simd, rounding * fastest * fastest),
            seen: rings.seen(velocity, before),
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
