//! New goals for agents, set from outside between two frames.

use std::collections::HashSet;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::{Crowd, Simulation};
use crate::journeys::Status;
use crate::math::Vector;
use crate::routes::{Destination, Routes, WayError};
use crate::scene::Scene;

/// An agent is not present.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Absent {
    /// Seconds.
    time: f64,
    /// The number of agents that have entered, if this agent has not.
    entered: Option<u32>,
}

impl std::fmt::Display for Absent {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "not present at {:.2} s: ", self.time)?;
        match self.entered {
            Some(entered) => write!(f, "only {entered} agents have entered, with ids from 0"),
            None => f.write_str("it has left"),
        }
    }
}

/// Why an agent cannot get a goal.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GoalError {
    /// There is no such agent.
    #[error("agent {0}: {1}")]
    Absent(u32, Absent),
    /// The agent's group walks in a direction.
    #[error("agent {0} walks in a direction, not to a point")]
    Directed(u32),
    /// The goal is not in the walkable area.
    #[error(
        "({}, {}) lies in an obstacle or outside of the walkable area; give a goal on the floor",
        .0.x, .0.y
    )]
    NotOnFloor(Vector),
    /// Walls close the goal off.
    #[error(
        "no way leads from agent {agent} at ({:.2}, {:.2}) to ({}, {}); give a goal that it can reach",
        from.x, from.y, goal.x, goal.y
    )]
    NoWay {
        /// The agent's id.
        agent: u32,
        /// Its position, meters.
        from: Vector,
        /// The goal, meters.
        goal: Vector,
    },
    /// No path map can be made.
    #[error(transparent)]
    Way(#[from] WayError),
}

/// A goal that an agent gets at the beginning of a frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct NewGoal {
    frame: u64,
    id: u32,
    /// Meters.
    goal: Vector,
}

impl NewGoal {
    pub(super) fn is_finite(&self) -> bool {
        self.goal.x.is_finite() && self.goal.y.is_finite()
    }
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

    /// Gives agents, by id, new goals in meters. They walk there from the next evaluated frame on, around walls if the
    /// scene has path maps. An agent on a journey abandons it and stays at its goal. Other agents leave at their goal
    /// if their group does. Agents that leave before that frame are left alone.
    ///
    /// # Errors
    /// An agent is absent or walks in a direction, or a goal is not on the floor or cannot be reached. Then no agent
    /// gets a new goal.
    pub fn set_goals(&mut self, new: &[(u32, Vector)]) -> Result<(), GoalError> {
        let indexed = self.indexed(new)?;
        let ids: HashSet<u32> = new.iter().map(|&(id, _)| id).collect();
        self.find_routes(&indexed, &ids)?;
        let frame = self.crowd.clock.frame() + u64::from(self.derived.evaluated);
        let waiting = &mut self.crowd.new_goals;
        waiting.retain(|old| !ids.contains(&old.id));
        waiting.extend(new.iter().map(|&(id, goal)| NewGoal { frame, id, goal }));
        Ok(())
    }

    /// Gives agents the new goals of this frame.
    pub(super) fn take_goals(&mut self) {
        let frame = self.crowd.clock.frame();
        let is_due = |new: &mut NewGoal| new.frame <= frame;
        let due: Vec<NewGoal> = self.crowd.new_goals.extract_if(.., is_due).collect();
        for NewGoal { id, goal, .. } in due {
            let Some(i) = self.crowd.agents.index_of(id) else {
                continue;
            };
            self.crowd.leave_journey(&self.fixed.scene, i);
            let agents = &mut self.crowd.agents;
            agents.goal[i] = goal;
            agents.forget_route(i);
        }
    }

    /// From now on, agents find their routes on this floor. No effect if the scene has path maps already.
    pub fn add_routes(&mut self, routes: Routes) {
        if self.fixed.scene.routes.is_none() {
            Arc::make_mut(&mut self.fixed).scene.routes = Some(Arc::new(routes));
        }
    }

