//! Steps 1–4: from the state to the accelerations, without moving agents.
//!
//! Plain form: `evaluate`, `terms` and `held_avoidance` in `examples/paper.rs`.

use rayon::prelude::*;

use super::{Fault, Fixed, Simulation, Stage};
use crate::density;
use crate::forces::goal;
use crate::forces::model::Gives;
use crate::forces::near::{self, PairCoefficients};
use crate::forces::rvo::{Preference, Scratch};
use crate::forces::walking::{Decided, Deciders, WalkingLaw, some_meet};
use crate::frame::Frame;
use crate::math::{Vector, are_finite, clamp_length, direction};
use crate::neighbors::{BLOCK, ListPolicy, TASK};
use crate::pairs::{dispatch, each, level};
use crate::scene::Group;

impl Simulation {
    /// Runs `work` on a thread of the thread pool, unless the crowd is too small for a second thread. Started from
    /// another thread, every parallel loop would wait until the pool wakes up.
    pub(super) fn on_pool<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> T + Send) -> T {
        // Loops run in parallel if they have at least two tasks. Choices of velocity take long: these run in parallel
        // from two agents on.
        let alone = self.crowd.agents.len().div_ceil(BLOCK) < 2 * self.fixed.task();
        if alone || rayon::current_thread_index().is_some() {
            return work(self);
        }
        rayon::scope(|_| work(self))
    }

    /// Step 1.
    pub(super) fn update_neighbors(&mut self) {
        self.begin_states();
        let stale = match self.fixed.scene.neighbor_lists {
            ListPolicy::Complete => self.derived.neighbors.are_stale(),
            ListPolicy::Coarse => self.crowd.decides(),
        };
        // On levels, people elsewhere must not decide when others are sorted, and with it the order of their sums.
        let on_levels = self.fixed.scene.levels.is_some();
        if self.crowd.changed || stale || self.has_left_period() || on_levels {
            self.sort_agents();
        }
        let needs = &self.fixed.needs;
        let reads_lists = needs.pairs.any() || needs.social || needs.walking || needs.reach > 0.0;
        if !(reads_lists || self.density_is_due()) {
            return;
        }
        let (fixed, agents, derived) = (&self.fixed, &self.crowd.agents, &mut self.derived);
        let (neighbors, packed) = (&mut derived.neighbors, &mut derived.packed);
        if neighbors.near().is_empty() || packed.is_empty() {
            self.stages.time(Stage::Neighbors, || {
                neighbors.list_agents();
                packed.take_bodies(agents, neighbors.extent(), neighbors.way(), |i| {
                    fixed.blend(agents, i).reach()
                });
            });
        }
    }

    /// Whether an agent has left the period. Then the agents are sorted in this frame, so that observers see all agents
    /// inside.
    fn has_left_period(&self) -> bool {
        let positions = self.crowd.agents.position.par_iter();
        self.fixed.scene.period.is_some_and(|period| {
            let positions = positions.with_min_len(TASK * BLOCK);
            positions.any(|&position| !period.contains(position))
        })
    }

    /// Sorts the agents into cells, and lists the walls near them. Agents that have left the period reenter at its
    /// other end, and those that have walked across a join are moved to the next level.
    pub(super) fn sort_agents(&mut self) {
        let (fixed, crowd, derived) = (&self.fixed, &mut self.crowd, &mut self.derived);
        if let Some(period) = &fixed.scene.period {
            crowd.agents.wrap(period);
        }
        if let Some(levels) = &fixed.scene.levels {
            crowd.agents.change_levels(levels);
        }
        let ranges = fixed.scene.ranges(&fixed.needs, &crowd.agents);
        let neighbors = &mut derived.neighbors;
        self.stages
            .time(Stage::Sort, || neighbors.sort(&mut crowd.agents, ranges));
        self.stages.time(Stage::Neighbors, || {
            neighbors.list_walls(&crowd.agents, &fixed.scene.walls);
        });
        derived.packed.clear();
        derived.fields.forget_walls();
        crowd.changed = false;
    }

    /// Packs the positions and velocities that the sums over pairs read.
    pub(super) fn pack(&mut self) {
        let (agents, packed) = (&self.crowd.agents, &mut self.derived.packed);
        // Without sums over pairs nothing is packed.
        if !packed.is_empty() {
            self.stages
                .time(Stage::Packing, || packed.take_motions(agents));
        }
    }

    /// Step 1B, `dt` seconds after the moving average was last stored.
    pub(super) fn update_density_and_pressure(&mut self, dt: f64) {
        let due = self.density_is_due();
        let (scene, crowd, derived) = (&self.fixed.scene, &mut self.crowd, &mut self.derived);
        let fields = &mut derived.fields;
        if !due {
            if !fields.density.is_empty() {
                crowd.agents.newcomer.fill(true); // ρ̂ restarts when the density is requested again
            }
            fields.resize_sph(0); // stale values must not be read
            return;
        }
        fields.resize_sph(crowd.agents.len());
        let input = density::Input {
            agents: &crowd.agents,
            neighbors: &derived.neighbors,
            walls: (&scene.walls, scene.wall_method),
            parameters: |group: u16| &scene.groups[usize::from(group)].blend.sph,
            time_step: dt,
            task: self.fixed.task_of_blocks(),
        };
        self.stages.time(Stage::DensityAndPressure, || {
            each!(&mut derived.packed, columns => input.update(columns, fields));
        });
    }

    /// Finds the next points on the routes around walls: for all agents if `is_time`, otherwise for those without one.
    pub(super) fn follow_routes(&mut self, is_time: bool) {
        let (scene, agents) = (&self.fixed.scene, &mut self.crowd.agents);
        if let Some(routes) = &scene.routes {
            self.stages
                .time(Stage::Routes, || agents.follow(routes, is_time, scene.seed));
        }
    }

    /// Step 2.
    pub(super) fn update_preferred_velocity(&mut self) {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let preferred = &mut self.derived.fields.preferred_velocity;
        preferred.resize(crowd.agents.len(), Vector::zeros());
        self.stages.time(Stage::PreferredVelocity, || {
            let agents = &crowd.agents;
            // Agents walk to the next point of their way; without routes, straight to their goal.
            let aims = match scene.routes {
                Some(_) => &agents.aim,
                None => &agents.goal,
            };
            let needs = &self.fixed.needs;
            let is_flat = scene.levels.is_none();
            let alike = !needs.paces && !needs.directions && is_flat && agents.walk_alike();
            if alike && agents.trip.is_empty() {
                let speed = scene.preferred_speed;
                return straight_at(speed, &agents.position, aims, preferred);
            }
            let time = crowd.clock.time();
            let wishes = preferred.par_iter_mut().with_min_len(TASK * BLOCK);
            wishes.enumerate().for_each(|(i, wish)| {
                let position = agents.position[i];
                let pace = scene.pace(agents, i, time);
                let levels = scene.levels.as_ref();
                let carried = levels.map_or(Vector::zeros(), |levels| levels.carries(position));
                let trip = agents.trip.get(i).and_then(Option::as_ref);
                if let Some(place) = trip.and_then(|trip| trip.hold) {
                    *wish = clamp_length((place - position) / ARRIVAL_TIME, pace) + carried;
                    return;
                }
                let heading = scene.groups[usize::from(agents.group[i])].direction;
                let heading = heading.unwrap_or_else(|| direction(aims[i] - position));
                let slope = levels.map_or(1.0, |levels| levels.speed_factor(position, heading));
                *wish = heading * (pace * slope) + carried;
            });
        });
    }

    /// Step 2, a model of one's own: asks it for all agents, or, if it is not its time, only for those that entered
    /// since. Velocities that it gives take the place of those toward goals.
    pub(super) fn follow_model(&mut self) -> Result<(), Fault> {
        let Some(own) = &self.fixed.scene.model else {
            return Ok(());
        };
        let is_time = !own.coarse || self.crowd.decides();
        let crowd = &mut self.crowd;
        crowd.agents.own.resize(crowd.agents.len(), None);
        if is_time || crowd.agents.own.contains(&None) {
            let frame = self.derived.frame(&self.fixed, crowd);
            let model = &own.model;
            let all = self.stages.time(Stage::OwnModel, || model.vectors(&frame));
            let fault = |message: String| Fault::Model {
                name: model.name().to_owned(),
                message,
            };
            let all = all.map_err(fault)?;
            if all.len() != crowd.agents.len() {
                let (given, wanted) = (all.len(), crowd.agents.len());
                return Err(fault(format!("{given} vectors for {wanted} agents")));
            }
            if let Some(i) = all.iter().position(|v| !are_finite(&[*v])) {
                let id = crowd.agents.id[i];
                let message = format!("({}, {}) for agent {id} is not finite", all[i].x, all[i].y);
                return Err(fault(message));
            }
            for (held, new) in crowd.agents.own.iter_mut().zip(all) {
                if is_time || held.is_none() {
                    *held = Some(new);
                }
            }
        }
        if own.gives == Gives::Velocities {
            let wanted = &mut self.derived.fields.preferred_velocity;
            for (wanted, held) in wanted.iter_mut().zip(&crowd.agents.own) {
                *wanted = held.unwrap_or_default();
            }
        }
        Ok(())
    }

    /// Step 3, walking laws: sets the speeds that agents may walk at, in coarse frames for all agents and in other
    /// frames for those that entered since.
    pub(super) fn update_walking_laws(&mut self) {
        if !self.fixed.needs.walking {
            return;
        }
        let (fixed, crowd) = (&self.fixed, &mut self.crowd);
        let count = crowd.agents.len();
        crowd.agents.allowed_speed.resize(count, None);
        if crowd.decides() {
            crowd.agents.allowed_speed.fill(None);
        }
        if !crowd.agents.allowed_speed.contains(&None) {
            return;
        }
        if fixed.needs.headings {
            crowd.agents.heading.resize(count, 0);
        }
        let (derived, allowed) = (&mut self.derived, &mut self.buffers.allowed_speed);
        let heading = &mut self.buffers.heading;
        allowed.clone_from(&crowd.agents.allowed_speed);
        heading.clone_from(&crowd.agents.heading);
        heading.resize(count, 0);
        self.stages.time(Stage::WalkingLaws, || {
            let wishes = &derived.fields.preferred_velocity;
            derived.packed.take_headings(wishes);
            let meets = fixed.needs.headings && some_meet(wishes);
            let laws: Vec<Followers> = fixed.followers(meets).collect();
            let frame = derived.frame(fixed, crowd);
            let blocks = allowed
                .par_chunks_mut(BLOCK)
                .zip(heading.par_chunks_mut(BLOCK));
            let blocks = blocks.with_min_len(fixed.task_of_blocks()).enumerate();
            blocks.for_each(|(b, (allowed, heading))| {
                for followers in &laws {
                    let due = fixed.due(&frame, b, followers, allowed);
                    let (allowed, heading) = (&mut *allowed, &mut *heading);
                    followers
                        .law
                        .decide(&frame, b, &due, Decided { allowed, heading });
                }
                for (allowed, heading) in allowed.iter_mut().zip(heading) {
                    if allowed.is_none() {
                        // No law, or an escalator, whose steps carry agents into whatever is ahead.
                        (*allowed, *heading) = (Some(f64::INFINITY), 0);
                    }
                }
            });
        });
        std::mem::swap(&mut self.crowd.agents.allowed_speed, allowed);
        if self.fixed.needs.headings {
            std::mem::swap(&mut self.crowd.agents.heading, heading);
        }
    }

    /// Step 3, RVO: chooses new accelerations in coarse frames, and in any frame for agents that hold none.
    pub(super) fn update_rvo(&mut self) {
        if !self.fixed.needs.rvo {
            return;
        }
        let count = self.crowd.agents.len();
        self.crowd.agents.avoidance.resize(count, None);
        let (fixed, is_time) = (&self.fixed, self.crowd.decides());
        let frame = self.derived.frame(fixed, &self.crowd);
        let (agents, chosen) = (frame.agents, &mut self.buffers.avoidance);
        chosen.resize(agents.len(), None);
        self.stages.time(Stage::Rvo, || {
            let slots = chosen.par_iter_mut().zip(&agents.avoidance).enumerate();
            let fewest = if is_time { 1 } else { TASK * BLOCK };
            let slots = slots.with_min_len(fewest).with_max_len(BLOCK); // choices differ in cost
            slots.for_each_init(Scratch::default, |scratch, (i, (chosen, &held))| {
                let blend = fixed.blend(agents, i);
                let rvo = blend.rvo().filter(|_| blend.rvo_acts(&frame, i));
                let held = held.filter(|_| !is_time);
                *chosen = rvo.map(|rvo| {
                    held.unwrap_or_else(|| {
                        rvo.acceleration(&frame, i, fixed.wish(&frame, i), scratch)
                    })
                });
            });
        });
        std::mem::swap(&mut self.crowd.agents.avoidance, chosen);
    }

    /// Steps 3, 3B and 4.
    pub(super) fn update_acceleration(&mut self) {
        let (fixed, agents, derived) = (&self.fixed, &self.crowd.agents, &mut self.derived);
        let accelerations = &mut self.buffers.acceleration;
        derived.fields.acceleration.clear(); // stale values must not be read
        derived.finite = self.stages.time(Stage::Acceleration, || {
            accelerations.resize(agents.len(), Vector::zeros());
            let frame = derived.frame(fixed, &self.crowd);
            let task = fixed.task();
            let blocks = accelerations.par_chunks_mut(BLOCK);
            let blocks = blocks.with_min_len(task).with_max_len(2 * task).enumerate();
            let finite = blocks.map(|(b, accelerations)| {
                fixed.accelerate(&frame, b, accelerations);
                block_is_finite(&frame, b, accelerations)
            });
            finite.reduce(|| true, |a, b| a && b)
        });
        self.update_state_rates();
        let fields = &mut self.derived.fields;
        std::mem::swap(&mut fields.acceleration, &mut self.buffers.acceleration);
    }
}

