//! Social force: avoidance of agents and walls (§5.3.1, Eqs. 18 and 19).

use std::f64::consts::{LN_2, SQRT_2};
use std::ops::Range;

use crate::engine::frame::Frame;
use crate::engine::geometry::WallPart;
use crate::engine::math::{Vector, direction};
use crate::engine::neighbors::{BLOCK, Run};
use crate::engine::pairs::prelude::*;
use crate::engine::pairs::{
    Bodies, Lanes, Level, PairSum, Real, Simd, add_pairs, dispatch, each, load, splat, spread,
    store,
};

/// Parameters of Eqs. 18 and 19 and of the field of view.
#[derive(Debug, Clone, Copy, PartialEq, serde::Deserialize)]
#[serde(default)]
pub struct SocialForce {
    /// V₀, m²/s².
    pub agent_strength: f64,
    /// σ, meters.
    pub agent_range: f64,
    /// T, seconds.
    pub anticipation_time: f64,
    /// U₀, m²/s².
    pub wall_strength: f64,
    /// R, meters.
    pub wall_range: f64,
    /// Agents and walls farther away are ignored, meters.
    pub avoidance_radius: f64,
    /// Agents are ignored beyond the distance at which their force on an agent of mass 1 is certainly below this,
    /// m/s². 0 disables this cutoff.
    pub avoidance_tolerance: f64,
}

impl Default for SocialForce {
    fn default() -> Self {
        Self {
            agent_strength: 2.1,
            agent_range: 0.3,
            anticipation_time: 2.0,
            wall_strength: 2.1,
            wall_range: 0.1,
            avoidance_radius: 5.0,
            avoidance_tolerance: 0.0,
        }
    }
}

/// The cosine of half the field of view, 100°: neighbors within this angle of the walking direction have full weight.
const FIELD_OF_VIEW: f64 = -0.173_648_177_666_930_3;
/// Weight of a neighbor outside the field of view.
const UNSEEN_WEIGHT: f64 = 0.5;

impl SocialForce {
    /// Eq. 18, summed over all agents in range and divided by the mass.
    pub fn from_agents(&self, frame: &Frame, i: usize) -> Vector {
        let mut coefficients = [0.0; BLOCK];
        coefficients[i % BLOCK] = 1.0 / frame.agents.mass[i];
        let mut accelerations = [Vector::zeros(); BLOCK];
        self.add_from_agents(frame, i / BLOCK, &coefficients, &mut accelerations);
        accelerations[i % BLOCK]
    }

    /// Adds Eq. 18, summed over all agents in range, times `coefficients`, to the accelerations of the agents of
    /// block `b`.
    pub fn add_from_agents(
        &self,
        frame: &Frame,
        b: usize,
        coefficients: &[f64; BLOCK],
        accelerations: &mut [Vector],
    ) {
        let mut runs = Vec::new();
        for (agents, _) in frame.neighbors.near().block(b).clusters() {
            let own = agents.start % BLOCK..agents.start % BLOCK + agents.len();
            let coefficients = &coefficients[own.clone()];
            if coefficients.iter().all(|&coefficient| coefficient == 0.0) {
                continue;
            }
            let around = |radius, runs: &mut Vec<_>| {
                let positions = &frame.agents.position;
                let neighbors = frame.neighbors;
                neighbors.around_cluster(agents.clone(), positions, radius, runs);
            };
            around(self.avoidance_radius, &mut runs);
            if self.avoidance_tolerance > 0.0 {
                let radius = self.reach(frame.relative_speed(agents.clone(), &runs));
                if radius < self.avoidance_radius {
                    around(radius, &mut runs);
                }
            }
            let out = &mut accelerations[own];
            each!(frame.packed, columns => dispatch!(Level::new(), simd => {
                self.add_sums(simd, &columns.bodies, (agents.start, &runs), coefficients, out);
            }));
        }
    }

