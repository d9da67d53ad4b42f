//! Rooms: the parts of a floor between its narrow places and doors, and the openings that join them.
//!
//! The narrow places (the passages of `narrow.rs` up to [`WIDEST`]) and the doors of a scene are closed in a second
//! triangulation of the floor. What remains connected is a room; a closed side between two rooms belongs to an opening.
//! Each opening has a path map inside its two rooms, and each goal one inside the rooms from which the way to it
//! crosses no opening.
//!
//! In a building each join is an opening, so that a room lies on one level. Points are those of the building; lengths
//! on slopes are those that take as long on a floor.

mod crossing;
mod cuts;
mod limits;
mod located;
mod opening;
mod side;

pub use cuts::Door;
pub use located::Located;
pub use opening::Opening;
pub use side::Side;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use std::sync::Arc;

use rayon::prelude::*;

use super::WayError;
use super::floor::{Floor, Mesh};
use super::paths::{Goal, PathMap, end, points};
use crate::geometry::Area;
use crate::levels::Levels;
use crate::math::{Vector, direction, perpendicular};
use cuts::Cuts;
use limits::Limits;
use opening::{MARGIN, on_both_sides, openings};

/// Wider passages are no openings, meters: the walk through them takes no waiting that counts.
pub const WIDEST: f64 = 6.0;

/// A way through an opening goes on from a point this far behind it, meters.
const BEYOND: f64 = 1e-3;

/// The rooms of a floor, and the routes in them.
#[derive(Debug, Clone)]
pub struct Rooms {
    /// The floor on which openings are closed.
    pub floor: Floor,
    /// The room of each triangle.
    of_triangle: Vec<u32>,
    openings: Vec<Opening>,
    has_one_way: bool,
    /// The sides of openings in each room, and those of them from which agents may pass.
    around: Vec<Vec<Side>>,
    out: Vec<Vec<Side>>,
    limits: Limits,
    /// For each side, the other sides from which agents come into its room, with the length of the way between the
    /// middles of their openings, meters.
    before: Vec<Vec<(Side, f64)>>,
    /// The routes to each goal inside the rooms from which they cross no opening, in the order of the path maps of the
    /// floor.
    goals: Vec<PathMap>,
    /// For each goal, the sides from which a way to it crosses no further opening, with its length beyond, meters.
    last: Vec<Vec<(Side, f64)>>,
    /// For each goal, the lengths of the shortest routes from each side, meters.
    lengths: Vec<Vec<f64>>,
}

impl Rooms {
    /// The rooms of a floor, which is given as `areas` that share at most points, for path maps to `goals`. Passages
    /// narrower than `least_width` meters are closed. Doors divide rooms, and passages up to `widest` meters, and the
    /// joins of `levels`.
    ///
    /// # Errors
    /// As [`Mesh::new`], or the floors on both sides of a join differ along it.
    pub fn new(
        (areas, levels): (&[Area], Option<&Arc<Levels>>),
        [least_width, widest]: [f64; 2],
        doors: &[Door],
        goals: &[Vec<Goal>],
    ) -> Result<Self, WayError> {
        let open = Mesh::new(areas, 0.0)?;
        let mut cuts = Cuts::of(&open, [least_width, widest], doors, levels);
        let (mesh, sheets) = cuts.mesh(areas, levels)?;
        let plane = sheets.as_ref().map_or(&mesh, |sheets| &sheets.mesh);
        cuts.keep_separating(&cuts.sides(plane), &mesh.parts());
        let (mesh, sheets) = cuts.mesh(areas, levels)?;
        let floor = Floor::prepared(mesh, sheets, least_width);
        let of_triangle = floor.mesh.parts();
        let openings = openings(&floor, &cuts, &of_triangle)?;
        let count = of_triangle.iter().max().map_or(0, |&most| most + 1);
        let mut rooms = Self {
            around: vec![Vec::new(); count as usize],
            out: vec![Vec::new(); count as usize],
            limits: Limits::of(&floor.mesh, &of_triangle),
            before: vec![Vec::new(); 2 * openings.len()],
            goals: Vec::new(),
            last: Vec::new(),
            lengths: Vec::new(),
            has_one_way: openings.iter().any(Opening::is_one_way),
            floor,
            of_triangle,
            openings,
        };
        let sides: Vec<Side> = rooms.sides().collect();
        for &side in &sides {
            let room = rooms.room_on(side) as usize;
            rooms.around[room].push(side);
            if rooms.is_passable(side) {
                rooms.out[room].push(side);
            }
        }
        let before = sides.par_iter().map(|&side| rooms.sides_before(side));
        rooms.before = before.collect();
        for goals in goals {
            rooms.add_goal(goals, None)?;
        }
        Ok(rooms)
    }