impl Fixed {
    /// The fewest blocks per parallel task: agents on stairs are near walls, which take much of the time.
    fn task_of_blocks(&self) -> usize {
        match self.scene.levels {
            Some(_) => 2,
            None => TASK,
        }
    }

    /// The fewest blocks per parallel task when forces are summed.
    fn task(&self) -> usize {
        match self.needs.avoidance {
            Some(_) => 1, // searching the avoidance radius is enough work for a task
            None => self.task_of_blocks(),
        }
    }

    /// The walking laws of the scene, with the groups that follow them; some agents may `meet` others.
    fn followers(&self, meet: bool) -> impl Iterator<Item = Followers<'_>> {
        self.walking_laws.iter().map(move |law| {
            let groups = self.scene.groups.iter();
            let follows = |group: &Group| group.blend.walking_law() == Some(law);
            Followers {
                law,
                groups: groups.map(follows).collect(),
                meet,
            }
        })
    }

    /// The followers of a walking law in block `b` that have no allowed speed yet.
    fn due(
        &self,
        frame: &Frame,
        b: usize,
        followers: &Followers,
        allowed: &[Option<f64>],
    ) -> Deciders {
        let (mut is_due, mut gap) = ([false; BLOCK], [1.0; BLOCK]);
        let headings = followers.law.headings();
        let levels = self.scene.levels.as_ref().filter(|levels| levels.carry());
        for (k, allowed) in allowed.iter().enumerate() {
            let i = b * BLOCK + k;
            let p = frame.agents.position[i];
            let is_carried = levels.is_some_and(|levels| levels.carries(p) != Vector::zeros());
            let follows = followers.groups[usize::from(frame.agents.group[i])] && !is_carried;
            is_due[k] = allowed.is_none() && follows;
            if let Some(law) = headings.filter(|_| is_due[k]) {
                gap[k] = self.gap(frame, i, (law, followers.meet));
            }
        }
        Deciders {
            is_due,
            gap,
            meets: followers.meet,
        }
    }

    /// The input of RVO for agent `i`.
    fn wish(&self, frame: &Frame, i: usize) -> Preference {
        let free = frame.fields.preferred_velocity[i];
        let law = self.blend(frame.agents, i).law_of_rvo();
        Preference {
            preferred_velocity: match law {
                Some(law) => free + law.lost_velocity(frame, i),
                None => free,
            },
            max_speed: self.scene.max_speed(frame.agents, i),
        }
    }

    /// Computes the accelerations of the agents of block `b`.
    fn accelerate(&self, frame: &Frame, b: usize, acceleration: &mut [Vector]) {
        let from = b * BLOCK;
        let to = from + acceleration.len();
        if self.scene.is_replaced() {
            acceleration.fill(Vector::zeros());
        } else {
            self.accelerate_by_profiles(frame, b, acceleration);
        }
        for force in &self.scene.own_forces {
            force.add_accelerations(frame, from..to, 1.0, acceleration);
        }
    }

    fn accelerate_by_profiles(&self, frame: &Frame, b: usize, acceleration: &mut [Vector]) {
        let from = b * BLOCK;
        let to = from + acceleration.len();
        let mut felt = PairCoefficients::default();
        self.each_span(frame.agents, from..to, |span, blend, changed| {
            blend.add_pair_coefficients(frame, span, changed, &mut felt);
        });
        near::accelerations(frame, b, &felt, self.needs.pairs, acceleration);
        for social in &self.social_forces {
            let mut felt = [0.0; BLOCK];
            self.each_span(frame.agents, from..to, |span, blend, _| {
                blend.add_social_coefficients(frame, span, social, &mut felt);
            });
            social.add_from_agents(frame, b, &felt, acceleration);
        }
        self.each_span(frame.agents, from..to, |span, blend, changed| {
            let acceleration = &mut acceleration[span.start - from..span.end - from];
            blend.add_accelerations(frame, span, changed, acceleration);
        });
    }
}

