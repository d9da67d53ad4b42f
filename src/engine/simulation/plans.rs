//! Ways by time: in coarse frames agents that enter a room compare its openings. Those that have a choice compare them
//! again now and then.
//!
//! An agent expects to pass an opening when it has walked there, or when all agents that are bound for it and nearer
//! have walked there and passed at its flow, whichever is later. Beyond it, the least time to the goal is that of
//! Dijkstra's algorithm over openings, which runs once per second for each goal. Agents follow the path map of their
//! goal as long as its way leads through the opening that they have chosen; with a crowd before the opening they walk
//! straight to it.

use rand::Rng;
use rayon::prelude::*;

use super::bound::{self, Stream};
use super::times::{Outlook, SINGLE_FILE};
use super::{Crowd, Simulation, Stage};
use crate::journeys::Status;
use crate::neighbors::{BLOCK, TASK};
use crate::random::{self, Purpose};
use crate::scene::Scene;
use crate::ways::{Known, Leaving, Plan, Rooms, Step, Ways};

/// Agents are due again after a random time in this range, seconds.
const AGAIN: [f64; 2] = [2.0, 5.0];
/// After their first comparison, agents are due again sooner: most begin before others have chosen.
const FIRST_AGAIN: [f64; 2] = [0.5, 2.0];
/// Agents decide in the order of their ids times this odd number, modulo 2³².
const ORDER: u32 = 0x9E37_79B9;
/// An agent changes to another opening if that saves at least this time, seconds, and this part of the time.
const LEAST_GAIN: f64 = 1.0;
const LEAST_SHARE: f64 = 0.1;
/// Agents that choose for the first time in the same frame do so in this many batches of at least this size. Those of
/// each see the waits that follow from the choices before; when all have chosen, they choose again.
const BATCHES: usize = 8;
const LEAST_BATCH: usize = 8;
/// With so many agents ahead per meter of an opening that several can pass beside each other, agents use its whole
/// width: they walk straight to it, not to the corner that the shortest way bends around.
const CROWD_PER_METER: f64 = 3.0;

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

/// Whether a way that takes `new` seconds is so much quicker than one that takes `old` that an agent changes to it.
pub(super) fn is_clearly_quicker(new: f64, old: f64) -> bool {
    new < old - LEAST_GAIN.max(LEAST_SHARE * old)
}

/// An agent that compares its ways.
struct Due {
    agent: usize,
    /// The triangle where it was.
    from: Option<u32>,
    /// How far it can move without leaving its room, meters.
    free_distance: f64,
    /// The ways.
    leaving: Leaving,
}

