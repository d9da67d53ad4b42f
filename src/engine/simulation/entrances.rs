//! Agents that come in through entrances, and scheduled agents. They enter on coarse frames, where there is room.

use rand::Rng;
use rand::distr::Open01;
use serde::{Deserialize, Serialize};

use super::{Crowd, Fault};
use crate::agents::NewAgent;
use crate::entrance::{Arrivals, Entrance, Flow, ScheduledAgent, place};
use crate::math::{Vector, clamp_length};
use crate::random::{self, Purpose};
use crate::scene::Scene;

/// Progress at one entrance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Gate {
    /// Whether agents can enter; otherwise they wait.
    pub(super) open: bool,
    /// The flow from outside in place of the scene's, once there is one.
    pub(super) flow: Option<Flow>,
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

impl Default for Gate {
    fn default() -> Self {
        Self {
            open: true,
            flow: None,
            arrived: 0,
            last: None,
            entered: 0,
            largest: (0, 0),
        }
    }
}

impl Gate {
    /// The time of the last arrival, seconds.
    pub(super) fn last(&self) -> Option<f64> {
        self.last
    }

    /// The number of agents that have arrived.
    pub(super) fn arrived(&self) -> u32 {
        self.arrived
    }

    /// Whether a run can reach this progress.
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
        let changed = self.flow.map(|flow| match arrivals {
            Arrivals::Constant(_) => Arrivals::Constant(flow),
            Arrivals::Poisson(_) | Arrivals::At(_) => Arrivals::Poisson(flow),
        });
        let arrivals = changed.as_ref().unwrap_or(arrivals);
        arrivals.time(self.arrived, self.last, scene.seed, k as u32)
    }

    /// Whether more agents will enter.
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

/// Progress of the scheduled agents.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Late {
    /// Number of agents that have arrived.
    arrived: u32,
    /// The numbers of the scheduled agents that wait for room, ascending.
    waiting: Vec<u32>,
    /// The largest number of agents that waited, and the first frame in which they did.
    largest: (u32, u64),
}

impl Late {
    /// Whether this progress fits `scene`.
    pub(super) fn fits(&self, scene: &Scene) -> bool {
        let is_known = |&number: &u32| number < self.arrived;
        self.arrived as usize <= scene.scheduled.len()
            && self.waiting.iter().all(is_known)
            && self.waiting.is_sorted_by(|a, b| a < b)
    }

    /// Whether more agents will enter.
    pub(super) fn expects_agents(&self, scene: &Scene) -> bool {
        !self.waiting.is_empty() || (self.arrived as usize) < scene.scheduled.len()
    }

    /// The waiting scheduled agents, under the name of their first group; `None` if the scene has none.
    pub(super) fn backlog<'a>(&self, scene: &'a Scene) -> Option<Backlog<'a>> {
        Some(Backlog {
            name: scene.latecomers_name()?,
            waiting: self.waiting.len() as u32,
            largest: self.largest.0,
            largest_frame: self.largest.1,
        })
    }
}

impl Scene {
    /// The same agent, but with a speed of at most its s_max; it will have the id `id`.
    #[must_use]
    pub fn slowed(&self, agent: NewAgent, id: u32) -> NewAgent {
        let traits = &self.groups[usize::from(agent.group)].traits;
        let preferred = traits.drawn(agent, self.seed, id).preferred_speed;
        let most = preferred.map_or(self.max_speed, |speed| self.own_speeds(speed)[1]);
        NewAgent {
            velocity: clamp_length(agent.velocity, most),
            ..agent
        }
    }

