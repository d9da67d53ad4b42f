//! Sources and pushes: scheduled changes of the crowd, on coarse frames only.

use serde::{Deserialize, Serialize};

use crate::engine::agents::NewAgent;
use crate::engine::clock::Clock;
use crate::engine::math::Vector;
use crate::engine::scene::{Goal, Scene, Source};

use super::{Fault, Simulation, Stage};

/// A scheduled event.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// The frame.
    pub frame: u64,
    /// Name of the source or push in the scene.
    pub name: String,
    /// What happened.
    pub kind: EventKind,
}

/// The kind of an event, with the number of agents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum EventKind {
    /// This many agents entered.
    Entered(usize),
    /// A push began with this many agents.
    PushBegan(usize),
    /// A push ended.
    PushEnded,
}

/// Progress of the sources and pushes of a scene.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Schedule {
    /// Number of entries so far, per source.
    entries: Vec<u32>,
    /// Active pushes: index of the push and frame of its end.
    pushing: Vec<(u16, u64)>,
    /// Has each push of the scene begun?
    begun: Vec<bool>,
    events: Vec<Event>,
}

impl Schedule {
    pub(super) fn events(&self) -> &[Event] {
        &self.events
    }

    pub(super) fn expects_agents(&self, scene: &Scene) -> bool {
        scene.sources.iter().enumerate().any(|(s, source)| {
            let entries = self.entries.get(s).copied().unwrap_or(0);
            source.times.is_none_or(|times| entries < times)
        })
    }

    /// Does this progress fit `scene`?
    pub(super) fn fits(&self, scene: &Scene) -> bool {
        let (sources, pushes) = (scene.sources.len(), scene.pushes.len());
        let known = |&(push, _): &(u16, u64)| usize::from(push) < pushes;
        self.entries.len() <= sources
            && self.begun.len() <= pushes
            && self.pushing.iter().all(known)
    }

    fn note(&mut self, frame: u64, name: &str, kind: EventKind) {
        self.events.push(Event {
            frame,
            name: name.to_owned(),
            kind,
        });
    }
}

impl Source {
    /// The coarse frame of entry number `entry`, from 0; `None` if there is no such entry.
    fn frame_of(&self, entry: u32, clock: &Clock) -> Option<u64> {
        let due = self.times.is_none_or(|times| entry < times);
        due.then(|| clock.coarse_frame_at(self.start + f64::from(entry) * self.every))
    }
}

impl Simulation {
    /// On coarse frames, lets agents in, and begins and ends pushes that are due.
    pub(super) fn follow_schedule(&mut self) -> Result<(), Fault> {
        let nothing = self.scene.sources.is_empty() && self.scene.pushes.is_empty();
        if nothing || !self.clock.is_coarse() {
            return Ok(());
        }
        let mut stages = std::mem::take(&mut self.stages);
        let followed = stages.time(Stage::Schedule, || self.enter_and_push());
        self.stages = stages;
        followed
    }

    fn enter_and_push(&mut self) -> Result<(), Fault> {
        self.schedule.entries.resize(self.scene.sources.len(), 0);
        self.schedule.begun.resize(self.scene.pushes.len(), false);
        for s in 0..self.scene.sources.len() {
            self.follow_source(s)?;
        }
        self.end_pushes();
        for p in 0..self.scene.pushes.len() {
            self.begin_push(p);
        }
        Ok(())
    }

    fn follow_source(&mut self, s: usize) -> Result<(), Fault> {
        let frame = self.clock.frame();
        let source = self.scene.sources[s].clone();
        while source
            .frame_of(self.schedule.entries[s], &self.clock)
            .is_some_and(|due| due <= frame)
        {
            self.schedule.entries[s] += 1;
            let positions: Vec<Vector> = source
                .grid
                .positions(self.scene.seed, self.agents.entered())
                .collect();
            for &position in &positions {
                let goal = match source.goal {
                    Goal::Point(goal) => goal,
                    Goal::Offset(offset) => position + offset,
                };
                self.enter(NewAgent::at(position, goal, source.group))?;
            }
            let kind = EventKind::Entered(positions.len());
            self.schedule.note(frame, &source.name, kind);
        }
        Ok(())
    }

    /// Lets one agent in. An agent inside an obstacle is moved to a free point nearby.
    pub(super) fn enter(&mut self, mut agent: NewAgent) -> Result<(), Fault> {
        let id = self.agents.entered();
        if let Some(obstacle) = self.scene.walls.obstacle_at(agent.position) {
            agent.position =
                self.scene
                    .walls
                    .free_point_near(agent.position)
                    .ok_or(Fault::NoFreePoint {
                        agent: id,
                        obstacle,
                    })?;
            self.outcome.displaced.push((id, obstacle));
        }
        self.agents.enter(agent, self.scene.seed);
        self.crowd_changed = true;
        Ok(())
    }

    fn end_pushes(&mut self) {
        let frame = self.clock.frame();
        let (over, going_on) = std::mem::take(&mut self.schedule.pushing)
            .into_iter()
            .partition(|&(_, end)| end <= frame);
        self.schedule.pushing = going_on;
        let over: Vec<(u16, u64)> = over;
        for (p, _) in over {
            for push in &mut self.agents.push {
                *push = push.filter(|&current| current != p);
            }
            let name = &self.scene.pushes[usize::from(p)].name;
            self.schedule.note(frame, name, EventKind::PushEnded);
        }
    }

    fn begin_push(&mut self, p: usize) {
        let frame = self.clock.frame();
        let push = &self.scene.pushes[p];
        if self.schedule.begun[p] || self.clock.coarse_frame_at(push.at) > frame {
            return;
        }
        self.schedule.begun[p] = true;
        let end = self.clock.coarse_frame_at(push.at + push.lasting);
        self.schedule.pushing.push((p as u16, end));
        let mut count = 0;
        for (current, &position) in self.agents.push.iter_mut().zip(&self.agents.position) {
            if push.region.contains(position) {
                *current = Some(p as u16);
                count += 1;
            }
        }
        self.schedule
            .note(frame, &push.name, EventKind::PushBegan(count));
    }
}
