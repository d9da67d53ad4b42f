//! Whether a part of an area or a line lies on the floor.

use super::error::FloorPlanError;
use super::shape::Shape;
use super::unite::{free, outlines, rings};
use crate::engine::geometry::{Area, Ring, Walls};
use crate::engine::math::{Vector, direction, perpendicular};

/// A line is on the floor if floor is this near, meters: lines are drawn along walls.
const NEAR: f64 = 0.01;

/// Is a part of what `outline` encloses outside of all obstacles and inside of the walkable area? Outlines that enclose
/// nothing always are.
///
/// # Errors
/// Those of [`free`].
pub fn is_on_floor(outline: &[Vector], walls: &Walls) -> Result<bool, FloorPlanError> {
    let Ok(exterior) = Ring::new(outline.to_vec()) else {
        return Ok(true);
    };
    let area = Area {
        exterior,
        holes: Vec::new(),
    };
    if walls.obstacle_at(Shape::middle(&area).0).is_none() {
        return Ok(true);
    }
    let (mut floors, bodies) = outlines(walls.obstacles());
    floors.insert(0, rings(&[area]));
    Ok(!free(&floors, &bodies)?.is_empty())
}

/// Whether a part of a line between two points is on the floor, or next to it.
///
/// # Errors
/// Those of [`free`].
pub fn is_line_on_floor([a, b]: [Vector; 2], walls: &Walls) -> Result<bool, FloorPlanError> {
    let aside = perpendicular(direction(b - a)) * NEAR;
    is_on_floor(&[a - aside, b - aside, b + aside, a + aside], walls)
}
