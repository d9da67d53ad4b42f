//! The first targets of the shortest routes from each triangle.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::region::{Candidate, TIE, best};
use super::targets::{Entry, Source, Targets};
use crate::math::{Vector, bytes_of};
use crate::routes::floor::{Bend, Floor, Turn, View};

/// Triangles with more entries are pruned early, to save memory.
const MANY: u32 = 100;

/// Directions are off by less than this by rounding and by the margins of bends, radians.
const ROUNDING: f64 = 4e-6;

/// The entries of all triangles. Each can be the shortest somewhere in its triangle.
pub struct Entries<'a> {
    floor: &'a Floor,
    targets: &'a Targets,
    /// The entries of each triangle.
    found: Vec<Vec<Entry>>,
    /// For each triangle, the number of entries that triggers the next pruning.
    many: Vec<u32>,
    /// For each triangle, an upper bound of the length of the shortest way from anywhere in it, meters.
    most: Vec<f64>,
}

impl<'a> Entries<'a> {
    /// The entries of all triangles for sources with some `views`.
    pub fn new(floor: &'a Floor, targets: &'a Targets, views: Vec<(u32, u32, View)>) -> Self {
        let count = floor.mesh.triangles().len();
        let mut entries = Self {
            floor,
            targets,
            found: vec![Vec::new(); count],
            many: vec![MANY; count],
            most: vec![f64::INFINITY; count],
        };
        for (t, target, view) in views {
            entries.add(t, target, &view);
        }
        // The nearest first: their upper bounds end the views of most other corners early.
        let rest = &targets.rest;
        let reached = (0..rest.len()).filter(|&bend| rest[bend].is_finite());
        let mut bends: Vec<usize> = reached.collect();
        bends.sort_by(|&a, &b| rest[a].total_cmp(&rest[b]));
        for number in bends {
            let bend = Bend::of_index(number);
            let beyond = targets.beyond(floor, bend);
            let along = beyond - floor.place(bend);
            let enter = |t: u32, view: &View| {
                let (end, sign) = match bend.turn {
                    Turn::First => (view.right.at, -1.0),
                    Turn::Last => (view.left.at, 1.0),
                };
                let way = end - floor.place(bend);
                let is_beyond = sign * along.perp(&way) >= 0.0 || is_opposite(along, way);
                is_beyond && entries.add(t, number as u32, view)
            };
            floor.look_from(bend, enter, |_, _, _| ());
        }
        entries
    }

    /// Adds a target to triangle `t`. False if it cannot be the shortest anywhere in it. Then it is not the shortest
    /// behind the triangle either: routes from there cross the triangle, where another way is shorter.
    fn add(&mut self, t: u32, target: u32, view: &View) -> bool {
        let corners = self.floor.mesh.corners(t);
        let from_point = |point: Vector| {
            let distances = corners.iter().map(|c| (c - point).norm());
            (
                self.floor.mesh.distance(t, point),
                distances.fold(0.0, f64::max),
            )
        };
        let (nearest, farthest) = match self.targets.source(target) {
            None => from_point(self.floor.place(Bend::of_index(target as usize))),
            Some(&Source::Point { point, .. }) => from_point(point),
            Some(&Source::Line { ends: [a, b], .. }) => {
                let along = (b - a).normalize();
                let [x, y, z] = corners.map(|p| along.perp(&(p - a)));
                let (low, high) = (x.min(y).min(z), x.max(y).max(z));
                (low.max(-high).max(0.0), high.max(-low))
            }
        };
        let rest = self.targets.rest(target);
        let most = &mut self.most[t as usize];
        let least = rest + nearest;
        if least > *most + TIE {
            return false;
        }
        let entry = Entry {
            target,
            borders: [view.right.number, view.left.number],
        };
        if rest + farthest < *most {
            let targets = self.targets;
            if corners.iter().all(|&p| targets.holds(self.floor, entry, p)) {
                *most = rest + farthest;
            }
        }
        let t = t as usize;
        self.found[t].push(entry);
        if self.found[t].len() >= self.many[t] as usize {
            self.prune(t);
        }
        true
    }

    /// The entries of all triangles in order.
    pub fn of_triangles(self) -> impl Iterator<Item = Vec<Entry>> {
        self.found.into_iter()
    }

    /// Drops the entries of triangle `t` that are nowhere the shortest in it.
    fn prune(&mut self, t: usize) {
        let (floor, targets, found) = (self.floor, self.targets, &mut self.found[t]);
        let candidates = found
            .iter()
            .map(|&entry| Candidate::new(floor, targets, entry));
        let candidates: Vec<Candidate> = candidates.collect();
        let all: Vec<&Candidate> = candidates.iter().collect();
        let left = best(&all, floor.mesh.corners(t as u32));
        *found = left.into_iter().map(|candidate| candidate.entry).collect();
        self.many[t] = MANY.max(2 * found.len() as u32);
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        let found = self.found.iter().map(bytes_of).sum::<usize>();
        found + bytes_of(&self.found) + bytes_of(&self.most) + bytes_of(&self.many)
    }
}

/// Whether two directions are opposite, but for rounding. At the end of a wall without thickness, such as that between
/// two flights of stairs that touch, routes turn from one of its sides to the other: by just as much as a half-plane.
fn is_opposite(a: Vector, b: Vector) -> bool {
    let dot = a.dot(&b);
    dot < 0.0 && a.perp(&b).abs() <= ROUNDING * -dot
}

/// Computes the lengths of the routes from all bends by Dijkstra's algorithm, which starts at the bends that see the
/// goal.
pub fn spread(floor: &Floor, targets: &mut Targets) {
    let Targets { rest, next, .. } = targets;
    // The bits of numbers that are not negative sort like the numbers.
    let reached = rest.iter().enumerate().filter(|(_, rest)| rest.is_finite());
    let mut queue: BinaryHeap<Reverse<(u64, usize)>> = reached
        .map(|(bend, rest)| Reverse((rest.to_bits(), bend)))
        .collect();
    while let Some(Reverse((bits, bend))) = queue.pop() {
        let length = rest[bend];
        if bits != length.to_bits() {
            continue;
        }
        let place = floor.place(Bend::of_index(bend));
        for before in floor.before(bend) {
            let way = (floor.place(Bend::of_index(before)) - place).norm();
            if length + way < rest[before] {
                rest[before] = length + way;
                next[before] = bend as u32;
                queue.push(Reverse((rest[before].to_bits(), before)));
            }
        }
    }
}
