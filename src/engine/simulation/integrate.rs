//! Step 5: moves agents, stops them at walls, and removes those that reach their goal.
//!
//! Plain form: `integrate` in `examples/paper.rs`.

use rayon::prelude::*;

use super::{Arrival, Crowd, Fault, Simulation, Stage};
use crate::geometry::Walls;
use crate::math::{Vector, clamp_length, greatest, is_finite};
use crate::neighbors::{BLOCK, STRIP, Shifts, TASK};
use crate::pairs::{dispatch, level};
use crate::scene::{Integrator, Scene};

impl Simulation {
    /// Step 5: moves all agents by one frame and removes those that have reached their goal.
    ///
    /// # Errors
    /// A position, velocity, density or acceleration is not finite; the fault names the quantity, the agent and the
    /// frame. Then no agent moves.
    pub fn integrate(&mut self) -> Result<(), Fault> {
        self.on_pool(Self::advance)
    }

    fn advance(&mut self) -> Result<(), Fault> {
        self.evaluate()?;
        self.check()?;
        let dt = self.crowd.clock.time_step();
        self.keep_positions();
        match self.fixed.scene.integrator {
            Integrator::SemiImplicit => {
                self.keep_mean_density();
                self.move_both(|_, v, a| Motion {
                    way: v + a * dt,
                    velocity: v + a * dt,
                });
            }
            Integrator::ForwardEuler => {
                self.keep_mean_density();
                self.move_both(|_, v, a| Motion {
                    way: v,
                    velocity: v + a * dt,
                });
            }
            Integrator::VelocityVerlet => self.move_by_verlet(dt),
            Integrator::Midpoint => self.move_by_midpoint(dt)?,
        }
        self.crowd.clock.advance();
        self.crowd.decided = false;
        self.derived.evaluated = false;
        self.pass_lines();
        if self.fixed.needs.removal {
            let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
            self.stages
                .time(Stage::Removal, || crowd.remove_arrivals(scene));
        }
        self.stages.count_frame();
        Ok(())
    }

    /// Stores the moving averages of the evaluated frame for the next one.
    pub(super) fn keep_mean_density(&mut self) {
        let (agents, fields) = (&mut self.crowd.agents, &mut self.derived.fields);
        if !fields.density.is_empty() {
            std::mem::swap(&mut agents.mean_density, &mut fields.mean_density);
            agents.newcomer.fill(false);
        }
    }

    /// Moves agents, then the states that forces keep for them, by a whole frame.
    pub(super) fn move_both(
        &mut self,
        motion: impl Fn(usize, Vector, Vector) -> Motion + Sync + Copy,
    ) {
        self.move_all(motion);
        self.advance_states(self.crowd.clock.time_step());
    }

    /// Moves all agents by a whole frame; counts the moves of those that are present, those stopped by walls, and
    /// clamped speeds.
    pub(super) fn move_all(&mut self, motion: impl Fn(usize, Vector, Vector) -> Motion + Sync) {
        let moves = self.move_agents(self.crowd.clock.time_step(), motion);
        let (agents, outcome) = (&self.crowd.agents, &mut self.crowd.outcome);
        outcome.moves += agents.count_present() as u64;
        let present = |(agent, start): (usize, Vector)| agents.is_present(agent).then_some(start);
        for start in moves.contained.into_iter().filter_map(present) {
            outcome.contained.add(start);
        }
        for start in moves.clamped.into_iter().filter_map(present) {
            outcome.clamped.add(start);
        }
    }

