//! Control from outside: interventions are checked when they are given, and made at the beginning of the next frame.

use std::collections::{BTreeMap, BTreeSet};

use super::Simulation;
use super::interventions::is_finite;
use super::refused::{Absent, ActionError, MOST_PUSHES, refused_change, within};
use crate::agents::NewAgent;
use crate::limits::{FASTEST, MOST_PER_SEC, SPEED_FACTORS, STRONGEST};
use crate::math::Vector;
use crate::routes::{Destination, WayError};
use crate::scene::{Action, Intervention, Push};

/// The longest step is multiplied by this, against rounding.
const MARGIN: f64 = 1.001;

/// What became of agents that were to be added.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Added {
    /// The ids of those that enter, in order.
    pub ids: Vec<u32>,
    /// The places in the list of those for which there is no room, from 0. They do not enter.
    pub without_room: Vec<usize>,
}

/// An agent that an action can name.
struct Known {
    position: Vector,
    group: u16,
}

impl Simulation {
    /// The index of agent `id` in the current frame.
    ///
    /// # Errors
    /// It has not entered yet, or has left.
    pub fn present(&self, id: u32) -> Result<usize, Absent> {
        let agents = &self.crowd.agents;
        agents.index_of(id).ok_or_else(|| self.absent(id))
    }

    fn absent(&self, id: u32) -> Absent {
        let entered = self.crowd.agents.entered();
        Absent {
            time: self.crowd.clock.time(),
            entered: (id >= entered).then_some(entered),
        }
    }

    /// Does something at the beginning of the next frame that is computed: of the current one, if it has not been
    /// evaluated. Agents that leave before are skipped.
    ///
    /// # Errors
    /// The action is not possible. Nothing is done then.
    pub fn intervene(&mut self, action: Action) -> Result<(), ActionError> {
        self.check_action(&action)?;
        self.plan(action);
        Ok(())
    }

    /// Gives agents, by id, new goals in meters. They walk there from the next frame on, around walls if the scene has
    /// routes. An agent on a journey abandons it and stays at its goal. Other agents leave at their goal if their group
    /// does.
    ///
    /// # Errors
    /// An agent is absent or walks in a direction, or a goal is not on the floor or cannot be reached. Then no agent
    /// gets a new goal.
    pub fn set_goals(&mut self, new: &[(u32, Vector)]) -> Result<(), ActionError> {
        self.intervene(Action::Goals(new.to_vec()))
    }

    /// Adds agents at the beginning of the next frame, in order, where there is room between bodies and walls. If the
    /// current frame has been evaluated, agents that are present may move by one step before: those that are nearer
    /// leave no room.
    ///
    /// # Errors
    /// A position or a goal is not on the floor, no way leads from one to the other, a number is out of range, or there
    /// is no such group. No agent is added then.
    pub fn add(&mut self, new: &[NewAgent]) -> Result<Added, ActionError> {
        self.check_action(&Action::Add(new.to_vec()))?;
        let scene = &self.fixed.scene;
        let margin = match self.crowd.decided {
            true => MARGIN * scene.highest_speed(&self.crowd.agents) * self.crowd.clock.time_step(),
            false => 0.0,
        };
        let first = self.crowd.agents.entered() + self.planned().len() as u32;
        let mut planned = self.planned_bodies();
        let mut added = Added::default();
        let mut entering = Vec::new();
        for (k, &agent) in new.iter().enumerate() {
            let id = first + added.ids.len() as u32;
            let present = self.crowd.bodies();
            let present = present.map(|(center, radius)| (center, radius + margin));
            let bodies = present.chain(planned.iter().copied());
            match scene.has_room(agent, id, bodies) {
                true => {
                    planned.push((agent.position, scene.radius(agent, id)));
                    entering.push(agent);
                    added.ids.push(id);
                }
                false => added.without_room.push(k),
            }
        }
        if !entering.is_empty() {
            self.plan(Action::Add(entering));
        }
        Ok(added)
    }

    /// All interventions from outside, in the order of their frames.
    pub fn interventions(&self) -> &[Intervention] {
        self.crowd.interventions.outside()
    }

    fn plan(&mut self, action: Action) {
        let frame = self.crowd.clock.frame() + u64::from(self.crowd.decided);
        self.crowd
            .interventions
            .plan(Intervention { frame, action });
    }

    /// The agents that enter from outside at the beginning of the next frame.
    fn planned(&self) -> Vec<&NewAgent> {
        let pending = self.crowd.interventions.pending();
        let added = pending.filter_map(|action| match action {
            Action::Add(new) => Some(new),
            _ => None,
        });
        added.flatten().collect()
    }

