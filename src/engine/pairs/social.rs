//! Social forces (Eq. 18), for eight agents at a time.

use std::f64::consts::{LN_2, SQRT_2};
use std::ops::Range;

use fearless_simd::{Simd, prelude::*};

use super::columns::Columns;
use super::kernels::{load, splat, store};
use super::real::Real;
use crate::engine::math::Vector;

/// The parameters of a sum of social forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SocialLaw {
    /// V₀/σ, in the unit of V₀ per meter.
    pub strength: f64,
    /// σ, meters.
    pub range: f64,
    /// T, seconds.
    pub anticipation_time: f64,
    /// Agents farther away have no effect, meters.
    pub radius: f64,
    /// Cosine of half the field of view.
    pub field_of_view: f64,
    /// Weight of a neighbor outside the field of view.
    pub unseen_weight: f64,
}

/// One agent's effect on eight agents, before the exponential.
#[derive(Clone, Copy)]
struct Effect<R: Real, S: Simd> {
    /// √2 b, in coordinate units.
    b: R::Lanes<S>,
    /// (|d| + |a|)/(√2 h |d||a|) with h² = (|d||a| + |d·a|)/2, weighted; zero if the agent has no effect.
    size: R::Lanes<S>,
    /// A vector along the force: |d||a| times the sum or difference of the directions of d and a.
    along_x: R::Lanes<S>,
    along_y: R::Lanes<S>,
}

/// The eight agents and the parameters, in coordinate units.
#[derive(Clone, Copy)]
struct Observers<R: Real, S: Simd> {
    x: R::Places<S>,
    y: R::Places<S>,
    velocity_x: R::Lanes<S>,
    velocity_y: R::Lanes<S>,
    /// −T, in coordinate units per (m/s).
    ahead: R::Lanes<S>,
    /// T times the velocity, in coordinate units.
    ahead_x: R::Lanes<S>,
    ahead_y: R::Lanes<S>,
    /// Minus the speed, times the cosine of half the field of view.
    edge_of_view: R::Lanes<S>,
    unseen_weight: R::Lanes<S>,
    radius_squared: R::Lanes<S>,
}

impl<R: Real, S: Simd> Observers<R, S> {
    #[inline(always)]
    fn new(simd: S, columns: &Columns<R>, law: &SocialLaw, start: usize) -> Self {
        let ahead = law.anticipation_time / columns.unit;
        let radius = law.radius / columns.unit;
        let velocity_x = load(simd, &columns.velocity_x, start);
        let velocity_y = load(simd, &columns.velocity_y, start);
        let speed = velocity_y.mul_add(velocity_y, velocity_x * velocity_x);
        Self {
            x: R::places(simd, &columns.x[start..]),
            y: R::places(simd, &columns.y[start..]),
            velocity_x,
            velocity_y,
            ahead: splat::<R, S>(simd, -ahead),
            ahead_x: velocity_x * splat::<R, S>(simd, ahead),
            ahead_y: velocity_y * splat::<R, S>(simd, ahead),
            edge_of_view: speed.sqrt() * splat::<R, S>(simd, -law.field_of_view),
            unseen_weight: splat::<R, S>(simd, law.unseen_weight),
            radius_squared: splat::<R, S>(simd, radius * radius),
        }
    }

