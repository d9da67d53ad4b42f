//! Regions: the positions from which a way goes straight to a target.

use super::targets::{Entry, Limit, Source, Targets};
use crate::math::{Vector, direction};
use crate::routes::floor::{Floor, nearest_on};

/// Routes whose lengths differ by less than this count as equally long, meters.
pub const TIE: f64 = 1e-9;

/// A triangle, or a part of one.
pub type Corners = [Vector; 3];

/// An entry with the data that its regions depend on.
pub struct Candidate {
    /// The entry.
    pub entry: Entry,
    limits: [Limit; 3],
    /// The target: a point (twice), or a line, meters.
    ends: [Vector; 2],
    rest: f64,
}

impl Candidate {
    /// Looks up the data that the regions of an entry depend on.
    pub fn new(floor: &Floor, targets: &Targets, entry: Entry) -> Self {
        let ends = match targets.source(entry.target) {
            Some(&Source::Line { ends, .. }) => ends,
            _ => [targets.nearest(floor, entry.target, Vector::zeros()); 2],
        };
        Self {
            entry,
            limits: targets.limits(floor, entry),
            ends,
            rest: targets.rest(entry.target),
        }
    }

    fn nearest(&self, p: Vector) -> Vector {
        let [a, b] = self.ends;
        if a == b { a } else { nearest_on(p, a, b) }
    }

    /// The length of the way from `p` over the target, meters.
    pub fn length(&self, p: Vector) -> f64 {
        (self.nearest(p) - p).norm() + self.rest
    }

    /// Whether the entry holds at all of `points`.
    pub fn covers(&self, points: &[Vector]) -> bool {
        let mut limits = self.limits.iter();
        limits.all(|limit| points.iter().all(|&p| limit.holds(p, TIE)))
    }
}

/// The positions in a part of a triangle from which a target is seen and the way bends there.
pub struct Region {
    /// The mean of the corners, meters.
    pub center: Vector,
    corners: Polygon,
    /// A lower bound at each corner, meters. Interpolated barycentrically, it bounds the length of any way from p over
    /// the target.
    least: [f64; MOST_CORNERS],
}

impl Region {
    /// The region in the part with some `corners`; `None` if it is empty.
    pub fn new(corners: Corners, candidate: &Candidate) -> Option<Self> {
        let mut seen = Polygon::of(corners);
        for limit in &candidate.limits {
            seen.clip(|p| limit.inside(p));
        }
        let points = seen.points();
        if points.is_empty() {
            return None;
        }
        let center = points.iter().sum::<Vector>() / points.len() as f64;
        // Distances are convex functions: they are nowhere below their tangents.
        let way = center - candidate.nearest(center);
        let (length, ahead) = (way.norm() + candidate.rest, direction(way));
        let mut least = [0.0; MOST_CORNERS];
        for (least, p) in least.iter_mut().zip(points) {
            *least = length + ahead.dot(&(p - center));
        }
        Some(Self {
            center,
            least,
            corners: seen,
        })
    }

    /// Whether the way over the target of `rival` is nowhere longer in this region.
    pub fn is_beaten(&self, rival: &Candidate) -> bool {
        let points = self.corners.points();
        // Distances are convex functions: inside the region they do not exceed the interpolation of their values at the
        // corners.
        let mut pairs = points.iter().zip(&self.least);
        pairs.all(|(&p, least)| rival.length(p) <= least + TIE) && rival.covers(points)
    }
}

/// Each candidate is compared with at most this many shorter ones.
const RIVALS: usize = 8;

/// The candidates that can be the shortest somewhere in a part, in the order of their targets.
pub fn best<'a>(candidates: &[&'a Candidate], corners: Corners) -> Vec<&'a Candidate> {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let distances = corners.iter().map(|p| (p - middle).norm());
    let radius = distances.fold(0.0, f64::max);
    let lengths = candidates.iter().map(|one| (one.length(middle), *one));
    let mut nearest: Vec<(f64, &Candidate)> = lengths.collect();
    nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<&Candidate> = Vec::new();
    // An upper bound of the shortest way from anywhere in the part.
    let mut most = f64::INFINITY;
    for (length, candidate) in nearest {
        if length - radius > most {
            break;
        }
        let Some(region) = Region::new(corners, candidate) else {
            continue;
        };
        let mut rivals = kept.iter().take(RIVALS);
        if !rivals.any(|rival| region.is_beaten(rival)) {
            kept.push(candidate);
        }
        if candidate.covers(&corners) {
            let lengths = corners.iter().map(|&p| candidate.length(p));
            most = most.min(lengths.fold(0.0, f64::max));
        }
    }
    kept.sort_by_key(|candidate| candidate.entry.target);
    kept
}

/// Clipping a triangle with three half-planes adds at most one corner each.
const MOST_CORNERS: usize = 6;

/// A convex polygon of a few corners.
struct Polygon {
    corners: [Vector; MOST_CORNERS],
    count: usize,
}

impl Polygon {
    fn of([a, b, c]: Corners) -> Self {
        let mut corners = [Vector::zeros(); MOST_CORNERS];
        corners[..3].copy_from_slice(&[a, b, c]);
        Self { corners, count: 3 }
    }

    fn points(&self) -> &[Vector] {
        &self.corners[..self.count]
    }

    /// Keeps the part where the linear function `value` is not negative.
    fn clip(&mut self, value: impl Fn(Vector) -> f64) {
        let (old, count) = (self.corners, self.count);
        let values = old.map(value);
        if values[..count].iter().all(|&value| value >= 0.0) {
            return;
        }
        self.count = 0;
        for k in 0..count {
            let next = if k + 1 < count { k + 1 } else { 0 };
            let (p, q, at_p, at_q) = (old[k], old[next], values[k], values[next]);
            if at_p >= 0.0 {
                self.push(p);
            }
            if (at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0) {
                self.push(p + (q - p) * (at_p / (at_p - at_q)));
            }
        }
    }

    fn push(&mut self, p: Vector) {
        if let Some(corner) = self.corners.get_mut(self.count) {
            *corner = p;
            self.count += 1;
        }
    }
}
