//! The targets that the best ways from a triangle go straight to.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::corner::Bend;
use super::expansion::View;
use super::floor::Floor;
use super::goal::Seen;
use super::map::SLACK;
use super::mesh::{nearest_on, side, to_segment};
use crate::engine::math::Vector;

/// What an entry leads to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A corner.
    Corner(Bend),
    /// A point of the goal, meters.
    Point(Vector),
    /// The nearest point of a line of the goal, meters.
    Line([Vector; 2]),
}

/// A target that the best way from some part of a triangle goes straight to.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// The target.
    pub target: Target,
    /// The part of the triangle.
    pub view: View,
    /// The length of the way from the target on, meters.
    rest: f64,
}

impl Entry {
    /// The corner, if it is one.
    pub fn bend(&self) -> Option<Bend> {
        match self.target {
            Target::Corner(bend) => Some(bend),
            Target::Point(_) | Target::Line(_) => None,
        }
    }

    /// The length of the way from `p` over this target, and the straight part of it, meters.
    pub fn from(&self, floor: &Floor, p: Vector) -> (f64, Vector) {
        let to = match self.target {
            Target::Corner(bend) => floor.place(bend),
            Target::Point(point) => point,
            Target::Line([a, b]) => nearest_on(p, a, b),
        };
        (self.rest + (to - p).norm(), to - p)
    }
}

/// For each triangle, the entries that can be the best somewhere in it, or longer by at most [`SLACK`].
pub struct Entries<'a> {
    floor: &'a Floor,
    /// The entries of each triangle, and the least length of a way over each from anywhere in the triangle, meters.
    found: Vec<Vec<(f64, Entry)>>,
    /// For each triangle, a length that the best way from anywhere in it does not exceed, meters.
    most: Vec<f64>,
}

impl<'a> Entries<'a> {
    /// The entries of all triangles for goals that are `seen`, and the bend after each bend.
    pub fn new(floor: &'a Floor, seen: Seen) -> (Self, Vec<Option<Bend>>) {
        let count = floor.mesh.triangles().len();
        let mut entries = Self {
            floor,
            found: vec![Vec::new(); count],
            most: vec![f64::INFINITY; count],
        };
        for (t, target, view) in seen.views {
            entries.add(
                t,
                Entry {
                    target,
                    view,
                    rest: 0.0,
                },
            );
        }
        let mut from_bend = seen.from_bend;
        let after = spread(floor, &mut from_bend);
        // The nearest first: they bound the lengths of most ways, and views of other corners end early.
        let mut bends: Vec<usize> = (0..from_bend.len())
            .filter(|&bend| from_bend[bend].is_finite())
            .collect();
        bends.sort_by(|&a, &b| from_bend[a].total_cmp(&from_bend[b]));
        for bend in bends {
            let (target, rest) = (Target::Corner(Bend::of_index(bend)), from_bend[bend]);
            let enter = |t: u32, view: &View| {
                entries.add(
                    t,
                    Entry {
                        target,
                        view: *view,
                        rest,
                    },
                )
            };
            floor.look_from(Bend::of_index(bend), enter, |_, _, _| ());
        }
        (entries, after)
    }

    /// Adds an entry to triangle `t`. False if it cannot be the best anywhere in it; then it cannot be the best behind
    /// the triangle either.
    fn add(&mut self, t: u32, entry: Entry) -> bool {
        let corners = self.floor.mesh.corners(t);
        let (nearest, farthest) = match entry.target {
            Target::Corner(bend) => from_point(self.floor.place(bend), corners),
            Target::Point(point) => from_point(point, corners),
            Target::Line([a, b]) => {
                let along = (b - a).normalize();
                let [x, y, z] = corners.map(|p| along.perp(&(p - a)));
                let (low, high) = (x.min(y).min(z), x.max(y).max(z));
                (low.max(-high).max(0.0), high.max(-low))
            }
        };
        let most = &mut self.most[t as usize];
        let least = entry.rest + nearest;
        if least > *most + SLACK {
            return false;
        }
        if corners.iter().all(|&p| entry.view.holds(p)) {
            *most = most.min(entry.rest + farthest);
        }
        self.found[t as usize].push((least, entry));
        true
    }

    /// The entries of all triangles in order.
    pub fn of_triangles(self) -> impl Iterator<Item = Vec<Entry>> {
        let most = self.most.into_iter();
        self.found.into_iter().zip(most).map(|(mut found, most)| {
            found.retain(|(least, _)| *least <= most + SLACK);
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            found.into_iter().map(|(_, entry)| entry).collect()
        })
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
    let farthest = corners
        .iter()
        .map(|c| (c - point).norm())
        .fold(0.0, f64::max);
    (nearest, farthest)
}

/// Dijkstra's algorithm from the bends that see the goal. Returns the bend after each.
fn spread(floor: &Floor, from_bend: &mut [f64]) -> Vec<Option<Bend>> {
    let mut after = vec![None; from_bend.len()];
    // Lengths from 0 are ordered as their bits are.
    let seen = from_bend
        .iter()
        .enumerate()
        .filter(|(_, rest)| rest.is_finite());
    let mut next: BinaryHeap<Reverse<(u64, usize)>> = seen
        .map(|(bend, rest)| Reverse((rest.to_bits(), bend)))
        .collect();
    while let Some(Reverse((bits, bend))) = next.pop() {
        let length = from_bend[bend];
        if bits != length.to_bits() {
            continue;
        }
        for &(before, way) in &floor.ways[bend] {
            let longer = length + way;
            if longer < from_bend[before.index()] {
                from_bend[before.index()] = longer;
                after[before.index()] = Some(Bend::of_index(bend));
                next.push(Reverse((longer.to_bits(), before.index())));
            }
        }
    }
    after
}
