//! The legs under the bodies: their accelerations, and their moves.

use rayon::prelude::*;

use super::integrate::{Motion, find_motions, move_freely};
use super::{Fixed, Simulation, Stage};
use crate::agents::Agents;
use crate::forces::legs::{Both, Legs};
use crate::frame::Frame;
use crate::geometry::Walls;
use crate::math::{Vector, clamp_length, direction};
use crate::neighbors::{BLOCK, TASK};
use crate::pairs::{Level, dispatch};

impl Simulation {
    /// Puts legs under agents that entered since.
    pub(super) fn put_on_legs(&mut self) {
        if self.fixed.needs.legs {
            self.crowd.agents.stand(self.crowd.clock.time());
        }
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
        let mut legs = std::mem::take(&mut agents.legs);
        let mut legs_velocity = std::mem::take(&mut agents.legs_velocity);
        let agents = &*agents;
        let blocks = (
            legs.par_chunks_mut(BLOCK),
            legs_velocity.par_chunks_mut(BLOCK),
            self.derived.fields.legs_acceleration.par_chunks(BLOCK),
        );
        self.stages.time(Stage::Integration, || {
            let blocks = blocks.into_par_iter().with_min_len(TASK).enumerate();
            blocks.for_each(|(b, (legs, velocities, accelerations))| {
                let from = b * BLOCK;
                let block = from..from + legs.len();
                let motion = |k: usize, v: Vector, a: Vector| motion_of(from + k, v, a);
                let limit = |k: usize| fixed.scene.max_speed(agents, from + k);
                let mut motions = [Motion::default(); BLOCK];
                let motions = &mut motions[..accelerations.len()];
                let states = (&mut *legs, &mut *velocities);
                let is_moved = dispatch!(Level::new(), _simd => {
                    find_motions(motion, states.1, accelerations, motions);
                    let most = fixed.scene.max_speed;
                    agents.max_speed.is_empty() && move_freely(most, dt, motions, states)
                });
                if !is_moved {
                    let states = legs
                        .iter_mut()
                        .zip(&mut *velocities)
                        .zip(motions)
                        .enumerate();
                    for (k, ((legs, velocity), motion)) in states {
                        *legs += clamp_length(motion.way, limit(k)) * dt;
                        *velocity = clamp_length(motion.velocity, limit(k));
                    }
                }
                fixed.each_span(agents, block.clone(), |span, blend, _| {
                    let own = span.start - from..span.end - from;
                    let bodies = (&agents.position[span.clone()], &agents.velocity[span]);
                    let legs = (&mut legs[own.clone()], &mut velocities[own]);
                    match blend.legs() {
                        Some(law) => hold(&law, bodies, legs),
                        None => {
                            legs.0.copy_from_slice(bodies.0);
                            legs.1.copy_from_slice(bodies.1);
                        }
                    }
                });
                for (i, near) in neighbors.agents_near_walls(block) {
                    let legs = (&mut legs[i - from], &mut velocities[i - from]);
                    stop(&fixed.scene.walls, (agents.position[i], near), legs);
                }
            });
        });
        let agents = &mut self.crowd.agents;
        (agents.legs, agents.legs_velocity) = (legs, legs_velocity);
    }
}

impl Fixed {
    /// The body of agent `i` was held back before a line: it pulls its legs along at the limit of the lean.
    pub(super) fn hold_legs(&self, agents: &mut Agents, i: usize) {
        let Some(law) = self.blend(agents, i).legs() else {
            return;
        };
        if agents.legs.len() != agents.len() {
            return;
        }
        let (position, velocity) = (agents.position[i], agents.velocity[i]);
        let (legs, legs_velocity) = (&mut agents.legs[i], &mut agents.legs_velocity[i]);
        let both = (
            std::slice::from_mut(legs),
            std::slice::from_mut(legs_velocity),
        );
        hold(&law, (&[position], &[velocity]), both);
        let walls = &self.scene.walls;
        let near = walls.near_any(&[position, *legs], 0.0);
        stop(walls, (position, &near), (legs, legs_velocity));
    }
}

/// Bodies, with these positions and velocities, pull their legs along at the limit of the lean.
fn hold(
    law: &Legs,
    (positions, velocities): (&[Vector], &[Vector]),
    (legs, legs_velocities): (&mut [Vector], &mut [Vector]),
) {
    let legs = legs.iter_mut().zip(legs_velocities);
    let bodies = positions.iter().zip(velocities);
    for ((legs, velocity), (&r, &v)) in legs.zip(bodies) {
        let lean = r - *legs;
        if lean.norm_squared() > law.lean_limit * law.lean_limit {
            let e = direction(lean);
            *legs = r - e * law.lean_limit;
            *velocity += e * (v - *velocity).dot(&e).max(0.0);
        }
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
    /// Adds the terms of legs that do not depend on other agents to the accelerations of bodies and legs, of a block of
    /// agents that begins with `from`.
    pub(super) fn accelerate_legs(
        &self,
        frame: &Frame,
        from: usize,
        (bodies, legs): (&mut [Vector], &mut [Vector]),
    ) {
        let block = from..from + bodies.len();
        self.each_span(frame.agents, block, |span, blend, _| {
            let Some(law) = blend.legs() else {
                return;
            };
            let own = span.start - from..span.end - from;
            law.add_balance(
                frame,
                span.clone(),
                (&mut bodies[own.clone()], &mut legs[own]),
            );
            if law.legs_strength != 0.0 {
                for (i, near) in frame.neighbors.agents_near_walls(span) {
                    let Both { body, legs: under } = law.from_walls(frame, i, near);
                    bodies[i - from] += body;
                    legs[i - from] += under;
                }
            }
        });
    }
}
