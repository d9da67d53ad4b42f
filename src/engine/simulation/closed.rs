//! Which routes closed doors block, and until when.

use serde::Serialize;

use super::Simulation;
use crate::journeys::{Change, ChangeKind};
use crate::math::Vector;
use crate::routes::{Rooms, Side};
use crate::scene::Scene;

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
    /// Whether closed doors block every way of agent `i` to a path map's goal, or every one that leaves by `side`.
    pub fn closed_way(&self, i: usize, goal: u16, side: Option<Side>) -> Option<Closed> {
        let (scene, goal) = (&self.fixed.scene, usize::from(goal));
        let rooms = scene.rooms()?;
        let p = self.crowd.agents.position[i];
        let here = rooms.floor.locate_or_nearest(None, p)?;
        let at = rooms.floor.in_building(p);
        if side.is_none() && rooms.length_to_goal(at, here, goal).is_some() {
            return None;
        }
        let sides = match &side {
            Some(side) => std::slice::from_ref(side),
            None => rooms.sides_in(rooms.room(here)),
        };
        let mut open = self.open_places();
        let is_blocked = |open: &[bool]| blocks(rooms, (sides, goal), open);
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

    /// Which places are open now.
    fn open_places(&self) -> Vec<bool> {
        let places = self.crowd.progress.places.iter();
        places.map(|place| place.open).collect()
    }

    /// The points of the shortest way of agent `i` to a path map's goal that leaves by `side` and then avoids the
    /// doors that are closed now, as far as that is possible, meters.
    pub fn way_through(&self, i: usize, goal: u16, side: Side) -> Option<Vec<Vector>> {
        let (rooms, goal) = (self.fixed.scene.rooms()?, usize::from(goal));
        let open = self.open_places();
        let onward = lengths(rooms, goal, &open);
        let (start, mut side) = (self.crowd.agents.position[i], side);
        let mut here = rooms.floor.locate_or_nearest(None, start)?;
        let mut p = rooms.floor.in_building(start);
        let shift = start - p;
        let mut points = Vec::new();
        for _ in 0..rooms.sides().len() {
            points.extend(rooms.course((p, here), goal, Some(side)));
            let beyond = rooms.beyond(side, *points.last()?);
            p = rooms.floor.in_building(beyond);
            points.push(p);
            here = rooms.floor.locate_or_nearest(None, beyond)?;
            let sides = rooms.sides_in(rooms.room(here)).iter().copied();
            let sides = sides.filter(|&side| !is_shut(rooms, side, &open));
            let lengths = sides.filter_map(|side| {
                let length = rooms.length_to(p, here, side)? + onward[side.index()];
                length.is_finite().then_some((length, side))
            });
            let next = lengths.min_by(|(a, _), (b, _)| a.total_cmp(b));
            let direct = rooms.length_to_goal(p, here, goal);
            match next.filter(|&(length, _)| direct.is_none_or(|direct| length < direct)) {
                Some((_, next)) => side = next,
                None => break,
            }
        }
        points.extend(rooms.course((p, here), goal, None));
        // As seen from the agent.
        Some(points.into_iter().map(|point| point + shift).collect())
    }
}

/// The time of the first changes of places after `now`, all those of one instant together, after the last of which
/// `is_it` holds, seconds.
fn later(scene: &Scene, now: f64, mut is_it: impl FnMut(u16, ChangeKind) -> bool) -> Option<f64> {
    let together = scene.journeys.changes.chunk_by(|a, b| a.at == b.at);
    let mut later = together.filter(|changes| changes[0].at > now);
    let holds = |changes: &&[Change]| {
        let all = changes.iter();
        let all = all.map(|change| is_it(change.place, change.kind));
        all.last().unwrap_or(false)
    };
    later.find(holds).map(|changes| changes[0].at)
}

/// Whether the opening of a side is a door that is not open.
fn is_shut(rooms: &Rooms, side: Side, open: &[bool]) -> bool {
    let door = rooms.opening(side).door();
    door.is_some_and(|door| open.get(usize::from(door)) == Some(&false))
}

/// For each side, the length of the shortest way from its opening to a goal through open doors, meters; infinite
/// without one.
fn lengths(rooms: &Rooms, goal: usize, open: &[bool]) -> Vec<f64> {
    let is_shut = |side: Side| is_shut(rooms, side, open);
    rooms.onward(goal, |side, length| match side.is_some_and(is_shut) {
        true => f64::INFINITY,
        false => length,
    })
}

/// Whether all routes to a goal that leave by one of some sides lead through a door that is not open.
fn blocks(rooms: &Rooms, (sides, goal): (&[Side], usize), open: &[bool]) -> bool {
    let onward = lengths(rooms, goal, open);
    let is_closed = |&side: &Side| is_shut(rooms, side, open) || !onward[side.index()].is_finite();
    sides.iter().all(is_closed)
}