    /// The distance in meters beyond which every force is below the tolerance, if no relative speed exceeds
    /// `relative_speed`, m/s.
    ///
    /// With S = T `relative_speed` and r = |r_ij|, |r_ij + s| differs from r by at most S. So b² ≥ r (r − S), and
    /// the force, V₀/σ e^(−b/σ) (√q + 1/√q)/2 with q = |r_ij + s|/r, is at most 1.25 V₀/σ e^(−b/σ) for S ≤ ¾ r.
    pub fn reach(&self, relative_speed: f64) -> f64 {
        let ratio = 1.25 * self.agent_strength / (self.agent_range * self.avoidance_tolerance);
        let b = self.agent_range * ratio.max(1.0).ln();
        let s = self.anticipation_time * relative_speed;
        let beyond = 0.5 * (s + (s * s + 4.0 * b * b).sqrt());
        beyond.max(s / 0.75).min(self.avoidance_radius)
    }

    /// Adds Eq. 18 on the agents of one cluster, from `start` on, times their coefficients, to their accelerations,
    /// m/s². `runs` contain all agents in reach, and some out of reach.
    #[inline(always)]
    fn add_sums<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        (start, runs): (usize, &[Run]),
        coefficients: &[f64],
        out: &mut [Vector],
    ) {
        let mut sum = FromAgents::new(simd, self, bodies, start);
        add_pairs(simd, bodies, (start, runs), &mut sum);
        sum.add_last(simd);
        let (x, y) = (store::<R, S>(sum.sum[0]), store::<R, S>(sum.sum[1]));
        // 1/(4h) of the force, with √2 h in its place.
        let scale = self.agent_strength / self.agent_range * SQRT_2 / 4.0;
        for (k, (out, coefficient)) in out.iter_mut().zip(coefficients).enumerate() {
            *out += Vector::new(x[k], y[k]) * (scale * coefficient);
        }
    }

    /// Eq. 19, summed over the walls in range whose free side the agent is on, divided by the mass.
    pub fn from_walls(&self, frame: &Frame, i: usize) -> Vector {
        let r_i = frame.agents.position[i];
        let seen = FieldOfView::new(frame.agents.velocity[i]);
        let force: Vector = frame
            .neighbors
            .far_walls(i)
            .iter()
            .filter_map(|&k| {
                let wall = frame.walls.wall(k);
                if !wall.faces(r_i) {
                    return None;
                }
                let nearest = wall.nearest_point(r_i);
                // A corner belongs to two walls but counts once: for the wall that ends there.
                let before = frame.walls.wall(wall.previous);
                if nearest.part == WallPart::Start
                    && before.faces(r_i)
                    && before.nearest_point(r_i).part == WallPart::End
                {
                    return None;
                }
                let away = r_i - nearest.point;
                let in_range = away.norm() < self.avoidance_radius;
                in_range.then(|| self.wall_force(away) * seen.weight(-away))
            })
            .sum();
        force / frame.agents.mass[i]
    }

    /// Eq. 19 for `away` = r_i − r_k*.
    pub fn wall_force(&self, away: Vector) -> Vector {
        let strength =
            self.wall_strength / self.wall_range * (-away.norm() / self.wall_range).exp();
        direction(away) * strength
    }
}

/// Eq. 18 for eight agents i.
struct FromAgents<'a, R: Real, S: Simd> {
    bodies: &'a Bodies<R>,
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
    /// The effect of the previous agent, which is not summed yet.
    last: Effect<R, S>,
    sum: [Lanes<R, S>; 2],
}

/// One agent's effect on eight agents, before the exponential.
#[derive(Clone, Copy)]
struct Effect<R: Real, S: Simd> {
    /// √2 b, in coordinate units.
    b: Lanes<R, S>,
    /// (|d| + |a|)/(√2 h |d||a|) with h² = (|d||a| + |d·a|)/2, weighted; zero if the agent has no effect.
    size: Lanes<R, S>,
    /// A vector along the force: |d||a| times the sum or difference of the directions of d and a.
    along: [Lanes<R, S>; 2],
}

