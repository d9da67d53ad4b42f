//! Stuck agents: those that want to walk and make hardly any headway along their way.

mod cause;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::aim::Aim;
use super::passages::Openings;
use super::{Measure, Observed, is_due};
use analysis::evaluated::Evaluated;
use engine::journeys::Status;
use engine::math::Vector;
use engine::routes::Destination;
use engine::simulation::Simulation;

/// An agent is stuck if it has made no headway in this time of walking, seconds.
pub const STUCK_AFTER: f64 = 20.0;
/// It makes headway if its way gets shorter by this in that time, meters.
pub const HEADWAY: f64 = 1.0;
/// Slow agents make headway with this part of what they would walk at their preferred speed in that time.
const PART: f64 = 0.5;
/// Time between two observations, seconds.
const EVERY: f64 = 1.0;
/// The number of observations in [`STUCK_AFTER`] seconds.
const KEPT: usize = 20;
/// An agent has started after this number of observations.
const STARTED: u32 = 3;
/// The fewest agents that a thread observes.
pub(super) const SOME: usize = 64;
/// Headways are kept as whole parts of the headway that is needed: this many. Results do not depend on rounding.
const PARTS: f64 = 1e6;

/// Observes in every run which agents are stuck: those that walk to a goal at which they would leave, to the place of a
/// journey or in a direction, and whose way has become shorter by less than [`HEADWAY`] in the last [`STUCK_AFTER`]
/// seconds in which they walked. Agents whose preferred speed is below 0.1 m/s need only half of what they would walk.
/// An agent that waits, queues or stays at its goal is not stuck, and its time starts again when it walks on.
#[derive(Debug, Clone)]
pub struct Stuck;

/// The headway of an agent in the last seconds.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Headway {
    aim: Aim,
    /// Its position at the last observation, meters.
    position: Vector,
    /// How far it had to go then, meters; `None` without a way.
    left: Option<f64>,
    /// The number of observations since it walks.
    count: u32,
    /// Its headway before each of the last ones, number k at k modulo their number, in parts of the headway that is
    /// needed.
    made: [i32; KEPT],
    /// Since when it has made too little, seconds; `None` if it makes headway.
    since: Option<f64>,
}

/// Agents that are stuck for the same reason.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StuckGroup {
    /// The likely cause, in words.
    pub cause: String,
    /// How many agents.
    pub agents: usize,
    /// The id of one of them.
    pub agent: u32,
    /// Its position, meters.
    pub at: [f64; 2],
    /// In a building: the name of the level there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
    /// For how long it has made less headway than needed, seconds.
    pub for_secs: f64,
}

impl Measure for Stuck {
    /// By id; `None` for agents that are absent or do not walk.
    type Seen = Vec<Option<Headway>>;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        if is_due(simulation, [0.0, f64::INFINITY], EVERY) {
            watch(seen, simulation);
        }
    }
}

/// The indices of the agents that are stuck in the current frame, by id, each with the time since when, seconds, and
/// what it walks to.
pub(super) fn agents(seen: &[Option<Headway>], simulation: &Simulation) -> Vec<(usize, f64, Aim)> {
    let ids = &simulation.frame().agents.id;
    let mut order: Vec<usize> = (0..ids.len()).collect();
    order.sort_unstable_by_key(|&i| ids[i]);
    let stuck = order.into_iter().filter_map(|i| {
        let headway = seen.get(ids[i] as usize)?.as_ref()?;
        Some((i, headway.since?, aim(simulation, i)?))
    });
    stuck.collect()
}

/// The agents that are stuck in the current frame, grouped by the likely cause, the largest group first.
pub(super) fn groups(seen: &[Option<Headway>], simulation: &Simulation) -> Vec<StuckGroup> {
    let frame = simulation.frame();
    let doors = Openings::doors(simulation.scene());
    let mut groups: Vec<StuckGroup> = Vec::new();
    for (i, since, aim) in agents(seen, simulation) {
        let cause = cause::of(simulation, i, aim, &doors);
        match groups.iter_mut().find(|group| group.cause == cause) {
            Some(group) => group.agents += 1,
            None => groups.push(StuckGroup {
                cause,
                agents: 1,
                agent: frame.agents.id[i],
                at: frame.agents.position[i].into(),
                level: None,
                for_secs: frame.clock.time() - since,
            }),
        }
    }
    groups.sort_by_key(|group| std::cmp::Reverse(group.agents)); // stable
    groups
}

