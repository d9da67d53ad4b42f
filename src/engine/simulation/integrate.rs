//! Step 5: moves agents, stops them at walls, and removes those that reach their goal.

use rayon::prelude::*;

use super::{Arrival, Fault, Simulation, Stage};
use crate::engine::math::{Vector, clamp_length, is_finite};
use crate::engine::neighbors::{BLOCK, TASK};
use crate::engine::scene::{Integrator, Scene};

impl Simulation {
    /// Step 5: moves all agents by one frame and removes those that have reached their goal.
    ///
    /// # Errors
    /// A position, velocity, density or acceleration is not finite; the fault tells which, of which agent and in
    /// which frame. No agent has moved then.
    pub fn integrate(&mut self) -> Result<(), Fault> {
        self.evaluate()?;
        self.check()?;
        match self.scene.integrator {
            Integrator::SemiImplicit => self.move_semi_implicitly(),
            Integrator::ForwardEuler => self.move_with_old_velocities(),
            Integrator::VelocityVerlet => self.move_by_verlet(),
            Integrator::Midpoint => self.move_by_midpoint()?,
        }
        self.clock.advance();
        self.evaluated = false;
        if self.needs.removal {
            let mut stages = std::mem::take(&mut self.stages);
            stages.time(Stage::Removal, || self.remove_arrivals());
            self.stages = stages;
        }
        self.stages.count_frame();
        Ok(())
    }

    fn move_semi_implicitly(&mut self) {
        self.keep_mean_density();
        let dt = self.clock.time_step();
        self.move_all(|_, v, a| Motion::along(v + a * dt));
    }

    fn move_with_old_velocities(&mut self) {
        self.keep_mean_density();
        let dt = self.clock.time_step();
        self.move_all(|_, v, a| Motion {
            way: v,
            velocity: v + a * dt,
        });
    }

    /// The velocities of the frame were predicted with the accelerations of the previous frame. Corrects them first
    /// with the accelerations of this frame.
    fn move_by_verlet(&mut self) {
        self.keep_mean_density();
        let dt = self.clock.time_step();
        let mut before = std::mem::take(&mut self.agents.acceleration_before);
        before.resize(self.agents.len(), None); // for agents that entered since
        self.move_all(|i, v, a| {
            let v = v + before[i].map_or(Vector::zeros(), |before| (a - before) * (0.5 * dt));
            Motion {
                way: v + a * (0.5 * dt),
                velocity: v + a * dt,
            }
        });
        before.clear();
        before.extend(self.fields.acceleration.iter().copied().map(Some));
        self.agents.acceleration_before = before;
    }

    fn move_by_midpoint(&mut self) -> Result<(), Fault> {
        let dt = self.clock.time_step();
        let begin = self.agents.clone();
        self.keep_mean_density();
        self.move_agents(0.5 * dt, |_, v, a| Motion {
            way: v,
            velocity: v + a * (0.5 * dt),
        });
        self.pack();
        self.update_density_and_pressure(0.5 * dt);
        self.update_preferred_velocity();
        self.update_acceleration();
        self.check()
            .inspect_err(|_| self.agents.clone_from(&begin))?;
        let half_way = std::mem::replace(&mut self.agents.velocity, begin.velocity);
        self.agents.position = begin.position;
        self.move_all(|i, v, a| Motion {
            way: half_way[i],
            velocity: v + a * dt,
        });
        Ok(())
    }

    /// Stores the moving averages of the evaluated frame for the next one.
    fn keep_mean_density(&mut self) {
        if !self.fields.density.is_empty() {
            std::mem::swap(&mut self.agents.mean_density, &mut self.fields.mean_density);
            self.agents.newcomer.fill(false);
        }
    }

    /// Moves all agents by a whole frame; counts moves stopped by walls and clamped speeds.
    fn move_all(&mut self, motion: impl Fn(usize, Vector, Vector) -> Motion + Sync) {
        let moves = self.move_agents(self.clock.time_step(), motion);
        self.outcome.contained_moves += moves.contained;
        self.outcome.clamped_speeds += moves.clamped;
    }

    /// Moves all agents by `dt` seconds. `motion` maps index, velocity and acceleration to the motion of an agent.
    fn move_agents(
        &mut self,
        dt: f64,
        motion: impl Fn(usize, Vector, Vector) -> Motion + Sync,
    ) -> Moves {
        let mut stages = std::mem::take(&mut self.stages);
        let moves = stages.time(Stage::Integration, || self.moved_by(dt, motion));
        self.stages = stages;
        self.neighbors.travelled(moves.farthest.sqrt());
        moves
    }