    /// All who arrive at entrances and on schedule until `end`, seconds, each with the place that it would have if
    /// nobody were in the way. They are in the order of their arrival, and have the traits of ids from `first` on.
    pub fn arrivals(&self, first: u32, end: f64) -> Vec<ScheduledAgent> {
        let mut all: Vec<(f64, Result<&NewAgent, &Entrance>)> = Vec::new();
        let scheduled = self.scheduled.iter().filter(|late| late.at <= end);
        all.extend(scheduled.map(|late| (late.at, Ok(&late.agent))));
        for (k, entrance) in self.entrances.iter().enumerate() {
            let mut gate = Gate::default();
            while let Some(time) = gate.next(self, k).filter(|&time| time <= end) {
                all.push((time, Err(entrance)));
                gate.arrived += 1;
                gate.last = Some(time);
            }
        }
        all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let agents = (first..).zip(all).filter_map(|(id, (at, from))| {
            let agent = match from {
                Ok(agent) => *agent,
                Err(entrance) => through(self, entrance, id, std::iter::empty())?,
            };
            let traits = &self.groups[usize::from(agent.group)].traits;
            let agent = traits.drawn(agent, self.seed, id);
            Some(ScheduledAgent { at, agent })
        });
        agents.collect()
    }

    /// The name of the scheduled agents in reports, which is that of their first group; `None` if there are none.
    pub fn latecomers_name(&self) -> Option<&str> {
        let first = self.scheduled.first()?;
        let group = self.groups.get(usize::from(first.agent.group))?;
        Some(&group.name)
    }
}

impl Crowd {
    /// Lets in all scheduled agents that have arrived and have room. They do not queue for each other.
    pub(super) fn follow_latecomers(&mut self, scene: &Scene) -> Result<(), Fault> {
        let frame = self.clock.frame();
        let mut late = std::mem::take(&mut self.schedule.late);
        while let Some(next) = scene.scheduled.get(late.arrived as usize)
            && self.clock.coarse_frame_at(next.at) <= frame
        {
            late.waiting.push(late.arrived);
            late.arrived += 1;
        }
        for number in std::mem::take(&mut late.waiting) {
            let next = &scene.scheduled[number as usize];
            let id = self.agents.entered();
            let traits = &scene.groups[usize::from(next.agent.group)].traits;
            let radius = next.agent.radius;
            let radius = radius.unwrap_or_else(|| traits.radius_of(scene.seed, id));
            match next.has_room(radius, self.bodies()) {
                true => {
                    let agent = scene.slowed(next.agent, id);
                    if agent.velocity != next.agent.velocity {
                        self.outcome.clamped.add(agent.position);
                    }
                    self.enter(scene, agent)?;
                }
                false => late.waiting.push(number),
            }
        }
        let waiting = late.waiting.len() as u32;
        if waiting > late.largest.0 {
            late.largest = (waiting, frame);
        }
        self.schedule.late = late;
        Ok(())
    }

    /// The bodies of all agents: center and radius, meters.
    pub(super) fn bodies(&self) -> impl Iterator<Item = (Vector, f64)> {
        let bodies = self.agents.position.iter().zip(&self.agents.radius);
        bodies.map(|(&position, &radius)| (position, radius))
    }

    /// Lets in the agents that have arrived at entrance `k`, as long as there is room.
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
            && gate.open
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

    /// The next agent that enters through an entrance, at a random place with room; `None` if there is no room.
    fn next_through(&self, scene: &Scene, entrance: &Entrance) -> Option<NewAgent> {
        through(scene, entrance, self.agents.entered(), self.bodies())
    }
}

/// Agent `id` at a random place of an entrance with room between other bodies (center and radius, meters); `None` if
/// there is no room.
fn through(
    scene: &Scene,
    entrance: &Entrance,
    id: u32,
    bodies: impl Iterator<Item = (Vector, f64)>,
) -> Option<NewAgent> {
    let traits = &scene.groups[usize::from(entrance.group)].traits;
    let radius = traits.radius_of(scene.seed, id);
    let free = entrance.free(radius, &scene.walls, bodies);
    let share = random::stream(scene.seed, Purpose::Entry, id, 0).sample(Open01);
    let along = place(&free, share)?;
    Some(NewAgent {
        radius: Some(radius),
        ..NewAgent::at(entrance.at(along), entrance.goal, entrance.group)
    })
}
