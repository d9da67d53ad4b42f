//! The integrators that need more than the forces at the beginning of a frame.

use rayon::prelude::*;

use super::integrate::Motion;
use super::{Fault, Simulation, Stage};
use crate::math::Vector;
use crate::neighbors::{BLOCK, TASK};

impl Simulation {
    /// The velocities of the frame were predicted with the accelerations of the previous frame. Corrects them first
    /// with the accelerations of this frame.
    pub(super) fn move_by_verlet(&mut self, dt: f64) {
        self.keep_mean_density();
        let (agents, fields) = (&mut self.crowd.agents, &self.derived.fields);
        self.stages.time(Stage::Integration, || {
            let before = &mut agents.acceleration_before;
            correct(&mut agents.velocity, before, &fields.acceleration, dt);
        });
        self.move_both(|_, v, a| Motion {
            way: v + a * (0.5 * dt),
            velocity: v + a * dt,
        });
    }

    pub(super) fn move_by_midpoint(&mut self, dt: f64) -> Result<(), Fault> {
        let mut begin = self.crowd.agents.clone();
        self.keep_mean_density();
        self.move_agents(0.5 * dt, |_, v, a| Motion {
            way: v,
            velocity: v + a * (0.5 * dt),
        });
        self.advance_states(0.5 * dt);
        self.pack();
        self.update_density_and_pressure(0.5 * dt);
        self.follow_routes(self.crowd.clock.is_coarse());
        self.update_preferred_velocity();
        self.update_acceleration();
        if let Err(fault) = self.check() {
            self.crowd.agents = begin;
            return Err(fault);
        }
        let agents = &mut self.crowd.agents;
        agents.position = begin.position;
        std::mem::swap(&mut agents.velocity, &mut begin.velocity);
        let half_way = begin.velocity;
        agents.states = begin.states;
        self.move_all(|i, v, a| Motion {
            way: half_way[i],
            velocity: v + a * dt,
        });
        self.advance_states(dt);
        Ok(())
    }
}

/// Corrects velocities that were predicted with the accelerations of the previous frame.
fn correct(
    velocities: &mut [Vector],
    before: &mut Vec<Option<Vector>>,
    accelerations: &[Vector],
    dt: f64,
) {
    before.resize(velocities.len(), None); // for agents that entered since
    let blocks = (
        velocities.par_chunks_mut(BLOCK),
        before.par_chunks_mut(BLOCK),
        accelerations.par_chunks(BLOCK),
    );
    let blocks = blocks.into_par_iter().with_min_len(TASK);
    blocks.for_each(|(velocities, before, accelerations)| {
        let states = velocities.iter_mut().zip(before).zip(accelerations);
        for ((v, before), &a) in states {
            if let Some(before) = before.replace(a) {
                *v += (a - before) * (0.5 * dt);
            }
        }
    });
}
