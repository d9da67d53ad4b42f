//! Lines that agents cross: waypoints, and exits, where they leave.
//!
//! An agent that has crossed the line of an exit has left: it counts as arrived, and is no longer present. Its body
//! walks on for [`WALKS_ON`] meters, and all forces still act on it and come from it. Without the body, agents before
//! the line would walk into the gap that it leaves, and the flow through a door would be higher the nearer the line is
//! to it.

use rayon::prelude::*;

use super::{Arrival, Crowd, Simulation, Stage, TripEnd};
use crate::journeys::{Kind, Place, Status};
use crate::math::{Vector, direction, perpendicular};
use crate::neighbors::{BLOCK, Neighbors, TASK};
use crate::routes::{nearest_on, side};
use crate::scene::Scene;

/// The body of an agent that has left by an exit walks on this far behind the line, meters. With less, the flow through
/// a door would depend on the position of the line, because agents walk slower behind a crowd than with free floor
/// ahead.
pub const WALKS_ON: f64 = 6.0;
/// The walk ends this far before a wall, meters, so that no body is stopped there.
pub const BEFORE_WALLS: f64 = 1.0;
/// The goal of the body is this far behind the end of its way, meters.
const GOAL_BEHIND: f64 = 5.0;
/// Agents this near to a line stand on it, meters: more than rounding, less than where closed exits stop agents.
const ON_LINE: f64 = 1e-6;
/// A body that has not reached the end of its way is removed after this time, seconds.
const OUTSIDE_SECS: f64 = 30.0;

/// A move across the line of a place.
#[derive(Clone, Copy)]
pub(super) struct Crossing {
    pub(super) agent: usize,
    place: usize,
    pub(super) line: [Vector; 2],
    /// The fraction of the move before the line.
    pub(super) part: f64,
    /// Whether the agent has not crossed the line, but met another agent on it.
    met: bool,
}

/// The surroundings of a line: after a move across the line, an agent is here.
struct Line {
    low: Vector,
    high: Vector,
}

impl Line {
    fn all(scene: &Scene, longest_step: f64) -> Vec<Self> {
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
    /// exits, and at exits that have reached their limit per second, they stop before the line.
    pub(super) fn pass_lines(&mut self) {
        let (fixed, crowd) = (&self.fixed, &mut self.crowd);
        let scene = &fixed.scene;
        if scene.journeys.places.is_empty() {
            return;
        }
        let before = &self.buffers.before;
        self.stages.time(Stage::Journeys, || {
            let neighbors = &self.derived.neighbors;
            let near = crowd.near_lines(scene, neighbors);
            let mut crossings = crowd.crossings(scene, before, &near);
            if crowd.clock.is_coarse() {
                crossings.extend(crowd.meetings(scene, &crossings));
            }
            let leaving = crowd.pass(scene, before, &crossings);
            for crossing in &crossings {
                fixed.fit_states(&mut crowd.agents, crossing.agent);
            }
            crowd.pass_doors(scene, before, &near);
            crowd.leave(scene, leaving);
            if crowd.progress.outside > 0 {
                crowd.remove_bodies(scene);
            }
        });
    }
}

impl Crowd {
    /// The agents that a move across a line may have brought where they are.
    fn near_lines(&self, scene: &Scene, neighbors: &Neighbors) -> Vec<usize> {
        let positions = &self.agents.position;
        let mut near: Vec<u32> = Vec::new();
        for line in Line::all(scene, neighbors.longest_step()) {
            let runs = neighbors.in_rectangle([line.low, line.high]);
            let agents = runs.into_iter().flat_map(|run| run.agents);
            near.extend(agents.filter(|&i| line.is_near(positions[i as usize])));
        }
        near.sort_unstable();
        near.dedup(); // near two lines
        near.into_iter().map(|agent| agent as usize).collect()
    }

    /// All moves across lines by agents of `near`, in the order in which they happened.
    fn crossings(&self, scene: &Scene, before: &[Vector], near: &[usize]) -> Vec<Crossing> {
        let closed: Vec<u16> = (0..scene.journeys.places.len() as u16)
            .filter(|&place| self.is_closed(scene, place))
            .collect();
        let agents = &self.agents;
        let crossing = |agent: usize| {
            let to = agents.position[agent];
            let trip = agents.trip.get(agent).and_then(Option::as_ref);
            let trip = trip.filter(|trip| trip.status == Status::Walking);
            let own = trip.into_iter().flat_map(|trip| {
                let journey = &scene.journeys.journeys[usize::from(trip.journey)];
                let stage = journey.stage(trip.stage);
                stage.passed(trip.place, &scene.journeys.places)
            });
            let closed = closed.iter().copied();
            let all = own.map(|place| (place, false));
            let all = all.chain(closed.map(|place| (place, true)));
            let crossings = all.filter_map(|(place, is_closed)| {
                let place = usize::from(place);
                let line = scene.journeys.places[place].line()?;
                let part = match is_closed && is_on(before[agent], line) {
                    true => leaves([to, agents.goal[agent]], line).then_some(0.0)?,
                    false => crossed([before[agent], to], line)?,
                };
                if self.lets_pass(scene, place, side(line[0], line[1], before[agent])) {
                    return None;
                }
                Some(Crossing {
                    agent,
                    place,
                    line,
                    part,
                    met: false,
                })
            });
            crossings.min_by(|a, b| a.part.total_cmp(&b.part))
        };
        let mut found: Vec<Crossing> = near.iter().copied().filter_map(crossing).collect();
        let id = |crossing: &Crossing| agents.id[crossing.agent];
        found.sort_by(|a, b| a.part.total_cmp(&b.part).then(id(a).cmp(&id(b))));
        found
    }

