//! Quickest routes: in coarse frames agents that enter a room compare its openings. Those that have a choice compare
//! them again now and then.
//!
//! `expected.rs` has the rule. Beyond an opening, the least time to the goal is that of Dijkstra's algorithm over
//! openings, which runs once per second for each goal. Agents follow the path map of their goal as long as its way
//! leads through the opening that they have chosen; with a crowd before the opening they walk straight to it.

use rand::Rng;
use rayon::prelude::*;

use super::bound::is_due;
use super::expected::{is_clearly_quicker, least_or_kept};
use super::stream::Stream;
use super::times::{RouteProspect, SINGLE_FILE, quickest};
use super::{Crowd, Simulation, Stage};
use crate::journeys::Status;
use crate::neighbors::{BLOCK, TASK};
use crate::random::{self, Purpose};
use crate::routes::{Located, Plan, Rooms, Routes, RoutesOut, Side};
use crate::scene::Scene;

/// Agents are due again after a random time in this range, seconds.
const AGAIN: [f64; 2] = [2.0, 5.0];
/// After their first comparison, agents are due again sooner: most begin before others have chosen.
const FIRST_AGAIN: [f64; 2] = [0.5, 2.0];
/// Agents decide in the order of their ids times this odd number, modulo 2³².
const ORDER: u32 = 0x9E37_79B9;
/// Agents that choose for the first time in the same frame do so in this many batches of at least this size. Those of
/// each see the waits that follow from the choices before; when all have chosen, they choose again.
const BATCHES: usize = 8;
const LEAST_BATCH: usize = 8;
/// With so many agents ahead per meter of an opening that several can pass beside each other, agents use its whole
/// width: they walk straight to it, not to the corner that the shortest way bends around.
const CROWD_PER_METER: f64 = 3.0;

/// The decision of an agent between the routes out of its room.
#[derive(Debug, Clone, PartialEq)]
pub struct RouteDecision {
    /// Its plan.
    pub plan: Plan,
    /// The side of the opening by which the shortest way leaves the room; `None`: the goal is there.
    pub shortest: Option<Side>,
    /// The routes.
    pub prospects: Vec<RouteProspect>,
}

/// An agent that compares its routes.
struct Comparing {
    agent: usize,
    /// Whether it has no plan yet.
    is_new: bool,
    /// The room where it was located before, if it is in another one now.
    from: Option<u32>,
    /// Where it is located now.
    located: Located,
    routes: RoutesOut,
}

impl Simulation {
    /// In coarse frames: agents that choose their quickest routes compare them.
    pub(super) fn follow_plans(&mut self) {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        if let Some(routes) = &scene.routes
            && let Some(rooms) = routes.rooms()
            && crowd.decides()
        {
            self.stages
                .time(Stage::Routes, || crowd.compare_routes(scene, routes, rooms));
        }
    }

    /// The decision of agent `i` with what it expects now; `None` if it does not choose between routes.
    pub fn route_decision(&self, i: usize) -> Option<RouteDecision> {
        let (scene, crowd) = (&self.fixed.scene, &self.crowd);
        let plan = crowd.agents.plan.get(i).copied().flatten()?;
        let routes = scene.routes.as_ref()?;
        let p = crowd.agents.position[i];
        let here = plan.located.triangle_at(routes.rooms()?, p)?;
        let routes_out = routes.routes_out((p, here), plan.goal, None, None)?;
        Some(RouteDecision {
            plan,
            shortest: routes_out.shortest.and_then(|shortest| shortest.side),
            prospects: crowd.prospects_of(scene, i, &routes_out),
        })
    }
}

impl Crowd {
    fn compare_routes(&mut self, scene: &Scene, routes: &Routes, rooms: &Rooms) {
        let progress = &mut self.progress;
        let sides = rooms.sides().len();
        progress.sides.resize_with(sides, Stream::default);
        progress.onward.resize(rooms.goals(), Vec::new());
        let due = self.due(scene, routes, rooms);
        if is_due(&self.clock) {
            self.look_ahead(scene);
        }
        let (new, others): (Vec<Comparing>, Vec<Comparing>) =
            due.into_iter().partition(|due| due.is_new);
        for due in &others {
            self.plan(scene, due, false);
        }
        let rounds = 1 + usize::from(scene.by_time() && new.len() > LEAST_BATCH);
        let size = new.len().div_ceil(BATCHES).max(LEAST_BATCH);
        for round in 0..rounds {
            for (k, batch) in new.chunks(size).enumerate() {
                if k + round > 0 && rounds > 1 {
                    self.look_ahead(scene);
                }
                for due in batch {
                    self.plan(scene, due, round > 0);
                }
            }
        }
    }

