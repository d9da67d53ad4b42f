//! One boundary edge of an obstacle (O_k in the paper).

use parry2d::query::PointQueryWithLocation;
use parry2d::shape::{Segment, SegmentPointLocation};

use super::{from_parry, to_parry};
use crate::math::{Vector, perpendicular};

/// A wall stops moves up to this distance beyond its ends, meters: more than the rounding of coordinates up to 10⁶ m,
/// so that no agent slips between two walls at their corner.
const END_ROUNDING: f64 = 1e-9;

/// More than the rounding of the distance from a line, meters, for coordinates up to 10⁶ m.
const LINE_ROUNDING: f64 = 1e-6;

/// A directed edge with the obstacle on its left and the free side on its right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// First end point, meters.
    pub start: Vector,
    /// Second end point, meters.
    pub end: Vector,
    /// Unit vector from `start` to `end`.
    pub tangent: Vector,
    /// Unit normal, pointing out of the obstacle to the free side.
    pub normal: Vector,
    /// The index, in the order of the scene, of the obstacle that this edge bounds.
    pub obstacle: u32,
    /// The index of the wall of the same ring that ends where this wall starts.
    pub previous: u32,
}

/// The part of a wall on which its nearest point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WallPart {
    /// The first end.
    Start,
    /// Between the ends.
    Interior,
    /// The second end.
    End,
}

/// The point of a wall nearest to a given point (r_k* in the paper).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// The point, meters.
    pub point: Vector,
    /// The part of the wall on which it lies.
    pub part: WallPart,
}

impl Wall {
    /// The edge from `start` to `end`, with the solid on its left; the ends must differ.
    pub fn new(start: Vector, end: Vector, obstacle: u32, previous: u32) -> Self {
        let tangent = (end - start).normalize();
        Self {
            start,
            end,
            tangent,
            normal: -perpendicular(tangent),
            obstacle,
            previous,
        }
    }

    /// Length in meters.
    pub fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }

    /// Whether the position `along` the wall's line, meters from `start`, lies on the wall, within rounding.
    fn reaches(&self, along: f64) -> bool {
        (-END_ROUNDING..=self.length() + END_ROUNDING).contains(&along)
    }

    /// Distance of `p` from the wall's line in meters; negative behind the wall.
    pub fn signed_distance(&self, p: Vector) -> f64 {
        (p - self.start).dot(&self.normal)
    }

    /// Whether `p` is on the free side or on the wall's line.
    pub fn faces(&self, p: Vector) -> bool {
        self.signed_distance(p) >= 0.0
    }

    /// Whether the line of this wall is certainly more than `radius` meters from `p`: most walls of a list are, and
    /// this is much cheaper than the nearest point.
    pub fn is_beyond(&self, p: Vector, radius: f64) -> bool {
        self.signed_distance(p).abs() > radius + LINE_ROUNDING
    }

    /// The point of this wall nearest to `p`.
    pub fn nearest_point(&self, p: Vector) -> NearestPoint {
        let segment = Segment::new(to_parry(self.start), to_parry(self.end));
        let (projection, location) =
            segment.project_local_point_and_get_location(to_parry(p), false);
        NearestPoint {
            point: from_parry(projection.point),
            part: match location {
                SegmentPointLocation::OnVertex(0) => WallPart::Start,
                SegmentPointLocation::OnVertex(_) => WallPart::End,
                SegmentPointLocation::OnEdge(_) => WallPart::Interior,
            },
        }
    }

    /// The point `clearance` meters in front of the lines of both this wall and another, where they cross or meet.
    /// `None` if they do not meet, and at the tip of a spike, where that point is more than twice as far from the
    /// walls themselves.
    pub fn corner_with(&self, other: &Self, clearance: f64) -> Option<Vector> {
        let sine = self.tangent.perp(&other.tangent);
        let along = (other.start - self.start).perp(&other.tangent) / sine;
        let point = self.start + self.tangent * along;
        let there = (point - other.start).dot(&other.tangent);
        let crosses = self.reaches(along) && other.reaches(there);
        let cosine = self.normal.dot(&other.normal);
        let out = (self.normal + other.normal) * (clearance / (1.0 + cosine));
        let corner = point + out;
        let is_before = |wall: &Self| {
            let gap = (wall.nearest_point(corner).point - corner).norm();
            gap <= 2.0 * clearance // leaves room for rounding
        };
        (crosses && is_before(self) && is_before(other)).then_some(corner)
    }

    /// The fraction of the move from `from` (on the free side) to `to` at which it crosses this wall inward, ends
    /// included; `None` if it does not.
    pub fn crossing(&self, from: Vector, to: Vector) -> Option<f64> {
        let before = self.signed_distance(from);
        let after = self.signed_distance(to);
        if before < 0.0 || after >= 0.0 {
            return None;
        }
        let fraction = before / (before - after);
        let along = (from + (to - from) * fraction - self.start).dot(&self.tangent);
        self.reaches(along).then_some(fraction)
    }
}