    fn moved_by(
        &mut self,
        dt: f64,
        motion: impl Fn(usize, Vector, Vector) -> Motion + Sync,
    ) -> Moves {
        let (scene, neighbors) = (&self.scene, &self.neighbors);
        let agents = &mut self.agents;
        (
            agents.position.par_chunks_mut(BLOCK),
            agents.velocity.par_chunks_mut(BLOCK),
            self.fields.acceleration.par_chunks(BLOCK),
            neighbors.sorted_at().par_chunks(BLOCK),
        )
            .into_par_iter()
            .with_min_len(TASK)
            .enumerate()
            .map(|(b, (positions, velocities, accelerations, sorted_at))| {
                let mut moves = Moves::default();
                let from = b * BLOCK;
                let walled = neighbors.agents_near_walls(from..from + positions.len());
                let mut walled = walled.peekable();
                let states = positions.iter_mut().zip(velocities);
                let states = states.zip(accelerations).zip(sorted_at);
                for (k, (((position, velocity), &acceleration), start)) in states.enumerate() {
                    let walls = walled.next_if(|&(i, _)| i == from + k);
                    let walls = walls.map_or(&[][..], |(_, walls)| walls);
                    let motion = motion(from + k, *velocity, acceleration);
                    moves.make(scene, walls, dt, motion, position, velocity);
                    moves.farthest = moves.farthest.max((*position - start).norm_squared());
                }
                moves
            })
            .reduce(Moves::default, Moves::and)
    }

    fn check(&self) -> Result<(), Fault> {
        let fault = if self.finite { None } else { self.find_fault() };
        fault.map_or(Ok(()), Err)
    }

    /// The first quantity that is not finite, and its agent.
    fn find_fault(&self) -> Option<Fault> {
        let (agents, fields) = (&self.agents, &self.fields);
        let fault = |i: usize, quantity| Fault::NotFinite {
            frame: self.clock.frame(),
            time: self.clock.time(),
            agent: agents.id[i],
            position: agents.position[i],
            quantity,
        };
        let not_finite = |values: &[Vector]| values.iter().position(|&v| !is_finite(v));
        let density = || fields.density.iter().position(|d| !d.is_finite());
        // Causes before effects: a position that is not finite can make all forces on its agent not finite.
        None.or_else(|| Some((not_finite(&agents.position)?, "position")))
            .or_else(|| Some((not_finite(&agents.velocity)?, "velocity")))
            .or_else(|| Some((density()?, "density")))
            .or_else(|| Some((not_finite(&fields.acceleration)?, "acceleration")))
            .map(|(i, quantity)| fault(i, quantity))
    }

    fn remove_arrivals(&mut self) {
        let has_arrived = |i: usize| {
            let group = &self.scene.groups[usize::from(self.agents.group[i])];
            let distance = (self.agents.goal[i] - self.agents.position[i]).norm();
            group
                .removal_radius
                .is_some_and(|radius| distance <= radius)
        };
        let agents = (0..self.agents.len()).into_par_iter();
        // Most frames have no arrival: return before anything is allocated.
        if !agents.with_min_len(TASK * BLOCK).any(has_arrived) {
            return;
        }
        let (arrived, staying): (Vec<u32>, Vec<u32>) =
            (0..self.agents.len() as u32).partition(|&i| has_arrived(i as usize));
        let mut arrivals: Vec<Arrival> = arrived
            .into_iter()
            .map(|i| self.arrival(i as usize))
            .collect();
        arrivals.sort_by_key(|arrival| arrival.id);
        self.outcome.arrivals.append(&mut arrivals);
        self.agents.arrange(&staying);
        self.crowd_changed = true;
    }

    fn arrival(&self, i: usize) -> Arrival {
        Arrival {
            id: self.agents.id[i],
            time: self.clock.time(),
            position: self.agents.position[i],
            counted: self.scene.groups[usize::from(self.agents.group[i])].counted,
        }
    }
}

/// The motion of an agent. Both velocities are clamped to s_max.
struct Motion {
    /// The velocity during the move, m/s.
    way: Vector,
    /// The velocity after it, m/s.
    velocity: Vector,
}

impl Motion {
    /// A motion with the same velocity during and after the move.
    fn along(velocity: Vector) -> Self {
        Self {
            way: velocity,
            velocity,
        }
    }
}

/// Statistics of moves.
#[derive(Default)]
struct Moves {
    /// Number of moves stopped at a wall.
    contained: u64,
    /// Number of clamped speeds.
    clamped: u64,
    /// Largest squared distance of any agent from its position at the last sort, m².
    farthest: f64,
}

impl Moves {
    /// Moves one agent by `dt` seconds.
    #[inline]
    fn make(
        &mut self,
        scene: &Scene,
        walls: &[u32],
        dt: f64,
        motion: Motion,
        position: &mut Vector,
        velocity: &mut Vector,
    ) {
        let start = *position;
        *velocity = clamp_length(motion.velocity, scene.max_speed);
        self.clamped += u64::from(*velocity != motion.velocity);
        let target = start + clamp_length(motion.way, scene.max_speed) * dt;
        if walls.is_empty() {
            *position = target;
            return;
        }
        let stopped = scene.walls.stop(start, target, walls);
        *position = stopped.map_or(target, |(point, _)| point);
        if let Some((_, wall)) = stopped {
            let normal = scene.walls.wall(wall).normal;
            *velocity -= normal * velocity.dot(&normal).min(0.0);
            self.contained += 1;
        }
    }

    fn and(self, other: Self) -> Self {
        Self {
            contained: self.contained + other.contained,
            clamped: self.clamped + other.clamped,
            farthest: self.farthest.max(other.farthest),
        }
    }
}
