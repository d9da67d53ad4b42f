//! Steps 1–4: from the state to the accelerations, without moving agents.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::{Simulation, Stage, blend_of, change_of};
use crate::engine::density::SphStates;
use crate::engine::forces::goal;
use crate::engine::forces::rvo::Scratch;
use crate::engine::forces::social::SocialForce;
use crate::engine::frame::{Frame, velocity_range};
use crate::engine::math::{Vector, are_finite, numbers_are_finite};
use crate::engine::neighbors::{BLOCK, CLUSTER, ListPolicy, TASK};
use crate::engine::pairs::{Columns, PairCoefficients, Real, each};
use crate::engine::profile::{Blend, Override};

impl Simulation {
    /// Step 1.
    pub(super) fn update_neighbors(&mut self) {
        let stale = match self.scene.neighbor_lists {
            ListPolicy::Complete => self.neighbors.are_stale(),
            ListPolicy::Coarse => self.clock.is_coarse(),
        };
        if self.crowd_changed || stale {
            self.sort_agents();
            self.list_walls();
        }
        if !(self.needs.pairs.any() || self.needs.social || self.density_is_due()) {
            return;
        }
        let (agents, neighbors, packed) = (&self.agents, &mut self.neighbors, &mut self.packed);
        if neighbors.near().is_empty() || packed.is_empty() {
            self.stages.time(Stage::Neighbors, || {
                neighbors.list_agents();
                packed.take_bodies(agents, neighbors.extent(), |i| {
                    blend_of(&self.scene, agents, i).sph.support_radius
                });
            });
        }
    }

    pub(super) fn sort_agents(&mut self) {
        let ranges = self.scene.ranges(&self.needs);
        let (agents, neighbors) = (&mut self.agents, &mut self.neighbors);
        self.stages
            .time(Stage::Sort, || neighbors.sort(agents, ranges));
        self.packed.clear();
        self.fields.forget_walls();
        self.crowd_changed = false;
    }

    pub(super) fn list_walls(&mut self) {
        let (agents, neighbors) = (&self.agents, &mut self.neighbors);
        self.stages.time(Stage::Neighbors, || {
            neighbors.list_walls(agents, &self.scene.walls);
        });
    }

    /// Packs the positions and velocities that the sums over pairs read.
    pub(super) fn pack(&mut self) {
        if self.packed.is_empty() {
            return; // no sums over pairs
        }
        let (agents, packed) = (&self.agents, &mut self.packed);
        self.stages.time(Stage::Packing, || {
            each!(packed, columns => {
                let states = (
                    columns.motions(),
                    agents.position.par_chunks(BLOCK),
                    agents.velocity.par_chunks(BLOCK),
                );
                states
                    .into_par_iter()
                    .with_min_len(TASK)
                    .for_each(|(mut motion, positions, velocities)| motion.take(positions, velocities));
            });
        });
    }

    /// Step 2.
    pub(super) fn update_preferred_velocity(&mut self) {
        let (agents, speed) = (&self.agents, self.scene.preferred_speed);
        let preferred = &mut self.fields.preferred_velocity;
        preferred.resize(agents.len(), Vector::zeros());
        self.stages.time(Stage::PreferredVelocity, || {
            let blocks = (
                preferred.par_chunks_mut(BLOCK),
                agents.position.par_chunks(BLOCK),
                agents.goal.par_chunks(BLOCK),
            );
            blocks
                .into_par_iter()
                .with_min_len(TASK)
                .for_each(|(preferred, positions, goals)| {
                    for ((v, &r), &g) in preferred.iter_mut().zip(positions).zip(goals) {
                        *v = goal::preferred_velocity(r, g, speed);
                    }
                });
        });
    }

