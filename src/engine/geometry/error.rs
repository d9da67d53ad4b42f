//! Why corners form no polygon.

use crate::math::Vector;

/// Why points or rings do not form an obstacle.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PolygonError {
    /// Fewer than three points: the number given.
    #[error("a polygon needs at least 3 points, this one has {0}")]
    TooFewPoints(usize),
    /// The index of the non-finite point.
    #[error("point {0} is not finite")]
    NotFinite(usize),
    /// The indices of the equal points.
    #[error("points {0} and {1} are the same; remove one")]
    RepeatedPoint(usize, usize),
    /// All points lie on one line.
    #[error("the polygon encloses no area; its points lie on one line")]
    NoArea,
    /// The indices of the first points of the two edges that meet.
    #[error(
        "the polygon crosses or touches itself: the edge from point {0} meets the edge from point {1}; \
         move a point, or make two obstacles of it"
    )]
    SelfIntersection(usize, usize),
    /// The first points of the two edges that cross, meters.
    #[error(
        "two rings cross: the edge from ({}, {}) and the edge from ({}, {})", .0.x, .0.y, .1.x, .1.y
    )]
    Crossing(Vector, Vector),
    /// The hole's first point, meters.
    #[error(
        "the hole that begins at ({}, {}) does not lie in its outline, or lies in another hole", .0.x, .0.y
    )]
    StrayHole(Vector),
    /// The first point of one of the overlapping areas, meters.
    #[error("the area that begins at ({}, {}) overlaps another; unite them", .0.x, .0.y)]
    Overlap(Vector),
    /// No areas to walk in.
    #[error("there is no area to walk in")]
    NoFloor,
}