impl<'a, R: Real, S: Simd> FromAgents<'a, R, S> {
    /// The sum for the agents from `start` on.
    #[inline(always)]
    fn new(simd: S, social: &SocialForce, bodies: &'a Bodies<R>, start: usize) -> Self {
        let zero = splat::<R, S>(simd, 0.0);
        let time = social.anticipation_time / bodies.unit;
        let radius = social.avoidance_radius / bodies.unit;
        let falling = -bodies.unit / (SQRT_2 * LN_2 * social.agent_range);
        let x = load(simd, &bodies.velocity_x, start);
        let y = load(simd, &bodies.velocity_y, start);
        let ahead = splat::<R, S>(simd, time);
        let speed = y.mul_add(y, x * x).sqrt();
        Self {
            bodies,
            velocity: [x, y],
            minus_ahead: splat::<R, S>(simd, -time),
            ahead: [x * ahead, y * ahead],
            edge_of_view: speed * splat::<R, S>(simd, -FIELD_OF_VIEW),
            unseen_weight: splat::<R, S>(simd, UNSEEN_WEIGHT),
            radius_squared: splat::<R, S>(simd, radius * radius),
            falling: splat::<R, S>(simd, falling),
            last: Effect {
                b: zero,
                size: zero,
                along: [zero; 2],
            },
            sum: [zero; 2],
        }
    }

    /// The effect of an agent at a distance d = r_ij with velocity (`vx`, `vy`).
    ///
    /// With s = T v_ij and a = d + s, the force points along the bisector of d and a, and its magnitude is
    /// V₀/σ e^(−b/σ) (|d| + |a|)/(2√(|d||a|)). If d and a are nearly opposite, as for agents on a collision course,
    /// computing b and the sum of the two directions as in the equation cancels nearly equal numbers. In that case
    /// both are computed from d × s instead.
    #[inline(always)]
    fn effect(
        &self,
        simd: S,
        [dx, dy]: [Lanes<R, S>; 2],
        [vx, vy]: [Lanes<R, S>; 2],
    ) -> Effect<R, S> {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let sx = vx.mul_add(self.minus_ahead, self.ahead[0]);
        let sy = vy.mul_add(self.minus_ahead, self.ahead[1]);
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

        let seen = dy.mul_add(self.velocity[1], dx * self.velocity[0]);
        let seen = seen.simd_le(self.edge_of_view * d);
        let size = (d + a) * seen.select(one, self.unseen_weight) * per_h_product;
        // No effect from the agent itself, from agents out of range, or where the ellipse degenerates and values
        // may be NaN.
        let counts = b.simd_gt(zero) & squared.simd_lt(self.radius_squared);
        Effect {
            b: counts.select(b, zero),
            size: counts.select(size, zero),
            along: [along_x, along_y],
        }
    }

    #[inline(always)]
    fn add_last(&mut self, simd: S) {
        let size = R::exp2(simd, self.last.b * self.falling) * self.last.size;
        self.sum[0] = size.mul_add(self.last.along[0], self.sum[0]);
        self.sum[1] = size.mul_add(self.last.along[1], self.sum[1]);
    }
}

impl<'a, R: Real, S: Simd> PairSum<R, S> for FromAgents<'a, R, S> {
    type Run = [&'a [R]; 2];

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> [&'a [R]; 2] {
        let bodies = self.bodies;
        [&bodies.velocity_x[run.clone()], &bodies.velocity_y[run]]
    }

    /// Software pipelining: the exponential for one agent is computed alongside the roots for the next agent, since
    /// neither depends on the other.
    #[inline(always)]
    fn add(&mut self, simd: S, r_ij: [Lanes<R, S>; 2], [vx, vy]: [&'a [R]; 2], j: usize) {
        let next = self.effect(simd, r_ij, [spread(simd, vx[j]), spread(simd, vy[j])]);
        self.add_last(simd);
        self.last = next;
    }
}

/// Full weight inside the field of view; an agent at rest sees in all directions.
struct FieldOfView {
    heading: Vector,
}

impl FieldOfView {
    fn new(velocity: Vector) -> Self {
        Self {
            heading: direction(velocity),
        }
    }

    fn weight(&self, towards: Vector) -> f64 {
        let ahead = self.heading.dot(&towards) >= FIELD_OF_VIEW * towards.norm();
        if ahead || self.heading == Vector::zeros() {
            1.0
        } else {
            UNSEEN_WEIGHT
        }
    }
}
