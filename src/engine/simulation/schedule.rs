//! Sources, entrances, scheduled agents and pushes: scheduled changes of the crowd, on coarse frames only.

use serde::{Deserialize, Serialize};

use crate::agents::NewAgent;
use crate::clock::Clock;
use crate::scene::{Goal, Push, Scene, Source};

use super::entrances::{Backlog, Gate, Late};
use super::{Crowd, Fault, Simulation, Stage};

/// Agents this near to a free point are not moved to it, meters.
const EDGE: f64 = 1e-6;

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
    /// An exit opened.
    Opened,
    /// An exit closed.
    Closed,
    /// From now on, no agent waits in a waiting area.
    Released,
    /// What an [`Action`](crate::scene::Action) did, in words, which are the event's name.
    Intervention,
}

/// Progress of the sources, entrances, scheduled agents and pushes of a scene.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Schedule {
    /// Number of entries so far, per source.
    entries: Vec<u32>,
    /// Progress at each entrance.
    pub(super) gates: Vec<Gate>,
    /// Progress of the scheduled agents.
    pub(super) late: Late,
    /// Active pushes: index of the push and frame of its end.
    pushing: Vec<(u16, u64)>,
    /// Whether each push of the scene has begun.
    begun: Vec<bool>,
    events: Vec<Event>,
}

impl Schedule {
    pub(super) fn events(&self) -> &[Event] {
        &self.events
    }

    pub(super) fn expects_agents(&self, scene: &Scene) -> bool {
        let mut sources = scene.sources.iter().enumerate();
        let from_sources = sources.any(|(s, source)| {
            let entries = self.entries.get(s).copied().unwrap_or(0);
            source.times.is_none_or(|times| entries < times)
        });
        let mut gates = self.gates_of(scene).enumerate();
        let through = gates.any(|(k, gate)| gate.expects_agents(scene, k));
        from_sources || through || self.late.expects_agents(scene)
    }

    /// Progress at each entrance of the scene.
    fn gates_of(&self, scene: &Scene) -> impl Iterator<Item = Gate> {
        let gates = (0..scene.entrances.len()).map(|k| self.gates.get(k));
        gates.map(|gate| gate.copied().unwrap_or_default())
    }

    pub(super) fn backlogs<'a>(&self, scene: &'a Scene) -> impl Iterator<Item = Backlog<'a>> {
        let gates = self.gates_of(scene).zip(&scene.entrances);
        let gates = gates.map(|(gate, entrance)| gate.backlog(entrance));
        gates.chain(self.late.backlog(scene))
    }

    /// Whether this progress fits `scene`.
    pub(super) fn fits(&self, scene: &Scene) -> bool {
        let (sources, pushes) = (scene.sources.len(), scene.pushes.len());
        let known = |&(push, _): &(u16, u64)| usize::from(push) < pushes;
        self.entries.len() <= sources
            && self.gates.len() <= scene.entrances.len()
            && self.gates.iter().all(Gate::is_sound)
            && self.late.fits(scene)
            && self.begun.len() <= pushes
            && self.pushing.iter().all(known)
    }

    pub(super) fn note(&mut self, frame: u64, name: &str, kind: EventKind) {
        let name = name.to_owned();
        self.events.push(Event { frame, name, kind });
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
    /// On coarse frames: lets in the agents that are due, and begins and ends pushes.
    pub(super) fn follow_schedule(&mut self) -> Result<(), Fault> {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        let nothing = scene.sources.is_empty() && scene.pushes.is_empty();
        let nothing = nothing && scene.entrances.is_empty() && scene.scheduled.is_empty();
        if nothing || !crowd.decides() {
            return Ok(());
        }
        self.stages.time(Stage::Schedule, || {
            crowd.schedule.entries.resize(scene.sources.len(), 0);
            crowd.schedule.begun.resize(scene.pushes.len(), false);
            for (s, source) in scene.sources.iter().enumerate() {
                crowd.follow_source(scene, s, source)?;
            }
            let gates = &mut crowd.schedule.gates;
            gates.resize(scene.entrances.len(), Gate::default());
            for k in 0..scene.entrances.len() {
                crowd.follow_entrance(scene, k)?;
            }
            crowd.follow_latecomers(scene)?;
            crowd.end_pushes(scene);
            for (p, push) in scene.pushes.iter().enumerate() {
                crowd.begin_push(p, push);
            }
            Ok(())
        })
    }
}

