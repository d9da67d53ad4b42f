//! Ways by time: in coarse frames agents that enter a room, and now and then all others, compare its openings.
//!
//! An agent expects to pass an opening when it has walked there, or when all agents that are bound for it and nearer
//! have passed at its flow, whichever is later. Beyond it, the least time to the goal is that of Dijkstra's algorithm
//! over openings, which runs once per second for each goal. Agents follow the path map of their goal as long as its
//! way leads through the opening that they have chosen.

use rand::Rng;
use rayon::prelude::*;

use super::bound::{self, Stream};
use super::{Crowd, Progress, Simulation, Stage};
use crate::engine::journeys::Status;
use crate::engine::math::Vector;
use crate::engine::neighbors::{BLOCK, TASK};
use crate::engine::random::{self, Purpose};
use crate::engine::scene::{Knowledge, Scene};
use crate::engine::ways::{Destination, Plan, Rooms, Step, Ways};

/// Agents compare their ways again after a random time in this range, seconds.
const AGAIN: [f64; 2] = [2.0, 5.0];
/// An agent changes to another opening if that saves at least this time, seconds, and this part of the time.
const LEAST_GAIN: f64 = 1.0;
const LEAST_SHARE: f64 = 0.1;
/// Waiting before a closed door is expected to take this long, seconds.
const CLOSED: f64 = 3600.0;

/// The times that agents expect.
pub(super) struct Times<'a> {
    pub rooms: &'a Rooms,
    pub scene: &'a Scene,
    pub progress: &'a Progress,
    /// The flow that follows from the width of an opening, P/(m s).
    pub per_meter: f64,
}

/// A way out of a room, or to a goal in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outlook {
    /// The step by which it leaves the room; `None`: the goal is there.
    pub step: Option<Step>,
    /// The length of the way to the opening, or to the goal, meters.
    pub length: f64,
    /// Agents bound for the opening that are nearer to it.
    pub ahead: u32,
    /// Its flow, P/s; infinite at the goal.
    pub flow: f64,
    /// The time until the agent has passed the opening, seconds.
    pub until_through: f64,
    /// The time to the goal, seconds.
    pub total: f64,
}

/// The ways that an agent compares.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Its plan.
    pub plan: Plan,
    /// The step by which the shortest way leaves the room; `None`: the goal is there.
    pub shortest: Option<Step>,
    /// The ways.
    pub outlooks: Vec<Outlook>,
}

/// A way through an opening goes on from a point this far behind it, meters.
const BEYOND: f64 = 1e-3;

impl Times<'_> {
    /// The flow of a step, P/s.
    pub fn flow(&self, step: Step) -> f64 {
        let expected = self.per_meter * self.rooms.opening(step).width();
        let stream = self.progress.steps.get(step as usize);
        stream.map_or(expected, |stream| stream.flow(expected))
    }

    /// The time to walk `length` meters and pass the opening of a step (`None`: to arrive), seconds. `sees`: knowing
    /// who waits there.
    fn leg(&self, step: Option<Step>, length: f64, (speed, sees): (f64, bool)) -> f64 {
        let walking = length / speed;
        let Some(step) = step else {
            return walking;
        };
        let door = self.rooms.opening(step).door();
        let state = door.and_then(|door| self.progress.places.get(usize::from(door)));
        let closed = if state.is_some_and(|state| !state.open) {
            CLOSED
        } else {
            0.0
        };
        let waiting = match self.progress.steps.get(step as usize) {
            Some(stream) if sees && self.scene.by_time() => {
                f64::from(stream.nearer_than(length)) / self.flow(step)
            }
            _ => 0.0,
        };
        walking.max(waiting) + closed
    }

    /// The least times from each step to a goal, seconds, for agents that walk at the scene's speed.
    fn onward(&self, goal: usize) -> Vec<f64> {
        let sees = self.scene.routing.knowledge == Knowledge::Floor;
        let speed = self.scene.preferred_speed.max(SLOWEST);
        let leg = |step, length| self.leg(step, length, (speed, sees));
        self.rooms.onward(goal, leg)
    }

    /// The ways out of the room of `p`, in triangle `t`, that lead to a goal; `onward` are the times beyond.
    pub fn outlooks(
        &self,
        (p, t): (Vector, u32),
        goal: usize,
        onward: &[f64],
        speed: f64,
    ) -> Vec<Outlook> {
        let speed = speed.max(SLOWEST);
        let direct = self.rooms.length_to_goal(p, t, goal).map(|length| Outlook {
            step: None,
            length,
            ahead: 0,
            flow: f64::INFINITY,
            until_through: length / speed,
            total: length / speed,
        });
        let steps = self.rooms.steps_out(self.rooms.room(t)).iter();
        let through = steps.filter_map(|&step| {
            let onward = onward.get(step as usize).filter(|time| time.is_finite())?;
            let length = self.rooms.length_to(p, t, step)?;
            let until_through = self.leg(Some(step), length, (speed, true));
            let stream = self.progress.steps.get(step as usize);
            Some(Outlook {
                step: Some(step),
                length,
                ahead: stream.map_or(0, |stream| stream.nearer_than(length)),
                flow: self.flow(step),
                until_through,
                total: until_through + onward,
            })
        });
        direct.into_iter().chain(through).collect()
    }
}

