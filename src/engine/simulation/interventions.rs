//! Interventions: what is done to a crowd at the beginning of a frame, before anything else happens in it.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::entrances::Gate;
use super::{Crowd, EventKind, Fault, Removal, Simulation};
use crate::agents::NewAgent;
use crate::clock::Clock;
use crate::entrance::{Arrivals, Flow, ScheduledAgent};
use crate::geometry::Wall;
use crate::journeys::{ChangeKind, Status};
use crate::math::Vector;
use crate::scene::{Action, Intervention, Scene};

/// Interventions from outside, and how many have been made.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Interventions {
    /// Those from outside, in the order of their frames.
    from_outside: Vec<Intervention>,
    /// How many of these, and how many of the scene, have been made.
    made: [usize; 2],
}

impl Interventions {
    /// All from outside, in the order of their frames.
    pub(super) fn outside(&self) -> &[Intervention] {
        &self.from_outside
    }

    /// Those from outside that have not been made yet.
    pub(super) fn pending(&self) -> impl DoubleEndedIterator<Item = &Action> {
        let pending = self.from_outside[self.made[0]..].iter();
        pending.map(|intervention| &intervention.action)
    }

    pub(super) fn plan(&mut self, new: Intervention) {
        let all = &mut self.from_outside;
        let at = all.partition_point(|one| one.frame <= new.frame);
        all.insert(at, new);
    }

    /// The next intervention that is due in `frame`. In one frame, those from outside come first.
    fn take(&mut self, scene: &Scene, frame: u64) -> Option<Intervention> {
        let lists = [&self.from_outside[..], &scene.interventions[..]];
        let next = |k: usize| lists[k].get(self.made[k]).filter(|one| one.frame <= frame);
        let (list, next) = match [next(0), next(1)] {
            [Some(first), Some(second)] if second.frame < first.frame => (1, second),
            [Some(first), _] => (0, first),
            [None, second] => (1, second?),
        };
        let next = next.clone();
        self.made[list] += 1;
        Some(next)
    }

    /// Makes the changes to `scene` of all interventions that have been made.
    pub(super) fn edit_again(&self, scene: &mut Scene, clock: &Clock) {
        let counts = self.made;
        let mut again = Self {
            made: [0, 0],
            ..self.clone()
        };
        while again.made != counts {
            let Some(Intervention { frame, action }) = again.take(scene, u64::MAX) else {
                return;
            };
            scene.edit(&action, clock.time_at(frame));
        }
    }

    /// Whether they fit `scene`.
    pub(super) fn fit(&self, scene: &Scene) -> bool {
        self.made[0] <= self.from_outside.len()
            && self.made[1] <= scene.interventions.len()
            && self.from_outside.iter().all(|one| fits(&one.action, scene))
    }
}

/// Whether all that an action names is in `scene`, and its points are finite.
fn fits(action: &Action, scene: &Scene) -> bool {
    let journeys = &scene.journeys;
    let has = |number: u16, count: usize| usize::from(number) < count;
    match action {
        Action::Goals(goals) => goals.iter().all(|(_, goal)| is_finite(*goal)),
        Action::Add(new) => new.iter().all(|new| {
            is_finite(new.position) && is_finite(new.goal) && has(new.group, scene.groups.len())
        }),
        Action::Journey { journey, .. } => has(*journey, journeys.journeys.len()),
        Action::Place { place: number, .. } | Action::Capacity { exit: number, .. } => {
            has(*number, journeys.places.len())
        }
        Action::Entrance { entrance, .. } | Action::Rate { entrance, .. } => {
            has(*entrance, scene.entrances.len())
        }
        Action::Zone { zone, .. } => has(*zone, journeys.zones.len()),
        Action::Remove(_) | Action::Speeds(_) | Action::Push(..) => true,
    }
}

pub(super) fn is_finite(p: Vector) -> bool {
    p.x.is_finite() && p.y.is_finite()
}

/// The action in words, for events: how many of `all` agents it reached.
fn in_words(done: usize, all: usize, what: &str) -> String {
    match done == all {
        true => format!("{done} agents {what}"),
        false => format!("{done} of {all} agents {what}"),
    }
}

impl Simulation {
    /// Makes the interventions that are due in this frame.
    pub(super) fn make_interventions(&mut self) -> Result<(), Fault> {
        let frame = self.crowd.clock.frame();
        while let Some(due) = self.crowd.interventions.take(&self.fixed.scene, frame) {
            if let Some(words) = self.make(&due.action)? {
                let schedule = &mut self.crowd.schedule;
                schedule.note(frame, &words, EventKind::Intervention);
            }
        }
        Ok(())
    }

