//! Rooms: the parts of a floor between its narrow places and doors, and the openings that join them.
//!
//! The narrow places (the passages of `narrow.rs` up to [`WIDEST`]) and the doors of a scene are closed in a second
//! triangulation of the floor. What remains connected is a room; a closed side between two rooms belongs to an opening.
//! Each opening has a path map inside its two rooms, and each goal one inside the rooms from which the way to it
//! crosses no opening.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use rayon::prelude::*;

use super::WayError;
use super::course::{end, points};
use super::cuts::{Cuts, Door, parts};
use super::floor::Floor;
use super::goal::Goal;
use super::limits::Limits;
use super::map::PathMap;
use super::mesh::Mesh;
use super::opening::{MARGIN, Opening, Step, on_both_sides, openings};
use crate::geometry::Area;
use crate::math::{Vector, direction, perpendicular};

/// Wider passages are no openings, meters: the walk through them takes no waiting that counts.
pub const WIDEST: f64 = 6.0;

/// The rooms of a floor, and the ways in them.
#[derive(Debug, Clone)]
pub struct Rooms {
    /// The floor on which openings are closed.
    pub floor: Floor,
    /// The room of each triangle.
    of_triangle: Vec<u32>,
    openings: Vec<Opening>,
    has_one_way: bool,
    /// The steps out of each room, and those of them that can be taken.
    around: Vec<Vec<Step>>,
    out: Vec<Vec<Step>>,
    limits: Limits,
    /// For each step, the steps that can come before it in its room, with the length of the way between the middles of
    /// their openings, meters.
    before: Vec<Vec<(Step, f64)>>,
    /// The ways to each goal inside the rooms from which they cross no opening, in the order of the path maps of the
    /// floor.
    goals: Vec<PathMap>,
    /// For each goal, the steps after which a way to it crosses no further opening, with its length, meters.
    last: Vec<Vec<(Step, f64)>>,
    /// For each goal, the lengths of the shortest ways from each step, meters.
    lengths: Vec<Vec<f64>>,
}

