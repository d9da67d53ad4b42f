//! What ways go straight to: corners and parts of goals.

use super::corner::{Bend, Turn};
use super::expansion::Eye;
use super::floor::Floor;
use super::mesh::nearest_on;
use crate::engine::math::Vector;

/// A part of a goal that ways go straight to.
#[derive(Debug, Clone, Copy)]
pub enum Source {
    /// A point, meters.
    Point {
        /// The point.
        point: Vector,
        /// From where one looks: beside it, inside of its triangle.
        eye: Vector,
    },
    /// The nearest point of a line, meters.
    Line {
        /// The ends of the line.
        ends: [Vector; 2],
        /// The direction away from it.
        away: Vector,
    },
}

/// The targets of a path map, by number: the bends of the floor, then the sources.
#[derive(Debug, Clone, Default)]
pub struct Targets {
    /// The length of the way from each bend on, meters; infinite if there is none.
    pub rest: Vec<f64>,
    /// For each bend, the target that comes next.
    pub next: Vec<u32>,
    /// The parts of the goals.
    pub sources: Vec<Source>,
    /// Points on the borders of what sources see, in addition to those of the floor, meters.
    pub borders: Vec<Vector>,
}

/// A target that the shortest way from some part of a triangle goes straight to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The number of the target.
    pub target: u32,
    /// The numbers of the borders on the right and on the left of what the target sees of the triangle.
    pub borders: [u32; 2],
}

/// A half-plane: what lies on the left of the ray from an eye through a point (`sign` 1), or on the right (−1).
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    eye: Eye,
    through: Vector,
    sign: f64,
}

impl Limit {
    /// Above 0 inside, in proportion to the distance from the border.
    #[inline]
    pub fn inside(&self, p: Vector) -> f64 {
        self.eye.side(self.through, p) * self.sign
    }

    /// Does `p` lie in it, or within `margin` meters of it?
    #[inline]
    pub fn holds(&self, p: Vector, margin: f64) -> bool {
        let inside = self.inside(p);
        inside >= 0.0 || inside >= -margin * self.eye.scale(self.through)
    }
}

impl Targets {
    /// The bend with this number, if it is one.
    pub fn bend(&self, target: u32) -> Option<Bend> {
        let bend = target as usize;
        (bend < self.rest.len()).then(|| Bend::of_index(bend))
    }

    /// The part of a goal with this number, if it is one.
    pub fn source(&self, target: u32) -> Option<&Source> {
        self.sources
            .get((target as usize).checked_sub(self.rest.len())?)
    }

    /// From where a target looks.
    #[inline]
    pub fn eye(&self, floor: &Floor, target: u32) -> Eye {
        match self.source(target) {
            None => Eye::Near(floor.place(Bend::of_index(target as usize))),
            Some(&Source::Point { eye, .. }) => Eye::Near(eye),
            Some(&Source::Line { away, .. }) => Eye::Far(away),
        }
    }

    /// A point on a border, meters.
    #[inline]
    pub fn border(&self, floor: &Floor, number: u32) -> Vector {
        match (number as usize).checked_sub(floor.borders()) {
            Some(own) => self.borders[own],
            None => floor.border(number),
        }
    }

    /// The point of a target nearest to `p`, meters.
    #[inline]
    pub fn nearest(&self, floor: &Floor, target: u32, p: Vector) -> Vector {
        match self.source(target) {
            None => floor.place(Bend::of_index(target as usize)),
            Some(&Source::Point { point, .. }) => point,
            Some(&Source::Line { ends: [a, b], .. }) => nearest_on(p, a, b),
        }
    }

    /// The length of the way from a target on, meters.
    #[inline]
    pub fn rest(&self, target: u32) -> f64 {
        self.rest.get(target as usize).copied().unwrap_or_default()
    }

    /// The length of the way from `p` over a target, meters.
    #[inline]
    pub fn length(&self, floor: &Floor, target: u32, p: Vector) -> f64 {
        (self.nearest(floor, target, p) - p).norm() + self.rest(target)
    }

    /// A point in the direction beyond which the way over a bend does not bend around its walls, meters.
    #[inline]
    pub fn beyond(&self, floor: &Floor, bend: Bend) -> Vector {
        let place = floor.place(bend);
        let next = self.nearest(floor, self.next[bend.index()], place);
        bend.turn.beyond(place, place - next)
    }

    /// The half-planes whose common part is where an entry holds.
    #[inline]
    pub fn limits(&self, floor: &Floor, entry: Entry) -> [Limit; 3] {
        let eye = self.eye(floor, entry.target);
        let [right, left] = entry.borders.map(|number| self.border(floor, number));
        let limit = |through: Vector, sign: f64| Limit { eye, through, sign };
        let bends = match self.bend(entry.target) {
            None => limit(right, 1.0),
            Some(bend) => {
                let sign = if bend.turn == Turn::First { -1.0 } else { 1.0 };
                limit(self.beyond(floor, bend), sign)
            }
        };
        [limit(right, 1.0), limit(left, -1.0), bends]
    }

    /// Does `entry` hold at `p`, or within `margin` meters of it?
    #[inline]
    pub fn holds(&self, floor: &Floor, entry: Entry, p: Vector, margin: f64) -> bool {
        let limits = self.limits(floor, entry);
        limits.iter().all(|limit| limit.holds(p, margin))
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.rest.capacity() * size_of::<f64>()
            + self.next.capacity() * size_of::<u32>()
            + self.borders.capacity() * size_of::<Vector>()
            + self.sources.capacity() * size_of::<Source>()
    }
}
