//! The points of routes.

use super::map::{Next, PathMap};
use crate::math::Vector;
use crate::routes::floor::Floor;

/// The most points of a course, far more than the corners of any way.
const MOST_POINTS: usize = 10_000;

/// The last point of the way that begins with `first`, meters.
pub fn end(floor: &Floor, map: &PathMap, first: Next) -> Option<Vector> {
    match first {
        Next::Goal(point) => Some(point),
        Next::Corner(_) | Next::Out(_) => points(floor, map, first).last(),
    }
}

/// The points of the way that begins with `first`, meters.
pub fn points(floor: &Floor, map: &PathMap, first: Next) -> impl Iterator<Item = Vector> {
    let mut next = Some(first);
    let points = std::iter::from_fn(move || {
        let now = next?;
        next = match now {
            Next::Goal(_) => None,
            Next::Corner(bend) => map.after(floor, bend),
            // Of several levels, nothing says on which of them the point lies.
            Next::Out(_) if floor.has_levels() => None,
            Next::Out(point) => map.way_from(floor, point).map(|way| way.next),
        };
        Some(now.place(floor))
    });
    points.take(MOST_POINTS)
}