    /// Step 1B, `dt` seconds after the moving average was last stored.
    pub(super) fn update_density_and_pressure(&mut self, dt: f64) {
        let due = self.density_is_due();
        if !due && !self.fields.density.is_empty() {
            self.agents.newcomer.fill(true); // ρ̂ restarts when the density is requested again
        }
        self.fields.resize(self.agents.len(), due);
        if !due {
            return;
        }
        let mut packed = std::mem::take(&mut self.packed);
        each!(&mut packed, columns => self.compress(columns, dt));
        self.packed = packed;
    }

    fn compress<R: Real>(&mut self, columns: &mut Columns<R>, dt: f64) {
        let mut fields = std::mem::take(&mut self.fields);
        let mut stages = std::mem::take(&mut self.stages);
        let frame = self.frozen();
        let walls = self.scene.wall_method;
        stages.time(Stage::DensityAndPressure, || {
            let (bodies, pressures) = columns.pressures();
            let blocks = (
                pressures,
                fields.density.par_chunks_mut(BLOCK),
                fields.density_from_walls.par_chunks_mut(BLOCK),
                fields.mean_density.par_chunks_mut(BLOCK),
                fields.rest_density.par_chunks_mut(BLOCK),
                fields.pressure.par_chunks_mut(BLOCK),
                fields.wall_gradient.par_chunks_mut(BLOCK),
            );
            blocks
                .into_par_iter()
                .with_min_len(TASK)
                .enumerate()
                .for_each(|(b, block)| {
                    let (
                        (volumes, pressures),
                        density,
                        density_from_walls,
                        mean_density,
                        rest_density,
                        pressure,
                        wall_gradient,
                    ) = block;
                    bodies.densities(frame.neighbors.near().block(b), density);
                    let mut states = SphStates {
                        density,
                        density_from_walls,
                        mean_density,
                        rest_density,
                        pressure,
                        wall_gradient,
                    };
                    let from = b * BLOCK;
                    let to = from + states.density.len();
                    let same = self.same_group(from..to).map(|blend| blend.sph);
                    states.update(&frame, dt, from, walls, same, |i| &self.blend(i).sph);
                    let mass = &frame.agents.mass[from..to];
                    for k in 0..mass.len() {
                        volumes[k] = R::of(mass[k] / states.density[k]);
                        pressures[k] = R::of(states.pressure[k]);
                    }
                });
        });
        self.fields = fields;
        self.stages = stages;
    }

    /// Step 3, RVO: chooses new accelerations in coarse frames, and in any frame for agents that hold none.
    pub(super) fn update_rvo(&mut self) {
        if !self.needs.rvo {
            return;
        }
        self.agents.make_room_for_avoidance();
        let mut avoidance = std::mem::take(&mut self.agents.avoidance);
        let mut stages = std::mem::take(&mut self.stages);
        let frame = self.frozen();
        let coarse = self.clock.is_coarse();
        stages.time(Stage::Rvo, || {
            avoidance.par_iter_mut().enumerate().for_each_init(
                Scratch::default,
                |scratch, (i, held)| {
                    let blend = blend_of(&self.scene, &self.agents, i);
                    match blend.rvo().filter(|_| blend.rvo_acts(&frame, i)) {
                        None => *held = None,
                        Some(rvo) if coarse || held.is_none() => {
                            let max_speed = self.scene.max_speed;
                            *held = Some(rvo.acceleration(&frame, i, max_speed, scratch));
                        }
                        Some(_) => {}
                    }
                },
            );
        });
        self.agents.avoidance = avoidance;
        self.stages = stages;
    }