    /// The effect on them of an agent at (`x`, `y`) with velocity (`vx`, `vy`).
    ///
    /// With d = r_ij, s = T v_ij and a = d + s, the force points along the bisector of d and a, and its magnitude is
    /// V₀/σ e^(−b/σ) (|d| + |a|)/(2√(|d||a|)). If d and a are nearly opposite, as for agents on a collision course,
    /// computing b and the sum of the two directions as in the equation cancels nearly equal numbers. In that case
    /// both are computed from d × s instead.
    #[inline(always)]
    fn effect(
        &self,
        simd: S,
        [x, y]: [R::Coordinate; 2],
        [vx, vy]: [R::Lanes<S>; 2],
    ) -> Effect<R, S> {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let dx = R::differences(simd, self.x, x);
        let dy = R::differences(simd, self.y, y);
        let sx = vx.mul_add(self.ahead, self.ahead_x);
        let sy = vy.mul_add(self.ahead, self.ahead_y);
        let (ax, ay) = (dx + sx, dy + sy);
        let squared = dy.mul_add(dy, dx * dx);
        let d = squared.sqrt();
        let a = ay.mul_add(ay, ax * ax).sqrt();
        let product = d * a;
        let dot = dy.mul_add(ay, dx * ax);
        let cross = dx * sy - dy * sx;

        let h = (product + dot.abs()).sqrt(); // √2 h
        let per_h_product = one / (h * product);
        let facing = dot.simd_ge(zero);
        let b = facing.select(h, cross.abs() * (product * per_h_product));

        // |a| d + |d| a, or, if d·a < 0, their difference turned by a right angle.
        let side = one.copysign(cross);
        let (px, py) = (dx * a, dy * a);
        let (qx, qy) = (ax * d, ay * d);
        let along_x = facing.select(px + qx, side * (qy - py));
        let along_y = facing.select(py + qy, side * (px - qx));

        let seen = dy.mul_add(self.velocity_y, dx * self.velocity_x);
        let seen = seen.simd_le(self.edge_of_view * d);
        let size = (d + a) * seen.select(one, self.unseen_weight) * per_h_product;
        // No effect from the agent itself, from agents out of range, or where the ellipse degenerates and values
        // may be NaN.
        let counts = b.simd_gt(zero) & squared.simd_lt(self.radius_squared);
        Effect {
            b: counts.select(b, zero),
            size: counts.select(size, zero),
            along_x,
            along_y,
        }
    }
}

/// Adds Σ_j of Eq. 18, times each agent's coefficient, to the accelerations of `agents`, which are one cluster.
/// `runs` contain all agents in reach, and some out of reach.
#[inline(always)]
pub fn add_social<R: Real, S: Simd>(
    simd: S,
    columns: &Columns<R>,
    law: &SocialLaw,
    (agents, runs): (Range<usize>, &[Range<u32>]),
    coefficients: &[f64],
    out: &mut [Vector],
) {
    let zero = splat::<R, S>(simd, 0.0);
    let observers = Observers::<R, S>::new(simd, columns, law, agents.start);
    let falling = -columns.unit / (SQRT_2 * LN_2 * law.range);
    let falling = splat::<R, S>(simd, falling);

    let (mut sum_x, mut sum_y) = (zero, zero);
    // Software pipelining: the exponential for one agent is computed alongside the roots for the next agent, since
    // neither depends on the other.
    let mut last: Effect<R, S> = Effect {
        b: zero,
        size: zero,
        along_x: zero,
        along_y: zero,
    };
    for run in runs {
        let run = run.start as usize..run.end as usize;
        let count = run.len();
        let (x, y) = (&columns.x[run.clone()], &columns.y[run.clone()]);
        let vx = &columns.velocity_x[run.clone()];
        let vy = &columns.velocity_y[run];
        for j in 0..count {
            let velocity = [R::Lanes::splat(simd, vx[j]), R::Lanes::splat(simd, vy[j])];
            let next = observers.effect(simd, [x[j], y[j]], velocity);
            let size = R::exp2(simd, last.b * falling) * last.size;
            sum_x = size.mul_add(last.along_x, sum_x);
            sum_y = size.mul_add(last.along_y, sum_y);
            last = next;
        }
    }
    let size = R::exp2(simd, last.b * falling) * last.size;
    let sum_x = store::<R, S>(size.mul_add(last.along_x, sum_x));
    let sum_y = store::<R, S>(size.mul_add(last.along_y, sum_y));
    let scale = law.strength * SQRT_2 / 4.0; // 1/(4h) of the force, with √2 h in its place
    for (k, (sum, coefficient)) in out.iter_mut().zip(coefficients).enumerate() {
        let force = Vector::new(sum_x[k].double(), sum_y[k].double());
        *sum += force * (scale * coefficient);
    }
}