    /// Makes an intervention. Returns it in words, if no other event tells of it.
    fn make(&mut self, action: &Action) -> Result<Option<String>, Fault> {
        if Scene::is_edited_by(action) {
            let time = self.crowd.clock.time();
            let fixed = Arc::make_mut(&mut self.fixed);
            fixed.scene.edit(action, time);
            fixed.needs = fixed.needs.with(&fixed.scene.needs());
            self.crowd.changed = true;
        }
        if matches!(action, Action::Add(_) | Action::Goals(_)) {
            self.take_later_routes();
        }
        if self.fixed.scene.journeys.has_trips() {
            self.crowd.progress.extend_to(&self.fixed.scene.journeys);
        }
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        Ok(Some(match action {
            Action::Add(new) => self.add_agents(new)?,
            Action::Remove(ids) => in_words(crowd.take_out(scene, ids), ids.len(), "are removed"),
            Action::Goals(goals) => self.give_goals(goals),
            Action::Journey { agents, journey } => {
                let done = crowd.begin_journeys(scene, agents, *journey);
                let name = &scene.journeys.journeys[usize::from(*journey)].name;
                in_words(done, agents.len(), &format!("begin the journey {name}"))
            }
            Action::Speeds(speeds) => {
                let done = crowd.change_speeds(scene, speeds);
                in_words(done, speeds.len(), "want to walk at another speed")
            }
            Action::Push(..) => {
                let p = scene.pushes.len() - 1;
                crowd.start_push(p, &scene.pushes[p]);
                return Ok(None);
            }
            Action::Place { place, change } => {
                crowd.change_place(scene, *place, *change);
                return Ok(None);
            }
            Action::Entrance { entrance, open } => {
                crowd.gate(scene, *entrance).open = *open;
                let name = &scene.entrances[usize::from(*entrance)].name;
                format!("{name} {}", if *open { "opens" } else { "closes" })
            }
            Action::Rate { entrance, per_sec } => {
                crowd.change_rate(scene, *entrance, *per_sec);
                let name = &scene.entrances[usize::from(*entrance)].name;
                format!("{name}: {per_sec} people per second arrive")
            }
            Action::Capacity { exit, most_per_sec } => {
                let name = &scene.journeys.places[usize::from(*exit)].name;
                match most_per_sec {
                    Some(most) => format!("{name}: at most {most} people per second pass"),
                    None => format!("{name}: no limit"),
                }
            }
            Action::Zone { zone, speed_factor } => {
                let name = &scene.journeys.zones[usize::from(*zone)].name;
                format!("{name}: speed × {speed_factor}")
            }
        }))
    }

    fn add_agents(&mut self, new: &[NewAgent]) -> Result<String, Fault> {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        let before = crowd.agents.len();
        for agent in new {
            crowd.enter_with_room(scene, *agent)?;
        }
        let entered = before..crowd.agents.len();
        let walks_to_goal = |&i: &usize| {
            let group = &scene.groups[usize::from(crowd.agents.group[i])];
            group.journey.is_none() && group.direction.is_none()
        };
        let walking = entered.clone().filter(walks_to_goal);
        let goals: Vec<_> = walking.map(|i| (i, crowd.agents.goal[i])).collect();
        self.map_goals(&goals);
        Ok(in_words(entered.len(), new.len(), "enter"))
    }

    fn give_goals(&mut self, goals: &[(u32, Vector)]) -> String {
        let found = self.crowd.find(goals);
        self.map_goals(&found);
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        for &(i, goal) in &found {
            crowd.leave_journey(scene, i);
            crowd.agents.goal[i] = goal;
            crowd.agents.forget_route(i);
        }
        in_words(found.len(), goals.len(), "get a new goal")
    }
}

impl Crowd {
    /// Agents begin a journey; returns their number.
    fn begin_journeys(&mut self, scene: &Scene, ids: &[u32], journey: u16) -> usize {
        self.agents.trip.resize(self.agents.len(), None);
        let found = self.find_all(ids);
        for &i in &found {
            self.leave_journey(scene, i);
            self.begin(scene, i, journey);
        }
        found.len()
    }

    /// Agents get other preferred speeds, m/s; returns their number.
    fn change_speeds(&mut self, scene: &Scene, speeds: &[(u32, f64)]) -> usize {
        let usual = [scene.preferred_speed, scene.max_speed];
        let found = self.find(speeds);
        for &(i, preferred) in &found {
            let own = scene.own_speeds(preferred);
            self.agents.change_speeds(i, own, usual);
        }
        self.changed |= !found.is_empty();
        found.len()
    }