impl Simulation {
    /// In coarse frames: agents that choose their ways by time compare them.
    pub(super) fn follow_plans(&mut self) {
        let (scene, crowd) = (&self.fixed.scene, &mut self.crowd);
        let Some(ways) = &scene.ways else {
            return;
        };
        if ways.rooms().is_none() || !crowd.decides() {
            return;
        }
        self.stages.time(Stage::Ways, || {
            if scene.journeys.journeys.is_empty() && !scene.journeys.has_doors() {
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
        let here = ways
            .rooms()?
            .floor
            .locate_or_nearest(Some(plan.triangle), p)?;
        let leaving = ways.leaving((p, here), plan.goal, Known::default())?;
        Some(Comparison {
            plan,
            shortest: leaving.shortest.and_then(|shortest| shortest.step),
            outlooks: crowd.outlooks_of(scene, i, &leaving),
        })
    }
}

impl Crowd {
    fn compare_ways(&mut self, scene: &Scene, ways: &Ways) {
        let Some(rooms) = ways.rooms() else {
            return;
        };
        let progress = &mut self.progress;
        progress
            .steps
            .resize_with(rooms.steps() as usize, Stream::default);
        progress.onward.resize(rooms.goals(), Vec::new());
        let due = self.due(scene, ways, rooms);
        if bound::is_due(&self.clock) {
            self.look_ahead(scene, rooms);
        }
        let (new, others): (Vec<Due>, Vec<Due>) =
            due.into_iter().partition(|due| due.from.is_none());
        for due in &others {
            self.plan(scene, due, false);
        }
        let rounds = match scene.by_time() && new.len() > LEAST_BATCH {
            true => 0..2,
            false => 0..1,
        };
        let size = new.len().div_ceil(BATCHES).max(LEAST_BATCH);
        for round in rounds.clone() {
            for (k, batch) in new.chunks(size).enumerate() {
                if k + round > 0 && rounds.len() > 1 {
                    self.look_ahead(scene, rooms);
                }
                for due in batch {
                    self.plan(scene, due, round > 0);
                }
            }
        }
    }

    /// Finds the times from each opening on, for the goals of agents.
    fn look_ahead(&mut self, scene: &Scene, rooms: &Rooms) {
        let known = (0..rooms.goals()).into_par_iter().map(|goal| {
            let is_used = !self.progress.onward[goal].is_empty();
            self.times(scene)
                .filter(|_| is_used)
                .map(|times| times.onward(goal))
        });
        let known: Vec<Option<Vec<f64>>> = known.collect();
        self.progress.onward = known.into_iter().map(Option::unwrap_or_default).collect();
    }

    /// The agents that enter a room, have a new goal or compare their ways again, in a fixed order. Of the others,
    /// those that may have left their room note where they are, and those that are due but have no choice draw a new
    /// time.
    fn due(&mut self, scene: &Scene, ways: &Ways, rooms: &Rooms) -> Vec<Due> {
        let mut plans = std::mem::take(&mut self.agents.plan);
        plans.resize(self.agents.len(), None);
        let (crowd, agents, frame) = (&*self, &self.agents, self.clock.frame());
        let all = plans.par_iter_mut().with_min_len(TASK * BLOCK).enumerate();
        let due = all.filter_map(|(agent, plan)| {
            let trip = agents.trip.get(agent).and_then(Option::as_ref);
            let walks = trip
                .is_none_or(|trip| trip.status == Status::Walking || trip.place_ahead().is_none());
            let walks = walks && agents.is_present(agent);
            let goal = walks
                .then(|| ways.map_to(agents.destination(agent)))
                .flatten();
            let p = agents.position[agent];
            let goes_on = |plan: &Plan| Some(plan.goal) == goal && plan.decides_at > frame;
            if plan.is_some_and(|plan| goes_on(&plan) && plan.stays_at(p)) {
                return None;
            }
            let keeps_plan = |plan: &Plan| {
                goes_on(plan) || Some(plan.goal) == goal && has_no_choice(plan, rooms)
            };
            let from = plan.map(|plan| plan.triangle);
            let locate = |goal| Some((goal, rooms.floor.locate_or_nearest(from, p)?));
            let Some((goal, here)) = goal.and_then(locate) else {
                *plan = None;
                return None;
            };
            let free_distance = rooms.free_distance(here, p);
            if let Some(plan) = plan
                && rooms.room(plan.triangle) == rooms.room(here)
                && keeps_plan(plan)
            {
                (plan.triangle, plan.located, plan.free_distance) = (here, p, free_distance);
                if plan.decides_at <= frame {
                    plan.decides_at = crowd.due_again(scene, agent, Some(*plan));
                    plan.turns += 1;
                }
                return None;
            }
            Some(Due {
                agent,
                from,
                free_distance,
                leaving: ways.leaving((p, here), goal, Known::default())?,
            })
        });
        let mut due: Vec<Due> = due.collect();
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

    /// An agent that is due compares its ways; `afresh`: whatever it has planned.
    fn plan(&mut self, scene: &Scene, due: &Due, afresh: bool) {
        let (i, leaving) = (due.agent, &due.leaving);
        let (here, goal) = (leaving.triangle, leaving.goal);
        let (Some(ways), Some(rooms)) = (&scene.ways, scene.rooms()) else {
            return;
        };
        if self.progress.onward[usize::from(goal)].is_empty()
            && let Some(onward) = self
                .times(scene)
                .map(|times| times.onward(usize::from(goal)))
        {
            self.progress.onward[usize::from(goal)] = onward;
        }
        let (p, old) = (self.agents.position[i], self.agents.plan[i]);
        let from = due
            .from
            .map(|t| rooms.room(t))
            .filter(|&from| from != rooms.room(here));
        let taken = from.and_then(|from| rooms.step_between(from, rooms.room(here), p));
        if let Some(step) = taken {
            self.progress.steps[step as usize].pass();
        }
        let outlooks = self.outlooks_of(scene, i, leaving);
        let kept = kept(
            old.filter(|old| old.goal == goal && !afresh),
            taken,
            from.is_some(),
            &outlooks,
        );
        let crossed = taken.or(old.and_then(|old| old.crossed));
        let shortest = leaving.shortest.map(|shortest| shortest.step);
        let leads_on =
            |step: &Option<Step>| step.is_none() || *step != crossed.map(|step| step ^ 1);
        let usual = shortest.filter(leads_on).and_then(|step| {
            let mut outlooks = outlooks.iter();
            outlooks.find(|one| one.step == step).copied()
        });
        let chosen = chosen(kept, usual, &outlooks);
        let changes = kept.is_some() && chosen.map(|one| one.step) != kept.map(|one| one.step);
        let toward = chosen.and_then(|chosen| chosen.step);
        let is_elsewhere = shortest.is_none_or(|step| step != toward);
        let detours =
            chosen.is_some_and(|way| is_elsewhere || scene.by_time() && is_crowded(&way, rooms));
        let plan = Plan {
            triangle: here,
            located: p,
            free_distance: due.free_distance,
            goal,
            toward,
            crossed,
            detours,
            decides_at: self.due_again(scene, i, old),
            turns: turns(old),
            changes: old.map_or(0, |old| old.changes) + u32::from(changes),
        };
        let to = self.agents.destination(i);
        if old.and_then(|old| old.detour(ways, to)) != plan.detour(ways, to) {
            self.agents.forget_route(i);
        }
        // Agents that choose after this one see its choice.
        let left = old.and_then(|old| old.toward);
        let length = |step| {
            let known = leaving.through(step).map(|[length, _]| length);
            let length = known.or_else(|| rooms.length_to(p, here, step));
            length.unwrap_or(0.0)
        };
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

/// Whether an agent with this plan leaves its room as planned, whatever it expects: there is no other way, and people
/// pass the opening one behind the other.
fn has_no_choice(plan: &Plan, rooms: &Rooms) -> bool {
    let only = rooms.only_step(rooms.room(plan.triangle), usize::from(plan.goal));
    let is_narrow = |step: Step| rooms.opening(step).width() < SINGLE_FILE;
    !plan.detours && plan.toward == only && only.is_some_and(is_narrow)
}

/// The number of draws of `decides_at` with this one, after those of plan `old`.
fn turns(old: Option<Plan>) -> u32 {
    old.map_or(0, |old| old.turns) + 1
}

/// Whether a crowd stands before the opening of a way, and several people pass it beside each other.
fn is_crowded(way: &Outlook, rooms: &Rooms) -> bool {
    let width = way.step.map(|step| rooms.opening(step).width());
    let width = width.filter(|&width| width >= SINGLE_FILE);
    width.is_some_and(|width| f64::from(way.ahead) >= CROWD_PER_METER * width)
}

/// The way that an agent takes: the quickest, if that is clearly quicker than the one that it has kept; else the
/// shortest one that does not lead back, `usual`, if it is not slower than the one kept.
fn chosen(kept: Option<Outlook>, usual: Option<Outlook>, outlooks: &[Outlook]) -> Option<Outlook> {
    let quickest = outlooks.iter().min_by(|a, b| a.total.total_cmp(&b.total));
    let (Some(best), Some(kept)) = (quickest, kept) else {
        return quickest.copied();
    };
    if is_clearly_quicker(best.total, kept.total) {
        return Some(*best);
    }
    let usual = usual.filter(|usual| usual.total <= kept.total);
    Some(usual.unwrap_or(kept))
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