/// Slower agents are expected to walk at this speed, m/s.
const SLOWEST: f64 = 0.05;

/// Whether a way that takes `new` seconds is so much quicker than one that takes `old` that an agent changes to it.
pub(super) fn is_clearly_quicker(new: f64, old: f64) -> bool {
    new < old - LEAST_GAIN.max(LEAST_SHARE * old)
}

/// An agent that is due.
struct Due {
    agent: usize,
    /// Where it was and where it is.
    triangles: [Option<u32>; 2],
    goal: u16,
}

impl Simulation {
    /// In coarse frames: agents that choose their ways by time compare them.
    pub(super) fn follow_plans(&mut self) {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        let Some(ways) = &scene.ways else {
            return;
        };
        if ways.rooms.is_none() || !crowd.decides() {
            return;
        }
        self.stages.time(Stage::Ways, || {
            if scene.journeys.journeys.is_empty() {
                bound::count(crowd, scene);
            }
            crowd.compare_ways(scene, ways);
        });
    }

    /// The plan of agent `i`, and the ways that it compares; `None` if it does not choose between ways.
    pub fn comparison(&self, i: usize) -> Option<Comparison> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let plan = crowd.agents.plan.get(i).copied().flatten()?;
        let ways = scene.ways.as_ref()?;
        let p = crowd.agents.position[i];
        let points = ways.course(p, crowd.agents.destination(i));
        Some(Comparison {
            plan,
            shortest: scene.rooms()?.first_on(p, plan.triangle, &points),
            outlooks: crowd.outlooks_of(scene, i, plan.goal, plan.triangle),
        })
    }

    /// The points of the way from `p` that takes the least time now, meters: its corners, the places where it crosses
    /// openings, and its end. The shortest way if agents do not choose by time.
    pub fn course(&self, p: Vector, to: Destination) -> Vec<Vector> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let Some(ways) = &scene.ways else {
            return Vec::new();
        };
        let known = (crowd.times(scene), ways.map_to(to));
        let (Some(times), Some(goal)) = known else {
            return ways.course(p, to);
        };
        let (rooms, goal) = (times.rooms, usize::from(goal));
        let onward = times.onward(goal);
        let (mut points, mut here) = (Vec::new(), p);
        for _ in 0..=rooms.steps() {
            let Some(t) = rooms.floor.locate(here).or_else(|| rooms.floor.nearest(here)) else {
                break;
            };
            let all = times.outlooks((here, t), goal, &onward, scene.preferred_speed);
            let Some(best) = all.into_iter().min_by(|a, b| a.total.total_cmp(&b.total)) else {
                break;
            };
            let shortest = ways.course(here, to);
            if rooms.first_on(here, t, &shortest) == best.step && best.step.is_none() {
                points.extend(shortest);
                break;
            }
            points.extend(rooms.course((here, t), goal, best.step));
            let Some((step, &end)) = best.step.zip(points.last()) else {
                break;
            };
            here = end + rooms.ahead(step) * BEYOND;
        }
        points
    }

    /// The waiting time before each opening, seconds: that of an agent that comes last, beyond its walk. One for each
    /// opening of the scene's rooms, the longer one of both directions.
    pub fn waits(&self) -> Vec<f64> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let Some(times) = crowd.times(scene) else {
            return Vec::new();
        };
        let wait = |step: Step| {
            let stream = crowd.progress.steps.get(step as usize);
            stream.map_or(0.0, |stream| f64::from(stream.bound()) / times.flow(step))
        };
        let openings = 0..times.rooms.openings().len() as Step;
        openings.map(|k| wait(2 * k).max(wait(2 * k + 1))).collect()
    }
}

