//! The targets of straight routes: corners and parts of goals.

use crate::math::{Vector, bytes_of, direction};
use crate::routes::floor::{Bend, Eye, Floor, Turn, nearest_on, part};

/// A part of a goal that routes go straight to.
#[derive(Debug, Clone, Copy)]
pub enum Source {
    /// A point, meters.
    Point {
        /// The point.
        point: Vector,
        /// The viewpoint: beside the point, inside its triangle.
        eye: Vector,
        /// The middle of the line that ends here; the point itself if the goal is a point.
        middle: Vector,
    },
    /// The nearest point of a line, meters.
    Line {
        /// The ends of the line.
        ends: [Vector; 2],
        /// The direction in which it looks: at a right angle to the line.
        away: Vector,
    },
}

impl Source {
    /// The ends of the line that it belongs to, meters; `None` for a goal that is a point.
    pub fn ends(&self) -> Option<[Vector; 2]> {
        match *self {
            Self::Point { point, middle, .. } => {
                (point != middle).then(|| [point, middle * 2.0 - point])
            }
            Self::Line { ends, .. } => Some(ends),
        }
    }

    /// Whether this is still the part of its line nearest to `p`. An end is, as long as `p` lies beyond it.
    pub fn is_beside_line(&self, p: Vector) -> bool {
        match *self {
            Self::Point { point, middle, .. } => (p - point).dot(&(middle - point)) <= 0.0,
            Self::Line { .. } => true,
        }
    }
}

/// The targets of a path map, by number: the bends of the floor, then the sources.
#[derive(Debug, Clone, Default)]
pub struct Targets {
    /// The length of the rest of the way from each bend, meters; infinite if there is none.
    pub rest: Vec<f64>,
    /// For each bend, the target that comes next.
    pub next: Vec<u32>,
    /// For each bend, the direction beyond which routes over it do not bend around its walls.
    pub beyond: Vec<[f32; 2]>,
    /// The parts of the goals.
    pub sources: Vec<Source>,
    /// Points on the edges of the visible cones of the sources, in addition to those of the floor, meters.
    pub borders: Vec<Vector>,
}

/// The first target of the shortest routes from some part of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The number of the target.
    pub target: u32,
    /// The numbers of the borders on the right and left edge of the target's visible cone in the triangle.
    pub borders: [u32; 2],
}

/// A half-plane: the points on the left of the ray from an eye through a point (`sign` 1), or on its right (−1).
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    eye: Eye,
    /// A point on the border, meters.
    pub through: Vector,
    sign: f64,
}

impl Limit {
    /// Positive inside, proportional to the distance from the border.
    #[inline]
    pub fn inside(&self, p: Vector) -> f64 {
        self.eye.side(self.through, p) * self.sign
    }

    /// The distance of `p` from the border, meters, at most `most`; negative outside.
    #[inline]
    pub fn distance(&self, p: Vector, most: f64) -> f64 {
        part(self.inside(p), self.eye.ray(self.through), most)
    }

    /// Whether `p` lies in it, or within `margin` meters of it.
    #[inline]
    pub fn holds(&self, p: Vector, margin: f64) -> bool {
        let inside = self.inside(p);
        inside >= 0.0 || inside >= -margin * self.eye.ray(self.through).norm()
    }
}

impl Targets {
    /// The number of targets.
    pub fn len(&self) -> usize {
        self.rest.len() + self.sources.len()
    }

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

    /// The viewpoint of a target.
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

    /// The length of the rest of the way from a target, meters.
    #[inline]
    pub fn rest(&self, target: u32) -> f64 {
        self.rest.get(target as usize).copied().unwrap_or_default()
    }

    /// The length of the way from `p` over a target, meters.
    #[inline]
    pub fn length(&self, floor: &Floor, target: u32, p: Vector) -> f64 {
        (self.nearest(floor, target, p) - p).norm() + self.rest(target)
    }

    /// Computes the directions in `beyond`. All targets and `next` must be known.
    pub fn find_beyond(&mut self, floor: &Floor) {
        let directions = (0..self.next.len()).map(|number| {
            let bend = Bend::of_index(number);
            let place = floor.place(bend);
            let along = direction(place - self.nearest(floor, self.next[number], place));
            let beyond = bend.turn.beyond(Vector::zeros(), along);
            [beyond.x as f32, beyond.y as f32]
        });
        self.beyond = directions.collect();
    }

    /// A point in the direction beyond which routes over a bend do not bend around its walls, meters.
    #[inline]
    pub fn beyond(&self, floor: &Floor, bend: Bend) -> Vector {
        let [x, y] = self.beyond[bend.index()].map(f64::from);
        floor.place(bend) + Vector::new(x, y)
    }

    /// The half-planes whose intersection is the visible cone of an entry's target in the triangle.
    #[inline]
    pub fn cone(&self, floor: &Floor, entry: Entry) -> [Limit; 2] {
        let eye = self.eye(floor, entry.target);
        let [right, left] = entry.borders.map(|number| self.border(floor, number));
        [(right, 1.0), (left, -1.0)].map(|(through, sign)| Limit { eye, through, sign })
    }

    /// The half-planes whose intersection is the region where an entry holds.
    #[inline]
    pub fn limits(&self, floor: &Floor, entry: Entry) -> [Limit; 3] {
        let [right, left] = self.cone(floor, entry);
        let bends = self.bend(entry.target).map_or(right, |bend| Limit {
            through: self.beyond(floor, bend),
            sign: if bend.turn == Turn::First { -1.0 } else { 1.0 },
            ..right
        });
        [right, left, bends]
    }

    /// Whether `entry` holds at `p`: its target is visible, and the way bends or ends there.
    #[inline]
    pub fn holds(&self, floor: &Floor, entry: Entry, p: Vector) -> bool {
        let eye = self.eye(floor, entry.target);
        let [right, left] = entry.borders;
        eye.side(self.border(floor, right), p) >= 0.0
            && eye.side(self.border(floor, left), p) <= 0.0
            && self.bends(floor, entry.target, p)
    }

    /// Whether the way from `p` over a target bends there around walls, or ends.
    #[inline]
    pub fn bends(&self, floor: &Floor, target: u32, p: Vector) -> bool {
        let Some(bend) = self.bend(target) else {
            return true;
        };
        let side = Eye::Near(floor.place(bend)).side(self.beyond(floor, bend), p);
        match bend.turn {
            Turn::First => side <= 0.0,
            Turn::Last => side >= 0.0,
        }
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        let of_bends = bytes_of(&self.rest) + bytes_of(&self.next) + bytes_of(&self.beyond);
        of_bends + bytes_of(&self.borders) + bytes_of(&self.sources)
    }
}