    /// Adds the routes to a goal, or replaces those of goal number `replaced`.
    ///
    /// # Errors
    /// The goal is not on the floor.
    pub fn add_goal(&mut self, goals: &[Goal], replaced: Option<usize>) -> Result<(), WayError> {
        let goals = goals.iter().flat_map(|goal| match *goal {
            Goal::Point(_) => vec![goal.clone()],
            Goal::Line(ends) => on_both_sides(ends).to_vec(),
        });
        let goals: Vec<Goal> = goals.collect();
        let map = PathMap::within(&self.floor, &goals, MARGIN)?;
        let last = |side| Some((side, self.length_beyond(side, &map)?));
        let last = self.sides().filter_map(last).collect();
        let k = replaced.unwrap_or(self.goals.len());
        match replaced {
            Some(_) => (self.goals[k], self.last[k]) = (map, last),
            None => {
                self.goals.push(map);
                self.last.push(last);
                self.lengths.push(Vec::new());
            }
        }
        self.lengths[k] = self.onward(k, |_, length| length);
        Ok(())
    }

    /// The length of the shortest way from `p` to a goal that passes one-way doors in their direction only, meters;
    /// infinite without one. Measured over the middles of openings.
    pub fn length(&self, p: Vector, goal: usize) -> f64 {
        let Some(t) = self.floor.locate_or_nearest(None, p) else {
            return f64::INFINITY;
        };
        let p = self.floor.in_building(p);
        let direct = self.length_to_goal(p, t, goal);
        let sides = self.sides_in(self.room(t)).iter();
        let through = sides.filter_map(|&side| {
            let onward = self.lengths[goal][side.index()];
            let [length, aside] = self.lengths_to(p, t, side)?;
            onward.is_finite().then_some(length + aside + onward)
        });
        let lengths = direct.into_iter().chain(through);
        lengths.fold(f64::INFINITY, f64::min)
    }

    /// Whether a door is an opening between two rooms.
    pub fn has_door(&self, place: u16) -> bool {
        let mut openings = self.openings.iter();
        openings.any(|opening| opening.door() == Some(place))
    }

    /// Whether some doors can be passed in one direction only.
    pub fn has_one_way(&self) -> bool {
        self.has_one_way
    }

    /// The length of the shortest way from a side to a goal, meters, measured over the middles of openings.
    pub fn length_from(&self, side: Side, goal: usize) -> f64 {
        self.lengths[goal][side.index()]
    }

    /// The sides of all openings.
    pub fn sides(&self) -> impl ExactSizeIterator<Item = Side> + use<> {
        Side::all(self.openings.len())
    }

    /// The openings.
    pub fn openings(&self) -> &[Opening] {
        &self.openings
    }

    /// The opening of a side.
    pub fn opening(&self, side: Side) -> &Opening {
        &self.openings[side.opening()]
    }

    /// The straight parts of an opening in the plane, of a join those on one of its levels, meters.
    pub fn pieces_of<'a>(&'a self, opening: &'a Opening) -> impl Iterator<Item = [Vector; 2]> + 'a {
        let pieces = opening.pieces().iter();
        pieces.map(|ends| ends.map(|p| self.floor.in_plane(opening.beside[0], p)))
    }

    /// The routes to the opening of a side.
    pub fn map(&self, side: Side) -> &PathMap {
        &self.opening(side).map
    }

    /// The number of goals.
    pub fn goals(&self) -> usize {
        self.goals.len()
    }