impl Crowd {
    fn compare_ways(&mut self, scene: &Scene, ways: &Ways) {
        let Some(rooms) = &ways.rooms else {
            return;
        };
        let progress = &mut self.progress;
        progress.steps.resize_with(rooms.steps() as usize, Stream::default);
        progress.onward.resize(rooms.goals(), Vec::new());
        let due = self.due(ways, rooms);
        if bound::is_due(&self.clock) {
            let known = (0..rooms.goals()).into_par_iter().map(|goal| {
                let is_used = !self.progress.onward[goal].is_empty();
                self.times(scene).filter(|_| is_used).map(|times| times.onward(goal))
            });
            let known: Vec<Option<Vec<f64>>> = known.collect();
            self.progress.onward = known.into_iter().map(Option::unwrap_or_default).collect();
        }
        for due in due {
            self.plan(scene, &due);
        }
    }

    /// The agents that enter a room, have a new goal or compare their ways again, in order of their ids. The others
    /// only note where they are.
    fn due(&mut self, ways: &Ways, rooms: &Rooms) -> Vec<Due> {
        let mut plans = std::mem::take(&mut self.agents.plan);
        plans.resize(self.agents.len(), None);
        let (agents, frame) = (&self.agents, self.clock.frame());
        let all = plans.par_iter_mut().with_min_len(TASK * BLOCK).enumerate();
        let due = all.filter_map(|(agent, plan)| {
            let trip = agents.trip.get(agent).and_then(Option::as_ref);
            let walks = trip.is_none_or(|trip| trip.status == Status::Walking || trip.place_ahead().is_none());
            let walks = walks && agents.is_present(agent);
            let goal = walks.then(|| ways.map_to(agents.destination(agent))).flatten();
            let p = agents.position[agent];
            let before = plan.map(|plan| plan.triangle);
            let here = match before {
                Some(before) => rooms.floor.locate_from(before, p),
                None => rooms.floor.locate(p),
            };
            let (Some(goal), Some(here)) = (goal, here.or_else(|| rooms.floor.nearest(p))) else {
                *plan = None;
                return None;
            };
            if let Some(plan) = plan {
                let stays = rooms.room(plan.triangle) == rooms.room(here);
                if stays && plan.goal == goal && plan.decides_at > frame {
                    plan.triangle = here;
                    return None;
                }
            }
            Some(Due {
                agent,
                triangles: [before, Some(here)],
                goal,
            })
        });
        let mut due: Vec<Due> = due.collect();
        due.sort_unstable_by_key(|due| agents.id[due.agent]);
        self.agents.plan = plans;
        due
    }

    fn outlooks_of(&self, scene: &Scene, i: usize, goal: u16, t: u32) -> Vec<Outlook> {
        let goal = usize::from(goal);
        let onward = self.progress.onward.get(goal);
        let (Some(times), Some(onward)) = (self.times(scene), onward) else {
            return Vec::new();
        };
        let own = self.agents.preferred_speed.get(i).copied();
        let speed = own.unwrap_or(scene.preferred_speed);
        times.outlooks((self.agents.position[i], t), goal, onward, speed)
    }

    /// The time that agent `i` expects for the way to a goal, seconds; `None` if it is not known.
    pub(super) fn time_to(&self, scene: &Scene, i: usize, goal: u16) -> Option<f64> {
        let rooms = scene.rooms().filter(|_| scene.by_time())?;
        let p = self.agents.position[i];
        let plan = self.agents.plan.get(i).copied().flatten();
        let before = plan.map(|plan| plan.triangle);
        let here = before.map_or_else(|| rooms.floor.locate(p), |t| rooms.floor.locate_from(t, p))?;
        let all = self.outlooks_of(scene, i, goal, here).into_iter();
        all.map(|outlook| outlook.total).reduce(f64::min)
    }

