//! Stuck agents: those that make no way towards their goals.

mod cause;

use serde::{Deserialize, Serialize};

use super::{Measure, is_due};
use crate::engine::journeys::Status;
use crate::engine::math::Vector;
use crate::engine::simulation::Simulation;
use crate::engine::ways::Destination;

/// An agent is stuck if it has made no way for this long, seconds.
pub const STUCK_AFTER: f64 = 20.0;
/// It makes way if it comes this much nearer to its goal, meters: 2.5 mm/s.
const NEARER: f64 = 0.05;
/// An agent that is pushed back this far moves, so its time starts again, meters.
const PUSHED_BACK: f64 = 1.0;
/// Time between two observations, seconds.
const EVERY: f64 = 1.0;

/// Observes in every run which agents are stuck: those that walk to a goal at which they would leave, to the place of a
/// journey or in a direction, and have come less than 5 cm nearer to it in [`STUCK_AFTER`] seconds. Agents that wait,
/// queue or stay at their goal are not stuck. The distance is the length of the agent's way, if agents find ways.
#[derive(Debug, Clone)]
pub struct Stuck;

/// What an agent walks to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) enum Aim {
    /// Its goal, meters.
    Goal(Vector),
    /// The place of a stage of its journey: numbers of the stage and the place.
    Place(u16, u16),
    /// A direction.
    Direction(Vector),
}

/// The last time at which an agent made way.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Mark {
    aim: Aim,
    /// Seconds.
    time: f64,
    /// Its position then, in a periodic scene counted over all periods, meters.
    position: Vector,
    /// How far it had to go, meters; infinite without a way.
    length: f64,
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
    /// How long it has made no way, seconds.
    pub for_secs: f64,
}

impl Measure for Stuck {
    /// By id; `None` for agents that are absent or do not walk to a goal.
    type Seen = Vec<Option<Mark>>;

    fn observe(&self, seen: &mut Self::Seen, simulation: &Simulation) {
        if is_due(simulation, [0.0, f64::INFINITY], EVERY) {
            watch(seen, simulation);
        }
    }
}

/// The agents that are stuck in the current frame, grouped by the likely cause, the largest group first.
pub(super) fn groups(seen: &[Option<Mark>], simulation: &Simulation) -> Vec<StuckGroup> {
    let frame = simulation.frame();
    let (now, agents) = (frame.clock.time(), frame.agents);
    let mut groups: Vec<StuckGroup> = Vec::new();
    let mut order: Vec<usize> = (0..agents.len()).collect();
    order.sort_unstable_by_key(|&i| agents.id[i]);
    for i in order {
        let Some(Some(mark)) = seen.get(agents.id[i] as usize) else {
            continue;
        };
        let for_secs = now - mark.time;
        if for_secs < STUCK_AFTER || aim(simulation, i) != Some(mark.aim) {
            continue;
        }
        let cause = cause::of(simulation, i, mark);
        match groups.iter_mut().find(|group| group.cause == cause) {
            Some(group) => group.agents += 1,
            None => groups.push(StuckGroup {
                cause,
                agents: 1,
                agent: agents.id[i],
                at: agents.position[i].into(),
                for_secs,
            }),
        }
    }
    groups.sort_by_key(|group| std::cmp::Reverse(group.agents)); // stable
    groups
}

fn watch(seen: &mut Vec<Option<Mark>>, simulation: &Simulation) {
    let frame = simulation.frame();
    let (now, agents) = (frame.clock.time(), frame.agents);
    let groups = &simulation.scene().groups;
    let can_be_stuck = |group: &crate::engine::scene::Group| {
        group.removal_radius.is_some() || group.journey.is_some() || group.direction.is_some()
    };
    if !groups.iter().any(can_be_stuck) {
        return;
    }
    let before = std::mem::take(seen);
    seen.resize(agents.entered() as usize, None);
    for i in 0..agents.len() {
        let id = agents.id[i] as usize;
        let Some(aim) = aim(simulation, i) else {
            continue;
        };
        let position = position(simulation, i);
        let mark = before.get(id).copied().flatten();
        let mark = mark.filter(|mark| mark.aim == aim);
        // No way is longer or shorter by more than the agent has moved.
        if let Some(kept) = mark.filter(|mark| (position - mark.position).norm() < NEARER) {
            seen[id] = Some(kept);
            continue;
        }
        let length = length(simulation, i, aim);
        let made =
            |mark: &Mark| length < mark.length - NEARER || length > mark.length + PUSHED_BACK;
        seen[id] = mark.filter(|mark| !made(mark)).or(Some(Mark {
            aim,
            time: now,
            position,
            length,
        }));
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
    if group.journey.is_some() {
        let trip = agents.trip.get(i)?.as_ref()?;
        let walks = trip.status == Status::Walking && trip.hold.is_none();
        return walks.then_some(Aim::Place(trip.stage, trip.place));
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

/// How far agent `i` has to go, meters; infinite without a way.
fn length(simulation: &Simulation, i: usize, aim: Aim) -> f64 {
    let p = simulation.frame().agents.position[i];
    let ways = simulation.scene().ways.as_ref();
    let by_way = |to: Destination| {
        let ways = ways.filter(|ways| ways.leads_to(to))?;
        Some(ways.way(p, to).map_or(f64::INFINITY, |way| way.length))
    };
    match aim {
        Aim::Goal(goal) => by_way(Destination::Goal(goal)).unwrap_or((goal - p).norm()),
        Aim::Place(_, place) => by_way(Destination::Place(place)).unwrap_or(f64::INFINITY),
        Aim::Direction(direction) => -direction.dot(&position(simulation, i)),
    }
}
