//! Areas that touch or overlap as one, less what stands on them.

use geo::bool_ops::FillRule;
use geo::{BooleanOps, BoundingRect, Coord, CoordsIter, LineString, MapCoordsInPlace};
use geo::{MultiPolygon, Polygon};

use super::error::FloorPlanError;
use super::shape::distinct;
use crate::geometry::{Area, Ring};
use crate::math::Vector;

/// How far, in parts of the whole extent, corners may be from where they were given: geo computes on a grid
/// of some 2⁻³⁰.
const ROUNDING: f64 = 1.0 / (1 << 28) as f64;
/// What is narrower than this on the average is nothing but rounding, metres.
const NARROW: f64 = 1e-6;

/// The union of `areas` without the union of `obstacles`, as areas that touch at points at most.
pub fn without(areas: &[Area], obstacles: &[Area]) -> Result<Vec<Area>, FloorPlanError> {
    let (floor, bodies) = (to_geo(areas), to_geo(obstacles));
    // Outlines turn one way and holes the other: what lies in more outlines than holes counts.
    let mut free = floor.difference_with_fill_rule(&bodies, FillRule::Positive);
    let extent = floor
        .bounding_rect()
        .map_or(0.0, |bounds| bounds.width().max(bounds.height()));
    let given = floor.coords_iter().chain(bodies.coords_iter());
    restore_corners(&mut free, given.collect(), extent);
    let mut united = Vec::with_capacity(free.0.len());
    for polygon in free {
        let Some(exterior) = ring(polygon.exterior())? else {
            continue;
        };
        let mut holes = Vec::with_capacity(polygon.interiors().len());
        for hole in polygon.interiors() {
            holes.extend(ring(hole)?);
        }
        united.push(Area { exterior, holes });
    }
    Ok(united)
}

/// Corners as they were `given`, to the last bit, in something computed from these over so many metres.
pub fn restore_corners(area: &mut MultiPolygon, mut given: Vec<Coord>, extent: f64) {
    let rounding = extent * ROUNDING;
    given.sort_by(|a, b| a.x.total_cmp(&b.x));
    area.map_coords_in_place(|corner| {
        let from = given.partition_point(|other| other.x < corner.x - rounding);
        let near = given[from..]
            .iter()
            .take_while(|other| other.x <= corner.x + rounding)
            .find(|other| (other.y - corner.y).abs() <= rounding);
        near.copied().unwrap_or(corner)
    });
}

/// Outlines counter-clockwise, holes clockwise.
fn to_geo(areas: &[Area]) -> MultiPolygon {
    let ring = |ring: &Ring| -> Vec<Coord> {
        let points = ring.points().iter();
        points.map(|p| Coord { x: p.x, y: p.y }).collect()
    };
    let hole = |hole: &Ring| LineString(ring(hole).into_iter().rev().collect());
    let polygons = areas.iter().map(|area| {
        let holes = area.holes.iter().map(hole).collect();
        Polygon::new(LineString(ring(&area.exterior)), holes)
    });
    polygons.collect()
}

/// `None` for a sliver.
fn ring(line: &LineString) -> Result<Option<Ring>, FloorPlanError> {
    let points = distinct(line.coords().map(|c| Vector::new(c.x, c.y)));
    if points.len() < 3 {
        return Ok(None);
    }
    let ends = points.iter().cycle().skip(1);
    let around: f64 = points.iter().zip(ends).map(|(a, b)| (b - a).norm()).sum();
    let first = points[0];
    let ring = Ring::new(points).map_err(|error| FloorPlanError::Ring {
        place: format!("the ring through ({}, {})", first.x, first.y),
        reason: error.to_string(),
    })?;
    Ok((ring.area() > NARROW * around).then_some(ring))
}
