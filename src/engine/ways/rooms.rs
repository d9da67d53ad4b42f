//! Rooms: the parts of a floor between its narrow places and doors, and the openings that join them.
//!
//! The narrow places (the passages of `narrow.rs` up to [`WIDEST`]) and the doors of a scene are closed in a second
//! triangulation of the floor. What remains connected is a room; a closed side between two rooms belongs to an opening.
//! Each opening has a path map inside its two rooms, and each goal one inside the rooms from which the way to it
//! crosses no opening.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use rayon::prelude::*;

use super::WayError;
use super::floor::Floor;
use super::goal::Goal;
use super::map::PathMap;
use super::mesh::{Mesh, side, to_segment};
use super::narrow::{End, Narrow, narrow};
use super::route::points;
use crate::engine::geometry::Area;
use crate::engine::math::{Vector, direction, perpendicular};

/// Wider passages are no openings, meters: the walk through them takes no waiting that counts.
pub const WIDEST: f64 = 6.0;
/// Of two passages whose middles are nearer than this part of the width of the narrower one, such as the two sides of a
/// wall with a door, only the narrower one is an opening.
const APART: f64 = 0.45;
/// The most openings; wider ones are left out.
const MOST_OPENINGS: usize = 500;
/// Passages are too narrow for ways if they are narrower than the least width by more than this, meters.
const EXACT: f64 = 1e-6;
/// Doors reach this far into the walls at their ends, so that rounding leaves no gap, meters.
const INTO_WALLS: f64 = 0.01;
/// A side of a triangle this near to a passage is a part of it, meters.
const SAME: f64 = 1e-5;
/// Lines are shortened by this at both ends, meters.
const MARGIN: f64 = 0.01;

/// A door of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Door {
    /// Its ends, meters.
    pub line: [Vector; 2],
    /// The number of its place.
    pub place: u16,
    /// Whether people pass it only from the left to the right of its line.
    pub one_way: bool,
}

/// The number of an opening with the direction in which agents pass it: step 2 k + s leads through opening k into the
/// second room (s = 1) or into the first.
pub type Step = u32;

/// An opening between two rooms.
#[derive(Debug, Clone)]
pub struct Opening {
    /// Its straight parts, meters.
    pieces: Vec<[Vector; 2]>,
    /// The rooms on its two sides.
    rooms: [u32; 2],
    /// Triangles beside its middle, in these rooms.
    beside: [u32; 2],
    /// The number of the place of the door, and the step in which it can be passed, if it is a one-way door.
    door: Option<(u16, Option<usize>)>,
    /// The ways to it in its two rooms.
    map: PathMap,
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

    /// The number of its place, if it is a door of the scene.
    pub fn door(&self) -> Option<u16> {
        self.door.map(|(place, _)| place)
    }

    fn longest(&self) -> [Vector; 2] {
        let length = |[a, b]: &[Vector; 2]| (b - a).norm_squared();
        let all = self.pieces.iter().copied();
        all.reduce(|a, b| if length(&b) > length(&a) { b } else { a })
            .unwrap_or_default()
    }
}

/// The rooms of a floor, and the ways in them.
#[derive(Debug, Clone)]
pub struct Rooms {
    /// The floor on which openings are closed.
    pub floor: Floor,
    /// The room of each triangle.
    of_triangle: Vec<u32>,
    openings: Vec<Opening>,
    /// The steps out of each room.
    out: Vec<Vec<Step>>,
    /// For each step, the steps that can come before it in its room, with the length of the way from the middle of
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

/// A closed side of triangles, as it is found: the cut that it belongs to, its ends and the triangles beside it.
struct Closed {
    cut: usize,
    ends: [Vector; 2],
    beside: [u32; 2],
}

/// Passages and doors that divide a floor.
#[derive(Clone)]
struct Cuts {
    /// The passages that are too narrow for ways come first.
    passages: Vec<Narrow>,
    too_narrow: usize,
    /// Their ends, meters, then those of doors.
    lines: Vec<[Vector; 2]>,
    doors: Vec<Door>,
}

impl Cuts {
    /// The passages up to `widest` meters and the doors of a floor with this triangulation.
    fn of(mesh: &Mesh, least_width: f64, widest: f64, doors: &[Door]) -> Self {
        let ends = |passage: &Narrow| {
            let to = match passage.to {
                End::Corner(corner) => mesh.point(corner),
                End::Wall { at, .. } => at,
            };
            [mesh.point(passage.from), to]
        };
        let width = |[a, b]: &[Vector; 2]| (b - a).norm();
        let mut found: Vec<(Narrow, [Vector; 2])> = narrow(mesh, widest.max(least_width))
            .into_iter()
            .map(|passage| (passage, ends(&passage)))
            .collect();
        found.sort_by(|a, b| width(&a.1).total_cmp(&width(&b.1)));
        let is_narrow = |line: &[Vector; 2]| width(line) < least_width - EXACT;
        let too_narrow = found.iter().filter(|(_, line)| is_narrow(line)).count();
        let long = doors.iter().map(|door| {
            let [a, b] = door.line;
            let more = direction(b - a) * INTO_WALLS;
            [a - more, b + more]
        });
        let long: Vec<[Vector; 2]> = long.collect();
        let mut kept: Vec<(Narrow, [Vector; 2])> = Vec::new();
        for (k, one) in found.into_iter().enumerate() {
            let is_near = |other: &(Narrow, [Vector; 2])| {
                let middle = |[a, b]: [Vector; 2]| 0.5 * (a + b);
                (middle(one.1) - middle(other.1)).norm() < APART * width(&other.1)
            };
            let is_free = || {
                kept.len() < too_narrow + MOST_OPENINGS
                    && !kept[too_narrow..].iter().any(is_near)
                    && !long.iter().any(|&door| meet(door, one.1))
            };
            if k < too_narrow || is_free() {
                kept.push(one);
            }
        }
        let (passages, lines): (Vec<Narrow>, Vec<_>) = kept.into_iter().unzip();
        Self {
            passages,
            too_narrow,
            lines: lines.into_iter().chain(long).collect(),
            doors: doors.to_vec(),
        }
    }

