//! Step 5: moving, stopping at walls, leaving at the goal.

use rayon::prelude::*;

use super::{Arrival, Fault, Simulation, Stage};
use crate::engine::math::{Vector, clamp_length, is_finite};
use crate::engine::neighbors::{BLOCK, TASK};
use crate::engine::scene::{Integrator, Scene};

impl Simulation {
    /// Step 5: moves everybody by one frame and removes who has arrived.
    ///
    /// # Errors
    /// A position, velocity, density or acceleration is not finite: which, of whom, in which frame. Nobody has
    /// been moved then.
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

    /// The velocity of the frame was predicted with the acceleration of the frame before; what is better
    /// known now is mended first.
    fn move_by_verlet(&mut self) {
        self.keep_mean_density();
        let dt = self.clock.time_step();
        let mut before = std::mem::take(&mut self.agents.acceleration_before);
        before.resize(self.agents.len(), None); // for who entered since
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

    /// The moving average of the evaluated frame becomes that of the frame before.
    fn keep_mean_density(&mut self) {
        if !self.fields.density.is_empty() {
            std::mem::swap(&mut self.agents.mean_density, &mut self.fields.mean_density);
            self.agents.newcomer.fill(false);
        }
    }

    /// Moves everybody by a whole frame and counts what walls and the highest speed have changed.
    fn move_all(&mut self, motion: impl Fn(usize, Vector, Vector) -> Motion + Sync) {
        let moves = self.move_agents(self.clock.time_step(), motion);
        self.outcome.contained_moves += moves.contained;
        self.outcome.clamped_speeds += moves.clamped;
    }

    /// Moves everybody by `dt` seconds, each as `motion` says of its index, velocity and acceleration.
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

    /// The first quantity that is no number, and whose it is.
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
        // Causes before effects: a position that is no number makes all forces on it so, or none.
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
        // Hardly any frame has an arrival: nothing is allocated in the others.
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

/// How somebody moves; both are cut to the highest speed.
struct Motion {
    /// The velocity of the move, m/s.
    way: Vector,
    /// The velocity after it, m/s.
    velocity: Vector,
}

impl Motion {
    /// With one velocity.
    fn along(velocity: Vector) -> Self {
        Self {
            way: velocity,
            velocity,
        }
    }
}

/// What happened in the moves of some agents.
#[derive(Default)]
struct Moves {
    /// How many ended at a wall.
    contained: u64,
    /// How many were too fast.
    clamped: u64,
    /// The squared distance from where they were sorted, of who is farthest from there, meters².
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