    /// The bodies of these agents: center and radius, meters.
    fn planned_bodies(&self) -> Vec<(Vector, f64)> {
        let entered = self.crowd.agents.entered();
        let bodies = (entered..).zip(self.planned()).map(|(id, &agent)| {
            let radius = self.fixed.scene.radius(agent, id);
            (agent.position, radius)
        });
        bodies.collect()
    }

    /// The agents with these ids, which are present or enter at the beginning of the next frame.
    fn known(&self, ids: impl Iterator<Item = u32>) -> Result<Vec<Known>, ActionError> {
        let agents = &self.crowd.agents;
        let mut places = vec![None; agents.entered() as usize];
        for i in agents.present() {
            places[agents.id[i] as usize] = Some(i);
        }
        let planned = self.planned();
        let pending = self.crowd.interventions.pending();
        let removed: BTreeSet<u32> = pending
            .filter_map(|action| match action {
                Action::Remove(ids) => Some(ids),
                _ => None,
            })
            .flatten()
            .copied()
            .collect();
        let mut seen = BTreeSet::new();
        let mut find = |id: u32| {
            if !seen.insert(id) {
                return Err(ActionError::Twice(id));
            }
            let present = places.get(id as usize).copied().flatten();
            let later = id
                .checked_sub(agents.entered())
                .and_then(|k| planned.get(k as usize));
            let known = match (present, later) {
                (Some(i), _) => Some(Known {
                    position: agents.position[i],
                    group: agents.group[i],
                }),
                (None, Some(new)) => Some(Known {
                    position: new.position,
                    group: new.group,
                }),
                (None, None) => None,
            };
            let known = known.filter(|_| !removed.contains(&id));
            known.ok_or_else(|| ActionError::Absent(id, self.absent(id)))
        };
        ids.map(&mut find).collect()
    }

    fn check_action(&self, action: &Action) -> Result<(), ActionError> {
        let scene = &self.fixed.scene;
        let places = &scene.journeys.places;
        let unknown = |kind, number| ActionError::Unknown { kind, number };
        match action {
            Action::Add(new) => self.check_new(new),
            Action::Remove(ids) => self.known(ids.iter().copied()).map(drop),
            Action::Goals(goals) => self.check_goals(goals),
            Action::Journey { agents, journey } => self.check_journey(agents, *journey),
            Action::Speeds(speeds) => {
                for &(_, preferred) in speeds {
                    within("the speed", preferred, [0.0, FASTEST])?;
                }
                self.known(speeds.iter().map(|&(id, _)| id)).map(drop)
            }
            Action::Push(push, force) => {
                within("the duration", push.lasting, [0.0, f64::MAX])?;
                if let Some(force) = force {
                    let numbers = force.curve.iter().flatten();
                    let numbers = numbers.chain(force.direction.iter());
                    for &number in numbers {
                        within("acceleration", number, [f64::MIN, f64::MAX])?;
                    }
                }
                self.check_push(push)
            }
            Action::Place { place, change } => {
                refused_change(places, *place, *change).map_or(Ok(()), Err)
            }
            Action::Entrance { entrance, .. } | Action::Rate { entrance, .. } => {
                if let Action::Rate { per_sec, .. } = action {
                    within("the rate", *per_sec, [0.0, MOST_PER_SEC])?;
                }
                let known = scene.entrances.get(usize::from(*entrance));
                known.map(drop).ok_or(unknown("entrance", *entrance))
            }
            Action::Capacity { exit, most_per_sec } => {
                if let Some(most) = most_per_sec {
                    within("the capacity", *most, [f64::MIN_POSITIVE, MOST_PER_SEC])?;
                }
                let known = places.get(usize::from(*exit));
                let known = known.filter(|place| place.is_exit());
                known.map(drop).ok_or(unknown("exit", *exit))
            }
            Action::Zone { zone, speed_factor } => {
                within("the speed factor", *speed_factor, SPEED_FACTORS)?;
                let known = scene.journeys.zones.get(usize::from(*zone));
                known.map(drop).ok_or(unknown("zone", *zone))
            }
        }
    }

    fn check_push(&self, push: &Push) -> Result<(), ActionError> {
        let pending = self.crowd.interventions.pending();
        let pending = pending.filter(|action| matches!(action, Action::Push(..)));
        if self.fixed.scene.pushes.len() + pending.count() >= MOST_PUSHES {
            return Err(ActionError::TooManyPushes);
        }
        match push.change.goal_scale {
            Some(scale) => within("goal_scale", scale, [0.0, STRONGEST]),
            None => Ok(()),
        }
    }

