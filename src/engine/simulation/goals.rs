//! New goals: path maps to them, and the journeys that agents abandon for them.

use std::sync::Arc;

use super::{Crowd, Simulation};
use crate::journeys::Status;
use crate::math::Vector;
use crate::routes::{Destination, Routes};
use crate::scene::Scene;

impl Simulation {
    /// If the scene has no routes, goals and agents from outside follow these. They have no effect on others.
    pub fn set_later_routes(&mut self, routes: Routes) {
        if self.lacks_later_routes() {
            Arc::make_mut(&mut self.fixed).scene.later_routes = Some(Arc::new(routes));
        }
    }

    /// Whether the scene has no routes, not even for goals and agents from outside.
    pub fn lacks_later_routes(&self) -> bool {
        self.fixed.scene.routes.is_none() && self.fixed.scene.later_routes.is_none()
    }

    pub(super) fn take_later_routes(&mut self) {
        if self.fixed.scene.routes.is_none() && self.fixed.scene.later_routes.is_some() {
            let scene = &mut Arc::make_mut(&mut self.fixed).scene;
            scene.routes = scene.later_routes.clone();
        }
    }

    /// Makes path maps to goals of several agents and to those behind walls, for agents by index. If there are too
    /// many, agents walk straight to the others.
    pub(super) fn map_goals(&mut self, new: &[(usize, Vector)]) {
        let mut last = None;
        for &(i, goal) in new {
            let scene = &self.fixed.scene;
            let is_shared = last.replace(goal) == Some(goal);
            let Some(routes) = &scene.routes else {
                return;
            };
            let is_needed = || is_shared || self.is_hidden(self.crowd.agents.position[i], goal);
            if routes.leads_to(Destination::Goal(goal)) || !is_needed() {
                continue;
            }
            let agents = &self.crowd.agents;
            let is_used = |other| {
                let mut new = new.iter();
                agents.goal.contains(&other) || new.any(|&(_, goal)| goal == other)
            };
            let fixed = Arc::make_mut(&mut self.fixed);
            if let Some(routes) = fixed.scene.routes.as_mut().map(Arc::make_mut) {
                // Whether the goal is on the floor, and how many there are, was checked.
                let _ = routes.add_goal(goal, is_used);
            }
        }
    }

    /// Whether a wall stands between two points.
    pub(super) fn is_hidden(&self, from: Vector, to: Vector) -> bool {
        let walls = &self.fixed.scene.walls;
        let near = walls.near_any(&[from, to], 0.0);
        walls.first_crossing(from, to, &near).is_some()
    }
}

impl Crowd {
    /// Agent `i` abandons its journey: its place in a queue or waiting area becomes free.
    pub(super) fn leave_journey(&mut self, scene: &Scene, i: usize) {
        let trip = self.agents.trip.get(i).copied().flatten();
        if let (None, Some(journey)) = (trip, self.journey(scene, i)) {
            // It entered since the last coarse frame.
            self.agents.trip.resize(self.agents.len(), None);
            self.begin(scene, i, journey);
        }
        let Some(trip) = self.agents.trip.get(i).copied().flatten() else {
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
