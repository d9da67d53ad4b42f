//! A path map: for one goal, the next corner and the distance from any position.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::entries::{Entries, spread};
use super::goal::{Goal, Seen};
use super::parts::Parts;
use super::region::{Candidate, Region};
use super::targets::{Entry, Source, Targets};
use crate::math::{Vector, bytes_of};
use crate::routes::WayError;
use crate::routes::floor::{Bend, Floor, Turn};

/// An agent switches to another way only if that is shorter by this, meters, so that no agent wavers between two ways.
pub const SLACK: f64 = 0.5;

/// What an agent walks toward next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Next {
    /// This point of the goal, meters.
    Goal(Vector),
    /// A corner of the floor, and how the way bends there.
    Corner(Bend),
    /// This point on the way out of a place from which no target is visible, such as a niche behind a closed passage,
    /// meters.
    Out(Vector),
}

impl Next {
    /// Its place, meters.
    pub fn place(&self, floor: &Floor) -> Vector {
        match *self {
            Self::Goal(point) | Self::Out(point) => point,
            Self::Corner(bend) => floor.place(bend),
        }
    }

    /// The corner, if it is one.
    pub fn bend(&self) -> Option<Bend> {
        match *self {
            Self::Corner(bend) => Some(bend),
            Self::Goal(_) | Self::Out(_) => None,
        }
    }
}

/// No entry has this number.
pub const NO_ENTRY: usize = usize::MAX;

/// The way from a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    /// Its length, meters.
    pub length: f64,
    /// What comes first.
    pub next: Next,
    /// The distance to it, meters.
    pub distance: f64,
    /// The next point stays visible within this distance, in the same triangle and on the way to the next point,
    /// meters; at most 1.
    pub sight: f64,
    /// The number of the map's entry for this way; `NO_ENTRY` if it has none.
    pub entry: usize,
    /// Points on the edges of the visible cone of the next point, meters: of a corner first on the side of its walls,
    /// of the goal first on the right. `None` on the way out of a place.
    pub borders: Option<[Vector; 2]>,
}

impl Way {
    /// A way over no entry of the map, which is soon looked up again.
    fn without_entry(next: Next, length: f64, distance: f64) -> Self {
        Self {
            length,
            next,
            distance,
            sight: 0.0,
            entry: NO_ENTRY,
            borders: None,
        }
    }
}

/// For one goal, the way from any position.
#[derive(Debug, Clone)]
pub struct PathMap {
    targets: Targets,
    parts: Parts,
    /// The triangles without entries, in order, each with the next triangle on the way out and the length of the way
    /// from the middle of the next one, meters.
    out: Vec<(u32, u32, f64)>,
    /// The additional memory that building it took, bytes.
    building: usize,
}

impl PathMap {
    /// The map of one or more goals; agents go to the nearest. Lines are shortened by `margin` meters at both ends.
    ///
    /// # Errors
    /// A goal is not on the floor.
    pub fn new(floor: &Floor, goals: &[Goal], margin: f64) -> Result<Self, WayError> {
        let mut map = Self::within(floor, goals, margin)?;
        map.find_routes_out(floor);
        Ok(map)
    }

    /// The map of one or more goals as in [`new`](Self::new), for few positions: building it takes a small part of the
    /// time, and looking up a way takes longer.
    ///
    /// # Errors
    /// A goal is not on the floor.
    pub fn for_few(floor: &Floor, goals: &[Goal], margin: f64) -> Result<Self, WayError> {
        let mut map = Self::built(floor, goals, margin, |targets, entries| {
            Parts::undivided(floor, targets, entries.of_triangles())
        })?;
        map.find_routes_out(floor);
        Ok(map)
    }

    /// The map of one or more goals as in [`new`](Self::new), without routes through closed passages.
    ///
    /// # Errors
    /// A goal is not on the floor.
    pub fn within(floor: &Floor, goals: &[Goal], margin: f64) -> Result<Self, WayError> {
        Self::built(floor, goals, margin, |targets, entries| {
            Parts::new(floor, targets, entries.of_triangles())
        })
    }

    fn built(
        floor: &Floor,
        goals: &[Goal],
        margin: f64,
        divide: impl FnOnce(&Targets, Entries) -> Parts,
    ) -> Result<Self, WayError> {
        let mut seen = Seen::new(floor, goals, margin)?;
        spread(floor, &mut seen.targets);
        let Seen { mut targets, views } = seen;
        targets.find_beyond(floor);
        let entries = Entries::new(floor, &targets, views);
        let building = entries.bytes();
        let parts = divide(&targets, entries);
        Ok(Self {
            targets,
            parts,
            out: Vec::new(),
            building,
        })
    }

