//! The points of ways.

use super::Step;
use super::floor::Floor;
use super::map::{Next, PathMap};
use super::route::{Destination, Route, Ways};
use crate::engine::math::Vector;

/// The most points of a course, far more than the corners of any way.
const MOST_POINTS: usize = 10_000;

/// The shortest way to a goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shortest {
    /// The step by which it leaves the room; `None`: it stays there.
    pub step: Option<Step>,
    /// Its length, meters.
    pub length: f64,
}

impl Ways {
    /// The points of the shortest way from `p`, meters: its corners in order, then its end. Empty if there is no way.
    pub fn course(&self, p: Vector, to: Destination) -> Vec<Vector> {
        let first = self.map_to(to).zip(self.way(p, to));
        first.map_or(Vec::new(), |(map, way)| {
            points(&self.floor, &self.maps[usize::from(map)], way.next)
        })
    }

    /// The step by which the shortest way of a path map leaves the room of `p`, in triangle `t` of the rooms, and its
    /// length, meters.
    pub fn shortest(&self, (p, t): (Vector, u32), map: u16) -> Option<Shortest> {
        let way = self.from(map, p)?;
        let points = points(&self.floor, &self.maps[usize::from(map)], way.next);
        Some(Shortest {
            step: self.rooms.as_ref()?.first_on(p, t, &points),
            length: way.length,
        })
    }

    /// The points of the rest of a route, as in [`course`](Self::course); of a detour, those up to its opening.
    pub fn course_of(&self, route: &Route) -> Vec<Vector> {
        match self.map_of(route) {
            Some((floor, map)) => points(floor, map, route.first(floor)),
            None => vec![self.next(route)],
        }
    }

    /// The point that an agent on `route` walks to next, meters: a corner or its goal.
    pub fn next(&self, route: &Route) -> Vector {
        let floor = self.floor_of(route);
        route.first(floor).place(floor)
    }
}

/// The last point of the way that begins with `first`, meters.
pub fn end(floor: &Floor, map: &PathMap, first: Next) -> Option<Vector> {
    match first {
        Next::Goal(point) => Some(point),
        Next::Corner { .. } | Next::Out(_) => points(floor, map, first).pop(),
    }
}

/// The points of the way that begins with `first`, meters.
pub fn points(floor: &Floor, map: &PathMap, first: Next) -> Vec<Vector> {
    let (mut points, mut next) = (Vec::new(), Some(first));
    while let Some(now) = next.take_if(|_| points.len() < MOST_POINTS) {
        match now {
            Next::Goal(point) => points.push(point),
            Next::Corner { bend, .. } => {
                let bends = std::iter::successors(Some(bend), |bend| map.after(*bend));
                let bends: Vec<_> = bends.take(MOST_POINTS).collect();
                points.extend(bends.iter().map(|&bend| floor.place(bend)));
                let last = bends.last();
                points.extend(last.and_then(|&bend| map.end_after(floor, bend)));
            }
            Next::Out(point) => {
                points.push(point);
                next = map.way_from(floor, point).map(|way| way.next);
            }
        }
    }
    points
}