    /// Moves all agents by `dt` seconds. `motion_of` maps index, velocity and acceleration to the motion of an agent.
    pub(super) fn move_agents(
        &mut self,
        dt: f64,
        motion_of: impl Fn(usize, Vector, Vector) -> Motion + Sync,
    ) -> Moves {
        let (scene, agents) = (&self.fixed.scene, &mut self.crowd.agents);
        let (walls, max_speeds) = (&scene.walls, &agents.max_speed);
        let mut strips = self.derived.neighbors.take_strips();
        let neighbors = &self.derived.neighbors;
        let blocks = (
            agents.position.par_chunks_mut(BLOCK),
            agents.velocity.par_chunks_mut(BLOCK),
            self.derived.fields.acceleration.par_chunks(BLOCK),
            neighbors.sorted_at().par_chunks(BLOCK),
            strips.par_chunks_mut(BLOCK / STRIP),
        );
        let moves = self.stages.time(Stage::Integration, || {
            let blocks = blocks.into_par_iter().with_min_len(TASK).enumerate();
            let moved = blocks.map(|(b, block)| {
                let (positions, velocities, accelerations, sorted_at, strips) = block;
                let from = b * BLOCK;
                let walled = neighbors.agents_near_walls(from..from + positions.len());
                let mut walled = walled.peekable();
                let states = (&mut *positions, &mut *velocities);
                let motion = |k: usize, v: Vector, a: Vector| motion_of(from + k, v, a);
                let mut motions = [Motion::default(); BLOCK];
                let motions = &mut motions[..accelerations.len()];
                let mut moves = Moves::default();
                let may_be_free = max_speeds.is_empty() && walled.peek().is_none();
                let is_free = dispatch!(level(), _simd => {
                    find_motions(motion, states.1, accelerations, motions);
                    may_be_free && move_freely(scene.max_speed, dt, motions, states)
                });
                if !is_free {
                    let states = positions.iter_mut().zip(velocities).enumerate();
                    for ((k, (position, velocity)), motion) in states.zip(motions) {
                        let near = walled.next_if(|&(i, _)| i == from + k);
                        let near = near.map_or(&[][..], |(_, near)| near);
                        let most = max_speeds.get(from + k).copied();
                        let limits = Limits {
                            agent: from + k,
                            speed: most.unwrap_or(scene.max_speed),
                            walls,
                            near,
                        };
                        moves.make(&limits, dt, *motion, position, velocity);
                    }
                }
                moves.farthest = dispatch!(level(), _simd => {
                    if neighbors.follow() {
                        shift(positions, sorted_at, strips);
                    }
                    farthest(positions, sorted_at)
                });
                moves
            });
            moved.reduce(Moves::default, Moves::and)
        });
        self.derived.neighbors.moved(moves.farthest.sqrt(), strips);
        moves
    }

    pub(super) fn check(&self) -> Result<(), Fault> {
        if self.derived.finite {
            return Ok(());
        }
        self.find_fault().map_or(Ok(()), Err)
    }

    /// The first quantity that is not finite, and its agent.
    fn find_fault(&self) -> Option<Fault> {
        let (crowd, fields) = (&self.crowd, &self.derived.fields);
        let agents = &crowd.agents;
        let fault = |i: usize, quantity| Fault::NotFinite {
            frame: crowd.clock.frame(),
            time: crowd.clock.time(),
            agent: agents.id[i],
            position: agents.position[i],
            quantity,
        };
        let not_finite = |values: &[Vector]| values.iter().position(|&v| !is_finite(v));
        let state = || {
            let rates = fields.state_rates.iter().zip(&agents.states);
            let mut wrong = rates.filter_map(|(rates, states)| {
                let first = rates.iter().position(|rate| !rate.is_finite());
                Some(first? / states.width())
            });
            wrong.next()
        };
        let density = || fields.density.iter().position(|d| !d.is_finite());
        // Causes before effects: a non-finite position can make all forces on its agent non-finite.
        None.or_else(|| Some((not_finite(&agents.position)?, "position")))
            .or_else(|| Some((not_finite(&agents.velocity)?, "velocity")))
            .or_else(|| Some((state()?, "state that a force keeps")))
            .or_else(|| Some((density()?, "density")))
            .or_else(|| Some((not_finite(&fields.acceleration)?, "acceleration")))
            .map(|(i, quantity)| fault(i, quantity))
    }
}

impl Crowd {
    fn remove_arrivals(&mut self, scene: &Scene) {
        let agents = &mut self.agents;
        let group = |i: usize| &scene.groups[usize::from(agents.group[i])];
        let walks_on = |i: usize| {
            let trip = agents.trip.get(i).and_then(Option::as_ref);
            trip.is_some_and(|trip| trip.is_outside() || trip.place_ahead().is_some())
        };
        let has_arrived = |i: usize| {
            let squared = (agents.goal[i] - agents.position[i]).norm_squared();
            // Most agents are far from their goal: skip them without a square root.
            let radius = group(i).removal_radius;
            radius.is_some_and(|radius| {
                squared <= radius * radius * (1.0 + ROUNDING)
                    && squared.sqrt() <= radius
                    && !walks_on(i)
            })
        };
        let all = (0..agents.len()).into_par_iter();
        let arrived = all.with_min_len(TASK * BLOCK);
        let arrived: Vec<usize> = arrived.filter(|&i| has_arrived(i)).collect();
        if arrived.is_empty() {
            return;
        }
        let mut staying: Vec<u32> = Vec::with_capacity(agents.len());
        let starts = std::iter::once(0).chain(arrived.iter().map(|i| i + 1));
        let ends = arrived.iter().copied().chain([agents.len()]);
        for (start, end) in starts.zip(ends) {
            staying.extend(start as u32..end as u32);
        }
        let arrivals = arrived.into_iter().map(|i| Arrival {
            id: agents.id[i],
            time: self.clock.time(),
            position: agents.position[i],
            counted: group(i).counted,
            trip: None,
        });
        let first = self.outcome.arrivals.len();
        self.outcome.arrivals.extend(arrivals);
        self.outcome.arrivals[first..].sort_by_key(|arrival| arrival.id);
        agents.arrange(&staying);
        self.changed = true;
    }
}