    fn check_new(&self, new: &[NewAgent]) -> Result<(), ActionError> {
        let scene = &self.fixed.scene;
        let first = self.crowd.agents.entered() + self.planned().len() as u32;
        let mut goals = Vec::new();
        for (id, agent) in (first..).zip(new) {
            let group = scene.groups.get(usize::from(agent.group));
            let group = group.ok_or(ActionError::Unknown {
                kind: "group",
                number: agent.group,
            })?;
            self.check_floor(agent.position)?;
            for speed in agent.velocity.iter() {
                within("the velocity", *speed, [-FASTEST, FASTEST])?;
            }
            if let Some(speed) = agent.preferred_speed {
                within("the speed", speed, [0.0, FASTEST])?;
            }
            if group.journey.is_none() && group.direction.is_none() {
                goals.push((id, agent.position, agent.goal));
            }
        }
        self.check_ways(&goals)
    }

    fn check_goals(&self, new: &[(u32, Vector)]) -> Result<(), ActionError> {
        let known = self.known(new.iter().map(|&(id, _)| id))?;
        let mut goals = Vec::with_capacity(new.len());
        for (&(id, goal), agent) in new.iter().zip(&known) {
            let group = &self.fixed.scene.groups[usize::from(agent.group)];
            if group.direction.is_some() {
                return Err(ActionError::Directed(id));
            }
            goals.push((id, agent.position, goal));
        }
        self.check_ways(&goals)
    }

    fn check_floor(&self, p: Vector) -> Result<(), ActionError> {
        let is_free = is_finite(p) && self.fixed.scene.walls.obstacle_at(p).is_none();
        is_free.then_some(()).ok_or(ActionError::NotOnFloor(p))
    }

    /// Whether routes lead to goals from the places of agents: id, place and goal.
    fn check_ways(&self, new: &[(u32, Vector, Vector)]) -> Result<(), ActionError> {
        let scene = &self.fixed.scene;
        let routes = scene.routes.as_ref().or(scene.later_routes.as_ref());
        let bits = |goal: Vector| [goal.x, goal.y].map(f64::to_bits);
        let pending = self.crowd.interventions.pending();
        let pending = pending.filter_map(|action| match action {
            Action::Goals(goals) => Some(goals),
            _ => None,
        });
        let mut last: BTreeMap<u32, Vector> = pending.flatten().copied().collect();
        for (id, ..) in new {
            last.remove(id);
        }
        let mut unmapped: BTreeSet<[u64; 2]> = last.into_values().map(bits).collect();
        for together in new.chunk_by(|a, b| a.2 == b.2) {
            let goal = together[0].2;
            self.check_floor(goal)?;
            let Some(routes) = routes else {
                continue;
            };
            let is_needed = together.len() > 1
                || together
                    .iter()
                    .any(|&(_, from, goal)| self.is_hidden(from, goal));
            if !is_needed {
                continue;
            }
            let starts = together.iter().map(|&(_, from, _)| from);
            let cut_off = routes
                .without_way(starts, goal)
                .map_err(|error| match error {
                    WayError::NotOnFloor(_) => ActionError::NotOnFloor(goal),
                    error => error.into(),
                })?;
            if let Some(k) = cut_off {
                return Err(ActionError::NoWay {
                    agent: together[k].0,
                    from: together[k].1,
                    to: format!("({}, {})", goal.x, goal.y),
                });
            }
            if !routes.leads_to(Destination::Goal(goal)) {
                unmapped.insert(bits(goal));
            }
        }
        let is_used = |goal| self.crowd.agents.goal.contains(&goal);
        match routes {
            Some(routes) if routes.lacks_room_for(unmapped.len(), is_used) => {
                Err(WayError::TooMany.into())
            }
            _ => Ok(()),
        }
    }

    fn check_journey(&self, agents: &[u32], journey: u16) -> Result<(), ActionError> {
        let scene = &self.fixed.scene;
        let journeys = &scene.journeys.journeys;
        let unknown = ActionError::Unknown {
            kind: "journey",
            number: journey,
        };
        let known = journeys.get(usize::from(journey)).ok_or(unknown)?;
        let all = known.stages.iter().flat_map(|stage| &stage.places);
        let leads_to = |place: u16| {
            let routes = scene.routes.as_ref();
            routes.is_some_and(|routes| routes.leads_to(Destination::Place(place)))
        };
        if !all.copied().all(leads_to) {
            return Err(ActionError::NoMaps(known.name.clone()));
        }
        let found = self.known(agents.iter().copied())?;
        for (&id, agent) in agents.iter().zip(&found) {
            if scene.groups[usize::from(agent.group)].direction.is_some() {
                return Err(ActionError::Directed(id));
            }
            let mut first = known.stages[0].places.iter();
            let is_reached = first.any(|&place| {
                let routes = scene.routes.as_ref();
                routes.is_some_and(|routes| {
                    let to = Destination::Place(place);
                    routes.way(agent.position, to).is_some()
                })
            });
            if !is_reached {
                return Err(ActionError::NoWay {
                    agent: id,
                    from: agent.position,
                    to: format!("the first stage of `{}`", known.name),
                });
            }
        }
        Ok(())
    }
}
