//! The states that forces keep for agents: their beginning, their rates of change and their steps.

use std::ops::Range;

use rayon::prelude::*;

use super::{Fault, Fixed, Simulation, Stage};
use crate::agents::{Agents, States};
use crate::forces::own::{Body, Force, Step};
use crate::neighbors::{BLOCK, TASK};

impl Fixed {
    /// The forces on agent `i` in addition to those of the paper.
    pub(super) fn forces(&self, agents: &Agents, i: usize) -> impl Iterator<Item = &dyn Force> {
        let of_profile = self.blend(agents, i).forces();
        of_profile
            .iter()
            .chain(&self.scene.own_forces)
            .map(AsRef::as_ref)
    }

    /// The force of this name on agent `i`.
    fn force(&self, agents: &Agents, i: usize, name: &str) -> Option<&dyn Force> {
        self.forces(agents, i).find(|force| force.name() == name)
    }

    /// Takes the agents among `agents` on which the force of this name acts, with the force.
    fn each_with_force(
        &self,
        agents: &Agents,
        range: Range<usize>,
        name: &str,
        mut take: impl FnMut(Range<usize>, &dyn Force),
    ) {
        self.each_span(agents, range, |span, _, _| {
            if let Some(force) = self.force(agents, span.start, name) {
                take(span, force);
            }
        });
    }

    /// No states yet, of all forces that keep one.
    pub(super) fn no_states(&self) -> Result<Vec<States>, Fault> {
        let keeping = self.scene.keeping_forces();
        for force in self.scene.all_forces() {
            let mut others = keeping.iter().filter(|other| other.name() == force.name());
            if others.any(|other| other.kept() != force.kept()) {
                return Err(Fault::DifferentStates {
                    force: force.name().to_owned(),
                });
            }
        }
        let all = keeping.into_iter().map(|force| {
            let along = force.kept().iter().map(|kept| kept.along);
            States::new(force.name(), along.collect())
        });
        Ok(all.collect())
    }

    /// Fits the states of agent `i` to its body, which was moved back before a line.
    pub(super) fn fit_states(&self, agents: &mut Agents, i: usize) {
        let mut all = std::mem::take(&mut agents.states);
        for states in &mut all {
            let force = self.force(agents, i, &states.force);
            if let (Some(force), Some(state)) = (force, states.of_mut(i)) {
                let walls = &self.scene.walls;
                let reach = [agents.position[i]];
                let near_walls = walls.near_any(&reach, force.reach());
                force.fit(&self.body(agents, i, &near_walls), state);
            }
        }
        agents.states = all;
    }

    fn body<'a>(&'a self, agents: &Agents, i: usize, near_walls: &'a [u32]) -> Body<'a> {
        Body {
            position: agents.position[i],
            velocity: agents.velocity[i],
            walls: &self.scene.walls,
            near_walls,
        }
    }
}

impl Simulation {
    /// Begins the states of agents that entered since.
    pub(super) fn begin_states(&mut self) {
        let (fixed, agents) = (&self.fixed, &mut self.crowd.agents);
        let time = self.crowd.clock.time();
        let mut all = std::mem::take(&mut agents.states);
        for states in &mut all {
            for i in states.extend_to(agents.len()) {
                if let Some(force) = fixed.force(agents, i, &states.force) {
                    force.begin(agents, i, time, states.slot_mut(i));
                }
            }
        }
        agents.states = all;
    }

    /// Steps 3, 3B and 4 for states: their rates of change.
    pub(super) fn update_state_rates(&mut self) {
        let mut all = std::mem::take(&mut self.derived.fields.state_rates);
        let agents = &self.crowd.agents;
        all.resize(agents.states.len(), Vec::new());
        for (rates, states) in all.iter_mut().zip(&agents.states) {
            let width = states.width();
            rates.clear();
            rates.resize(agents.len() * width, 0.0);
            let frame = self.derived.frame(&self.fixed, &self.crowd);
            let fixed = &self.fixed;
            self.stages.time(Stage::Acceleration, || {
                let blocks = rates.par_chunks_mut(width * BLOCK).with_min_len(TASK);
                blocks.enumerate().for_each(|(b, rates)| {
                    let from = b * BLOCK;
                    let range = from..from + rates.len() / width;
                    fixed.each_with_force(agents, range, &states.force, |span, force| {
                        let rates = &mut rates[(span.start - from) * width..];
                        force.changes(&frame, span, states, rates);
                    });
                });
            });
        }
        let are_finite = all.iter().flatten().all(|rate| rate.is_finite());
        self.derived.finite &= are_finite;
        self.derived.fields.state_rates = all;
    }

    /// Moves the states of all agents on by `dt` seconds, after the bodies.
    pub(super) fn advance_states(&mut self, dt: f64) {
        let (fixed, neighbors) = (&self.fixed, &self.derived.neighbors);
        let mut all = std::mem::take(&mut self.crowd.agents.states);
        let agents = &self.crowd.agents;
        for (states, rates) in all.iter_mut().zip(&self.derived.fields.state_rates) {
            let (width, name) = (states.width(), states.force.clone());
            self.stages.time(Stage::Integration, || {
                let blocks = states.values_mut().par_chunks_mut(width * BLOCK);
                let blocks = blocks.zip(rates.par_chunks(width * BLOCK));
                let blocks = blocks.with_min_len(TASK).enumerate();
                blocks.for_each(|(b, (states, rates))| {
                    let from = b * BLOCK;
                    let range = from..from + states.len() / width;
                    fixed.each_with_force(agents, range, &name, |span, force| {
                        let own = (span.start - from) * width..(span.end - from) * width;
                        let states = states[own.clone()].chunks_mut(width);
                        let both = states.zip(rates[own].chunks(width));
                        for (i, (state, rates)) in span.zip(both) {
                            let body = fixed.body(agents, i, neighbors.near_walls(i));
                            let step = Step {
                                time: dt,
                                integrator: fixed.scene.integrator,
                                max_speed: fixed.scene.max_speed(agents, i),
                                body,
                            };
                            force.advance(&step, rates, state);
                            force.fit(&body, state);
                        }
                    });
                });
            });
        }
        self.crowd.agents.states = all;
    }
}
