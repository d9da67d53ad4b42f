//! Closed outlines, validated once and always counterclockwise, and areas between them.

use parry2d::bounding_volume::Aabb;
use parry2d::utils::{point_in_poly2d, segments_intersection2d};

use super::error::PolygonError;
use super::{bounds_of, index_of, to_parry};
use crate::math::{Vector, is_finite, perpendicular, sides};

/// A fraction of a length, not ½: corners of other rings often lie exactly in the middle of an edge.
const UNEVEN: f64 = 0.414;

/// A closed counterclockwise outline that neither crosses nor touches itself. Its first point is the first point
/// given.
#[derive(Debug, Clone, PartialEq)]
pub struct Ring {
    points: Vec<Vector>,
}

impl Ring {
    /// Checks `points` (meters, either orientation; the last must not repeat the first) and orients them.
    ///
    /// # Errors
    /// Fewer than three points, a non-finite or repeated point, an area below rounding error, or edges that meet
    /// anywhere but at a shared corner. Indices count from 0 in the order given.
    pub fn new(mut points: Vec<Vector>) -> Result<Self, PolygonError> {
        let count = points.len();
        if count < 3 {
            return Err(PolygonError::TooFewPoints(count));
        }
        if let Some(i) = points.iter().position(|&p| !is_finite(p)) {
            return Err(PolygonError::NotFinite(i));
        }
        // Also rejects edges so short that their squared length underflows: they have no direction.
        let edge = |i: usize| points[(i + 1) % count] - points[i];
        if let Some(i) = (0..count).find(|&i| edge(i).norm_squared() < f64::MIN_POSITIVE) {
            return Err(PolygonError::RepeatedPoint(i, (i + 1) % count));
        }
        if let Some((i, j)) = first_crossing(&points) {
            return Err(PolygonError::SelfIntersection(i, j));
        }
        let area = signed_area(&points);
        let reach = points.iter().map(|p| (p - points[0]).norm_squared());
        // An area below rounding error may have either sign.
        if area.abs() <= f64::EPSILON * reach.fold(0.0, f64::max) {
            return Err(PolygonError::NoArea);
        }
        if area < 0.0 {
            points[1..].reverse();
        }
        Ok(Self { points })
    }

    /// The corners, counterclockwise.
    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    /// The same ring at another place, meters away.
    #[must_use]
    pub fn moved(mut self, by: Vector) -> Self {
        self.points.iter_mut().for_each(|point| *point += by);
        self
    }

    /// The enclosed area in m²; always positive.
    pub fn area(&self) -> f64 {
        signed_area(&self.points)
    }

    /// Whether `p` lies inside. Within rounding of the boundary either answer is possible.
    pub fn contains(&self, p: Vector) -> bool {
        encloses(&self.points, p)
    }

    /// A point inside the ring, between its longest edge and the nearest edge across from it. The point is clear
    /// of the boundary, so that rings that touch this ring, or cross it by rounding, do not reach the point.
    pub(super) fn inner_point(&self) -> Vector {
        let edge = |k: usize| (self.points[k], self.points[(k + 1) % self.points.len()]);
        let length = |k: &usize| (edge(*k).1 - edge(*k).0).norm_squared();
        let edges = 0..self.points.len();
        let longest = edges.clone().max_by(|i, j| length(i).total_cmp(&length(j)));
        let longest = longest.unwrap_or(0);
        let (a, b) = edge(longest);
        let (start, along) = (a + (b - a) * UNEVEN, (b - a) / (b - a).norm());
        let place = |p: Vector| [along.dot(&(p - start)), along.perp(&(p - start))];
        let across = edges.filter(|&k| k != longest).filter_map(|k| {
            let [[u, v], [u_end, v_end]] = [edge(k).0, edge(k).1].map(place);
            let meets = (u > 0.0) != (u_end > 0.0);
            meets.then(|| v - u * (v_end - v) / (u_end - u))
        });
        let depth = across.filter(|&v| v > 0.0).fold(f64::INFINITY, f64::min);
        let depth = if depth.is_finite() { depth } else { 0.0 };
        start + perpendicular(along) * (UNEVEN * depth)
    }

    /// The corners in clockwise order: the enclosed area is on the right.
    pub(super) fn into_clockwise(mut self) -> Vec<Vector> {
        self.points[1..].reverse();
        self.points
    }

    /// The corners in counterclockwise order: the enclosed area is on the left.
    pub(super) fn into_points(self) -> Vec<Vector> {
        self.points
    }
}

/// A part of the plane, inside its outline and outside its holes. The holes lie in the outline and may touch it
/// and each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    /// The outline.
    pub exterior: Ring,
    /// The holes cut out of it.
    pub holes: Vec<Ring>,
}

impl Area {
    /// The outline, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.exterior).chain(&self.holes)
    }

    /// The same area at another place, meters away.
    #[must_use]
    pub fn moved(self, by: Vector) -> Self {
        let holes = self.holes.into_iter();
        Self {
            exterior: self.exterior.moved(by),
            holes: holes.map(|hole| hole.moved(by)).collect(),
        }
    }

    /// The area in m², without the holes.
    pub fn area(&self) -> f64 {
        self.exterior.area() - self.holes.iter().map(Ring::area).sum::<f64>()
    }

    /// Whether `p` lies in the area. Within rounding of the boundary either answer is possible.
    pub fn contains(&self, p: Vector) -> bool {
        self.exterior.contains(p) && !self.holes.iter().any(|hole| hole.contains(p))
    }
}

/// Whether `p` lies inside the outline `points`, of either orientation.
pub(super) fn encloses(points: &[Vector], p: Vector) -> bool {
    let points: Vec<_> = points.iter().map(|&p| to_parry(p)).collect();
    let p = to_parry(p);
    // Check the bounds first: for an edge that rises by less than rounding, parry takes points before the start of
    // the edge to be inside.
    Aabb::from_points(points.iter().copied()).contains_local_point(p) && point_in_poly2d(p, &points)
}

/// The shoelace formula, relative to the first point so that polygons far from the origin keep their precision.
pub(super) fn signed_area(points: &[Vector]) -> f64 {
    let origin = points[0];
    let twice: f64 = points[1..]
        .windows(2)
        .map(|pair| (pair[0] - origin).perp(&(pair[1] - origin)))
        .sum();
    twice / 2.0
}

/// The first two edges that share more than a common corner, by the indices of their first points.
fn first_crossing(points: &[Vector]) -> Option<(usize, usize)> {
    let count = points.len();
    let corner = |i: usize| to_parry(points[i % count]);
    let bounds: Vec<Aabb> = sides(points).map(|(a, b)| bounds_of([a, b])).collect();
    let index = index_of(bounds.iter().copied());
    (0..count).find_map(|i| {
        let turn = points[(i + 1) % count] - points[i];
        let next = points[(i + 2) % count] - points[(i + 1) % count];
        if turn.perp(&next) == 0.0 && turn.dot(&next) < 0.0 {
            return Some((i, (i + 1) % count));
        }
        index
            .intersect_aabb(&bounds[i])
            .map(|j| j as usize)
            .filter(|&j| j > i + 1 && (j + 1) % count != i)
            .filter(|&j| {
                segments_intersection2d(corner(i), corner(i + 1), corner(j), corner(j + 1), 0.0)
                    .is_some()
            })
            .min()
            .map(|j| (i, j))
    })
}