    /// Agents that cannot cross the line of their place: those that stand on it, and those that meet an agent from the
    /// other side on the line of their exit, where both bodies touch the line and each other. The agents of `passing`
    /// cross a line in this frame and are already behind it, so agents that follow them do not count as meeting them.
    fn meetings(&self, scene: &Scene, passing: &[Crossing]) -> Vec<Crossing> {
        let agents = &self.agents;
        let touching = |agent: usize| {
            let trip = agents.trip.get(agent)?.as_ref()?;
            let number = usize::from(trip.place);
            let place = &scene.journeys.places[number];
            let is_open = self.progress.places[number].open;
            let ([a, b], p) = (place.line()?, agents.position[agent]);
            let walks_from = agents.walks_from.get(agent).copied().unwrap_or(0.0);
            let stands = is_open && walks_from <= self.clock.time() && is_on(p, [a, b]);
            let touches = (nearest_on(p, a, b) - p).norm() < agents.radius[agent];
            let meets = stands || (touches && place.is_exit());
            let is_left = (!stands).then(|| side(a, b, p) > 0.0);
            (meets && trip.status == Status::Walking).then_some((number, is_left, agent))
        };
        let all = (0..agents.len()).into_par_iter();
        let is_new = |&agent: &usize| passing.iter().all(|crossing| crossing.agent != agent);
        let all: Vec<(usize, Option<bool>, usize)> = all
            .with_min_len(TASK * BLOCK)
            .filter(is_new)
            .filter_map(touching)
            .collect();
        // `None`: it stands on the line.
        let meets = |&(place, is_left, agent): &(usize, Option<bool>, usize)| {
            let (p, radius) = (agents.position[agent], agents.radius[agent]);
            let mut others = all.iter();
            is_left.is_none()
                || others.any(|&(other_place, is_other_left, other)| {
                    let gap = (agents.position[other] - p).norm() - radius - agents.radius[other];
                    other_place == place && is_other_left != is_left && gap < 0.0
                })
        };
        let found = all.iter().filter(|one| meets(one));
        let crossing = |&(place, _, agent): &(usize, Option<bool>, usize)| Crossing {
            agent,
            place,
            line: scene.journeys.places[place].line().unwrap_or_default(),
            part: 1.0,
            met: true,
        };
        let mut found: Vec<Crossing> = found.map(crossing).collect();
        found.sort_by_key(|crossing| agents.id[crossing.agent]);
        found
    }

    /// Agents go on that cross the lines of their places, or are held back. Returns those that leave, each with the
    /// direction in which its body walks on.
    fn pass(
        &mut self,
        scene: &Scene,
        before: &[Vector],
        crossings: &[Crossing],
    ) -> Vec<(usize, Option<Vector>)> {
        let mut leaving = Vec::new();
        for crossing in crossings {
            let i = crossing.agent;
            let kind = &scene.journeys.places[crossing.place].kind;
            if matches!(kind, Kind::Door(_)) {
                self.hold_back(scene, before[i], crossing);
                continue;
            }
            let Kind::Exit(exit) = kind else {
                self.take_place(i, crossing.place);
                self.go_on(scene, i);
                continue;
            };
            let now = self.clock.time();
            let state = &mut self.progress.places[crossing.place];
            if !state.open || now < state.ready {
                self.hold_back(scene, before[i], crossing);
                continue;
            }
            if let Some(rate) = exit.most_per_sec {
                // The delay to the next frame does not reduce the rate.
                state.ready = state.ready.max(now - self.clock.time_step()) + 1.0 / rate;
            }
            self.take_place(i, crossing.place);
            let way = (!crossing.met).then(|| self.agents.position[i] - before[i]);
            leaving.push((i, way.map(|way| across(crossing.line, way))));
        }
        leaving
    }

    /// Agent `i` passes a place of its stage, which may differ from the one that it chose.
    fn take_place(&mut self, i: usize, place: usize) {
        if let Some(trip) = &mut self.agents.trip[i] {
            let places = &mut self.progress.places;
            places[usize::from(trip.place)].count(None, false);
            places[place].count(None, true);
            trip.place = place as u16;
        }
    }