impl Crowd {
    /// Whether the decisions of a coarse frame are due.
    pub(super) fn decides(&self) -> bool {
        self.clock.is_coarse() && !self.decided
    }

    fn follow_source(&mut self, scene: &Scene, s: usize, source: &Source) -> Result<(), Fault> {
        let clock = self.clock;
        let is_due = |entry| {
            let due = source.frame_of(entry, &clock);
            due.is_some_and(|due| due <= clock.frame())
        };
        while is_due(self.schedule.entries[s]) {
            self.schedule.entries[s] += 1;
            let first = self.agents.entered();
            for position in source.grid.positions(scene.seed, first) {
                let goal = match source.goal {
                    Goal::Point(goal) => goal,
                    Goal::Offset(offset) => position + offset,
                };
                self.enter(scene, NewAgent::at(position, goal, source.group))?;
            }
            let kind = EventKind::Entered((self.agents.entered() - first) as usize);
            self.schedule.note(clock.frame(), &source.name, kind);
        }
        Ok(())
    }

    /// Lets one agent in. An agent inside an obstacle is moved to a free point nearby.
    pub(super) fn enter(&mut self, scene: &Scene, mut new: NewAgent) -> Result<(), Fault> {
        let agent = self.agents.entered();
        let traits = &scene.groups[usize::from(new.group)].traits;
        new = traits.drawn(new, scene.seed, agent);
        if let Some(period) = &scene.period {
            (new.position, _) = period.wrapped(new.position);
        }
        if let Some(obstacle) = scene.walls.obstacle_at(new.position) {
            let free = scene.walls.free_point_near(new.position);
            let free = free.ok_or(Fault::NoFreePoint { agent, obstacle })?;
            // An agent on the edge of an obstacle stays there.
            if (free - new.position).norm() > EDGE {
                self.outcome.displaced.push((agent, obstacle));
            }
            new.position = free;
        }
        self.agents.enter(new, scene.seed);
        let usual = [scene.preferred_speed, scene.max_speed];
        let own = new.preferred_speed.map(|speed| scene.own_speeds(speed));
        self.agents.set_speeds(own, usual);
        let walks_from = new.premovement.map(|wait| self.clock.time() + wait);
        self.agents.set_start(walks_from);
        self.changed = true;
        Ok(())
    }

    fn end_pushes(&mut self, scene: &Scene) {
        let frame = self.clock.frame();
        let is_over = |&mut (_, end): &mut (u16, u64)| end <= frame;
        let over: Vec<_> = self.schedule.pushing.extract_if(.., is_over).collect();
        for (p, _) in over {
            for push in &mut self.agents.push {
                *push = push.filter(|&current| current != p);
            }
            let name = &scene.pushes[usize::from(p)].name;
            self.schedule.note(frame, name, EventKind::PushEnded);
        }
    }

    fn begin_push(&mut self, p: usize, push: &Push) {
        let frame = self.clock.frame();
        if self.schedule.begun[p] || self.clock.coarse_frame_at(push.at) > frame {
            return;
        }
        self.start_push(p, push);
    }

    /// A push begins in this frame.
    pub(super) fn start_push(&mut self, p: usize, push: &Push) {
        let frame = self.clock.frame();
        let begun = &mut self.schedule.begun;
        begun.resize(begun.len().max(p + 1), false);
        begun[p] = true;
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
