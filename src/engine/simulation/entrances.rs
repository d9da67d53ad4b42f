//! Agents that come in through entrances: on coarse frames, where there is room.

use rand::Rng;
use rand::distr::Open01;
use serde::{Deserialize, Serialize};

use super::{Crowd, Fault};
use crate::engine::agents::NewAgent;
use crate::engine::entrance::{Entrance, place};
use crate::engine::random::{self, Purpose};
use crate::engine::scene::Scene;

/// Progress at one entrance.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Gate {
    /// Number of agents that have arrived.
    arrived: u32,
    /// The time of the last arrival, seconds.
    last: Option<f64>,
    /// Number of agents that have entered.
    entered: u32,
    /// The largest number of agents that waited, and the first frame in which they did.
    largest: (u32, u64),
}

/// Agents that wait for room at an entrance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Backlog<'a> {
    /// Name of the entrance.
    pub name: &'a str,
    /// How many wait now.
    pub waiting: u32,
    /// The most that have waited at once.
    pub largest: u32,
    /// The first frame with this number.
    pub largest_frame: u64,
}

impl Gate {
    /// Could a run have come to this?
    pub(super) fn is_sound(&self) -> bool {
        self.entered <= self.arrived && self.last.is_none_or(|last| last >= 0.0)
    }

    /// The number of agents that wait for room.
    fn waiting(&self) -> u32 {
        self.arrived.saturating_sub(self.entered)
    }

    /// The time of the next arrival, seconds; `None` if all have arrived.
    fn next(&self, scene: &Scene, k: usize) -> Option<f64> {
        let arrivals = &scene.entrances[k].arrivals;
        arrivals.time(self.arrived, self.last, scene.seed, k as u32)
    }

    /// Will more agents enter?
    pub(super) fn expects_agents(&self, scene: &Scene, k: usize) -> bool {
        self.waiting() > 0 || self.next(scene, k).is_some()
    }

    /// The agents that wait at `entrance`.
    pub(super) fn backlog<'a>(&self, entrance: &'a Entrance) -> Backlog<'a> {
        Backlog {
            name: &entrance.name,
            waiting: self.waiting(),
            largest: self.largest.0,
            largest_frame: self.largest.1,
        }
    }
}

impl Crowd {
    /// Lets agents in through entrance `k` as far as they have arrived and there is room.
    pub(super) fn follow_entrance(&mut self, scene: &Scene, k: usize) -> Result<(), Fault> {
        let frame = self.clock.frame();
        let mut gate = self.schedule.gates[k];
        while let Some(time) = gate.next(scene, k)
            && self.clock.coarse_frame_at(time) <= frame
        {
            gate.arrived += 1;
            gate.last = Some(time);
        }
        let entrance = &scene.entrances[k];
        while gate.waiting() > 0
            && let Some(agent) = self.next_through(scene, entrance)
        {
            self.enter(scene, agent)?;
            gate.entered += 1;
        }
        if gate.waiting() > gate.largest.0 {
            gate.largest = (gate.waiting(), frame);
        }
        self.schedule.gates[k] = gate;
        Ok(())
    }

    /// The next agent to come through an entrance, at a random place with room; `None` if there is no room.
    fn next_through(&self, scene: &Scene, entrance: &Entrance) -> Option<NewAgent> {
        let id = self.agents.entered();
        let traits = &scene.groups[usize::from(entrance.group)].traits;
        let radius = traits.radius_of(scene.seed, id);
        let agents = &self.agents;
        let others = agents.position.iter().zip(&agents.radius);
        let others = others.map(|(&position, &radius)| (position, radius));
        let free = entrance.free(radius, &scene.walls, others);
        let share = random::stream(scene.seed, Purpose::Entry, id, 0).sample(Open01);
        let along = place(&free, share)?;
        Some(NewAgent {
            radius: Some(radius),
            ..NewAgent::at(entrance.at(along), entrance.goal, entrance.group)
        })
    }
}
