//! Step 5: moving, stopping at walls, leaving at the goal.

use rayon::prelude::*;

use super::{Arrival, Fault, Simulation, Stage};
use crate::math::{Vector, clamp_length, is_finite};
use crate::neighbors::{BLOCK, TASK};
use crate::scene::{Integrator, Scene};

impl Simulation {
    /// Step 5: moves everybody by one frame and removes who has arrived.
    ///
    /// # Errors
    /// A position, velocity, density or acceleration is not finite: which, of whom, in which frame. Nobody has
    /// been moved then.
    pub fn integrate(&mut self) -> Result<(), Fault> {
        self.evaluate()?;
        let mut stages = std::mem::take(&mut self.stages);
        let moved = stages.time(Stage::Integration, || {
            let fault = if self.finite { None } else { self.find_fault() };
            fault.map_or_else(
                || {
                    self.move_agents();
                    Ok(())
                },
                Err,
            )
        });
        self.stages = stages;
        moved?;
        self.clock.advance();
        self.evaluated = false;
        if !self.fields.density.is_empty() {
            std::mem::swap(&mut self.agents.mean_density, &mut self.fields.mean_density);
            self.agents.newcomer.fill(false);
        }
        if self.needs.removal {
            self.remove_arrivals();
        }
        self.stages.count_frame();
        Ok(())
    }

    fn move_agents(&mut self) {
        let dt = self.clock.time_step();
        let (scene, neighbors) = (&self.scene, &self.neighbors);
        let agents = &mut self.agents;
        let total = (
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
                let motions = positions.iter_mut().zip(velocities);
                let motions = motions.zip(accelerations).zip(sorted_at);
                for (k, (((position, velocity), &acceleration), start)) in motions.enumerate() {
                    let walls = walled.next_if(|&(i, _)| i == from + k);
                    let walls = walls.map_or(&[][..], |(_, walls)| walls);
                    moves.make(scene, walls, dt, position, velocity, acceleration);
                    moves.farthest = moves.farthest.max((*position - start).norm_squared());
                }
                moves
            })
            .reduce(Moves::default, Moves::and);
        self.outcome.contained_moves += total.contained;
        self.outcome.clamped_speeds += total.clamped;
        self.neighbors.travelled(total.farthest.sqrt());
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
        let time = self.clock.time();
        let agents = &self.agents;
        let mut staying: Vec<u32> = Vec::new();
        let mut arrivals = Vec::new();
        for i in 0..agents.len() {
            let group = &self.scene.groups[usize::from(agents.group[i])];
            let distance = (agents.goal[i] - agents.position[i]).norm();
            if group
                .removal_radius
                .is_some_and(|radius| distance <= radius)
            {
                arrivals.push(Arrival {
                    id: agents.id[i],
                    time,
                    position: agents.position[i],
                    counted: group.counted,
                });
            } else {
                staying.push(i as u32);
            }
        }
        if !arrivals.is_empty() {
            arrivals.sort_by_key(|arrival| arrival.id);
            self.outcome.arrivals.append(&mut arrivals);
            self.agents.arrange(&staying);
            self.crowd_changed = true;
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
    /// The squared distance from where they were sorted, of who is farthest from there, metres².
    farthest: f64,
}

impl Moves {
    /// Moves one agent by one frame of `dt` seconds.
    #[inline]
    fn make(
        &mut self,
        scene: &Scene,
        walls: &[u32],
        dt: f64,
        position: &mut Vector,
        velocity: &mut Vector,
        acceleration: Vector,
    ) {
        let (before, start) = (*velocity, *position);
        let wish = before + acceleration * dt;
        *velocity = clamp_length(wish, scene.max_speed);
        self.clamped += u64::from(*velocity != wish);
        let step = match scene.integrator {
            Integrator::SemiImplicit => *velocity,
            // A velocity that an agent enters with may be too fast.
            Integrator::ForwardEuler => clamp_length(before, scene.max_speed),
        };
        let target = start + step * dt;
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
