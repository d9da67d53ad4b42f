//! Levels: the sheets of a building, such as floors, flights of stairs and landings, side by side in one plane, and the
//! joins through which people pass and see from one to the other.
//!
//! Level k of a building lies at its own places plus k times a spacing along x, which is longer than the building, so
//! that people on two levels are far apart wherever they stand above each other. Two levels are joined at an edge that
//! both have. Who walks across it is moved by whole spacings; so x and y of the building run on. Who looks across it
//! sees those beyond as many spacings away.

use serde::{Deserialize, Serialize};

use crate::math::{Vector, perpendicular};
use crate::routes::{nearest_on, side};

/// How far beyond a join people are who have just walked across it, meters: farther than a step, and shorter than the
/// floor of the next level that continues there.
const BEYOND: f64 = 0.5;

/// Ways over a join lead over points this far apart and this far behind it, meters: nobody reaches one before crossing.
const BETWEEN: f64 = 0.2;
const BEHIND: f64 = 0.3;

/// An edge of a level through which people pass to another.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Join {
    /// Its ends, meters: the level lies on the left of the way from the first to the second.
    pub line: [Vector; 2],
    /// The number of levels from its own to that beyond.
    pub to: i32,
}

impl Join {
    /// Whether `p` lies beyond the edge's line.
    pub fn is_beyond(&self, p: Vector) -> bool {
        let [a, b] = self.line;
        side(a, b, p) < 0.0
    }

    /// The square of the distance of `p` from the edge, m².
    pub fn distance_squared(&self, p: Vector) -> f64 {
        let [a, b] = self.line;
        (nearest_on(p, a, b) - p).norm_squared()
    }

    /// Points in a row behind the edge, over which ways lead to the level beyond, meters.
    pub fn points_behind(&self) -> impl Iterator<Item = Vector> {
        let [a, b] = self.line;
        let along = b - a;
        let count = (along.norm() / BETWEEN).round().max(1.0);
        let behind = -perpendicular(along).normalize() * BEHIND;
        (0..count as u32).map(move |k| a + along * ((f64::from(k) + 0.5) / count) + behind)
    }

    /// Whether somebody at `p` has just walked across.
    fn was_passed(&self, p: Vector) -> bool {
        let [a, b] = self.line;
        let part = (p - a).dot(&(b - a)) / (b - a).norm_squared();
        let is_before_it = (0.0..=1.0).contains(&part);
        is_before_it && self.is_beyond(p) && self.distance_squared(p) < BEYOND * BEYOND
    }
}

/// The levels of a building.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    spacing: f64,
    joins: Vec<Join>,
}

impl Levels {
    /// Levels that lie `spacing` meters apart along x, and their joins, each given from one of its two levels.
    pub fn new(spacing: f64, joins: &[Join]) -> Self {
        let levels = Self {
            spacing,
            joins: Vec::new(),
        };
        let both = joins.iter().flat_map(|join| {
            let [a, b] = join.line.map(|p| p + levels.way(join.to));
            let back = Join {
                line: [b, a],
                to: -join.to,
            };
            [*join, back]
        });
        Self {
            joins: both.collect(),
            ..levels
        }
    }

    /// The way over this number of levels, meters.
    pub fn way(&self, levels: i32) -> Vector {
        Vector::new(self.spacing * f64::from(levels), 0.0)
    }

    /// The number of the level on which `p` lies.
    pub fn level(&self, p: Vector) -> i32 {
        (p.x / self.spacing).floor() as i32
    }

    /// The place of `p` in the building, meters.
    pub fn in_building(&self, p: Vector) -> Vector {
        p - self.way(self.level(p))
    }

    /// All joins, each from both of its levels: one after the other.
    pub fn joins(&self) -> &[Join] {
        &self.joins
    }

    /// The way to the next level for somebody at `p` who has just walked across a join, meters.
    pub fn passed(&self, p: Vector) -> Option<Vector> {
        let join = self.joins.iter().find(|join| join.was_passed(p));
        join.map(|join| self.way(join.to))
    }
}
