//! Steps 1–4: from the state to the accelerations, moving nobody.

use std::ops::Range;

use rayon::prelude::*;

use super::{Simulation, Stage, blend_of, change_of};
use crate::density;
use crate::forces::goal;
use crate::neighbors::BLOCK;
use crate::pairs::PairSums;

impl Simulation {
    /// Step 1.
    pub(super) fn update_neighbors(&mut self) {
        if self.crowd_changed || self.neighbors.are_stale() {
            self.sort_agents();
            self.list_walls();
        }
        if self.needs.pairs || self.density_is_due() {
            let (agents, neighbors, packed) = (&self.agents, &mut self.neighbors, &mut self.packed);
            self.stages.time(Stage::Neighbors, || {
                if neighbors.near().is_empty() {
                    neighbors.list_agents(agents);
                }
                packed.take_bodies(agents, neighbors.extent());
            });
        }
    }

    fn sort_agents(&mut self) {
        let ranges = self.scene.ranges(&self.needs);
        let (agents, neighbors) = (&mut self.agents, &mut self.neighbors);
        self.stages
            .time(Stage::Sort, || neighbors.sort(agents, ranges));
        self.crowd_changed = false;
    }

    fn list_walls(&mut self) {
        let (agents, neighbors) = (&self.agents, &mut self.neighbors);
        self.stages.time(Stage::Neighbors, || {
            neighbors.list_walls(agents, &self.scene.walls);
        });
    }

    /// Step 1B.
    pub(super) fn update_density_and_pressure(&mut self) {
        let due = self.density_is_due();
        if !due && !self.fields.density.is_empty() {
            self.agents.newcomer.fill(true); // when asked for again, ρ̂ starts anew
        }
        self.fields.resize(self.agents.len(), due);
        if !due {
            return;
        }
        let mut fields = std::mem::take(&mut self.fields);
        let mut stages = std::mem::take(&mut self.stages);
        let frame = self.frame();
        stages.time(Stage::DensityAndPressure, || {
            (
                fields.density.par_chunks_mut(BLOCK),
                fields.density_from_walls.par_chunks_mut(BLOCK),
                fields.mean_density.par_chunks_mut(BLOCK),
                fields.rest_density_before.par_chunks_mut(BLOCK),
                fields.rest_density.par_chunks_mut(BLOCK),
                fields.pressure.par_chunks_mut(BLOCK),
                fields.wall_gradient.par_chunks_mut(BLOCK),
            )
                .into_par_iter()
                .enumerate()
                .for_each(
                    |(b, (density, from_walls, mean, before, rest, pressure, gradient))| {
                        let block = b * BLOCK..b * BLOCK + density.len();
                        let chunks = self.neighbors.near();
                        let support = self.support_radii(block.clone());
                        self.packed
                            .densities(chunks, (block.clone(), &support), density);
                        for (k, i) in block.enumerate() {
                            let (sph, walls) = (&self.blend(i).sph, self.scene.wall_method);
                            let state = density::sph_state(&frame, i, density[k], sph, walls);
                            density[k] = state.density;
                            from_walls[k] = state.density_from_walls;
                            mean[k] = state.mean_density;
                            before[k] = state.rest_density_before;
                            rest[k] = state.rest_density;
                            pressure[k] = state.pressure;
                            gradient[k] = state.wall_gradient;
                        }
                    },
                );
        });
        let agents = &mut self.agents;
        stages.time(Stage::DensityAndPressure, || {
            self.packed
                .take_pressures(&agents.mass, &fields.density, &fields.pressure);
            agents.mean_density.copy_from_slice(&fields.mean_density);
            agents.newcomer.fill(false);
        });
        self.fields = fields;
        self.stages = stages;
    }

    /// h of every agent of a block, metres.
    fn support_radii(&self, block: Range<usize>) -> [f64; BLOCK] {
        let mut radii = [0.0; BLOCK];
        for (radius, i) in radii.iter_mut().zip(block) {
            *radius = self.blend(i).sph.support_radius;
        }
        radii
    }

    /// Step 2.
    pub(super) fn update_preferred_velocity(&mut self) {
        let (agents, speed) = (&self.agents, self.scene.preferred_speed);
        let preferred = &mut self.fields.preferred_velocity;
        self.stages.time(Stage::PreferredVelocity, || {
            preferred
                .par_chunks_mut(BLOCK)
                .enumerate()
                .for_each(|(b, preferred)| {
                    for (k, v) in preferred.iter_mut().enumerate() {
                        let i = b * BLOCK + k;
                        *v = goal::preferred_velocity(agents.position[i], agents.goal[i], speed);
                    }
                });
        });
    }

    /// Step 3, the coarse part: RVO where it acts and no earlier choice is held.
    pub(super) fn update_rvo(&mut self) {
        if !self.needs.rvo {
            return;
        }
        let mut avoidance = std::mem::take(&mut self.agents.avoidance);
        let mut stages = std::mem::take(&mut self.stages);
        let frame = self.frame();
        let coarse = self.clock.is_coarse();
        stages.time(Stage::Rvo, || {
            avoidance.par_iter_mut().enumerate().for_each(|(i, held)| {
                let blend = blend_of(&self.scene, &self.agents, i);
                match blend.rvo().filter(|_| blend.rvo_acts(&frame, i)) {
                    None => *held = None,
                    Some(rvo) if coarse || held.is_none() => {
                        *held = Some(rvo.acceleration(&frame, i, self.scene.max_speed));
                    }
                    Some(_) => {}
                }
            });
        });
        self.agents.avoidance = avoidance;
        self.stages = stages;
    }

    /// Steps 3, 3B and 4.
    pub(super) fn update_acceleration(&mut self) {
        let mut acceleration = std::mem::take(&mut self.fields.acceleration);
        let mut stages = std::mem::take(&mut self.stages);
        let frame = self.frame();
        stages.time(Stage::Acceleration, || {
            acceleration
                .par_chunks_mut(BLOCK)
                .enumerate()
                .for_each(|(b, acceleration)| {
                    let block = b * BLOCK..b * BLOCK + acceleration.len();
                    let mut sums = [PairSums::default(); BLOCK];
                    if self.needs.pairs {
                        let chunks = self.neighbors.near();
                        let support = self.support_radii(block.clone());
                        self.packed
                            .forces(chunks, (block.clone(), &support), &mut sums);
                    }
                    for ((i, a), sums) in block.zip(acceleration).zip(&sums) {
                        let changed = change_of(&self.scene, &self.agents, i);
                        *a = self.blend(i).acceleration(&frame, i, sums, changed);
                    }
                });
        });
        self.fields.acceleration = acceleration;
        self.stages = stages;
    }
}
