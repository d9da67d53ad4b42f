//! A path map: for one goal, the next corner and the distance from any position.

use std::collections::VecDeque;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::WayError;
use super::corner::{Bend, Turn};
use super::entries::{Entries, Entry, Target};
use super::expansion::View;
use super::floor::Floor;
use super::goal::{Goal, Seen};
use super::mesh::nearest_on;
use crate::engine::math::{Vector, direction};

/// An agent keeps its way until another one is shorter by this, meters: no agent wavers between two ways.
pub const SLACK: f64 = 0.5;

/// What an agent walks toward next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Next {
    /// This point of the goal, meters.
    Goal(Vector),
    /// A corner of the floor.
    Corner {
        /// Which, and how the way bends there.
        bend: Bend,
        /// Points on the borders of what the corner sees: on the side of its walls, then on the other, meters.
        borders: [Vector; 2],
    },
    /// This point, where the agent comes out of a place too narrow for ways, meters.
    Out(Vector),
}

impl Next {
    /// The corner, if it is one.
    pub fn bend(&self) -> Option<Bend> {
        match *self {
            Self::Corner { bend, .. } => Some(bend),
            Self::Goal(_) | Self::Out(_) => None,
        }
    }
}

/// The way from a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    /// Its length, meters.
    pub length: f64,
    /// What comes first.
    pub next: Next,
}

/// For one goal, the way from any position.
#[derive(Debug, Clone)]
pub struct PathMap {
    /// The entries of triangle t are `starts[t]..starts[t + 1]`, by `least`.
    starts: Vec<u32>,
    entries: Vec<Entry>,
    /// Triangles and entries: those that can be the best in cell c of the floor's grid are
    /// `near[cells[c]..cells[c + 1]]`.
    near: Vec<(u32, u32)>,
    cells: Vec<u32>,
    /// From triangles without entries: the next triangle, and the length of the way out.
    out: Vec<Option<(u32, f64)>>,
    /// The bend after each.
    after: Vec<Option<Bend>>,
}

impl PathMap {
    /// The map of one or more goals; agents go to the nearest. Lines are shortened by `margin` meters at both ends.
    ///
    /// # Errors
    /// A goal is not on the floor.
    pub fn new(floor: &Floor, goals: &[Goal], margin: f64) -> Result<Self, WayError> {
        let (entries, after) = Entries::new(floor, Seen::new(floor, goals, margin)?);
        let mut map = Self {
            starts: vec![0],
            entries: Vec::new(),
            near: Vec::new(),
            cells: vec![0],
            out: vec![None; floor.mesh.triangles().len()],
            after,
        };
        for entries in entries.of_triangles() {
            map.entries.extend(entries);
            map.starts.push(map.entries.len() as u32);
        }
        map.find_ways_out(floor);
        map.fill_cells(floor);
        Ok(map)
    }

    /// Finds the entries that can be the best, cell by cell.
    fn fill_cells(&mut self, floor: &Floor) {
        let grid = &floor.grid;
        let fill = |cell: usize| {
            let (center, corners) = (grid.center(cell), grid.corners(cell));
            let mut found = Vec::new();
            for &t in grid.triangles(cell) {
                let entries = self.entries(t);
                let whole = entries
                    .iter()
                    .filter(|e| corners.iter().all(|&p| e.view.holds(p)));
                let best = whole
                    .map(|entry| entry.from(floor, center))
                    .min_by(|a, b| a.0.total_cmp(&b.0));
                let first = self.starts[t as usize];
                let can_win = (first..).zip(entries).filter(|(_, entry)| {
                    let is_longer = best.is_some_and(|(least, best)| {
                        let (length, way) = entry.from(floor, center);
                        length - least > SLACK + grid.radius * most_change(way, best, grid.radius)
                    });
                    !entry.view.misses(&corners) && !is_longer
                });
                found.extend(can_win.map(|(k, _)| (t, k)));
            }
            found
        };
        let cells: Vec<Vec<_>> = (0..grid.cells()).into_par_iter().map(fill).collect();
        for cell in cells {
            self.near.extend(cell);
            self.cells.push(self.near.len() as u32);
        }
    }

    fn entries(&self, t: u32) -> &[Entry] {
        let [from, to] = [t, t + 1].map(|t| self.starts[t as usize] as usize);
        &self.entries[from..to]
    }

    /// Finds ways out of triangles without entries, through any opening.
    fn find_ways_out(&mut self, floor: &Floor) {
        let count = self.out.len() as u32;
        let mut queue: VecDeque<u32> = (0..count)
            .filter(|&t| !self.entries(t).is_empty())
            .collect();
        while let Some(t) = queue.pop_front() {
            let triangle = floor.mesh.triangle(t);
            let length = self.out[t as usize].map_or(0.0, |(_, length)| length);
            for next in triangle.across.into_iter().flatten() {
                if self.out[next as usize].is_none() && self.entries(next).is_empty() {
                    self.out[next as usize] = Some((t, length + 1.0));
                    queue.push_back(next);
                }
            }
        }
    }

