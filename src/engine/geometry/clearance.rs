//! The parts of a line that the centers of bodies reach.
//!
//! A body keeps its center at a distance from all walls, so a stretch of a line is clear if no wall is nearer. The
//! stretch between it and a wall that the line ends at is a part of the same gap. Nothing else is reached: a piece
//! behind the end of a wall, or a stretch along a wall.

use super::Walls;
use crate::math::{Vector, direction};
use libm::hypot;

/// Shorter pieces and distances come from rounding, meters.
const TINY: f64 = 1e-6;
/// A stretch reaches to the end of its line over at most so many times the distance from walls.
const MOST: f64 = 2.0;

/// The slope of a wall along which people do not slide past its end.
const FLAT: f64 = 0.35;

/// A line among walls.
#[derive(Debug)]
pub struct LineAmongWalls {
    start: Vector,
    along: Vector,
    /// The walls near it.
    walls: Vec<Beside>,
    /// The pieces between walls, meters from the start.
    pieces: Vec<[f64; 2]>,
}

/// The parts of a line that the centers of bodies reach.
#[derive(Debug, Clone, PartialEq)]
pub struct Clear {
    /// The parts, up to walls beside them, meters. `None`: the line as it is.
    pub parts: Option<Vec<[Vector; 2]>>,
    /// The middles of the stretches that are clear of walls, meters.
    pub middles: Vec<Vector>,
}

/// A wall beside a line.
#[derive(Debug)]
struct Beside {
    /// Its ends, along the line and across, meters.
    ends: [[f64; 2]; 2],
    /// The part of the line nearest to it, meters from the start of the line.
    nearest: [f64; 2],
    /// Its distance from there, meters.
    away: f64,
    /// Whether no other wall is nearer to that part.
    stops: bool,
}

impl LineAmongWalls {
    /// The line between two points, with the walls up to `reach` meters beside it.
    pub fn new([a, b]: [Vector; 2], walls: &Walls, reach: f64) -> Self {
        let (along, length) = (direction(b - a), (b - a).norm());
        let near = walls.near_any(&[a, b], reach).into_iter();
        let near = near.map(|k| Beside::new([walls.wall(k).start, walls.wall(k).end], a, along));
        let is_near = |wall: &Beside| {
            let part = wall.within(reach);
            part.is_some_and(|[low, high]| low < length && high > 0.0)
        };
        let mut line = Self {
            start: a,
            along,
            walls: near.filter(is_near).collect(),
            pieces: Vec::new(),
        };
        line.find_stops();
        let touching = line.walls.iter().filter(|wall| wall.away <= TINY);
        let mut cuts: Vec<f64> = touching.flat_map(|wall| wall.nearest).collect();
        cuts.extend([0.0, length]);
        cuts.retain(|cut| (0.0..=length).contains(cut));
        cuts.sort_by(f64::total_cmp);
        let pieces = cuts.windows(2).map(|pair| [pair[0], pair[1]]);
        let is_free = |[from, to]: &[f64; 2]| {
            let middle = 0.5 * (from + to);
            to - from > TINY
                && !line.touches(middle)
                && walls.obstacle_at(line.at(middle)).is_none()
        };
        line.pieces = pieces.filter(is_free).collect();
        line
    }

    fn at(&self, s: f64) -> Vector {
        self.start + self.along * s
    }

    /// Finds the walls to which the line comes nearest at some point, and nearer than on both sides of it.
    fn find_stops(&mut self) {
        let is_least = |wall: &Beside| {
            let [begin, end] = wall.nearest;
            [begin, 0.5 * (begin + end), end].into_iter().any(|s| {
                let mut others = self.walls.iter();
                others.all(|other| other.distance(s) >= wall.away - TINY)
            })
        };
        let stops: Vec<bool> = self.walls.iter().map(is_least).collect();
        for (wall, stops) in self.walls.iter_mut().zip(stops) {
            wall.stops = stops;
        }
    }

    /// Whether a wall touches the line here.
    fn touches(&self, s: f64) -> bool {
        let mut walls = self.walls.iter().filter(|wall| wall.away <= TINY);
        walls.any(|wall| (wall.nearest[0] - TINY..=wall.nearest[1] + TINY).contains(&s))
    }

    /// The parts reached by centers that keep `gap` meters from walls in gaps between two walls, and `body` meters
    /// elsewhere.
    pub fn clear(&self, body: f64, gap: f64) -> Clear {
        let (mut parts, mut middles, mut is_whole) = (Vec::new(), Vec::new(), true);
        for &piece in &self.pieces {
            let is_gap = piece.iter().all(|&end| self.touches(end));
            let distance = if is_gap { gap } else { body } - TINY;
            // A piece between a wall and an end of the line that is shorter than a body is no way on.
            let is_short = !is_gap && self.pieces.len() > 1 && piece[1] - piece[0] < 2.0 * distance;
            let stretches = match is_short {
                true => Vec::new(),
                false => self.stretches(piece, distance),
            };
            middles.extend(
                stretches
                    .iter()
                    .map(|[from, to]| self.at(0.5 * (from + to))),
            );
            let reached = self.extended(piece, &stretches, distance);
            is_whole &= match reached[..] {
                [[from, to]] => from - piece[0] <= TINY && piece[1] - to <= TINY,
                _ => false,
            };
            parts.extend(reached.into_iter().map(|ends| ends.map(|end| self.at(end))));
        }
        Clear {
            parts: (!is_whole).then_some(parts),
            middles,
        }
    }

