//! Eq. 18, summed over pairs of agents, eight pairs at a time.
//!
//! Plain form: `social_force_by_agent` in `examples/paper.rs`.

use std::f64::consts::{LN_2, SQRT_2};

use super::{FIELD_OF_VIEW, SocialForce, UNSEEN_WEIGHT};
use crate::pairs::prelude::*;
use crate::pairs::{Lanes, Mask, Real, Simd, splat};

/// A sequence of pairs, eight at a time.
pub trait Pairs<R: Real, S: Simd> {
    /// The number of steps.
    fn steps(&self) -> usize;

    /// r_ij in coordinate units and v_j in m/s, of the pairs of a step.
    fn pairs(&self, simd: S, step: usize) -> [[Lanes<R, S>; 2]; 2];
}

/// The input of Eq. 18: the agents i of eight pairs.
pub struct Feeling<R: Real, S: Simd> {
    velocity: [Lanes<R, S>; 2],
    /// −T, in coordinate units per (m/s).
    minus_ahead: Lanes<R, S>,
    /// T times the velocity, in coordinate units.
    ahead: [Lanes<R, S>; 2],
    /// Minus the speed, times the cosine of half the field of view.
    edge_of_view: Lanes<R, S>,
    unseen_weight: Lanes<R, S>,
    /// The square of the avoidance radius, in coordinate units².
    radius_squared: Lanes<R, S>,
    /// −1/(√2 σ ln 2), per coordinate unit.
    falling: Lanes<R, S>,
}

/// Pairs before the second root: d = r_ij, s = T v_ij and a = d + s.
#[derive(Clone, Copy)]
struct Begun<R: Real, S: Simd> {
    r_ij: [Lanes<R, S>; 2],
    d_squared: Lanes<R, S>,
    d: Lanes<R, S>,
    r_ij_ahead: [Lanes<R, S>; 2],
    a: Lanes<R, S>,
    /// d·a
    dot: Lanes<R, S>,
    /// d × s
    cross: Lanes<R, S>,
    /// d·v_i
    towards: Lanes<R, S>,
}

/// Pairs before the division.
#[derive(Clone, Copy)]
struct Rooted<R: Real, S: Simd> {
    begun: Begun<R, S>,
    /// |d||a|
    product: Lanes<R, S>,
    /// √2 h with h² = (|d||a| + |d·a|)/2.
    h: Lanes<R, S>,
}

/// Pairs before the exponential.
#[derive(Clone, Copy)]
struct Effect<R: Real, S: Simd> {
    /// √2 b, in coordinate units.
    b: Lanes<R, S>,
    /// (|d| + |a|)/(√2 h |d||a|) with h² = (|d||a| + |d·a|)/2, weighted; zero if the agent has no effect.
    size: Lanes<R, S>,
    /// A vector along the force: |d||a| times the sum or difference of the directions of d and a.
    along: [Lanes<R, S>; 2],
}

impl<R: Real, S: Simd> Feeling<R, S> {
    /// Agents i with these velocities.
    #[inline(always)]
    pub fn new(simd: S, social: &SocialForce, unit: f64, [x, y]: [Lanes<R, S>; 2]) -> Self {
        let time = social.anticipation_time / unit;
        let radius = social.avoidance_radius / unit;
        let falling = -unit / (SQRT_2 * LN_2 * social.agent_range);
        let ahead = splat::<R, S>(simd, time);
        let speed = y.mul_add_precise(y, x * x).sqrt();
        Self {
            velocity: [x, y],
            minus_ahead: splat::<R, S>(simd, -time),
            ahead: [x * ahead, y * ahead],
            edge_of_view: speed * splat::<R, S>(simd, -FIELD_OF_VIEW),
            unseen_weight: splat::<R, S>(simd, UNSEEN_WEIGHT),
            radius_squared: splat::<R, S>(simd, radius * radius),
            falling: splat::<R, S>(simd, falling),
        }
    }

    /// Adds the forces of all `pairs` to `sum`, step by step.
    ///
    /// Software pipelining: a step divides for its pairs, takes the second root of the next ones, adds the exponentials
    /// of the previous ones and takes the first roots of those after the next. None of these depends on the others, so
    /// that few have to wait.
    #[inline(always)]
    pub fn add(&self, simd: S, pairs: &impl Pairs<R, S>, sum: &mut [Lanes<R, S>; 2]) {
        if pairs.steps() < 2 {
            for step in 0..pairs.steps() {
                let rooted = self.begin(simd, pairs, step).root();
                let effect = self.finish(simd, rooted, rooted.quotient(simd));
                self.add_effect(simd, effect, sum);
            }
            return;
        }
        let mut rooted = self.begin(simd, pairs, 0).root();
        let mut begun = self.begin(simd, pairs, 1);
        let mut last = Effect::none(simd);
        for step in 2..pairs.steps() {
            let quotient = rooted.quotient(simd);
            let next = begun.root();
            self.add_effect(simd, last, sum);
            last = self.finish(simd, rooted, quotient);
            rooted = next;
            begun = self.begin(simd, pairs, step);
        }
        self.add_effect(simd, last, sum);
        for rooted in [rooted, begun.root()] {
            let effect = self.finish(simd, rooted, rooted.quotient(simd));
            self.add_effect(simd, effect, sum);
        }
    }

