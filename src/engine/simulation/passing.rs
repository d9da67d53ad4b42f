//! Lines that agents cross: waypoints, and exits, where they leave.

use rayon::prelude::*;

use super::{Arrival, Crowd, Simulation, Stage, TripEnd};
use crate::engine::agents::Agents;
use crate::engine::journeys::{Kind, Place, Status};
use crate::engine::math::{Vector, direction, perpendicular};
use crate::engine::neighbors::{BLOCK, TASK};
use crate::engine::scene::Scene;
use crate::engine::ways::{nearest_on, side};

/// Agents that may not pass an exit stop this far before its line, meters.
const STOP_BEFORE: f64 = 1e-3;

/// A move across the line of a place.
#[derive(Clone, Copy)]
struct Crossing {
    agent: usize,
    place: usize,
    line: [Vector; 2],
    /// The part of the move before the line.
    part: f64,
}

/// The surroundings of a line: after a move across the line, an agent is here.
struct Line {
    low: Vector,
    high: Vector,
}

impl Line {
    fn all(scene: &Scene, agents: &Agents) -> Vec<Self> {
        let longest_step = scene.highest_speed(agents) * scene.clock.time_step();
        let margin = Vector::repeat(longest_step * (1.0 + 1e-9));
        let lines = scene.journeys.places.iter().filter_map(Place::line);
        let around = lines.map(|[a, b]| Self {
            low: a.inf(&b) - margin,
            high: a.sup(&b) + margin,
        });
        around.collect()
    }

    #[inline]
    fn is_near(&self, p: Vector) -> bool {
        (p.x >= self.low.x) & (p.x <= self.high.x) & (p.y >= self.low.y) & (p.y <= self.high.y)
    }
}

impl Simulation {
    /// Keeps the positions before a move, for scenes with journeys.
    pub(super) fn keep_positions(&mut self) {
        if !self.fixed.scene.journeys.places.is_empty() {
            let before = &mut self.buffers.before;
            before.clone_from(&self.crowd.agents.position);
        }
    }

    /// Agents that have crossed the line of their place go on to the next stage, or leave if it is an exit. At closed
    /// exits, and at those that as many agents have passed as may, they stop before the line.
    pub(super) fn pass_lines(&mut self) {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        if scene.journeys.places.is_empty() {
            return;
        }
        let before = &self.buffers.before;
        self.stages.time(Stage::Journeys, || {
            let mut crossings = crowd.crossings(scene, before);
            if crowd.clock.is_coarse() {
                crossings.extend(crowd.meetings(scene, &crossings));
            }
            if !crossings.is_empty() {
                crowd.pass(scene, before, &crossings);
            }
        });
    }
}

impl Crowd {
    /// All moves across lines, in the order in which they happened.
    fn crossings(&self, scene: &Scene, before: &[Vector]) -> Vec<Crossing> {
        let lines = Line::all(scene, &self.agents);
        let closed: Vec<u16> = (0..scene.journeys.places.len() as u16)
            .filter(|&place| self.is_closed(scene, place))
            .collect();
        let agents = &self.agents;
        let crossing = |agent: usize| {
            let to = agents.position[agent];
            if !lines.iter().any(|line| line.is_near(to)) {
                return None;
            }
            let trip = agents.trip.get(agent).and_then(Option::as_ref);
            let trip = trip.filter(|trip| trip.status == Status::Walking);
            let own = trip.map_or(&[][..], |trip| {
                let journey = &scene.journeys.journeys[usize::from(trip.journey)];
                &journey.stage(trip.stage).places
            });
            let crossings = own.iter().chain(&closed).filter_map(|&place| {
                let place = usize::from(place);
                let line = scene.journeys.places[place].line()?;
                let part = crossed([before[agent], to], line)?;
                Some(Crossing {
                    agent,
                    place,
                    line,
                    part,
                })
            });
            crossings.min_by(|a, b| a.part.total_cmp(&b.part))
        };
        let all = (0..agents.len()).into_par_iter();
        let mut found: Vec<Crossing> = all
            .with_min_len(TASK * BLOCK)
            .filter_map(crossing)
            .collect();
        let id = |crossing: &Crossing| agents.id[crossing.agent];
        found.sort_by(|a, b| a.part.total_cmp(&b.part).then(id(a).cmp(&id(b))));
        found
    }