    /// The routes to a goal inside the rooms from which they cross no opening.
    pub fn goal(&self, goal: usize) -> Option<&PathMap> {
        self.goals.get(goal)
    }

    /// The room of a triangle.
    pub fn room(&self, triangle: u32) -> u32 {
        self.of_triangle[triangle as usize]
    }

    /// The number of rooms.
    pub fn count(&self) -> usize {
        self.out.len()
    }

    /// The room on a side.
    pub fn room_on(&self, side: Side) -> u32 {
        self.opening(side).rooms[1 - side.beyond()]
    }

    /// The room beyond the opening of a side.
    pub fn room_beyond(&self, side: Side) -> u32 {
        self.opening(side).rooms[side.beyond()]
    }

    /// The sides of openings in a room from which agents may pass, in order.
    pub fn sides_in(&self, room: u32) -> &[Side] {
        &self.out[room as usize]
    }

    /// The side from which all routes to a goal leave a room; `None` if there are several, or the goal is there.
    pub fn only_side(&self, room: u32, goal: usize) -> Option<Side> {
        let sides = self.sides_in(room).iter();
        let mut sides = sides.filter(|&&side| self.length_from(side, goal).is_finite());
        let only = sides.next().filter(|_| sides.next().is_none())?;
        let mut last = self.last[goal].iter();
        let is_here = last.any(|&(side, _)| self.room_beyond(side) == room);
        (!is_here && !self.has_one_way).then_some(*only)
    }