/// The agents that follow a walking law.
struct Followers<'a> {
    law: &'a WalkingLaw,
    /// Whether it is the law of each group.
    groups: Vec<bool>,
    /// Whether some of all agents may want to walk against others.
    meet: bool,
}

/// Agents slow down this many seconds before they reach the spot where they wait.
const ARRIVAL_TIME: f64 = 1.0;

/// The preferred velocities of agents that walk straight toward their `aims` at the same `speed`, m/s.
fn straight_at(speed: f64, positions: &[Vector], aims: &[Vector], preferred: &mut [Vector]) {
    let blocks = (
        preferred.par_chunks_mut(BLOCK),
        positions.par_chunks(BLOCK),
        aims.par_chunks(BLOCK),
    );
    let blocks = blocks.into_par_iter().with_min_len(TASK);
    blocks.for_each(|(preferred, positions, aims)| {
        dispatch!(level(), _simd => walk_straight(speed, (positions, aims), preferred));
    });
}

#[inline(always)]
fn walk_straight(speed: f64, (positions, aims): (&[Vector], &[Vector]), preferred: &mut [Vector]) {
    for ((v, &r), &g) in preferred.iter_mut().zip(positions).zip(aims) {
        *v = goal::preferred_velocity(r, g, speed);
    }
}

fn block_is_finite(frame: &Frame, b: usize, acceleration: &[Vector]) -> bool {
    let block = b * BLOCK..b * BLOCK + acceleration.len();
    let density = frame.fields.density.get(block.clone()).unwrap_or(&[]);
    let (position, velocity) = (&frame.agents.position, &frame.agents.velocity);
    let vectors = [acceleration, &position[block.clone()], &velocity[block]];
    vectors.into_iter().all(are_finite) && are_finite(density)
}