    /// The door with the number of this cut.
    fn door(&self, cut: usize) -> Option<&Door> {
        self.doors.get(cut.checked_sub(self.passages.len())?)
    }

    fn mesh(&self, areas: &[Area]) -> Result<Mesh, WayError> {
        let doors = &self.lines[self.passages.len()..];
        Mesh::divided(areas, &self.passages, doors)
    }

    /// The closed sides of a triangulation.
    fn sides(&self, mesh: &Mesh) -> Vec<Closed> {
        let mut found = Vec::new();
        for t in 0..mesh.triangles().len() as u32 {
            let (triangle, corners) = (mesh.triangle(t), mesh.corners(t));
            for k in 0..3 {
                let Some(other) = triangle.closed[k].filter(|&other| other > t) else {
                    continue;
                };
                let ends = [corners[k], corners[(k + 1) % 3]];
                let is_on = |line: &[Vector; 2]| {
                    let mut ends = ends.iter();
                    ends.all(|&end| to_segment(end, line[0], line[1]) < SAME)
                };
                found.extend(self.lines.iter().position(is_on).map(|cut| Closed {
                    cut,
                    ends,
                    beside: [t, other],
                }));
            }
        }
        found
    }

    /// Keeps only those cuts that lie between two rooms.
    fn keep_separating(&mut self, sides: &[Closed], room: &[u32]) {
        let mut separates = vec![false; self.lines.len()];
        separates[..self.too_narrow].fill(true);
        for side in sides {
            let [a, b] = side.beside.map(|t| room[t as usize]);
            separates[side.cut] |= a != b;
        }
        separates[self.passages.len()..].fill(true);
        let mut kept = separates.iter();
        self.lines.retain(|_| *kept.next().unwrap_or(&true));
        let mut kept = separates.iter();
        self.passages.retain(|_| *kept.next().unwrap_or(&true));
    }
}

/// Whether two segments cross or touch.
fn meet([a, b]: [Vector; 2], [c, d]: [Vector; 2]) -> bool {
    let apart = |a, b, p, q| {
        let [p, q] = [p, q].map(|p| side(a, b, p));
        (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0)
    };
    !apart(a, b, c, d) && !apart(c, d, a, b)
}

/// The parts of a triangulation that are connected without closed sides: the number of each triangle's part.
fn parts(mesh: &Mesh) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mut part = vec![NONE; mesh.triangles().len()];
    let mut count = 0;
    for start in 0..part.len() as u32 {
        if part[start as usize] != NONE {
            continue;
        }
        let mut waiting = vec![start];
        while let Some(t) = waiting.pop() {
            if part[t as usize] == NONE {
                part[t as usize] = count;
                waiting.extend(mesh.triangle(t).across.iter().flatten());
            }
        }
        count += 1;
    }
    part
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
            out: vec![Vec::new(); count as usize],
            before: vec![Vec::new(); 2 * openings.len()],
            goals: Vec::new(),
            last: Vec::new(),
            lengths: Vec::new(),
            floor,
            of_triangle,
            openings,
        };
        for step in 0..rooms.steps() {
            let source = rooms.source(step) as usize;
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
        let map = PathMap::within(&self.floor, goals, MARGIN)?;
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
        let Some(t) = self.floor.locate(p).or_else(|| self.floor.nearest(p)) else {
            return f64::INFINITY;
        };
        let direct = self.length_to_goal(p, t, goal);
        let steps = self.steps_out(self.room(t)).iter();
        let through = steps.filter_map(|&step| {
            let onward = self.lengths[goal][step as usize];
            onward.is_finite().then_some(self.length_to(p, t, step)? + onward)
        });
        direct.into_iter().chain(through).fold(f64::INFINITY, f64::min)
    }

    /// Whether a door is an opening between two rooms.
    pub fn has_door(&self, place: u16) -> bool {
        let mut openings = self.openings.iter();
        openings.any(|opening| opening.door() == Some(place))
    }

    /// Whether some doors can be passed in one direction only.
    pub fn has_one_way(&self) -> bool {
        (0..self.steps()).any(|step| !self.is_passable(step))
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

    /// The step from one room to another whose opening is nearest to `p`; `None` if there is none.
    pub fn step_between(&self, from: u32, to: u32, p: Vector) -> Option<Step> {
        let steps = (0..self.steps()).filter(|&s| self.source(s) == from && self.target(s) == to);
        let distance = |step: Step| {
            let pieces = self.opening(step).pieces.iter();
            let each = pieces.map(|&[a, b]| to_segment(p, a, b));
            each.fold(f64::INFINITY, f64::min)
        };
        steps.min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    }

    /// The length of the way from `p` in triangle `t` to the opening of a step, inside of the room, meters.
    pub fn length_to(&self, p: Vector, t: u32, step: Step) -> Option<f64> {
        Some(self.map(step).way(&self.floor, p, t, None)?.length)
    }

    /// The length of the way from `p` in triangle `t` to a goal, if it crosses no opening, meters.
    pub fn length_to_goal(&self, p: Vector, t: u32, goal: usize) -> Option<f64> {
        Some(self.goals[goal].way(&self.floor, p, t, None)?.length)
    }

    /// The points of the way from `p` in triangle `t` to the opening of a step, or to a goal in the room, meters.
    pub fn course(&self, (p, t): (Vector, u32), goal: usize, step: Option<Step>) -> Vec<Vector> {
        let map = step.map_or_else(|| &self.goals[goal], |step| self.map(step));
        let way = map.way(&self.floor, p, t, None);
        way.map_or(Vec::new(), |way| points(&self.floor, map, way.next))
    }

    /// The direction of a step across its opening, of length 1.
    pub fn ahead(&self, step: Step) -> Vector {
        let opening = self.opening(step);
        let [a, b] = opening.longest();
        let across = perpendicular(direction(b - a));
        let inside = self.floor.mesh.middle(opening.beside[step as usize % 2]);
        if across.dot(&(inside - a)) > 0.0 { across } else { -across }
    }

    /// The first of the steps out of the room of triangle `t` that a way over `points` from `p` takes; `None` if it
    /// stays there.
    pub fn first_on(&self, p: Vector, t: u32, points: &[Vector]) -> Option<Step> {
        let steps = self.steps_out(self.room(t));
        let points = beside_corners(p, points);
        let crossed = points.windows(2).find_map(|pair| {
            let part = |step: Step| {
                let pieces = self.opening(step).pieces.iter();
                let crossed = pieces.filter_map(|&piece| crossing(piece, [pair[0], pair[1]]));
                Some((crossed.reduce(f64::min)?, step))
            };
            let crossed = steps.iter().filter_map(|&step| part(step));
            crossed.min_by(|a, b| a.0.total_cmp(&b.0))
        });
        crossed.map(|(_, step)| step)
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
            + self.of_triangle.len() * size_of::<u32>()
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
        let lengths = all.filter_map(|s| Some((s, self.length_after(s, self.map(step))?)));
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

/// The points of a way from `p`, whose corners are moved off their walls: openings end at corners, and walls go on behind
/// them.
fn beside_corners(p: Vector, points: &[Vector]) -> Vec<Vector> {
    let mut beside = vec![p];
    for (k, &point) in points.iter().enumerate() {
        let before = if k == 0 { p } else { points[k - 1] };
        let away = points.get(k + 1).map_or(Vector::zeros(), |next| {
            // The wall is on the side to which the way turns.
            direction(direction(point - before) - direction(next - point))
        });
        beside.push(point + away * OFF_WALLS);
    }
    beside
}

/// Corners are moved off their walls by this, meters.
const OFF_WALLS: f64 = 1e-3;

/// The part of a straight way before it crosses an opening; `None` if it does not.
fn crossing([a, b]: [Vector; 2], [from, to]: [Vector; 2]) -> Option<f64> {
    let (along, way) = (b - a, to - from);
    let across = way.perp(&along);
    let part = (a - from).perp(&along) / across;
    let share = (a - from).perp(&way) / across;
    let is_crossed = (0.0..=1.0).contains(&share) && (0.0..=1.0).contains(&part);
    is_crossed.then_some(part)
}

/// The openings between rooms.
fn openings(floor: &Floor, cuts: &Cuts, room: &[u32]) -> Result<Vec<Opening>, WayError> {
    let mut sides: BTreeMap<(usize, [u32; 2]), Vec<Closed>> = BTreeMap::new();
    for mut side in cuts.sides(&floor.mesh) {
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
        let goals: Vec<Goal> = pieces.iter().map(|&piece| Goal::Line(piece)).collect();
        let door = cuts.door(cut).map(|door| {
            let [a, b] = door.line;
            // People pass from the left to the right of the line.
            let is_left = side(a, b, floor.mesh.middle(beside[1])) > 0.0;
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