impl Rooms {
    /// The rooms of a floor, which is given as `areas` that share at most points, for path maps to `goals`. Passages
    /// narrower than `least_width` meters are closed. Doors divide rooms, and passages up to `widest` meters.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn new(
        areas: &[Area],
        least_width: f64,
        doors: &[Door],
        widest: f64,
        goals: &[Vec<Goal>],
    ) -> Result<Self, WayError> {
        let open = Mesh::new(areas, 0.0)?;
        let mut cuts = Cuts::of(&open, least_width, widest, doors);
        let mesh = cuts.mesh(areas)?;
        cuts.keep_separating(&cuts.sides(&mesh), &parts(&mesh));
        let floor = Floor::of(cuts.mesh(areas)?, least_width);
        let of_triangle = parts(&floor.mesh);
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
        for step in 0..rooms.steps() {
            let source = rooms.source(step) as usize;
            rooms.around[source].push(step);
            if rooms.is_passable(step) {
                rooms.out[source].push(step);
            }
        }
        let before = (0..rooms.steps()).into_par_iter();
        rooms.before = before.map(|step| rooms.steps_before(step)).collect();
        for goals in goals {
            rooms.add_goal(goals, None)?;
        }
        Ok(rooms)
    }

    /// Adds the ways to a goal, or replaces those of goal number `replaced`.
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
        let steps = 0..self.steps();
        let last = steps.filter_map(|step| Some((step, self.length_after(step, &map)?)));
        let last = last.collect();
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
        let direct = self.length_to_goal(p, t, goal);
        let steps = self.steps_out(self.room(t)).iter();
        let through = steps.filter_map(|&step| {
            let onward = self.lengths[goal][step as usize];
            let [length, aside] = self.lengths_to(p, t, step)?;
            onward.is_finite().then_some(length + aside + onward)
        });
        direct
            .into_iter()
            .chain(through)
            .fold(f64::INFINITY, f64::min)
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

    /// The length of the shortest way from a step to a goal, meters, measured over the middles of openings.
    pub fn length_from(&self, step: Step, goal: usize) -> f64 {
        self.lengths[goal][step as usize]
    }

    /// The number of steps.
    pub fn steps(&self) -> Step {
        2 * self.openings.len() as Step
    }

    /// The openings.
    pub fn openings(&self) -> &[Opening] {
        &self.openings
    }

    /// The opening of a step.
    pub fn opening(&self, step: Step) -> &Opening {
        &self.openings[step as usize / 2]
    }

    /// The ways to the opening of a step.
    pub fn map(&self, step: Step) -> &PathMap {
        &self.opening(step).map
    }

    /// The number of goals.
    pub fn goals(&self) -> usize {
        self.goals.len()
    }

    /// The ways to a goal inside the rooms from which they cross no opening.
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

    /// The room that a step leaves.
    pub fn source(&self, step: Step) -> u32 {
        self.opening(step).rooms[1 - step as usize % 2]
    }

    /// The room that a step enters.
    pub fn target(&self, step: Step) -> u32 {
        self.opening(step).rooms[step as usize % 2]
    }

    /// The steps out of a room, in order.
    pub fn steps_out(&self, room: u32) -> &[Step] {
        &self.out[room as usize]
    }

    /// The step out of a room by which all ways to a goal leave it; `None` if there are several, or the goal is there.
    pub fn only_step(&self, room: u32, goal: usize) -> Option<Step> {
        let steps = self.steps_out(room).iter();
        let mut steps = steps.filter(|&&step| self.length_from(step, goal).is_finite());
        let only = steps.next().filter(|_| steps.next().is_none())?;
        let mut last = self.last[goal].iter();
        let is_here = last.any(|&(step, _)| self.target(step) == room);
        (!is_here && !self.has_one_way).then_some(*only)
    }

    /// The length of the longest way from another opening of its room to the opening of a step, meters; infinite if the
    /// room has no other.
    pub fn depth(&self, step: Step) -> f64 {
        let lengths = self.before[step as usize].iter().map(|&(_, length)| length);
        lengths.reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// The step from one room to another whose opening is nearest to `p`; `None` if there is none.
    pub fn step_between(&self, from: u32, to: u32, p: Vector) -> Option<Step> {
        let steps = self.around[from as usize].iter().copied();
        let steps = steps.filter(|&step| self.target(step) == to);
        let distance = |step| self.opening(step).distance(p);
        steps.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }

    /// The distance from `p` in triangle `t` to the nearest opening or closed passage at which its room ends, at most a
    /// meter. An agent that stays nearer to `p` stays in the room.
    pub fn free_distance(&self, t: u32, p: Vector) -> f64 {
        self.limits.distance(t, p)
    }

    /// The length of the way from `p` in triangle `t` to the opening of a step, inside of the room, meters.
    pub fn length_to(&self, p: Vector, t: u32, step: Step) -> Option<f64> {
        Some(self.map(step).way(&self.floor, p, t, None)?.length)
    }

    /// As [`length_to`](Self::length_to), and the distance from where that way ends to the middle of the opening,
    /// meters.
    pub fn lengths_to(&self, p: Vector, t: u32, step: Step) -> Option<[f64; 2]> {
        let map = self.map(step);
        let way = map.way(&self.floor, p, t, None)?;
        let aside = |end: Vector| (end - self.opening(step).middle()).norm();
        let aside = end(&self.floor, map, way.next).map_or(0.0, aside);
        Some([way.length, aside])
    }

    /// The length of the way from `p` in triangle `t` to a goal, if it crosses no opening, meters.
    pub fn length_to_goal(&self, p: Vector, t: u32, goal: usize) -> Option<f64> {
        Some(self.goals[goal].way(&self.floor, p, t, None)?.length)
    }

    /// The points of the way from `p` in triangle `t` to the opening of a step, or to a goal in the room, meters.
    pub fn course(&self, (p, t): (Vector, u32), goal: usize, step: Option<Step>) -> Vec<Vector> {
        let map = step.map_or_else(|| &self.goals[goal], |step| self.map(step));
        let way = map.way(&self.floor, p, t, None);
        way.map_or(Vec::new(), |way| {
            points(&self.floor, map, way.next).collect()
        })
    }

    /// The direction of a step across its opening, of length 1.
    pub fn ahead(&self, step: Step) -> Vector {
        let opening = self.opening(step);
        let [a, b] = opening.longest();
        let across = perpendicular(direction(b - a));
        let inside = self.floor.mesh.middle(opening.beside[step as usize % 2]);
        if across.dot(&(inside - a)) > 0.0 {
            across
        } else {
            -across
        }
    }

    /// For each step, the least time from its opening to a goal, seconds; infinite without a way. `leg` gives the time
    /// from the middle of an opening over a way of some length to the end of a step, or to the goal (`None`).
    pub fn onward(&self, goal: usize, leg: impl Fn(Option<Step>, f64) -> f64) -> Vec<f64> {
        let mut onward = vec![f64::INFINITY; self.steps() as usize];
        // The bits of numbers that are not negative sort like the numbers.
        let mut queue = BinaryHeap::new();
        let mut found: Vec<(Step, f64)> = Vec::new();
        let last = self.last[goal].iter();
        found.extend(last.map(|&(step, length)| (step, leg(None, length))));
        loop {
            for (step, time) in found.drain(..) {
                if time < onward[step as usize] {
                    onward[step as usize] = time;
                    queue.push(Reverse((time.to_bits(), step)));
                }
            }
            let Some(Reverse((bits, step))) = queue.pop() else {
                return onward;
            };
            let time = onward[step as usize];
            if time.to_bits() == bits {
                let before = self.before[step as usize].iter();
                found.extend(before.map(|&(s, length)| (s, time + leg(Some(step), length))));
            }
        }
    }

    /// The memory that they take, bytes.
    pub fn bytes(&self) -> usize {
        let maps = self.openings.iter().map(|opening| &opening.map);
        let before = self.before.iter().chain(&self.last).map(Vec::len);
        self.floor.bytes()
            + maps.chain(&self.goals).map(PathMap::bytes).sum::<usize>()
            + before.sum::<usize>() * size_of::<(Step, f64)>()
            + size_of_val(&self.of_triangle[..])
            + self.limits.bytes()
    }

    /// Whether agents may take a step: it does not lead through a one-way door against its direction.
    fn is_passable(&self, step: Step) -> bool {
        let only = self.opening(step).door.and_then(|(_, only)| only);
        only.is_none_or(|only| only == step as usize % 2)
    }

    /// The steps into the room that a step leaves, with the lengths of the ways between them.
    fn steps_before(&self, step: Step) -> Vec<(Step, f64)> {
        let room = self.source(step);
        let all = (0..self.steps()).filter(|&s| self.is_passable(s) && self.is_passable(step));
        let all = all.filter(|&s| self.target(s) == room && s / 2 != step / 2);
        let lengths = all.filter_map(|s| {
            let from = self.opening(s);
            let [length, aside] =
                self.lengths_to(from.middle(), from.beside[s as usize % 2], step)?;
            Some((s, length + aside))
        });
        lengths.collect()
    }

    /// The length of the way of `map` from the middle of the opening of a step, in the room that it enters, meters.
    fn length_after(&self, step: Step, map: &PathMap) -> Option<f64> {
        if !self.is_passable(step) {
            return None;
        }
        let opening = self.opening(step);
        let t = opening.beside[step as usize % 2];
        Some(map.way(&self.floor, opening.middle(), t, None)?.length)
    }
}