    /// The length of the longest way from another opening of its room to the opening of a side, meters; infinite if the
    /// room has no other.
    pub fn depth(&self, side: Side) -> f64 {
        let lengths = self.before[side.index()].iter().map(|&(_, length)| length);
        lengths.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// The side in one room, with another room beyond, whose opening is nearest to `p`; `None` if there is none.
    pub fn side_between(&self, from: u32, to: u32, p: Vector) -> Option<Side> {
        let sides = self.around[from as usize].iter().copied();
        let sides = sides.filter(|&side| self.room_beyond(side) == to);
        let distance = |side| self.opening(side).distance(p);
        sides.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }

    /// The distance from `p` in triangle `t` to the nearest opening or closed passage at which its room ends, at most a
    /// meter. An agent that stays nearer to `p` stays in the room.
    pub fn free_distance(&self, t: u32, p: Vector) -> f64 {
        self.limits.distance(t, p)
    }

    /// The length of the way from `p` in triangle `t` to the opening of a side, inside of the room, meters.
    pub fn length_to(&self, p: Vector, t: u32, side: Side) -> Option<f64> {
        let length = self.map(side).way(&self.floor, p, t, None)?.length;
        Some(length * self.effort(t, [p, self.opening(side).middle()]))
    }

    /// By how much the way from one place to another in the room of triangle `t` takes longer than on a floor.
    fn effort(&self, t: u32, ends: [Vector; 2]) -> f64 {
        let sheets = self.floor.sheets();
        sheets.map_or(1.0, |sheets| sheets.effort(t, ends))
    }

    /// As [`length_to`](Self::length_to), and the distance from where that way ends to the middle of the opening,
    /// meters.
    pub fn lengths_to(&self, p: Vector, t: u32, side: Side) -> Option<[f64; 2]> {
        let map = self.map(side);
        let way = map.way(&self.floor, p, t, None)?;
        let aside = |end: Vector| (end - self.opening(side).middle()).norm();
        let aside = end(&self.floor, map, way.next).map_or(0.0, aside);
        let effort = self.effort(t, [p, self.opening(side).middle()]);
        Some([way.length, aside].map(|length| length * effort))
    }

    /// The length of the way from `p` in triangle `t` to a goal, if it crosses no opening, meters.
    pub fn length_to_goal(&self, p: Vector, t: u32, goal: usize) -> Option<f64> {
        let map = &self.goals[goal];
        let way = map.way(&self.floor, p, t, None)?;
        let end = end(&self.floor, map, way.next).unwrap_or(p);
        Some(way.length * self.effort(t, [p, end]))
    }

    /// The points of the way from `p` in triangle `t` to the opening of a side, or to a goal in the room, meters.
    pub fn course(&self, (p, t): (Vector, u32), goal: usize, side: Option<Side>) -> Vec<Vector> {
        let map = side.map_or_else(|| &self.goals[goal], |side| self.map(side));
        let way = map.way(&self.floor, p, t, None);
        way.map_or(Vec::new(), |way| {
            points(&self.floor, map, way.next).collect()
        })
    }

    /// The place a little beyond the opening of a side, for a way that ends at `p` on the opening, in the plane.
    pub fn beyond(&self, side: Side, p: Vector) -> Vector {
        let t = self.opening(side).beside[side.beyond()];
        self.floor.in_plane(t, p + self.ahead(side) * BEYOND)
    }

    /// The direction from a side across its opening, of length 1.
    pub fn ahead(&self, side: Side) -> Vector {
        let opening = self.opening(side);
        let [a, b] = opening.longest();
        let across = perpendicular(direction(b - a));
        let inside = self.floor.mesh.middle(opening.beside[side.beyond()]);
        if across.dot(&(inside - a)) > 0.0 {
            across
        } else {
            -across
        }
    }

    /// For each side, the least time from its opening to a goal, seconds; infinite without a way. `leg` gives the time
    /// from the middle of an opening over a way of some length through that of another side, or to the goal (`None`).
    pub fn onward(&self, goal: usize, leg: impl Fn(Option<Side>, f64) -> f64) -> Vec<f64> {
        let mut onward = vec![f64::INFINITY; self.sides().len()];
        // The bits of numbers that are not negative sort like the numbers.
        let mut queue = BinaryHeap::new();
        let mut found: Vec<(Side, f64)> = Vec::new();
        let last = self.last[goal].iter();
        found.extend(last.map(|&(side, length)| (side, leg(None, length))));
        loop {
            for (side, time) in found.drain(..) {
                if time < onward[side.index()] {
                    onward[side.index()] = time;
                    queue.push(Reverse((time.to_bits(), side)));
                }
            }
            let Some(Reverse((bits, side))) = queue.pop() else {
                return onward;
            };
            let time = onward[side.index()];
            if time.to_bits() == bits {
                let before = self.before[side.index()].iter();
                found.extend(before.map(|&(s, length)| (s, time + leg(Some(side), length))));
            }
        }
    }

    /// The memory that they take, bytes.
    pub fn bytes(&self) -> usize {
        let maps = self.openings.iter().map(|opening| &opening.map);
        let before = self.before.iter().chain(&self.last).map(Vec::len);
        self.floor.bytes()
            + maps.chain(&self.goals).map(PathMap::bytes).sum::<usize>()
            + before.sum::<usize>() * size_of::<(Side, f64)>()
            + size_of_val(&self.of_triangle[..])
            + self.limits.bytes()
    }

    /// Whether agents may pass from a side: its opening is no one-way door in the other direction.
    fn is_passable(&self, side: Side) -> bool {
        let only = self.opening(side).door.and_then(|(_, only)| only);
        only.is_none_or(|only| only == side.beyond())
    }

    /// The sides from which agents come into the room of a side, with the lengths of the routes between their openings.
    fn sides_before(&self, side: Side) -> Vec<(Side, f64)> {
        let room = self.room_on(side);
        let all = self.sides();
        let all = all.filter(|&s| self.is_passable(s) && self.is_passable(side));
        let all = all.filter(|&s| self.room_beyond(s) == room && s.opening() != side.opening());
        let lengths = all.filter_map(|s| {
            let from = self.opening(s);
            let [length, aside] = self.lengths_to(from.middle(), from.beside[s.beyond()], side)?;
            Some((s, length + aside))
        });
        lengths.collect()
    }

    /// The length of the way of `map` from the middle of the opening of a side, in the room beyond, meters.
    fn length_beyond(&self, side: Side, map: &PathMap) -> Option<f64> {
        if !self.is_passable(side) {
            return None;
        }
        let opening = self.opening(side);
        let (t, from) = (opening.beside[side.beyond()], opening.middle());
        let way = map.way(&self.floor, from, t, None)?;
        let end = end(&self.floor, map, way.next).unwrap_or(from);
        Some(way.length * self.effort(t, [from, end]))
    }
}
