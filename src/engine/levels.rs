//! Levels: the sheets of a building, such as floors, flights of stairs and landings, side by side in one plane, and the
//! joins through which people pass and see from one to the other (after van Toll, Cook and Geraerts 2011).
//!
//! Level k of a building lies at its own places plus k times a spacing along x, which is longer than the building, so
//! that people on two levels are far apart wherever they stand above each other. Two levels are joined at an edge that
//! both have. Who walks across it is moved by whole spacings: x and y of the building run on. Who looks across it sees
//! those beyond as many spacings away.

use std::ops::Range;

use crate::geometry::{Area, Ring};
use crate::math::{Vector, bounds};

/// How far beyond a join people are who have just walked across it, meters: farther than a step, and shorter than the
/// floor of the next level that continues there.
const BEYOND: f64 = 0.5;

/// Levels lie this far apart, meters.
const GAP: f64 = 25.0;

/// The farthest that anybody may see, meters: the floors behind exits reach up to 7 m into the gap between two levels.
pub const FARTHEST: f64 = 17.0;

/// The speed of a person on a floor for whom escalators are compared with other ways, m/s (Weidmann 1993).
const USUAL_SPEED: f64 = 1.34;
/// Ways over a level take at most as long as at this part of the speed on a floor.
const SLOWEST: f64 = 0.01;

/// A level: a plane that may slope.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Its name.
    pub name: String,
    /// A point of it in the building, meters.
    pub at: Vector,
    /// The height of this point, meters.
    pub elevation: f64,
    /// By how much it rises per meter along x and along y.
    pub rise: Vector,
    /// The preferred speed of those who walk up and of those who walk down is multiplied by this. It is that along the
    /// slope.
    pub speed_factors: [f64; 2],
    /// The velocity at which an escalator carries people, seen from above, m/s.
    pub carries: Vector,
    /// Where people walk on it, at its place in the building.
    pub floor: Vec<Area>,
}

impl Level {
    /// The lower left and the upper right corner of the rectangle around its floor in the building, meters.
    pub fn corners(&self) -> [Vector; 2] {
        let outlines = self.floor.iter().map(|area| &area.exterior);
        bounds(outlines.flat_map(Ring::points).copied()).unwrap_or_default()
    }

    /// The height of a point of the building on this level, meters.
    pub fn height(&self, p: Vector) -> f64 {
        self.elevation + self.rise.dot(&(p - self.at))
    }

    /// The preferred speed of those who walk toward `heading`, a unit vector, is multiplied by this: seen from above, a
    /// slope shortens steps.
    pub fn speed_factor(&self, heading: Vector) -> f64 {
        let climb = self.rise.dot(&heading);
        let [up, down] = self.speed_factors;
        let factor = match climb.total_cmp(&0.0) {
            _ if self.rise == Vector::zeros() => 1.0,
            std::cmp::Ordering::Less => down,
            _ => up,
        };
        factor / (1.0 + climb * climb).sqrt()
    }

    /// The speed of people who go toward `heading`, a unit vector, over that on a floor: their own, and that of an
    /// escalator.
    pub fn progress(&self, heading: Vector) -> f64 {
        let carried = self.carries.dot(&heading) / USUAL_SPEED;
        (self.speed_factor(heading) + carried).max(SLOWEST)
    }
}

/// An edge of a level through which people pass to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Join {
    /// Its ends, meters: the level lies on the left of the way from the first to the second.
    pub line: [Vector; 2],
    /// The number of levels from its own to that beyond.
    pub to: i32,
}

impl Join {
    /// Whether `p` lies beyond the edge's line.
    pub fn is_beyond(&self, p: Vector) -> bool {
        self.side(p) < 0.0
    }

    /// Whether `p` lies before the edge's line: on it is neither before nor beyond.
    pub fn is_before(&self, p: Vector) -> bool {
        self.side(p) > 0.0
    }

    /// The square of the distance of `p` from the edge, m².
    pub fn distance_squared(&self, p: Vector) -> f64 {
        let [a, b] = self.line;
        (a + (b - a) * self.part(p).clamp(0.0, 1.0) - p).norm_squared()
    }

    /// The part of the way from `p` to `q` after which it crosses the edge from before it, from 0 to 1.
    pub fn crossed(&self, p: Vector, q: Vector) -> Option<f64> {
        let (from, to) = (self.side(p), self.side(q));
        let part = (from > 0.0 && to < 0.0).then(|| from / (from - to))?;
        let is_between = (0.0..=1.0).contains(&self.part(p + (q - p) * part));
        is_between.then_some(part)
    }

    /// Positive on the left of the way from its first to its second end.
    fn side(&self, p: Vector) -> f64 {
        let [a, b] = self.line;
        (b - a).perp(&(p - a))
    }

