//! Openings between the rooms of a floor.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::cuts::{Closed, Cuts};
use crate::math::{Vector, direction, perpendicular};
use crate::routes::WayError;
use crate::routes::floor::{Floor, side, to_segment};
use crate::routes::paths::{Goal, PathMap};

/// Lines are shortened by this at both ends, meters.
pub const MARGIN: f64 = 0.01;

/// An opening between two rooms.
#[derive(Debug, Clone)]
pub struct Opening {
    /// Its straight parts, of a building at their places there, meters.
    pub(super) pieces: Vec<[Vector; 2]>,
    /// The rooms on its two sides.
    pub(super) rooms: [u32; 2],
    /// Triangles beside its middle, in these rooms.
    pub(super) beside: [u32; 2],
    /// The number of the place of the door, and the room into which it can be passed, if it is a one-way door.
    pub(super) door: Option<(u16, Option<usize>)>,
    /// The routes to it in its two rooms.
    pub(super) map: PathMap,
}

impl Opening {
    /// Its width, meters.
    pub fn width(&self) -> f64 {
        self.pieces.iter().map(|[a, b]| (b - a).norm()).sum()
    }

    /// The middle of its longest part, meters.
    pub fn middle(&self) -> Vector {
        let longest = self.longest();
        0.5 * (longest[0] + longest[1])
    }

    /// Its straight parts, meters.
    pub fn pieces(&self) -> &[[Vector; 2]] {
        &self.pieces
    }

    /// Its distance from `p`, meters.
    pub fn distance(&self, p: Vector) -> f64 {
        let pieces = self.pieces.iter();
        let distances = pieces.map(|&[a, b]| to_segment(p, a, b));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// The number of its place, if it is a door of the scene.
    pub fn door(&self) -> Option<u16> {
        self.door.map(|(place, _)| place)
    }

    /// Whether it can be passed in one direction only.
    pub fn is_one_way(&self) -> bool {
        self.door.is_some_and(|(_, only)| only.is_some())
    }

    /// Its longest straight part, meters.
    pub(super) fn longest(&self) -> [Vector; 2] {
        let length = |[a, b]: &[Vector; 2]| (b - a).norm_squared();
        let all = self.pieces.iter().copied();
        all.reduce(|a, b| if length(&b) > length(&a) { b } else { a })
            .unwrap_or_default()
    }
}

/// Routes end this far before a line that can lie on an opening, meters.
const BEFORE: f64 = 1e-4;

/// Lines beside a line, one on each side: on an opening, only they are seen from both rooms.
pub fn on_both_sides([a, b]: [Vector; 2]) -> [Goal; 2] {
    let aside = perpendicular(direction(b - a)) * BEFORE;
    [aside, -aside].map(|aside| Goal::Line([a + aside, b + aside]))
}

/// Lines beside a closed side, one on each side, in the plane.
fn beside(floor: &Floor, side: &Closed) -> [Goal; 2] {
    let [a, b] = side.ends;
    let is_join = floor
        .sheets()
        .is_some_and(|sheets| sheets.join_between(side.beside, side.ends).is_some());
    if !is_join {
        return on_both_sides([a, b].map(|p| floor.in_plane(side.beside[0], p)));
    }
    let across = perpendicular(direction(b - a)) * BEFORE;
    side.beside.map(|t| {
        let inside = floor.mesh.middle(t) - a;
        let aside = if across.dot(&inside) > 0.0 {
            across
        } else {
            -across
        };
        Goal::Line([a, b].map(|p| floor.in_plane(t, p + aside)))
    })
}

/// The openings between rooms.
pub fn openings(floor: &Floor, cuts: &Cuts, room: &[u32]) -> Result<Vec<Opening>, WayError> {
    let mut sides: BTreeMap<(usize, [u32; 2]), Vec<Closed>> = BTreeMap::new();
    for mut side in cuts.sides_of(floor) {
        let rooms = side.beside.map(|t| room[t as usize]);
        if side.cut < cuts.too_narrow || rooms[0] == rooms[1] {
            continue;
        }
        if rooms[0] > rooms[1] {
            side.beside.reverse();
        }
        let key = (side.cut, [rooms[0].min(rooms[1]), rooms[0].max(rooms[1])]);
        sides.entry(key).or_default().push(side);
    }
    let all: Vec<_> = sides.into_iter().collect();
    let made = all.into_par_iter().map(|((cut, rooms), mut sides)| {
        let length = |side: &Closed| (side.ends[1] - side.ends[0]).norm();
        sides.sort_by(|a, b| length(b).total_cmp(&length(a)));
        let beside = sides[0].beside;
        let pieces: Vec<[Vector; 2]> = sides.iter().map(|side| side.ends).collect();
        let goals: Vec<Goal> = sides
            .iter()
            .flat_map(|side| self::beside(floor, side))
            .collect();
        let door = cuts.door(cut).map(|door| {
            let [a, b] = door.line;
            // People pass from the left to the right of the line.
            let is_left = side(a, b, floor.plane().middle(beside[1])) > 0.0;
            (door.place, door.one_way.then_some(usize::from(!is_left)))
        });
        Ok(Opening {
            map: PathMap::within(floor, &goals, MARGIN)?,
            pieces,
            rooms,
            beside,
            door,
        })
    });
    made.collect()
}