    /// Finds the times from each opening on, for the goals of agents.
    fn look_ahead(&mut self, scene: &Scene) {
        if let Some(times) = self.times(scene) {
            let known = self.progress.onward.par_iter().enumerate();
            let onward = known.map(|(goal, known)| match known.is_empty() {
                true => Vec::new(),
                false => times.onward(goal),
            });
            self.progress.onward = onward.collect::<Vec<_>>();
        }
    }

    /// The agents that enter a room, have a new goal or compare their routes again, in a fixed order. Of the others,
    /// those that may have left their room note where they are, and those that are due but have no choice draw a new
    /// time.
    fn due(&mut self, scene: &Scene, routes: &Routes, rooms: &Rooms) -> Vec<Comparing> {
        let mut plans = std::mem::take(&mut self.agents.plan);
        plans.resize(self.agents.len(), None);
        let (crowd, agents, frame) = (&*self, &self.agents, self.clock.frame());
        let all = plans.par_iter_mut().with_min_len(TASK * BLOCK).enumerate();
        let due = all.filter_map(|(agent, plan)| {
            let trip = agents.trip.get(agent).and_then(Option::as_ref);
            let walks = trip
                .is_none_or(|trip| trip.status == Status::Walking || trip.place_ahead().is_none());
            let walks = walks && agents.is_present(agent);
            let to = walks.then(|| agents.destination(agent));
            let goal = to.and_then(|to| routes.map_to(to));
            let p = agents.position[agent];
            let goes_on = |plan: &Plan| Some(plan.goal) == goal && plan.decides_at > frame;
            if plan.is_some_and(|plan| goes_on(&plan) && plan.located.stays_at(p)) {
                return None;
            }
            let keeps_plan = |plan: &Plan| {
                goes_on(plan) || Some(plan.goal) == goal && has_no_choice(plan, rooms)
            };
            let before = plan.map(|plan| plan.located);
            let locate = |goal| Some((goal, Located::new(rooms, before, p)?));
            let Some((goal, located)) = goal.and_then(locate) else {
                *plan = None;
                return None;
            };
            let here = located.triangle();
            let before = before.map(|before| rooms.room(before.triangle()));
            let from = before.filter(|&from| from != rooms.room(here));
            let kept = plan
                .as_mut()
                .filter(|plan| from.is_none() && keeps_plan(plan));
            if let Some(plan) = kept {
                plan.located = located;
                if plan.decides_at <= frame {
                    plan.decides_at = crowd.due_again(scene, agent, Some(*plan));
                    plan.turns += 1;
                }
                return None;
            }
            Some(Comparing {
                agent,
                is_new: before.is_none(),
                from,
                located,
                routes: routes.routes_out((p, here), goal, None, None)?,
            })
        });
        let mut due: Vec<Comparing> = due.collect();
        // Neighbors have similar ids: in another order, no side of a room decides first.
        due.sort_unstable_by_key(|due| agents.id[due.agent].wrapping_mul(ORDER));
        self.agents.plan = plans;
        due
    }

    /// The frame in which agent `i` is due again, with plan `old` so far.
    fn due_again(&self, scene: &Scene, i: usize, old: Option<Plan>) -> u64 {
        let turn = u64::from(turns(old));
        let mut random = random::stream(scene.seed, Purpose::Plan, self.agents.id[i], turn);
        let [least, most] = if old.is_none() { FIRST_AGAIN } else { AGAIN };
        let again = self.clock.time() + random.random_range(least..most);
        self.clock.coarse_frame_at(again)
    }

    /// An agent that is due compares its routes; `afresh`: whatever it has planned.
    fn plan(&mut self, scene: &Scene, due: &Comparing, afresh: bool) {
        let (Some(routes), Some(rooms)) = (&scene.routes, scene.rooms()) else {
            return;
        };
        let (i, goal) = (due.agent, due.routes.goal);
        self.look_ahead_to(scene, usize::from(goal));
        let old = self.agents.plan[i];
        let (p, here) = (self.agents.position[i], due.located.triangle());
        let at = rooms.floor.in_building(p);
        let passed = (due.from).and_then(|from| rooms.side_between(from, rooms.room(here), at));
        if let Some(side) = passed {
            self.progress.sides[side.index()].pass();
        }
        let prospects = self.prospects_of(scene, i, &due.routes);
        let is_lost = passed.is_none() && due.from.is_some();
        let planned = old.filter(|old| old.goal == goal && !afresh && !is_lost);
        let kept = kept(planned, passed, &prospects);
        let crossed = passed.or(old.and_then(|old| old.crossed));
        let shortest = due.routes.shortest.map(|shortest| shortest.side);
        let leads_on =
            |side: &Option<Side>| side.is_none() || *side != crossed.map(|side| side.other());
        let usual = shortest.filter(leads_on);
        let usual = usual.and_then(|side| leaving_by(side, &prospects));
        let chosen = chosen(kept, usual, &prospects);
        let changes = kept.is_some() && chosen.map(|way| way.side) != kept.map(|way| way.side);
        let toward = chosen.and_then(|chosen| chosen.side);
        let is_elsewhere = shortest.is_none_or(|side| side != toward);
        let detours =
            chosen.is_some_and(|way| is_elsewhere || scene.by_time() && is_crowded(&way, rooms));
        let plan = Plan {
            located: due.located,
            goal,
            toward,
            crossed,
            detours,
            decides_at: self.due_again(scene, i, old),
            turns: turns(old),
            changes: old.map_or(0, |old| old.changes) + u32::from(changes),
        };
        let to = self.agents.destination(i);
        if old.and_then(|old| old.detour(routes, to)) != plan.detour(routes, to) {
            self.agents.forget_route(i);
        }
        let left = old.and_then(|old| old.toward);
        self.count_change(rooms, due, [left, toward], passed.is_some());
        self.agents.plan[i] = Some(plan);
    }