    /// Finds routes out of triangles without entries, through any opening.
    fn find_routes_out(&mut self, floor: &Floor) {
        let count = floor.mesh.triangles().len() as u32;
        let is_empty = |t: u32| self.parts.is_empty(t);
        if !(0..count).any(is_empty) {
            return;
        }
        let mut out: Vec<Option<(u32, f64)>> = vec![None; count as usize];
        let mut queue: VecDeque<u32> = (0..count).filter(|&t| !is_empty(t)).collect();
        while let Some(t) = queue.pop_front() {
            let mut from_middle = None;
            let triangle = floor.mesh.triangle(t);
            for next in (0..3).filter_map(|side| triangle.beyond(side)) {
                if out[next as usize].is_none() && is_empty(next) {
                    let length = from_middle
                        .get_or_insert_with(|| self.length_from_middle(floor, t, out[t as usize]));
                    out[next as usize] = Some((t, *length));
                    queue.push_back(next);
                }
            }
        }
        let found = (0..).zip(out);
        let found = found.filter_map(|(t, out)| out.map(|(next, length)| (t, next, length)));
        self.out = found.collect();
    }

    /// The length of the way from the middle of triangle `t`, meters; `out` is the way out of it, if it needs one.
    fn length_from_middle(&self, floor: &Floor, t: u32, out: Option<(u32, f64)>) -> f64 {
        let middle = floor.mesh.middle(t);
        match out {
            Some((next, rest)) => {
                let opening = floor.mesh.opening(t, next);
                let beyond = floor.mesh.middle(next);
                (opening - middle).norm() + (beyond - opening).norm() + rest
            }
            None => {
                let way = self.way(floor, middle, t, None);
                way.map_or(f64::INFINITY, |way| way.length)
            }
        }
    }

    /// The way from a position in the plane, on the floor or in a wall.
    pub fn way_from(&self, floor: &Floor, p: Vector) -> Option<Way> {
        let here = floor.locate_or_nearest(None, p)?;
        self.way(floor, floor.in_building(p), here, None)
    }

    /// The way from `p` in the building, which lies in triangle `t`. `None` if the goal cannot be reached from there.
    /// An agent that walks toward `held` goes on until this corner is behind it or another way is shorter by
    /// [`SLACK`].
    pub fn way(&self, floor: &Floor, p: Vector, t: u32, held: Option<Bend>) -> Option<Way> {
        let Some((number, entry)) = self.best(floor, p, t) else {
            return self
                .way_in(floor, p, t)
                .or_else(|| self.way_out(floor, p, t));
        };
        let other = held.filter(|&held| {
            let bend = self.targets.bend(entry.target);
            bend.is_some_and(|bend| bend != held)
        });
        let best = self.over(floor, p, (number, entry));
        let kept = other.and_then(|held| self.kept(floor, (p, t), held, best.length));
        Some(kept.unwrap_or(best))
    }

    /// The way from `p` over entry `number`, if its target is still visible from `p` and the way still bends there. `p`
    /// must lie in the entry's triangle, or between it and the target.
    pub fn way_over(&self, floor: &Floor, p: Vector, number: usize) -> Option<Way> {
        let entry = self.parts.entry(number)?;
        let source = self.targets.source(entry.target);
        let is_beside = source.is_none_or(|source| source.is_beside_line(p));
        if !is_beside || !self.targets.bends(floor, entry.target, p) {
            return None;
        }
        let way = self.over(floor, p, (number, entry));
        (way.sight > 0.0).then_some(way)
    }

    /// The part of the goal that is the target of entry `number`; `None` if the target is a corner.
    pub fn source(&self, number: usize) -> Option<&Source> {
        self.targets.source(self.parts.entry(number)?.target)
    }

    /// The way from `p` over an entry with this number.
    #[inline]
    fn over(&self, floor: &Floor, p: Vector, (number, entry): (usize, Entry)) -> Way {
        let place = self.targets.nearest(floor, entry.target, p);
        let distance = (place - p).norm();
        let cone = self.targets.cone(floor, entry);
        let edges = cone.map(|limit| limit.through);
        let (next, borders) = match self.targets.bend(entry.target) {
            None => (Next::Goal(place), edges),
            Some(bend) => (Next::Corner(bend), from_walls(bend, edges)),
        };
        let [right, left] = cone.map(|limit| limit.distance(p, FAR));
        Way {
            length: distance + self.targets.rest(entry.target),
            next,
            distance,
            sight: right.min(left),
            entry: number,
            borders: Some(borders),
        }
    }

    /// The entry of the shortest way from `p` in triangle `t`, and its number.
    #[inline]
    fn best(&self, floor: &Floor, p: Vector, t: u32) -> Option<(usize, Entry)> {
        let shortest = self.shortest(floor, (p, t), |entry| self.targets.holds(floor, entry, p));
        // Rounding can leave gaps between regions.
        shortest.or_else(|| {
            self.shortest(floor, (p, t), |entry| {
                let limits = self.targets.limits(floor, entry);
                limits.iter().all(|limit| limit.holds(p, GAP))
            })
        })
    }