    /// The place of `p` along the edge, from 0 to 1 between its ends.
    fn part(&self, p: Vector) -> f64 {
        let [a, b] = self.line;
        (p - a).dot(&(b - a)) / (b - a).norm_squared()
    }

    /// Whether somebody at `p` has just walked across.
    fn was_passed(&self, p: Vector) -> bool {
        let is_before_it = (0.0..=1.0).contains(&self.part(p));
        is_before_it && self.is_beyond(p) && self.distance_squared(p) < BEYOND * BEYOND
    }
}

/// The levels of a building.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// The lower left and the upper right corner of all floors in the building, meters.
    corners: [Vector; 2],
    spacing: f64,
    levels: Vec<Level>,
    /// The joins of each level, one level after the other.
    joins: Vec<Join>,
    /// The number of joins before those of each level, and of all.
    starts: Vec<usize>,
}

impl Levels {
    /// Levels of a building, not joined yet.
    pub fn new(levels: Vec<Level>) -> Self {
        let corners = bounds(levels.iter().flat_map(Level::corners)).unwrap_or_default();
        let spacing = (corners[1].x - corners[0].x + GAP).ceil();
        Self {
            corners,
            spacing,
            starts: vec![0; levels.len() + 1],
            levels,
            joins: Vec::new(),
        }
    }

    /// Joins the levels `from` and `to` at a line of the building: `from` lies on the left of the way from its first to
    /// its second end, meters.
    pub fn join(&mut self, [a, b]: [Vector; 2], [from, to]: [usize; 2]) {
        for ([a, b], from, to) in [([a, b], from, to), ([b, a], to, from)] {
            let join = Join {
                line: [a, b].map(|p| p + self.way(from as i32)),
                to: to as i32 - from as i32,
            };
            self.joins.insert(self.starts[from + 1], join);
            for start in &mut self.starts[from + 1..] {
                *start += 1;
            }
        }
    }

    /// The levels in order.
    pub fn all(&self) -> &[Level] {
        &self.levels
    }

    /// The way over this number of levels, meters.
    pub fn way(&self, levels: i32) -> Vector {
        Vector::new(self.spacing * f64::from(levels), 0.0)
    }

    /// The number of the level on which `p` lies.
    pub fn level(&self, p: Vector) -> usize {
        let steps = (p.x - self.corners[0].x + 0.5 * GAP) / self.spacing;
        (steps.max(0.0) as usize).min(self.levels.len() - 1)
    }

    /// The place of `p` in the building, meters.
    pub fn in_building(&self, p: Vector) -> Vector {
        p - self.way(self.level(p) as i32)
    }

    /// The place on the level of `other` with the same place in the building as `p`, meters.
    pub fn on_level_of(&self, other: Vector, p: Vector) -> Vector {
        self.in_building(p) + (other - self.in_building(other))
    }

    /// The height of somebody at `p`, meters.
    pub fn height(&self, p: Vector) -> f64 {
        self.levels[self.level(p)].height(self.in_building(p))
    }

    /// The preferred speed of somebody at `p` who walks toward `heading`, a unit vector, is multiplied by this.
    pub fn speed_factor(&self, p: Vector, heading: Vector) -> f64 {
        self.levels[self.level(p)].speed_factor(heading)
    }

    /// Whether there are escalators.
    pub fn carry(&self) -> bool {
        let mut levels = self.levels.iter();
        levels.any(|level| level.carries != Vector::zeros())
    }

    /// The velocity at which somebody at `p` is carried, m/s.
    pub fn carries(&self, p: Vector) -> Vector {
        self.levels[self.level(p)].carries
    }

    /// The rectangle around all levels, given by its lower left and upper right corner, meters.
    pub fn extent(&self) -> [Vector; 2] {
        let last = self.levels.len().saturating_sub(1) as i32;
        let margin = Vector::repeat(0.25 * GAP);
        let [low, high] = self.corners;
        [low - margin, high + self.way(last) + margin]
    }

    /// All joins, each from both of its levels, level by level.
    pub fn joins(&self) -> &[Join] {
        &self.joins
    }

    /// The numbers of the joins of the level on which `p` lies.
    pub fn joins_at(&self, p: Vector) -> Range<usize> {
        let level = self.level(p);
        self.starts[level]..self.starts[level + 1]
    }

    /// The way to the next level for somebody at `p` who has just walked across a join, meters.
    pub fn passed(&self, p: Vector) -> Option<Vector> {
        let mut joins = self.joins[self.joins_at(p)].iter();
        let join = joins.find(|join| join.was_passed(p));
        join.map(|join| self.way(join.to))
    }
}
