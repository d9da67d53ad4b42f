//! The union of areas minus the union of obstacles.

use geo::bool_ops::FillRule;
use geo::orient::Direction;
use geo::{BooleanOps, Coord, LineString, MultiPolygon, Orient, Polygon};

use super::error::FloorPlanError;
use super::shape::SAME;
use crate::engine::geometry::{Area, Polygon as Solid, Ring, assemble};
use crate::engine::math::{Vector, bounds};

/// Largest distance between a computed and a given corner, relative to the whole extent: geo computes on a grid of
/// about 2⁻³⁰ of it.
const ROUNDING: f64 = 1.0 / (1 << 28) as f64;

/// Closed outlines. A point is inside if its winding number is positive.
pub type Rings = Vec<Vec<Vector>>;

/// The union of `areas` minus the union of `obstacles`, as areas that touch at points at most.
pub fn without(areas: &[Area], obstacles: &[Area]) -> Result<Vec<Area>, FloorPlanError> {
    free(&[rings(areas)], &rings(obstacles))
}

/// The intersection of all `floors` minus the union of the `bodies`, as areas that touch at points at most. Corners
/// near a given point are that point, to the last bit.
///
/// # Errors
/// Rings that cross each other in the result; no input is known that causes this.
pub fn free(floors: &[Rings], bodies: &Rings) -> Result<Vec<Area>, FloorPlanError> {
    let Some((first, others)) = floors.split_first() else {
        return Ok(Vec::new());
    };
    let mut free = to_geo(first).difference_with_fill_rule(&to_geo(bodies), FillRule::Positive);
    for floor in others {
        let so_far = to_geo(&oriented(&free));
        free = so_far.intersection_with_fill_rule(&to_geo(floor), FillRule::Positive);
    }
    let given = || floors.iter().chain([bodies]).flatten().flatten().copied();
    let [low, high] = bounds(given()).unwrap_or_default();
    let tolerance = SAME.max((high - low).max() * ROUNDING);
    assemble(&oriented(&free), given(), tolerance).map_err(|(error, ring)| {
        let distance = |p: &Vector| (p - ring[0]).norm();
        let nearest = given().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let place = nearest.map_or(String::new(), |p| format!("near ({}, {})", p.x, p.y));
        let reason = error.to_string();
        FloorPlanError::Geometry { place, reason }
    })
}

/// The rings of `areas`: outlines counterclockwise, holes clockwise.
fn rings(areas: &[Area]) -> Rings {
    let reversed = |hole: &Ring| hole.points().iter().rev().copied().collect();
    let rings = areas.iter().flat_map(|area| {
        let holes = area.holes.iter().map(reversed);
        std::iter::once(area.exterior.points().to_vec()).chain(holes)
    });
    rings.collect()
}

/// The floors that unbounded obstacles enclose, and the rings of the bounded obstacles.
pub fn outlines(obstacles: &[Solid]) -> (Vec<Rings>, Rings) {
    let (unbounded, bounded): (Vec<&Solid>, Vec<&Solid>) = obstacles
        .iter()
        .partition(|obstacle| obstacle.is_unbounded());
    let reversed = |ring: &[Vector]| ring.iter().rev().copied().collect();
    let floors = unbounded
        .iter()
        .map(|floor| floor.rings().map(reversed).collect());
    let bodies = bounded.iter().flat_map(|obstacle| obstacle.rings());
    (floors.collect(), bodies.map(<[Vector]>::to_vec).collect())
}

fn to_geo(rings: &Rings) -> MultiPolygon {
    let line =
        |ring: &Vec<Vector>| LineString::from_iter(ring.iter().map(|p| Coord { x: p.x, y: p.y }));
    let polygons = rings
        .iter()
        .map(|ring| Polygon::new(line(ring), Vec::new()));
    polygons.collect()
}

/// The rings of geo's result: outlines counterclockwise, holes clockwise. geo itself gives holes that touch their
/// outline the outline's orientation.
fn oriented(area: &MultiPolygon) -> Rings {
    let ring = |line: &LineString| {
        let open = &line.0[..line.0.len().saturating_sub(1)];
        open.iter().map(|c| Vector::new(c.x, c.y)).collect()
    };
    let oriented = area.orient(Direction::Default);
    let rings = oriented.iter().flat_map(|polygon| {
        let holes = polygon.interiors().iter();
        std::iter::once(polygon.exterior()).chain(holes).map(ring)
    });
    rings.collect()
}