    /// The entry of the shortest way from `p` in triangle `t` over an entry that `holds`, and its number.
    #[inline]
    fn shortest(
        &self,
        floor: &Floor,
        (p, t): (Vector, u32),
        holds: impl Fn(Entry) -> bool,
    ) -> Option<(usize, Entry)> {
        let (mut best, mut least) = (None, f64::INFINITY);
        for (number, entry) in self.parts.at(floor, p, t) {
            let rest = self.targets.rest(entry.target);
            let way = self.targets.nearest(floor, entry.target, p) - p;
            // Most routes are longer: skip them without a square root.
            let left = least - rest;
            if left > 0.0 && way.norm_squared() < left * left && holds(entry) {
                least = way.norm() + rest;
                best = Some((number, entry));
            }
        }
        best
    }

    /// The way over `held` from `p` in triangle `t`, if `held` is visible from `p`, the way bends there, and its length
    /// exceeds `least` by at most [`SLACK`].
    fn kept(&self, floor: &Floor, (p, t): (Vector, u32), held: Bend, least: f64) -> Option<Way> {
        let target = held.index() as u32;
        let distance = (floor.place(held) - p).norm();
        let length = distance + self.targets.rest(target);
        if length > least + SLACK || !self.targets.bends(floor, target, p) {
            return None;
        }
        let mut entries = self.parts.at(floor, p, t);
        let holds = |entry: Entry| entry.target == target && self.targets.holds(floor, entry, p);
        if let Some(found) = entries.find(|&(_, entry)| holds(entry)) {
            // This way is not the shortest. Without an entry, it is soon compared with others again.
            let entry = NO_ENTRY;
            return Some(Way {
                entry,
                ..self.over(floor, p, found)
            });
        }
        let view = floor.sight(p, t, held)?;
        Some(Way {
            borders: Some(from_walls(held, [view.right.at, view.left.at])),
            ..Way::without_entry(Next::Corner(held), length, distance)
        })
    }

    /// The way from a position in triangle `t` without a visible target: first to a part of the triangle from which a
    /// target is visible.
    fn way_in(&self, floor: &Floor, p: Vector, t: u32) -> Option<Way> {
        let mut best: Option<Way> = None;
        self.parts.each(floor, t, |corners, entry| {
            let candidate = Candidate::new(floor, &self.targets, entry);
            let Some(region) = Region::new(corners, &candidate) else {
                return;
            };
            let point = region.center;
            let rest = self.targets.length(floor, entry.target, point);
            let distance = (point - p).norm();
            let length = distance + rest;
            if best.is_none_or(|best| length < best.length) {
                best = Some(Way::without_entry(Next::Out(point), length, distance));
            }
        });
        best
    }

    /// The way from a triangle without entries: through the middle of an opening.
    fn way_out(&self, floor: &Floor, p: Vector, t: u32) -> Option<Way> {
        let place = self.out.binary_search_by_key(&t, |out| out.0).ok()?;
        let (_, next, rest) = self.out[place];
        let opening = floor.mesh.opening(t, next);
        let beyond = floor.mesh.middle(next);
        let to_opening = (opening - p).norm();
        let length = to_opening + (beyond - opening).norm() + rest;
        // In the opening, go on to the place behind it.
        let next = if to_opening > IN_OPENING {
            opening
        } else {
            beyond
        };
        let distance = (next - p).norm();
        Some(Way::without_entry(Next::Out(next), length, distance))
    }

    /// What comes after a corner on the way: another corner, or the end.
    pub fn after(&self, floor: &Floor, bend: Bend) -> Option<Next> {
        let next = self.targets.next[bend.index()];
        if let Some(bend) = self.targets.bend(next) {
            return Some(Next::Corner(bend));
        }
        self.targets.source(next)?;
        let end = self.targets.nearest(floor, next, floor.place(bend));
        Some(Next::Goal(end))
    }

    /// Whether some way bends, because a wall or a closed passage hides the goal.
    pub fn bends(&self) -> bool {
        let mut entries = self.parts.all();
        !self.out.is_empty() || entries.any(|entry| self.targets.bend(entry.target).is_some())
    }

    /// The additional memory that building it took, bytes.
    pub fn building_bytes(&self) -> usize {
        self.building
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.targets.bytes() + self.parts.bytes() + bytes_of(&self.out)
    }
}

/// Points on the right and left edges of the visible cone of a corner: first on the side of its walls.
fn from_walls(bend: Bend, [right, left]: [Vector; 2]) -> [Vector; 2] {
    match bend.turn {
        Turn::First => [right, left],
        Turn::Last => [left, right],
    }
}

/// Distances to the edges of a visible cone are clamped to this, meters.
const FAR: f64 = 1.0;

/// Regions are widened by this where rounding leaves gaps between them, meters.
const GAP: f64 = 1e-6;

/// An agent this near to the middle of an opening is in it, meters.
const IN_OPENING: f64 = 0.05;
