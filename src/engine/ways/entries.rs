//! The targets that shortest ways from a triangle can go straight to.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::corner::{Bend, Turn};
use super::expansion::View;
use super::floor::Floor;
use super::mesh::{side, to_segment};
use super::region::{Candidate, best};
use super::targets::{Entry, Source, Targets};
use crate::engine::math::Vector;

/// Ways whose lengths differ by less than this are not told apart, meters.
pub const TIE: f64 = 1e-9;
/// Triangles with more entries are pruned early, to save memory.
const MANY: u32 = 100;

/// All entries that can be the best somewhere in their triangle.
pub struct Entries<'a> {
    floor: &'a Floor,
    targets: &'a Targets,
    /// The entries of each triangle.
    found: Vec<Vec<Entry>>,
    /// For each triangle, the number of entries at which they are pruned next.
    many: Vec<u32>,
    /// For each triangle, a length that the best way from anywhere in it does not exceed, meters.
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
        // The nearest first: they bound the lengths of most ways, and views of other corners end early.
        let rest = &targets.rest;
        let reached = (0..rest.len()).filter(|&bend| rest[bend].is_finite());
        let mut bends: Vec<usize> = reached.collect();
        bends.sort_by(|&a, &b| rest[a].total_cmp(&rest[b]));
        for number in bends {
            let bend = Bend::of_index(number);
            let beyond = targets.beyond(floor, bend);
            let enter = |t: u32, view: &View| {
                let bends = match bend.turn {
                    Turn::First => view.eye.side(beyond, view.right.at) <= 0.0,
                    Turn::Last => view.eye.side(beyond, view.left.at) >= 0.0,
                };
                bends && entries.add(t, number as u32, view)
            };
            floor.look_from(bend, enter, |_, _, _| ());
        }
        entries
    }

    /// Adds a target to triangle `t`. False if it cannot be the best anywhere in it, and so not behind it either: the
    /// better way goes on as well.
    fn add(&mut self, t: u32, target: u32, view: &View) -> bool {
        let corners = self.floor.mesh.corners(t);
        let (nearest, farthest) = match self.targets.source(target) {
            None => from_point(self.floor.place(Bend::of_index(target as usize)), corners),
            Some(&Source::Point { point, .. }) => from_point(point, corners),
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

    /// Drops entries of triangle `t` that can be the best nowhere in it.
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
        let found = self.found.iter().map(Vec::capacity).sum::<usize>();
        found * size_of::<Entry>()
            + self.found.capacity() * size_of::<Vec<Entry>>()
            + self.most.capacity() * size_of::<f64>()
            + self.many.capacity() * size_of::<u32>()
    }
}

/// The least and the greatest distance of a point from a triangle's points.
fn from_point(point: Vector, corners: [Vector; 3]) -> (f64, f64) {
    let ends = |k: usize| (corners[k], corners[(k + 1) % 3]);
    let is_inside = (0..3).all(|k| side(ends(k).0, ends(k).1, point) >= 0.0);
    let sides = (0..3).map(|k| to_segment(point, ends(k).0, ends(k).1));
    let nearest = if is_inside {
        0.0
    } else {
        sides.fold(f64::INFINITY, f64::min)
    };
    let distances = corners.iter().map(|c| (c - point).norm());
    (nearest, distances.fold(0.0, f64::max))
}

/// Finds the lengths of the ways from all bends by Dijkstra's algorithm, from those that see the goal.
pub fn spread(floor: &Floor, targets: &mut Targets) {
    let Targets { rest, next, .. } = targets;
    // Lengths from 0 are ordered as their bits are.
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
