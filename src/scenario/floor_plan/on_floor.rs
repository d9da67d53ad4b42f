//! The parts of areas and lines that lie on the floor.

use super::error::FloorPlanError;
use super::shape::Shape;
use super::unite::{Rings, free, outlines};
use engine::geometry::{Area, Ring, Walls};
use engine::math::{Vector, direction, perpendicular};

/// A line is on the floor if floor is this near, meters: lines are drawn along walls.
const NEAR: f64 = 0.01;

/// The parts of what `outline` encloses that lie on the floor, outside of `bodies`.
///
/// # Errors
/// Those of [`free`].
pub fn parts_on_floor(
    outline: &Ring,
    walls: &Walls,
    bodies: &Rings,
) -> Result<Vec<Area>, FloorPlanError> {
    let (mut floors, mut solids) = outlines(walls.obstacles());
    floors.insert(0, vec![outline.points().to_vec()]);
    solids.extend(bodies.iter().cloned());
    free(&floors, &solids)
}

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
    Ok(!parts_on_floor(&area.exterior, walls, &Rings::new())?.is_empty())
}

/// Whether a part of a line between two points is on the floor, or next to it.
///
/// # Errors
/// Those of [`free`].
pub fn is_line_on_floor([a, b]: [Vector; 2], walls: &Walls) -> Result<bool, FloorPlanError> {
    let aside = perpendicular(direction(b - a)) * NEAR;
    is_on_floor(&[a - aside, b - aside, b + aside, a + aside], walls)
}