/// An upper bound of the relative rounding errors of squared distances.
const ROUNDING: f64 = 1e-12;

/// The motion of an agent. Both velocities are clamped to s_max.
#[derive(Clone, Copy, Default)]
pub(super) struct Motion {
    /// The velocity during the move, m/s.
    pub(super) way: Vector,
    /// The velocity after it, m/s.
    pub(super) velocity: Vector,
}

impl Motion {
    /// Whether neither velocity is above `limit`, m/s.
    fn is_within(&self, limit: f64) -> bool {
        let is_within = |v: Vector| v.norm_squared() <= limit * limit;
        is_within(self.way) & is_within(self.velocity)
    }
}

/// The motions of the agents of a block.
#[inline(always)]
fn find_motions(
    motion_of: impl Fn(usize, Vector, Vector) -> Motion,
    velocities: &[Vector],
    accelerations: &[Vector],
    motions: &mut [Motion],
) {
    let states = velocities.iter().zip(accelerations).enumerate();
    for (motion, (k, (&v, &a))) in motions.iter_mut().zip(states) {
        *motion = motion_of(k, v, a);
    }
}

/// Moves agents by `dt` seconds if none is faster than `limit`, m/s; else returns `false` and moves none.
#[inline(always)]
fn move_freely(
    limit: f64,
    dt: f64,
    motions: &[Motion],
    (positions, velocities): (&mut [Vector], &mut [Vector]),
) -> bool {
    // Counting is branchless.
    let too_fast = motions.iter().map(|motion| !motion.is_within(limit));
    if too_fast.map(u64::from).sum::<u64>() > 0 {
        return false;
    }
    let states = positions.iter_mut().zip(velocities);
    for ((position, velocity), motion) in states.zip(motions) {
        *velocity = motion.velocity;
        *position += motion.way * dt;
    }
    true
}

/// The largest squared distance between two positions of an agent of a block, m².
#[inline(always)]
fn farthest(positions: &[Vector], before: &[Vector]) -> f64 {
    let mut squares = [0.0; BLOCK];
    let pairs = positions.iter().zip(before);
    for (square, (position, start)) in squares.iter_mut().zip(pairs) {
        *square = (position - start).norm_squared();
    }
    greatest(&squares, |&square| square)
}

/// Finds the shifts of the agents of a block since the sort, strip by strip.
#[inline(always)]
pub(super) fn shift(positions: &[Vector], sorted_at: &[Vector], strips: &mut [Shifts]) {
    let agents = positions.chunks(STRIP).zip(sorted_at.chunks(STRIP));
    for (strip, (positions, sorted_at)) in strips.iter_mut().zip(agents) {
        *strip = Shifts::of(positions, sorted_at);
    }
}

/// The limits of a move.
struct Limits<'a> {
    /// The index of the agent.
    agent: usize,
    /// s_max, m/s.
    speed: f64,
    walls: &'a Walls,
    /// The walls that may be in reach.
    near: &'a [u32],
}

/// Statistics of moves.
#[derive(Default)]
pub(super) struct Moves {
    /// The agents whose moves were stopped at a wall, with the starting points, meters.
    contained: Vec<(usize, Vector)>,
    /// The agents whose speed was clamped after the move, with the starting points, meters.
    clamped: Vec<(usize, Vector)>,
    /// Largest squared distance of any agent from its position at the last sort, m².
    farthest: f64,
}

impl Moves {
    /// Moves one agent by `dt` seconds.
    #[inline]
    fn make(
        &mut self,
        limits: &Limits,
        dt: f64,
        motion: Motion,
        position: &mut Vector,
        velocity: &mut Vector,
    ) {
        let start = *position;
        *velocity = clamp_length(motion.velocity, limits.speed);
        if *velocity != motion.velocity {
            self.clamped.push((limits.agent, start));
        }
        let target = start + clamp_length(motion.way, limits.speed) * dt;
        if limits.near.is_empty() {
            *position = target;
            return;
        }
        let stopped = limits.walls.stop(start, target, limits.near);
        *position = stopped.map_or(target, |(point, _)| point);
        if let Some((_, wall)) = stopped {
            let normal = limits.walls.wall(wall).normal;
            *velocity -= normal * velocity.dot(&normal).min(0.0);
            self.contained.push((limits.agent, start));
        }
    }

    fn and(mut self, mut other: Self) -> Self {
        self.contained.append(&mut other.contained);
        self.clamped.append(&mut other.clamped);
        self.farthest = self.farthest.max(other.farthest);
        self
    }
}