    /// The stretches of a piece that are `distance` meters from all walls.
    fn stretches(&self, [from, to]: [f64; 2], distance: f64) -> Vec<[f64; 2]> {
        let walls = self.walls.iter();
        let mut blocked: Vec<_> = walls.filter_map(|wall| wall.within(distance)).collect();
        blocked.push([to, f64::INFINITY]);
        blocked.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (mut found, mut free) = (Vec::new(), from);
        for [low, high] in blocked {
            if low.min(to) > free {
                found.push([free, low.min(to)]);
            }
            free = free.max(high);
        }
        found
    }

    /// Stretches of a piece with what lies between them and its ends, or between two of them, if they come nearer to
    /// a wall up to there.
    fn extended(
        &self,
        [from, to]: [f64; 2],
        stretches: &[[f64; 2]],
        distance: f64,
    ) -> Vec<[f64; 2]> {
        let stops = || {
            let walls = self.walls.iter();
            let walls = walls.filter(|wall| wall.stops && wall.away < distance);
            walls.map(Beside::least)
        };
        let most = MOST * distance;
        let before = |s: f64| {
            let ends = stops().map(|[_, end]| end).filter(|end| *end <= s);
            let stop = ends.fold(from, f64::max);
            if s - stop <= most { stop } else { s }
        };
        let after = |s: f64| {
            let begins = stops().map(|[begin, _]| begin).filter(|begin| *begin >= s);
            let stop = begins.fold(to, f64::min);
            if stop - s <= most { stop } else { s }
        };
        let mut found: Vec<[f64; 2]> = Vec::new();
        for &[low, high] in stretches {
            let begin = before(low);
            match found.last_mut() {
                Some(last) if after(last[1]) >= begin - TINY => last[1] = high,
                Some(_) => found.push([low, high]),
                None => found.push([if begin <= from + TINY { from } else { low }, high]),
            }
        }
        if let Some(last) = found.last_mut()
            && after(last[1]) >= to - TINY
        {
            last[1] = to;
        }
        found
    }
}

impl Beside {
    fn new(ends: [Vector; 2], start: Vector, along: Vector) -> Self {
        let ends = ends.map(|end| [along.dot(&(end - start)), along.perp(&(end - start))]);
        let [[x_a, y_a], [x_b, y_b]] = ends;
        let (nearest, away) = if (y_a - y_b).abs() <= TINY {
            ([x_a.min(x_b), x_a.max(x_b)], y_a.abs().min(y_b.abs()))
        } else if y_a * y_b <= 0.0 {
            ([x_a + (x_b - x_a) * y_a / (y_a - y_b); 2], 0.0)
        } else if y_a.abs() < y_b.abs() {
            ([x_a; 2], y_a.abs())
        } else {
            ([x_b; 2], y_b.abs())
        };
        Self {
            ends,
            nearest,
            away,
            stops: false,
        }
    }

    /// The part of the line beside which the wall stops people, meters from its start: where it is nearest, or
    /// all along a wall that is nearly parallel.
    fn least(&self) -> [f64; 2] {
        let [[x_a, y_a], [x_b, y_b]] = self.ends;
        match self.away > TINY && (y_b - y_a).abs() < FLAT * (x_b - x_a).abs() {
            true => [x_a.min(x_b), x_a.max(x_b)],
            false => self.nearest,
        }
    }

    /// Its distance from a point of the line, meters.
    fn distance(&self, s: f64) -> f64 {
        let [a, b] = self.ends.map(Vector::from);
        let p = Vector::new(s, 0.0);
        let along = b - a;
        let part = (p - a).dot(&along) / along.norm_squared();
        (a + along * part.clamp(0.0, 1.0) - p).norm()
    }

    /// The part of the line nearer to the wall than `distance`.
    fn within(&self, distance: f64) -> Option<[f64; 2]> {
        let [[x_a, y_a], [x_b, y_b]] = self.ends;
        let [x, y] = [x_b - x_a, y_b - y_a];
        let length = hypot(x, y);
        // The points whose nearest point lies between the ends of the wall, from its first end.
        let beside = [
            (y, x * y_a, distance * length),
            (x, -y * y_a - 0.5 * length * length, 0.5 * length * length),
        ];
        let mut part = [f64::NEG_INFINITY, f64::INFINITY];
        for (slope, offset, most) in beside {
            let ends = [-most - offset, most - offset].map(|end| end / slope);
            if slope.abs() > TINY * length {
                part = [
                    part[0].max(ends[0].min(ends[1])),
                    part[1].min(ends[0].max(ends[1])),
                ];
            } else if offset.abs() >= most {
                part = [f64::INFINITY, f64::NEG_INFINITY];
            }
        }
        let mut found = if part[0] < part[1] {
            part.map(|s| s + x_a)
        } else {
            [f64::INFINITY, f64::NEG_INFINITY]
        };
        for [x, y] in self.ends {
            let half = (distance * distance - y * y).max(0.0).sqrt();
            if half > 0.0 {
                found = [found[0].min(x - half), found[1].max(x + half)];
            }
        }
        (found[0] < found[1]).then_some(found)
    }
}