    /// The indices of the agents, with their new goals.
    fn indexed(&self, new: &[(u32, Vector)]) -> Result<Vec<(usize, Vector)>, GoalError> {
        let (scene, agents) = (&self.fixed.scene, &self.crowd.agents);
        let mut places = vec![None; agents.entered() as usize];
        for (i, &id) in agents.id.iter().enumerate() {
            places[id as usize] = Some(i);
        }
        let mut last = None;
        let indexed = new.iter().map(|&(id, goal)| {
            let place = places.get(id as usize).copied().flatten();
            let i = place.ok_or_else(|| GoalError::Absent(id, self.absent(id)))?;
            let group = &scene.groups[usize::from(agents.group[i])];
            if group.direction.is_some() {
                return Err(GoalError::Directed(id));
            }
            let is_checked = last.replace(goal) == Some(goal);
            let is_number = goal.x.is_finite() && goal.y.is_finite();
            if !is_checked && (!is_number || scene.walls.obstacle_at(goal).is_some()) {
                return Err(GoalError::NotOnFloor(goal));
            }
            Ok((i, goal))
        });
        indexed.collect()
    }

    /// Makes path maps to goals of several agents, and to those behind walls, for agents with these ids.
    fn find_routes(
        &mut self,
        new: &[(usize, Vector)],
        ids: &HashSet<u32>,
    ) -> Result<(), GoalError> {
        let agents = &self.crowd.agents;
        let mut last = None;
        for &(i, goal) in new {
            let scene = &self.fixed.scene;
            let Some(routes) = &scene.routes else {
                return Ok(());
            };
            let to = Destination::Goal(goal);
            let is_shared = last.replace(goal) == Some(goal);
            let position = agents.position[i];
            let is_blocked = || {
                let near = scene.walls.near_any(&[position, goal], 0.0);
                let crossing = scene.walls.first_crossing(position, goal, &near);
                crossing.is_some()
            };
            if !routes.leads_to(to) {
                if !is_shared && !is_blocked() {
                    continue;
                }
                let is_new = |other| {
                    let waiting = self.crowd.new_goals.iter();
                    let waiting = waiting
                        .filter(|old| !ids.contains(&old.id))
                        .map(|old| old.goal);
                    let new = new.iter().map(|&(_, goal)| goal);
                    waiting.chain(new).any(|goal| goal == other)
                };
                let is_used = |other| agents.goal.contains(&other) || is_new(other);
                let fixed = Arc::make_mut(&mut self.fixed);
                let routes = fixed.scene.routes.as_mut().map(Arc::make_mut);
                let made = routes.map_or(Ok(()), |routes| routes.add_goal(goal, is_used));
                made.map_err(|error| match error {
                    WayError::NotOnFloor(_) => GoalError::NotOnFloor(goal),
                    error => error.into(),
                })?;
            }
            let routes = self.fixed.scene.routes.as_ref();
            if routes.is_some_and(|routes| routes.way(position, to).is_none()) {
                return Err(GoalError::NoWay {
                    agent: agents.id[i],
                    from: position,
                    goal,
                });
            }
        }
        Ok(())
    }
}

impl Crowd {
    /// Agent `i` abandons its journey: its place in a queue or waiting area becomes free.
    fn leave_journey(&mut self, scene: &Scene, i: usize) {
        if self.journey(scene, i).is_none() {
            return;
        }
        self.agents.trip.resize(self.agents.len(), None);
        if self.agents.trip[i].is_none() {
            // It entered since the last coarse frame.
            self.begin(scene, i);
        }
        let Some(trip) = self.agents.trip[i] else {
            return;
        };
        let state = &mut self.progress.places[usize::from(trip.place)];
        match trip.status {
            Status::Walking => {}
            Status::Waiting { spot, since, .. } => {
                state.leave_spot(spot);
                self.count_wait(i, since);
            }
            Status::Queued { ticket, since, .. } => {
                self.count_wait(i, since);
                self.close_ranks(trip.place, ticket);
            }
            Status::Finished | Status::Outside { .. } => {}
        }
        if trip.status != Status::Finished {
            self.progress.places[usize::from(trip.place)].count(None, false);
        }
        if let Some(trip) = &mut self.agents.trip[i] {
            trip.status = Status::Finished;
            trip.hold = None;
            trip.chooses_at = u64::MAX;
        }
    }

    /// The agents behind a ticket of a queue move up by one.
    fn close_ranks(&mut self, queue: u16, gone: u32) {
        for trip in self.agents.trip.iter_mut().flatten() {
            if let Status::Queued { ticket, .. } = &mut trip.status
                && trip.place == queue
                && *ticket > gone
            {
                *ticket -= 1;
            }
        }
        let tickets = &mut self.progress.places[usize::from(queue)].tickets;
        *tickets = tickets.saturating_sub(1);
    }
}