    /// The indices of those agents that are present, by id, each once, with their values.
    fn find<T: Copy>(&self, values: &[(u32, T)]) -> Vec<(usize, T)> {
        let agents = &self.agents;
        let mut places = vec![None; agents.entered() as usize];
        for i in agents.present() {
            places[agents.id[i] as usize] = Some(i);
        }
        let mut found = Vec::with_capacity(values.len());
        for &(id, value) in values {
            let place = places.get_mut(id as usize).and_then(Option::take);
            found.extend(place.map(|i| (i, value)));
        }
        found
    }

    fn find_all(&self, ids: &[u32]) -> Vec<usize> {
        let ids: Vec<(u32, ())> = ids.iter().map(|&id| (id, ())).collect();
        self.find(&ids).into_iter().map(|(i, ())| i).collect()
    }

    /// Lets an agent in if there is room for it between bodies and walls.
    fn enter_with_room(&mut self, scene: &Scene, new: NewAgent) -> Result<(), Fault> {
        let id = self.agents.entered();
        let agent = scene.slowed(new, id);
        if scene.has_room(agent, id, self.bodies()) {
            self.enter(scene, agent)?;
        }
        Ok(())
    }

    /// Takes agents out; returns their number.
    fn take_out(&mut self, scene: &Scene, ids: &[u32]) -> usize {
        let gone = self.find_all(ids);
        for &i in &gone {
            self.leave_journey(scene, i);
        }
        let agents = &self.agents;
        let removed = gone.iter().map(|&i| Removal {
            id: agents.id[i],
            time: self.clock.time(),
            position: agents.position[i],
        });
        self.outcome.removed.extend(removed);
        self.remove(&gone);
        gone.len()
    }

    /// The progress at an entrance.
    fn gate(&mut self, scene: &Scene, entrance: u16) -> &mut Gate {
        let gates = &mut self.schedule.gates;
        gates.resize(scene.entrances.len(), Gate::default());
        &mut gates[usize::from(entrance)]
    }

    fn change_rate(&mut self, scene: &Scene, entrance: u16, per_sec: f64) {
        let from = self.clock.time();
        let arrivals = &scene.entrances[usize::from(entrance)].arrivals;
        let gate = self.gate(scene, entrance);
        let given = match arrivals {
            Arrivals::Constant(flow) | Arrivals::Poisson(flow) => Some(*flow),
            Arrivals::At(_) => None,
        };
        let (until, number) = given.map_or((f64::INFINITY, None), |flow| (flow.until, flow.number));
        let before = gate.flow.or(given);
        let waited = before.map_or(0.0, |flow| flow.waited(gate.last(), from));
        gate.flow = Some(Flow {
            per_sec,
            from,
            until,
            number,
            first: gate.arrived(),
            waited,
        });
    }

    /// Opens or closes a place, or releases it.
    pub(super) fn change_place(&mut self, scene: &Scene, place: u16, kind: ChangeKind) {
        let frame = self.clock.frame();
        let state = &mut self.progress.places[usize::from(place)];
        state.open = kind == ChangeKind::Open;
        for trip in self.agents.trip.iter_mut().flatten() {
            if trip.place == place && trip.status == Status::Walking {
                trip.chooses_at = trip.chooses_at.min(frame);
            }
        }
        let name = &scene.journeys.places[usize::from(place)].name;
        let kind = match kind {
            ChangeKind::Open => EventKind::Opened,
            ChangeKind::Close => EventKind::Closed,
            ChangeKind::Release => EventKind::Released,
        };
        self.schedule.note(frame, name, kind);
    }
}

impl Scene {
    /// D_i of an agent that gets `id`, meters.
    pub(super) fn radius(&self, new: NewAgent, id: u32) -> f64 {
        let traits = &self.groups[usize::from(new.group)].traits;
        let drawn = || traits.radius_of(self.seed, id);
        new.radius.unwrap_or_else(drawn)
    }

    /// Whether an agent that gets `id` has room between the walls and some bodies (center and radius, meters).
    pub(super) fn has_room(
        &self,
        agent: NewAgent,
        id: u32,
        bodies: impl Iterator<Item = (Vector, f64)>,
    ) -> bool {
        let (place, radius) = (agent.position, self.radius(agent, id));
        let images = bodies.map(|(center, other)| match &self.period {
            Some(period) => (place + period.shortest(center - place), other),
            None => (center, other),
        });
        let near = self.walls.near_any(&[place], radius);
        let mut walls = near.into_iter().map(|k| self.walls.wall(k));
        let is_far = |wall: &Wall| (wall.nearest_point(place).point - place).norm() >= radius;
        self.walls.obstacle_at(place).is_none()
            && walls.all(is_far)
            && ScheduledAgent { at: 0.0, agent }.has_room(radius, images)
    }
}