    /// The way from `p`, which lies in triangle `t`. `None` if the goal cannot be reached from there. An agent that
    /// walks toward `held` goes on until this corner is behind it or another way is shorter by [`SLACK`].
    pub fn way(&self, floor: &Floor, p: Vector, t: u32, held: Option<Bend>) -> Option<Way> {
        let mut best: Option<(f64, &Entry)> = None;
        let mut kept: Option<(f64, &Entry)> = None;
        let cell = floor.grid.cell(p);
        let [from, to] = [cell, cell + 1].map(|cell| self.cells[cell] as usize);
        let here = self.near[from..to]
            .iter()
            .filter(|(triangle, _)| *triangle == t);
        for entry in here.map(|&(_, k)| &self.entries[k as usize]) {
            if entry.view.holds(p) {
                let (length, _) = entry.from(floor, p);
                if best.is_none_or(|(least, _)| length < least) {
                    best = Some((length, entry));
                }
                if entry.bend().is_some_and(|bend| Some(bend) == held) {
                    kept = Some((length, entry));
                }
            }
        }
        let is_other_way = |(least, entry): (f64, &Entry)| {
            kept.filter(|(length, _)| {
                *length <= least + SLACK && !self.is_behind(held, entry.bend())
            })
        };
        if let Some((length, entry)) = best.and_then(is_other_way).or(best) {
            let next = match entry.target {
                Target::Corner(bend) => {
                    let View { right, left, .. } = entry.view;
                    let borders = match bend.turn {
                        Turn::First => [right, left],
                        Turn::Last => [left, right],
                    };
                    Next::Corner { bend, borders }
                }
                Target::Point(point) => Next::Goal(point),
                Target::Line([a, b]) => Next::Goal(nearest_on(p, a, b)),
            };
            return Some(Way { length, next });
        }
        self.way_out(floor, p, t)
    }

    /// Does the way over bend `held` lead over `next` (or, if that is none, straight to the goal) later on?
    fn is_behind(&self, held: Option<Bend>, next: Option<Bend>) -> bool {
        let after = |bend: &Bend| self.after[bend.index()];
        let mut way = std::iter::successors(held, after).skip(1);
        match next {
            Some(next) => way.any(|bend| bend == next),
            None => true,
        }
    }

    /// The way from a position from which no entry is visible: through the middle of an opening of its triangle.
    fn way_out(&self, floor: &Floor, p: Vector, t: u32) -> Option<Way> {
        let (next, extra) = self.out[t as usize]?;
        let corners = floor.mesh.corners(t);
        let side = floor.mesh.side_along(t, next);
        let opening = (corners[side] + corners[(side + 1) % 3]) * 0.5;
        let [a, b, c] = floor.mesh.corners(next);
        let beyond = (a + b + c) / 3.0;
        let rest = match self.entries(next) {
            [] => extra,
            _ => self
                .way(floor, beyond, next, None)
                .map_or(extra, |way| way.length),
        };
        let to_opening = (opening - p).norm();
        let length = to_opening + (beyond - opening).norm() + rest;
        // In the opening, go on to what lies behind it.
        let next = if to_opening > IN_OPENING {
            opening
        } else {
            beyond
        };
        Some(Way {
            length,
            next: Next::Out(next),
        })
    }

    /// The bend after `bend` on the way; `None` if the way from there leads straight to the goal.
    pub fn after(&self, bend: Bend) -> Option<Bend> {
        self.after[bend.index()]
    }

    /// Where ways end that bend around this corner last, meters.
    pub fn end_after(&self, floor: &Floor, bend: Bend) -> Option<Vector> {
        let corner = &floor.corners[bend.corner as usize];
        let around = corner.fan.iter().flat_map(|&(t, _)| self.entries(t));
        let seen = around.filter(|entry| entry.bend().is_none() && entry.view.holds(corner.place));
        let ends = seen.map(|entry| entry.from(floor, corner.place));
        let nearest = ends.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, way)| corner.place + way)
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.entries.capacity() * size_of::<Entry>()
            + self.near.capacity() * size_of::<(u32, u32)>()
            + (self.starts.capacity() + self.cells.capacity()) * size_of::<u32>()
            + self.out.capacity() * size_of::<Option<(u32, f64)>>()
            + self.after.capacity() * size_of::<Option<Bend>>()
    }
}

/// An agent this near to the middle of an opening is in it, meters.
const IN_OPENING: f64 = 0.05;

/// How much the difference between the lengths of two straight ways can change at most per meter within `radius`.
fn most_change(a: Vector, b: Vector, radius: f64) -> f64 {
    let bend = |way: Vector| {
        let length = way.norm();
        if length > radius {
            radius / (length - radius)
        } else {
            2.0
        }
    };
    ((direction(a) - direction(b)).norm() + bend(a) + bend(b)).min(2.0)
}