    /// Steps 3, 3B and 4.
    pub(super) fn update_acceleration(&mut self) {
        let mut fields = std::mem::take(&mut self.fields);
        let mut stages = std::mem::take(&mut self.stages);
        let mut acceleration = std::mem::take(&mut fields.acceleration);
        let task = if self.needs.avoidance.is_some() {
            1 // searching the avoidance radius is enough work for a task
        } else {
            TASK
        };
        let finite = AtomicBool::new(true);
        stages.time(Stage::Acceleration, || {
            self.update_velocity_ranges(&mut fields.velocity_ranges);
            let frame = Frame {
                fields: &fields,
                ..self.frozen()
            };
            acceleration
                .par_chunks_mut(BLOCK)
                .with_min_len(task)
                .enumerate()
                .for_each(|(b, acceleration)| {
                    self.accelerate(&frame, b, acceleration);
                    if !self.block_is_finite(&frame, b, acceleration) {
                        finite.store(false, Ordering::Relaxed);
                    }
                });
        });
        self.finite = finite.into_inner();
        fields.acceleration = acceleration;
        self.fields = fields;
        self.stages = stages;
    }

    /// Updates the velocity ranges; leaves them empty if no social force has a tolerance.
    fn update_velocity_ranges(&self, ranges: &mut Vec<[Vector; 2]>) {
        ranges.clear();
        let tolerant = |social: &SocialForce| social.avoidance_tolerance > 0.0;
        if self.social_forces.iter().any(tolerant) {
            let some = self.agents.velocity.par_chunks(CLUSTER);
            let some = some.with_min_len(TASK * BLOCK);
            ranges.par_extend(some.map(|v| velocity_range(v.iter().map(|&v| [v, v]))));
        }
    }

    /// Computes the accelerations of the agents of block `b`.
    fn accelerate(&self, frame: &Frame, b: usize, acceleration: &mut [Vector]) {
        let from = b * BLOCK;
        let to = from + acceleration.len();
        let mut felt = PairCoefficients::default();
        self.each_span(from..to, |span, blend, changed| {
            blend.add_pair_coefficients(frame, span, changed, &mut felt);
        });
        let clusters = frame.neighbors.near().block(b);
        frame
            .packed
            .accelerations(clusters, &felt, frame.wanted, acceleration);
        for social in &self.social_forces {
            let mut felt = [0.0; BLOCK];
            self.each_span(from..to, |span, blend, _| {
                blend.add_social_coefficients(frame, span, social, &mut felt);
            });
            social.add_from_agents(frame, b, &felt, acceleration);
        }
        self.each_span(from..to, |span, blend, changed| {
            let acceleration = &mut acceleration[span.start - from..span.end - from];
            blend.add_accelerations(frame, span, changed, acceleration);
        });
        for force in &self.scene.own_forces {
            for (k, acceleration) in acceleration.iter_mut().enumerate() {
                *acceleration += force.acceleration(frame, from + k);
            }
        }
    }

    fn block_is_finite(&self, frame: &Frame, b: usize, acceleration: &[Vector]) -> bool {
        let agents = b * BLOCK..b * BLOCK + acceleration.len();
        let density = frame.fields.density.get(agents.clone()).unwrap_or(&[]);
        let vectors = [
            acceleration,
            &self.agents.position[agents.clone()],
            &self.agents.velocity[agents],
        ];
        vectors.into_iter().all(are_finite) && numbers_are_finite(density)
    }

    /// The blend of `agents`, if all are in the same group.
    fn same_group(&self, agents: Range<usize>) -> Option<&Blend> {
        let groups = &self.agents.group[agents];
        let first = *groups.first()?;
        let same = groups.iter().all(|&group| group == first);
        same.then(|| &self.scene.groups[usize::from(first)].blend)
    }

    /// Splits a range of agents wherever group or push changes.
    #[inline]
    fn each_span(
        &self,
        agents: Range<usize>,
        mut take: impl FnMut(Range<usize>, &Blend, Option<&Override>),
    ) {
        let behavior = |i: usize| (self.agents.group[i], self.agents.push[i]);
        let mut start = agents.start;
        while start < agents.end {
            let same = |&i: &usize| behavior(i) == behavior(start);
            let end = (start + 1..agents.end)
                .find(|i| !same(i))
                .unwrap_or(agents.end);
            let changed = change_of(&self.scene, &self.agents, start);
            take(start..end, self.blend(start), changed);
            start = end;
        }
    }
}
