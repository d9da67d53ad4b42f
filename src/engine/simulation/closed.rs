//! Which ways closed doors block, and until when.

use serde::Serialize;

use super::Simulation;
use crate::journeys::{Change, ChangeKind};
use crate::math::Vector;
use crate::scene::Scene;
use crate::ways::{Rooms, Step};

/// A way goes on this far behind an opening, meters.
const BEYOND: f64 = 1e-3;

/// A way that closed doors block.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Closed {
    /// When the times and events of the scenario open it, seconds; `None`: never.
    pub until_secs: Option<f64>,
}

impl std::fmt::Display for Closed {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self.until_secs {
            Some(until) => write!(f, "closed until {until:.2} s"),
            None => f.write_str("closed"),
        }
    }
}

impl Simulation {
    /// Whether closed doors block every way of agent `i` to a path map's goal, or every one that begins with `step`.
    pub fn closed_way(&self, i: usize, goal: u16, step: Option<Step>) -> Option<Closed> {
        let (scene, goal) = (&self.fixed.scene, usize::from(goal));
        let rooms = scene.rooms()?;
        let p = self.crowd.agents.position[i];
        let here = rooms.floor.locate_or_nearest(None, p)?;
        if step.is_none() && rooms.length_to_goal(p, here, goal).is_some() {
            return None;
        }
        let steps = match &step {
            Some(step) => std::slice::from_ref(step),
            None => rooms.steps_out(rooms.room(here)),
        };
        let places = self.crowd.progress.places.iter();
        let mut open: Vec<bool> = places.map(|place| place.open).collect();
        let is_blocked = |open: &[bool]| blocks(rooms, (steps, goal), open);
        if !is_blocked(&open) {
            return None;
        }
        Some(Closed {
            until_secs: later(scene, self.crowd.clock.time(), |place, kind| {
                if let Some(open) = open.get_mut(usize::from(place)) {
                    *open = kind == ChangeKind::Open;
                }
                !is_blocked(&open)
            }),
        })
    }
}

impl Simulation {
    /// The points of the shortest way of agent `i` to a path map's goal that begins with `step` and then avoids the
    /// doors that are closed now, as far as that is possible, meters.
    pub fn way_through(&self, i: usize, goal: u16, step: Step) -> Option<Vec<Vector>> {
        let (rooms, goal) = (self.fixed.scene.rooms()?, usize::from(goal));
        let places = self.crowd.progress.places.iter();
        let open: Vec<bool> = places.map(|place| place.open).collect();
        let onward = rooms.onward(goal, |next, length| {
            match next.is_some_and(|next| is_shut(rooms, next, &open)) {
                true => f64::INFINITY,
                false => length,
            }
        });
        let (mut p, mut step) = (self.crowd.agents.position[i], step);
        let mut here = rooms.floor.locate_or_nearest(None, p)?;
        let mut points = Vec::new();
        for _ in 0..rooms.steps() {
            points.extend(rooms.course((p, here), goal, Some(step)));
            p = points.last()? + rooms.ahead(step) * BEYOND;
            points.push(p);
            here = rooms.floor.locate_or_nearest(None, p)?;
            let steps = rooms.steps_out(rooms.room(here)).iter().copied();
            let steps = steps.filter(|&step| !is_shut(rooms, step, &open));
            let lengths = steps.filter_map(|step| {
                let length = rooms.length_to(p, here, step)? + onward[step as usize];
                length.is_finite().then_some((length, step))
            });
            let next = lengths.min_by(|(a, _), (b, _)| a.total_cmp(b));
            let direct = rooms.length_to_goal(p, here, goal);
            match next.filter(|&(length, _)| direct.is_none_or(|direct| length < direct)) {
                Some((_, next)) => step = next,
                None => break,
            }
        }
        points.extend(rooms.course((p, here), goal, None));
        Some(points)
    }
}

/// The time of the first changes of places after `now`, all those of one instant together, after the last of which
/// `is_it` holds, seconds.
fn later(scene: &Scene, now: f64, mut is_it: impl FnMut(u16, ChangeKind) -> bool) -> Option<f64> {
    let together = scene.journeys.changes.chunk_by(|a, b| a.at == b.at);
    let mut later = together.filter(|changes| changes[0].at > now);
    let holds = |changes: &&[Change]| {
        let all = changes
            .iter()
            .map(|change| is_it(change.place, change.kind));
        all.last().unwrap_or(false)
    };
    later.find(holds).map(|changes| changes[0].at)
}

/// Whether a step leads through a door that is not open.
fn is_shut(rooms: &Rooms, step: Step, open: &[bool]) -> bool {
    let door = rooms.opening(step).door();
    door.is_some_and(|door| open.get(usize::from(door)) == Some(&false))
}

/// Whether all ways to a goal that begin with one of some steps lead through a door that is not open.
fn blocks(rooms: &Rooms, (steps, goal): (&[Step], usize), open: &[bool]) -> bool {
    let is_shut = |step: Step| is_shut(rooms, step, open);
    let onward = rooms.onward(goal, |step, length| match step.is_some_and(is_shut) {
        true => f64::INFINITY,
        false => length,
    });
    steps
        .iter()
        .all(|&step| is_shut(step) || !onward[step as usize].is_finite())
}