    /// Counts an agent that was bound for one side and is now bound for another, after it `has_passed` the first, so
    /// that agents that choose after it see its choice.
    fn count_change(
        &mut self,
        rooms: &Rooms,
        due: &Comparing,
        [left, toward]: [Option<Side>; 2],
        has_passed: bool,
    ) {
        if left == toward && !has_passed {
            return;
        }
        let (p, here) = (self.agents.position[due.agent], due.located.triangle());
        let length = |side| {
            let known = due.routes.through(side).map(|[length, _]| length);
            let at = rooms.floor.in_building(p);
            let length = known.or_else(|| rooms.length_to(at, here, side));
            length.unwrap_or(0.0)
        };
        if let Some(side) = left {
            let length = if has_passed { 0.0 } else { length(side) };
            self.progress.sides[side.index()].count(length, false);
        }
        if let Some(side) = toward {
            self.progress.sides[side.index()].count(length(side), true);
        }
    }

    /// Finds the times from each opening on to a goal, if they are not known.
    fn look_ahead_to(&mut self, scene: &Scene, goal: usize) {
        if self.progress.onward[goal].is_empty()
            && let Some(onward) = self.times(scene).map(|times| times.onward(goal))
        {
            self.progress.onward[goal] = onward;
        }
    }
}

/// Whether an agent with this plan leaves its room as planned, whatever it expects: there is no other way, and people
/// pass the opening one behind the other.
fn has_no_choice(plan: &Plan, rooms: &Rooms) -> bool {
    let room = rooms.room(plan.located.triangle());
    let only = rooms.only_side(room, usize::from(plan.goal));
    let is_narrow = |side: Side| rooms.opening(side).width() < SINGLE_FILE;
    !plan.detours && plan.toward == only && only.is_some_and(is_narrow)
}

/// The number of draws of `decides_at` with this one, after those of plan `old`.
fn turns(old: Option<Plan>) -> u32 {
    old.map_or(0, |old| old.turns) + 1
}

/// Whether a crowd stands before the opening of a way, and several people pass it beside each other.
fn is_crowded(way: &RouteProspect, rooms: &Rooms) -> bool {
    let width = way.side.map(|side| rooms.opening(side).width());
    let width = width.filter(|&width| width >= SINGLE_FILE);
    width.is_some_and(|width| f64::from(way.expected.ahead) >= CROWD_PER_METER * width)
}

/// The way that an agent takes: the quickest, if that is clearly quicker than the one that it has kept; else the
/// shortest one that does not lead back, `usual`, if it is not slower than the one kept.
fn chosen(
    kept: Option<RouteProspect>,
    usual: Option<RouteProspect>,
    prospects: &[RouteProspect],
) -> Option<RouteProspect> {
    let times = prospects.iter().map(|way| (*way, way.expected.total_secs));
    let (chosen, _) = least_or_kept(times, kept, is_clearly_quicker)?;
    let is_kept = kept == Some(chosen);
    let is_slower = |way: &RouteProspect| way.expected.total_secs > chosen.expected.total_secs;
    Some(
        usual
            .filter(|usual| is_kept && !is_slower(usual))
            .unwrap_or(chosen),
    )
}

/// The way that leaves the room by a side.
fn leaving_by(side: Option<Side>, prospects: &[RouteProspect]) -> Option<RouteProspect> {
    prospects.iter().find(|way| way.side == side).copied()
}

/// The way that an agent keeps unless another one is clearly quicker: the one that it has planned, and after it has
/// passed an opening the best one that does not lead back. An agent that was pushed back through an opening keeps the
/// way through it.
fn kept(
    old: Option<Plan>,
    passed: Option<Side>,
    prospects: &[RouteProspect],
) -> Option<RouteProspect> {
    let old = old?;
    let Some(passed) = passed else {
        return leaving_by(old.toward, prospects);
    };
    let back = Some(passed.other());
    match old.toward != Some(passed) && old.crossed == back {
        true => leaving_by(back, prospects),
        false => quickest(prospects.iter().filter(|way| way.side != back)),
    }
}