    /// T v_ij
    #[inline(always)]
    pub fn shift(&self, [vx, vy]: [Lanes<R, S>; 2]) -> [Lanes<R, S>; 2] {
        [
            vx.mul_add_precise(self.minus_ahead, self.ahead[0]),
            vy.mul_add_precise(self.minus_ahead, self.ahead[1]),
        ]
    }

    /// Whether the square of |r_ij| is in range.
    #[inline(always)]
    pub fn is_in_range(&self, d_squared: Lanes<R, S>) -> Mask<R, S> {
        d_squared.simd_lt(self.radius_squared)
    }

    #[inline(always)]
    fn begin(&self, simd: S, pairs: &impl Pairs<R, S>, step: usize) -> Begun<R, S> {
        let [[dx, dy], v_j] = pairs.pairs(simd, step);
        let [sx, sy] = self.shift(v_j);
        let (ax, ay) = (dx + sx, dy + sy);
        let d_squared = dy.mul_add_precise(dy, dx * dx);
        Begun {
            r_ij: [dx, dy],
            d_squared,
            d: d_squared.sqrt(),
            r_ij_ahead: [ax, ay],
            a: ay.mul_add_precise(ay, ax * ax).sqrt(),
            dot: dy.mul_add_precise(ay, dx * ax),
            cross: dx * sy - dy * sx,
            towards: dy.mul_add_precise(self.velocity[1], dx * self.velocity[0]),
        }
    }

    /// The force points along the bisector of d and a, and its magnitude is V₀/σ e^(−b/σ) (|d| + |a|)/(2√(|d||a|)).
    /// If d and a are nearly opposite, as for agents on a collision course, computing b and the sum of the two
    /// directions as in the equation cancels nearly equal numbers. In that case both are computed from d × s instead.
    #[inline(always)]
    fn finish(&self, simd: S, rooted: Rooted<R, S>, per_h_product: Lanes<R, S>) -> Effect<R, S> {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let pair = rooted.begun;
        let ([dx, dy], [ax, ay], d, a) = (pair.r_ij, pair.r_ij_ahead, pair.d, pair.a);
        let facing = pair.dot.simd_ge(zero);
        let aside = pair.cross.abs() * (rooted.product * per_h_product);
        let b = facing.select(rooted.h, aside);

        // |a| d + |d| a, or, if d·a < 0, their difference turned by a right angle.
        let (px, py) = (dx * a, dy * a);
        let (qx, qy) = (ax * d, ay * d);
        let along_x = facing.select(px + qx, with_sign_of::<R, S>(simd, pair.cross, qy - py));
        let along_y = facing.select(py + qy, with_sign_of::<R, S>(simd, pair.cross, px - qx));

        let seen = pair.towards.simd_le(self.edge_of_view * d);
        let size = (d + a) * seen.select(one, self.unseen_weight) * per_h_product;
        // No effect from the agent itself, from agents out of range, or where the ellipse degenerates and values
        // may be NaN.
        let counts = b.simd_gt(zero) & self.is_in_range(pair.d_squared);
        Effect {
            b: counts.select(b, zero),
            size: counts.select(size, zero),
            along: [along_x, along_y],
        }
    }

    #[inline(always)]
    fn add_effect(&self, simd: S, effect: Effect<R, S>, sum: &mut [Lanes<R, S>; 2]) {
        let size = R::exp2(simd, effect.b * self.falling) * effect.size;
        sum[0] = size.mul_add_precise(effect.along[0], sum[0]);
        sum[1] = size.mul_add_precise(effect.along[1], sum[1]);
    }
}

impl<R: Real, S: Simd> Begun<R, S> {
    #[inline(always)]
    fn root(self) -> Rooted<R, S> {
        let product = self.d * self.a;
        let h = (product + self.dot.abs()).sqrt();
        Rooted {
            begun: self,
            product,
            h,
        }
    }
}

impl<R: Real, S: Simd> Rooted<R, S> {
    /// 1/(√2 h |d||a|)
    #[inline(always)]
    fn quotient(&self, simd: S) -> Lanes<R, S> {
        splat::<R, S>(simd, 1.0) / (self.h * self.product)
    }
}

impl<R: Real, S: Simd> Effect<R, S> {
    #[inline(always)]
    fn none(simd: S) -> Self {
        let zero = splat::<R, S>(simd, 0.0);
        Self {
            b: zero,
            size: zero,
            along: [zero; 2],
        }
    }
}

/// `value` times 1 with the sign of `sign`.
#[inline(always)]
fn with_sign_of<R: Real, S: Simd>(simd: S, sign: Lanes<R, S>, value: Lanes<R, S>) -> Lanes<R, S> {
    let minus = splat::<R, S>(simd, -0.0).to_bits();
    Lanes::<R, S>::from_bits(value.to_bits() ^ (sign.to_bits() & minus))
}