    /// Agents leave; the bodies of those with a direction in which they crossed the line walk on.
    fn leave(&mut self, scene: &Scene, leaving: Vec<(usize, Option<Vector>)>) {
        let mut gone = Vec::new();
        for (i, way) in leaving {
            let Some(trip) = self.agents.trip[i] else {
                continue;
            };
            let state = &mut self.progress.places[usize::from(trip.place)];
            state.pass(self.agents.id[i]);
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
            let room = way.map_or(0.0, |way| room_ahead(scene, self.agents.position[i], way));
            match way.filter(|_| room > 0.0) {
                Some(way) => self.walk_on(i, way * (room + GOAL_BEHIND)),
                None => gone.push(i),
            }
        }
        self.remove(&gone);
    }

    /// The body of agent `i`, which has left, walks on.
    fn walk_on(&mut self, i: usize, way: Vector) {
        let until = self.clock.coarse_frame_at(self.clock.time() + OUTSIDE_SECS);
        if let Some(trip) = &mut self.agents.trip[i] {
            trip.status = Status::Outside { until };
            trip.hold = None;
            trip.chooses_at = u64::MAX;
            self.progress.outside += 1;
        }
        self.agents.goal[i] = self.agents.position[i] + way;
        self.agents.forget_route(i);
    }

    /// Removes the bodies of agents that have left: at the ends of their routes, after [`OUTSIDE_SECS`], and, in coarse
    /// frames, where they meet an agent that is present and ahead of them.
    fn remove_bodies(&mut self, scene: &Scene) {
        let outside = (0..self.agents.len()).filter(|&i| !self.agents.is_present(i));
        let outside: Vec<usize> = outside.collect();
        let is_gone = |&i: &usize| {
            let Some(trip) = &self.agents.trip[i] else {
                return true;
            };
            let Some(line) = scene.journeys.places[usize::from(trip.place)].line() else {
                return true;
            };
            let ahead = self.agents.goal[i] - self.agents.position[i];
            let way = across(line, ahead);
            let is_late =
                matches!(trip.status, Status::Outside { until } if until <= self.clock.frame());
            is_late || ahead.dot(&way) <= GOAL_BEHIND || self.meets_anyone(i, way)
        };
        let gone: Vec<usize> = outside.into_iter().filter(is_gone).collect();
        self.progress.outside -= gone.len() as u32;
        self.remove(&gone);
    }

    /// Whether the body of agent `i` touches an agent that is present and ahead of it.
    fn meets_anyone(&self, i: usize, way: Vector) -> bool {
        let agents = &self.agents;
        let (p, radius) = (agents.position[i], agents.radius[i]);
        let meets = |j: usize| {
            let to = agents.position[j] - p;
            let reach = radius + agents.radius[j];
            to.norm_squared() < reach * reach && to.dot(&way) > 0.0 && agents.is_present(j)
        };
        self.clock.is_coarse() && (0..agents.len()).any(meets)
    }

    pub(super) fn remove(&mut self, gone: &[usize]) {
        if gone.is_empty() {
            return;
        }
        let mut stays = vec![true; self.agents.len()];
        for &i in gone {
            stays[i] = false;
        }
        let staying = (0..stays.len() as u32).filter(|&i| stays[i as usize]);
        self.agents.arrange(&staying.collect::<Vec<_>>());
        self.changed = true;
    }
}

/// The direction across a line on the side to which `way` leads, of length 1.
pub(super) fn across([a, b]: [Vector; 2], way: Vector) -> Vector {
    let across = perpendicular(direction(b - a));
    if across.dot(&way) > 0.0 {
        across
    } else {
        -across
    }
}

/// The distance that a body can walk on from `p` in the direction `way`, meters.
fn room_ahead(scene: &Scene, p: Vector, way: Vector) -> f64 {
    let length = WALKS_ON + BEFORE_WALLS;
    let end = p + way * length;
    let near = scene.walls.near_any(&[p, end], 0.0);
    let part = scene.walls.first_crossing(p, end, &near);
    part.map_or(WALKS_ON, |(part, _)| part * length - BEFORE_WALLS)
}

/// Whether an agent at `p` stands on a line.
fn is_on(p: Vector, [a, b]: [Vector; 2]) -> bool {
    (nearest_on(p, a, b) - p).norm() < ON_LINE
}

/// Whether an agent that stood on a closed line, as after entering there, has moved away from its goal.
fn leaves([to, goal]: [Vector; 2], [a, b]: [Vector; 2]) -> bool {
    is_on(goal, [a, b]) || (side(a, b, to) > 0.0) != (side(a, b, goal) > 0.0)
}

/// The fraction of a move after which it crosses a line; `None` if it does not.
pub(super) fn crossed([from, to]: [Vector; 2], [a, b]: [Vector; 2]) -> Option<f64> {
    let [start, end] = [from, to].map(|p| side(a, b, p));
    let [left, right] = [a, b].map(|p| side(from, to, p));
    let crosses = (start > 0.0) != (end > 0.0) && (left > 0.0) != (right > 0.0);
    crosses.then(|| start / (start - end))
}