    /// Agents that meet another one on the line of their exit, which comes from the other side: neither could cross it.
    /// Both bodies touch the line, and each other. Agents of `passing` cross a line already.
    fn meetings(&self, scene: &Scene, passing: &[Crossing]) -> Vec<Crossing> {
        let agents = &self.agents;
        let touching = |agent: usize| {
            let trip = agents.trip.get(agent)?.as_ref()?;
            let place = usize::from(trip.place);
            let Kind::Exit(exit) = &scene.journeys.places[place].kind else {
                return None;
            };
            let ([a, b], p) = (exit.line, agents.position[agent]);
            let touches = (nearest_on(p, a, b) - p).norm() < agents.radius[agent];
            (touches && trip.status == Status::Walking).then(|| (place, side(a, b, p) > 0.0, agent))
        };
        let all = (0..agents.len()).into_par_iter();
        let all: Vec<(usize, bool, usize)> = all
            .with_min_len(TASK * BLOCK)
            .filter_map(touching)
            .collect();
        let meets = |&(place, is_left, agent): &(usize, bool, usize)| {
            let (p, radius) = (agents.position[agent], agents.radius[agent]);
            all.iter().any(|&(other_place, is_other_left, other)| {
                let gap = (agents.position[other] - p).norm() - radius - agents.radius[other];
                other_place == place && is_other_left != is_left && gap < 0.0
            })
        };
        let is_new = |agent: usize| passing.iter().all(|crossing| crossing.agent != agent);
        let found = all.iter().filter(|one| meets(one) && is_new(one.2));
        let crossing = |&(place, _, agent): &(usize, bool, usize)| Crossing {
            agent,
            place,
            line: scene.journeys.places[place].line().unwrap_or_default(),
            part: 1.0,
        };
        let mut found: Vec<Crossing> = found.map(crossing).collect();
        found.sort_by_key(|crossing| agents.id[crossing.agent]);
        found
    }

    fn is_closed(&self, scene: &Scene, place: u16) -> bool {
        let is_exit = scene.journeys.places[usize::from(place)].is_exit();
        let state = self.progress.places.get(usize::from(place));
        is_exit && state.is_some_and(|state| !state.open)
    }

    fn pass(&mut self, scene: &Scene, before: &[Vector], crossings: &[Crossing]) {
        let mut leaving = Vec::new();
        for crossing in crossings {
            let i = crossing.agent;
            let Kind::Exit(exit) = &scene.journeys.places[crossing.place].kind else {
                self.take_place(i, crossing.place);
                self.go_on(scene, i);
                continue;
            };
            let now = self.clock.time();
            let state = &mut self.progress.places[crossing.place];
            if !state.open || now < state.ready {
                self.hold_back(before[i], crossing);
                continue;
            }
            if let Some(rate) = exit.most_per_sec {
                // What a frame is too late is not lost.
                state.ready = state.ready.max(now - self.clock.time_step()) + 1.0 / rate;
            }
            self.take_place(i, crossing.place);
            leaving.push(i);
        }
        self.leave(scene, leaving);
    }

    /// Agent `i` passes a place of its stage, perhaps not the one that it had chosen.
    fn take_place(&mut self, i: usize, place: usize) {
        if let Some(trip) = &mut self.agents.trip[i] {
            let bound = &mut self.progress.places[usize::from(trip.place)].bound;
            *bound = bound.saturating_sub(1);
            self.progress.places[place].bound += 1;
            trip.place = place as u16;
        }
    }

    /// Stops an agent before a line.
    fn hold_back(&mut self, from: Vector, crossing: &Crossing) {
        let (position, velocity) = (
            &mut self.agents.position[crossing.agent],
            &mut self.agents.velocity[crossing.agent],
        );
        let way = *position - from;
        let length = way.norm();
        let [a, b] = crossing.line;
        let across = perpendicular(direction(b - a));
        let across = if across.dot(&way) > 0.0 {
            across
        } else {
            -across
        };
        let kept = (crossing.part * length - STOP_BEFORE).max(0.0);
        *position = from + direction(way) * kept;
        *velocity -= across * velocity.dot(&across).max(0.0);
    }

    fn leave(&mut self, scene: &Scene, leaving: Vec<usize>) {
        if leaving.is_empty() {
            return;
        }
        let mut stays = vec![true; self.agents.len()];
        for i in leaving {
            stays[i] = false;
            let Some(trip) = self.agents.trip[i] else {
                continue;
            };
            let state = &mut self.progress.places[usize::from(trip.place)];
            state.pass(&self.clock, scene);
            let group = usize::from(self.agents.group[i]);
            self.outcome.arrivals.push(Arrival {
                id: self.agents.id[i],
                time: self.clock.time(),
                position: self.agents.position[i],
                counted: scene.groups[group].counted,
                trip: Some(TripEnd {
                    journey: trip.journey,
                    exit: trip.place,
                    entered: trip.entered,
                    waited: trip.waited,
                }),
            });
        }
        let staying = (0..stays.len() as u32).filter(|&i| stays[i as usize]);
        self.agents.arrange(&staying.collect::<Vec<_>>());
        self.changed = true;
    }
}

/// The part of a move after which it crosses a line; `None` if it does not.
fn crossed([from, to]: [Vector; 2], [a, b]: [Vector; 2]) -> Option<f64> {
    let [start, end] = [from, to].map(|p| side(a, b, p));
    let [left, right] = [a, b].map(|p| side(from, to, p));
    let crosses = (start > 0.0) != (end > 0.0) && (left > 0.0) != (right > 0.0);
    crosses.then(|| start / (start - end))
}
