//! The points of ways.

use rayon::prelude::*;

use super::Step;
use super::floor::Floor;
use super::map::{Next, PathMap};
use super::rooms::Rooms;
use super::route::{Destination, Route, Ways};
use crate::math::Vector;

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

/// The ways out of a room that lead to a goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaving {
    /// The triangle of the rooms from which they lead.
    pub triangle: u32,
    /// The number of the path map to the goal.
    pub goal: u16,
    /// The length of the way to the goal inside of the room, meters.
    pub direct: Option<f64>,
    /// Steps out of the room, each with the length of the way to its opening and the distance from where that ends to
    /// the middle of the opening, meters.
    pub through: Vec<(Step, [f64; 2])>,
    /// The shortest of all ways to the goal, also through one-way doors against their direction.
    pub shortest: Option<Shortest>,
}

/// What is known of the ways from a position to a goal.
#[derive(Debug, Clone, Copy, Default)]
pub struct Known<'a> {
    /// The ways to another goal from there.
    pub leaving: Option<&'a Leaving>,
    /// The length of the shortest way, meters.
    pub length: Option<f64>,
}

impl Leaving {
    /// The lengths for a step, meters, if it is one of these ways.
    pub fn through(&self, step: Step) -> Option<[f64; 2]> {
        let mut through = self.through.iter();
        through.find(|way| way.0 == step).map(|way| way.1)
    }
}

impl Ways {
    /// The points of the shortest way from `p`, meters: its corners in order, then its end. Empty if there is no way.
    pub fn course(&self, p: Vector, to: Destination) -> Vec<Vector> {
        let first = self.map_to(to).zip(self.way(p, to));
        first.map_or(Vec::new(), |(map, way)| {
            points(&self.floor, &self.maps[usize::from(map)], way.next).collect()
        })
    }

    /// Divides the floor into rooms.
    pub fn divide(&mut self, rooms: Rooms) {
        let mesh = &rooms.floor.mesh;
        let triangles = (0..mesh.triangles().len() as u32).into_par_iter();
        let beneath = triangles.map(|t| self.floor.locate_or_nearest(None, mesh.middle(t)));
        self.beneath = beneath.collect();
        self.rooms = Some(rooms);
    }

    /// The rooms of the floor, if it is divided.
    pub fn rooms(&self) -> Option<&Rooms> {
        self.rooms.as_ref()
    }

    /// The ways out of the room of `p`, in triangle `t` of the rooms, that lead to the goal of a path map, and the
    /// shortest of all ways; `None` without rooms.
    pub fn leaving(&self, (p, t): (Vector, u32), map: u16, known: Known) -> Option<Leaving> {
        let (rooms, goal) = (self.rooms.as_ref()?, usize::from(map));
        let steps = rooms.steps_out(rooms.room(t)).iter();
        let steps = steps.filter(|&&step| rooms.length_from(step, goal).is_finite());
        let through = steps.filter_map(|&step| {
            let known = known.leaving.and_then(|known| known.through(step));
            Some((step, known.or_else(|| rooms.lengths_to(p, t, step))?))
        });
        let (direct, through) = (
            rooms.length_to_goal(p, t, goal),
            through.collect::<Vec<_>>(),
        );
        let only = match through[..] {
            [(only, _)] if direct.is_none() && !rooms.has_one_way() => Some(only),
            _ => None,
        };
        let shortest = match known.length.filter(|_| only.is_some()) {
            Some(length) => Some(Shortest { step: only, length }),
            None => {
                let beneath = self.beneath[t as usize];
                let here = self.floor.locate_or_nearest(beneath, p)?;
                let way = self.maps[goal].way(&self.floor, p, here, None);
                way.map(|way| Shortest {
                    step: only.or_else(|| {
                        let points = points(&self.floor, &self.maps[goal], way.next);
                        rooms.first_crossing(p, t, points).map(|first| first.step)
                    }),
                    length: way.length,
                })
            }
        };
        Some(Leaving {
            triangle: t,
            goal: map,
            direct,
            through,
            shortest,
        })
    }

    /// The points of the rest of a route, as in [`course`](Self::course); of a detour, those up to its opening.
    pub fn course_of(&self, route: &Route) -> Vec<Vector> {
        match self.map_of(route) {
            Some((floor, map)) => points(floor, map, route.first(floor)).collect(),
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
        Next::Corner { .. } | Next::Out(_) => points(floor, map, first).last(),
    }
}

/// The points of the way that begins with `first`, meters.
pub fn points(floor: &Floor, map: &PathMap, first: Next) -> impl Iterator<Item = Vector> {
    let mut next = Some(first);
    let points = std::iter::from_fn(move || {
        let now = next?;
        next = match now {
            Next::Goal(_) => None,
            Next::Corner { bend, .. } => map.after(floor, bend),
            Next::Out(point) => map.way_from(floor, point).map(|way| way.next),
        };
        Some(now.place(floor))
    });
    points.take(MOST_POINTS)
}