fn watch(seen: &mut Vec<Option<Headway>>, simulation: &Simulation) {
    let agents = simulation.frame().agents;
    let groups = &simulation.scene().groups;
    let can_be_stuck = |group: &engine::scene::Group| {
        group.removal_radius.is_some() || group.journey.is_some() || group.direction.is_some()
    };
    if !groups.iter().any(can_be_stuck) {
        return;
    }
    let mut index = vec![None; agents.entered() as usize];
    for (i, &id) in agents.id.iter().enumerate() {
        index[id as usize] = Some(i as u32);
    }
    seen.resize(index.len(), None);
    let all = seen.par_iter_mut().zip(index).with_min_len(SOME);
    all.for_each(|(seen, index)| {
        let index = index.map(|i| i as usize);
        let walking = index.and_then(|i| Some((i, aim(simulation, i)?)));
        match (walking, &mut *seen) {
            (Some((i, aim)), Some(before)) => before.follow(simulation, i, aim),
            (Some((i, aim)), None) => {
                let begun = Headway::begin(simulation, position(simulation, i), aim);
                *seen = Some(begun);
            }
            (None, _) => *seen = None,
        }
    });
}

impl Headway {
    /// What the agent walks to, and how far it has to go, meters; `None` without a way, if it walks in a direction, or
    /// if it has just started.
    pub(super) fn way(&self) -> Option<(Aim, f64)> {
        let is_direction = matches!(self.aim, Aim::Direction(_));
        let has_started = self.count >= STARTED;
        let left = self.left.filter(|_| has_started && !is_direction)?;
        Some((self.aim, left))
    }

    /// That of an agent at `p` that begins to walk to `aim`.
    fn begin(simulation: &Simulation, p: Vector, aim: Aim) -> Self {
        Self {
            aim,
            position: p,
            left: left(simulation, p, aim),
            count: 0,
            made: [0; KEPT],
            since: None,
        }
    }

    /// Becomes the headway of agent `i`, which now walks to `aim`, one observation later.
    fn follow(&mut self, simulation: &Simulation, i: usize, aim: Aim) {
        let frame = simulation.frame();
        let (here, now) = (position(simulation, i), frame.clock.time());
        // The headway on the way that it walks now, also if it has chosen that just now.
        let before = match self.aim == aim {
            true => self.left,
            false => left(simulation, self.position, aim),
        };
        self.left = match self.position == here {
            true => before,
            false => left(simulation, here, aim),
        };
        let made = before.zip(self.left).map_or(0.0, |(a, b)| a - b);
        let pace = simulation.scene().pace(frame.agents, i, now);
        let needed = match pace > 0.0 {
            true => HEADWAY.min(PART * STUCK_AFTER * pace),
            false => HEADWAY,
        };
        (self.aim, self.position) = (aim, here);
        self.made[self.count as usize % KEPT] = (PARTS * made / needed).round() as i32; // saturates
        self.count = self.count.saturating_add(1);
        let all: i64 = self.made.iter().map(|&made| i64::from(made)).sum();
        let is_short = self.count as usize >= KEPT && all < PARTS as i64;
        self.since = is_short.then(|| self.since.unwrap_or(now - STUCK_AFTER));
    }
}

/// What agent `i` walks to; `None` if it waits, or would stay there.
fn aim(simulation: &Simulation, i: usize) -> Option<Aim> {
    let (frame, scene) = (simulation.frame(), simulation.scene());
    let agents = frame.agents;
    let starts = agents.walks_from.get(i);
    if starts.is_some_and(|&start| start > frame.clock.time()) {
        return None;
    }
    let group = &scene.groups[usize::from(agents.group[i])];
    if let Some(direction) = group.direction {
        return Some(Aim::Direction(direction));
    }
    let trip = agents.trip.get(i).and_then(Option::as_ref);
    let is_on_journey = trip.is_some_and(|trip| trip.place_ahead().is_some());
    if group.journey.is_some() || is_on_journey {
        let trip = trip?;
        let walks = trip.status == Status::Walking && trip.hold.is_none();
        return walks.then_some(Aim::Place(trip.place));
    }
    let leaves = group.removal_radius.is_some();
    leaves.then_some(Aim::Goal(agents.goal[i]))
}

/// The position of agent `i`, counted over all periods, meters.
fn position(simulation: &Simulation, i: usize) -> Vector {
    let agents = simulation.frame().agents;
    let laps = agents.laps.get(i).copied().unwrap_or(0);
    let way = simulation.scene().period.map(|period| period.way(laps));
    agents.position[i] + way.unwrap_or_default()
}

/// How far it is from `p` to `aim`, meters; `None` without a way.
fn left(simulation: &Simulation, p: Vector, aim: Aim) -> Option<f64> {
    let routes = simulation.scene().routes.as_ref();
    let by_way = |to: Destination| {
        let routes = routes.filter(|routes| routes.leads_to(to))?;
        Some(routes.way(p, to).map(|way| way.length))
    };
    let length = match aim {
        Aim::Goal(goal) => by_way(Destination::Goal(goal)).unwrap_or(Some((goal - p).norm())),
        Aim::Place(place) => by_way(Destination::Place(place)).flatten(),
        Aim::Direction(direction) => Some(-direction.dot(&p)),
    };
    length.filter(|length| length.is_finite())
}