    /// An agent that is due compares its ways.
    fn plan(&mut self, scene: &Scene, due: &Due) {
        let (i, goal) = (due.agent, due.goal);
        let (Some(ways), [before, Some(here)]) = (&scene.ways, due.triangles) else {
            return;
        };
        let Some(rooms) = &ways.rooms else {
            return;
        };
        if self.progress.onward[usize::from(goal)].is_empty()
            && let Some(onward) = self.times(scene).map(|times| times.onward(usize::from(goal)))
        {
            self.progress.onward[usize::from(goal)] = onward;
        }
        let (p, old) = (self.agents.position[i], self.agents.plan[i]);
        let from = before.map(|t| rooms.room(t)).filter(|&from| from != rooms.room(here));
        let taken = from.and_then(|from| rooms.step_between(from, rooms.room(here), p));
        if let Some(step) = taken {
            self.progress.steps[step as usize].pass();
            if let Some(door) = rooms.opening(step).door() {
                self.progress.places[usize::from(door)].passed += 1;
            }
        }
        let outlooks = self.outlooks_of(scene, i, goal, here);
        let kept = kept(old.filter(|old| old.goal == goal), taken, from.is_some(), &outlooks);
        let best = outlooks.iter().min_by(|a, b| a.total.total_cmp(&b.total)).copied();
        let chosen = match (best, kept) {
            (Some(best), Some(kept)) if !is_clearly_quicker(best.total, kept.total) => Some(kept),
            _ => best,
        };
        let changes = kept.is_some() && chosen.map(|one| one.step) != kept.map(|one| one.step);
        let toward = chosen.and_then(|chosen| chosen.step);
        let points = ways.course(p, self.agents.destination(i));
        let detours = chosen.is_some() && rooms.first_on(p, here, &points) != toward;
        let turns = old.map_or(0, |old| old.turns) + 1;
        let id = self.agents.id[i];
        let mut random = random::stream(scene.seed, Purpose::Plan, id, u64::from(turns));
        let again = self.clock.time() + random.random_range(AGAIN[0]..AGAIN[1]);
        let plan = Plan {
            triangle: here,
            goal,
            toward,
            crossed: taken.or(old.and_then(|old| old.crossed)),
            detours,
            decides_at: self.clock.coarse_frame_at(again),
            turns,
            changes: old.map_or(0, |old| old.changes) + u32::from(changes),
        };
        let to = self.agents.destination(i);
        if old.and_then(|old| old.detour(ways, to)) != plan.detour(ways, to) {
            self.agents.forget_route(i);
        }
        // Agents that choose after this one see its choice.
        let left = old.and_then(|old| old.toward);
        let length = |step| rooms.length_to(p, here, step).unwrap_or(0.0);
        if left != toward || taken.is_some() {
            if let Some(step) = left {
                let length = if taken.is_some() { 0.0 } else { length(step) };
                self.progress.steps[step as usize].count(length, false);
            }
            if let Some(step) = toward {
                self.progress.steps[step as usize].count(length(step), true);
            }
        }
        self.agents.plan[i] = Some(plan);
    }
}

/// The way that an agent keeps unless another one is clearly quicker: the one that it has planned, and after a step the
/// best one that does not lead back. An agent that was pushed back through an opening keeps the way through it.
fn kept(
    old: Option<Plan>,
    taken: Option<Step>,
    moved: bool,
    outlooks: &[Outlook],
) -> Option<Outlook> {
    let old = old?;
    let by = |step: Option<Step>| outlooks.iter().find(|one| one.step == step).copied();
    match taken {
        None if moved => None,
        None => by(old.toward),
        Some(taken) if old.toward != Some(taken) && old.crossed == Some(taken ^ 1) => {
            by(Some(taken ^ 1))
        }
        Some(taken) => {
            let onward = outlooks.iter().filter(|one| one.step != Some(taken ^ 1));
            onward.min_by(|a, b| a.total.total_cmp(&b.total)).copied()
        }
    }
}
