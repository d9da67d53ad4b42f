//! The union of areas minus the union of obstacles.
//!
//! i_overlay computes the winding numbers on both sides of every edge. Its own rings are not used: where areas touch
//! at several points, it takes some outlines for holes.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::float::overlay::FloatOverlay;
use i_overlay::i_float::int::point::IntPoint;
use i_overlay::vector::edge::{CLIP_LEFT, CLIP_RIGHT, SUBJ_LEFT, SUBJ_RIGHT, VectorEdge};

use super::boundary::{self, Edge, Point};
use super::error::FloorPlanError;
use super::shape::SAME;
use engine::geometry::{Area, Polygon as Solid, Ring, assemble};
use engine::math::{Vector, bounds};

/// Largest distance between a computed and a given corner, relative to the whole extent: i_overlay computes on a grid
/// of about 2⁻³⁰ of it.
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
/// Rings that cross each other in the result, or do not close; no input is known that causes this.
pub fn free(floors: &[Rings], bodies: &Rings) -> Result<Vec<Area>, FloorPlanError> {
    let Some((first, others)) = floors.split_first() else {
        return Ok(Vec::new());
    };
    let given = || floors.iter().chain([bodies]).flatten().flatten().copied();
    let wrong = |at: Vector, reason: String| {
        let distance = |p: &Vector| (p - at).norm();
        let nearest = given().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let place = nearest.map_or(String::new(), |p| format!("near ({}, {})", p.x, p.y));
        FloorPlanError::Geometry { place, reason }
    };
    let unclosed = |at| wrong(at, "the boundary does not close".to_owned());
    let mut free = overlay(first, bodies, |floor, body| floor && !body).map_err(unclosed)?;
    for floor in others {
        free = overlay(&free, floor, |one, other| one && other).map_err(unclosed)?;
    }
    let [low, high] = bounds(given()).unwrap_or_default();
    let tolerance = SAME.max((high - low).max() * ROUNDING);
    assemble(&free, given(), tolerance).map_err(|(error, ring)| wrong(ring[0], error.to_string()))
}

/// The area that two areas share, m².
///
/// # Errors
/// Those of [`free`].
pub fn shared(one: &Area, other: &Area) -> Result<f64, FloorPlanError> {
    let outline = |area: &Area| bounds(area.exterior.points().iter().copied()).unwrap_or_default();
    let [[low, high], [from, to]] = [one, other].map(outline);
    if from.x >= high.x || from.y >= high.y || low.x >= to.x || low.y >= to.y {
        return Ok(0.0);
    }
    let both = free(&[rings([one]), rings([other])], &Rings::new())?;
    Ok(both.iter().map(Area::area).sum())
}

/// The rings of `areas`: outlines counterclockwise, holes clockwise.
pub fn rings<'a>(areas: impl IntoIterator<Item = &'a Area>) -> Rings {
    let reversed = |hole: &Ring| hole.points().iter().rev().copied().collect();
    let rings = areas.into_iter().flat_map(|area| {
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
    let outer = unbounded.iter();
    let floors = outer.map(|floor| floor.rings().map(reversed).collect());
    let bodies = bounded.iter().flat_map(|obstacle| obstacle.rings());
    (floors.collect(), bodies.map(<[Vector]>::to_vec).collect())
}

/// The boundary of the points that are free, with them on the left. A point is free depending on whether it is inside
/// `subject` and inside `clip`.
///
/// # Errors
/// A point of a boundary that does not close.
fn overlay(
    subject: &Rings,
    clip: &Rings,
    is_free: impl Fn(bool, bool) -> bool,
) -> Result<Rings, Vector> {
    let paths = |rings: &Rings| -> Vec<Vec<[f64; 2]>> {
        let path = |ring: &Vec<Vector>| ring.iter().map(|&p| p.into()).collect();
        rings.iter().map(path).collect()
    };
    let mut overlay = FloatOverlay::with_subj_and_clip(&paths(subject), &paths(clip));
    let Some(found) = overlay.build_graph_view(FillRule::Positive) else {
        return Ok(Vec::new());
    };
    let directed = |VectorEdge { a, b, fill }: VectorEdge| {
        let inside = |side: u8| fill & side != 0;
        let left = is_free(inside(SUBJ_LEFT), inside(CLIP_LEFT));
        let right = is_free(inside(SUBJ_RIGHT), inside(CLIP_RIGHT));
        let [a, b] = [a, b].map(|p| [p.x, p.y].map(i64::from));
        match (left, right) {
            (true, false) => Some(Edge { from: a, to: b }),
            (false, true) => Some(Edge { from: b, to: a }),
            _ => None,
        }
    };
    let edges = found.graph.extract_separate_vectors().into_iter();
    let place = |[x, y]: Point| {
        let p = IntPoint::new(x as i32, y as i32);
        Vector::from(found.adapter.int_to_float(&p))
    };
    let rings = boundary::rings(edges.filter_map(directed).collect()).map_err(place)?;
    let ring = |points: Vec<Point>| points.into_iter().map(place).collect();
    Ok(rings.into_iter().map(ring).collect())
}
