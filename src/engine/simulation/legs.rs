//! The legs under the bodies: their accelerations, and their moves.

use rayon::prelude::*;

use super::integrate::Motion;
use super::{Fixed, Simulation, Stage};
use crate::engine::forces::legs::{Both, Legs};
use crate::engine::frame::Frame;
use crate::engine::geometry::Walls;
use crate::engine::math::{Vector, are_finite, clamp_length, direction};
use crate::engine::neighbors::{BLOCK, TASK};

impl Simulation {
    /// Puts legs under agents that entered since.
    pub(super) fn put_on_legs(&mut self) {
        if self.fixed.needs.legs {
            self.crowd.agents.stand();
        }
    }

    /// The accelerations of legs, and what legs add to those of bodies.
    pub(super) fn update_legs(&mut self) {
        if !self.fixed.needs.legs {
            return;
        }
        let fields = &mut self.derived.fields;
        let mut bodies = std::mem::take(&mut fields.acceleration);
        let mut legs = std::mem::take(&mut fields.legs_acceleration);
        legs.clear();
        legs.resize(bodies.len(), Vector::zeros());
        let (fixed, laws) = (&self.fixed, self.fixed.scene.legs());
        let frame = self.derived.frame(fixed, &self.crowd);
        let finite = self.stages.time(Stage::Acceleration, || {
            let blocks = (bodies.par_chunks_mut(BLOCK), legs.par_chunks_mut(BLOCK));
            let blocks = blocks.into_par_iter().with_min_len(TASK).enumerate();
            let each = blocks.map(|(b, (bodies, legs))| {
                fixed.accelerate_legs(&frame, &laws, b, (bodies, legs));
                are_finite(bodies) && are_finite(legs)
            });
            each.reduce(|| true, |a, b| a && b)
        });
        let fields = &mut self.derived.fields;
        (fields.acceleration, fields.legs_acceleration) = (bodies, legs);
        self.derived.finite &= finite;
    }

    /// Moves the legs of all agents by `dt` seconds, after their bodies. `motion_of` maps index, velocity and
    /// acceleration to the motion of legs.
    pub(super) fn move_legs(
        &mut self,
        dt: f64,
        motion_of: impl Fn(usize, Vector, Vector) -> Motion + Sync,
    ) {
        if !self.fixed.needs.legs {
            return;
        }
        let (fixed, agents) = (&self.fixed, &mut self.crowd.agents);
        let neighbors = &self.derived.neighbors;
        let (positions, velocities) = (&agents.position, &agents.velocity);
        let (groups, max_speeds) = (&agents.group, &agents.max_speed);
        let moves = agents.legs.par_iter_mut().zip(&mut agents.legs_velocity);
        let moves = moves.zip(&self.derived.fields.legs_acceleration);
        let moves = moves.enumerate().with_min_len(TASK * BLOCK);
        self.stages.time(Stage::Integration, || {
            moves.for_each(|(i, ((legs, velocity), &acceleration))| {
                let body = (positions[i], velocities[i]);
                let group = &fixed.scene.groups[usize::from(groups[i])];
                let Some(law) = group.blend.legs() else {
                    (*legs, *velocity) = body;
                    return;
                };
                let limit = max_speeds.get(i).copied().unwrap_or(fixed.scene.max_speed);
                let motion = motion_of(i, *velocity, acceleration);
                *legs += clamp_length(motion.way, limit) * dt;
                *velocity = clamp_length(motion.velocity, limit);
                hold(&law, body, (legs, velocity));
                let near = neighbors.near_walls(i);
                stop(&fixed.scene.walls, (body.0, near), (legs, velocity));
            });
        });
    }
}

/// The body, with this position and velocity, pulls its legs along at the limit of the lean.
fn hold(law: &Legs, (r, v): (Vector, Vector), (legs, velocity): (&mut Vector, &mut Vector)) {
    let lean = r - *legs;
    if lean.norm() > law.lean_limit {
        let e = direction(lean);
        *legs = r - e * law.lean_limit;
        *velocity += e * (v - *velocity).dot(&e).max(0.0);
    }
}

/// Walls between a body and its legs stop the legs.
fn stop(
    walls: &Walls,
    (body, near): (Vector, &[u32]),
    (legs, velocity): (&mut Vector, &mut Vector),
) {
    if let Some((point, wall)) = walls.stop(body, *legs, near) {
        let normal = walls.wall(wall).normal;
        *legs = point;
        *velocity -= normal * velocity.dot(&normal).min(0.0);
    }
}

impl Fixed {
    /// Computes the accelerations of the legs of block `b`, and adds those that legs bring to bodies.
    fn accelerate_legs(
        &self,
        frame: &Frame,
        laws: &[Legs],
        b: usize,
        (bodies, legs): (&mut [Vector], &mut [Vector]),
    ) {
        let from = b * BLOCK;
        let block = from..from + bodies.len();
        for law in laws {
            let has_law = |i: usize| self.blend(frame.agents, i).legs() == Some(*law);
            let mut felt = [0.0; BLOCK];
            for i in block.clone().filter(|&i| has_law(i)) {
                felt[i % BLOCK] = 1.0 / frame.agents.mass[i];
            }
            let mut sums = [Both::default(); BLOCK];
            if law.legs_strength != 0.0 {
                law.add_from_agents(frame, b, &felt, &mut sums);
            }
            for i in block.clone().filter(|&i| has_law(i)) {
                let (balance, walls) = (law.balance(frame, i), law.from_walls(frame, i));
                bodies[i - from] += sums[i - from].body + balance.body + walls.body;
                legs[i - from] += sums[i - from].legs + balance.legs + walls.legs;
            }
        }
    }
}
