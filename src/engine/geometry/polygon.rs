//! Obstacles: solid bodies with straight sides.

use parry2d::bounding_volume::Aabb;

use super::error::PolygonError;
use super::ring::{Area, Ring, encloses, signed_area};
use super::ring_index::{AreaIndex, RingIndex};
use super::{bounds_of, index_of};
use crate::math::{Vector, sides};

/// Edges of different rings may cross by this many meters, or by this fraction of the whole extent, whichever is
/// larger. In floor plans, corners are computed on a grid and moved by up to a micrometer to a given corner, across the
/// edges that they touch.
const TOUCHING: f64 = 1.5e-6;
const TOUCHING_PART: f64 = 1e-8;

/// An obstacle: a body with straight sides, or everything around the floor that people walk on.
///
/// Its boundary is one or more closed rings. Every edge has the solid on its left.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    points: Vec<Vector>,
    /// The end of each ring in `points`.
    ends: Vec<usize>,
    unbounded: bool,
}

impl Polygon {
    /// A body without holes. Checks `points` (meters, either orientation; the last must not repeat the first).
    ///
    /// # Errors
    /// As [`Ring::new`].
    pub fn new(points: Vec<Vector>) -> Result<Self, PolygonError> {
        Ok(Self::of_rings([Ring::new(points)?.into_points()], false))
    }

    /// A body with holes; people may stand in the holes.
    ///
    /// # Errors
    /// A hole that is not in the outline or lies in another hole, or rings that cross.
    pub fn filling(area: Area) -> Result<Self, PolygonError> {
        check(std::slice::from_ref(&area))?;
        let holes = area.holes.into_iter().map(Ring::into_clockwise);
        let rings = std::iter::once(area.exterior.into_points()).chain(holes);
        Ok(Self::of_rings(rings, false))
    }

    /// Everything outside `areas`, unbounded: the walls around a floor. Areas may touch, and an area may lie in
    /// a hole of another.
    ///
    /// # Errors
    /// No areas, areas that overlap, a hole that is not in its outline or lies in another hole, or rings that
    /// cross.
    pub fn enclosing(areas: Vec<Area>) -> Result<Self, PolygonError> {
        if areas.is_empty() {
            return Err(PolygonError::NoFloor);
        }
        check(&areas)?;
        let rings = areas.into_iter().flat_map(|area| {
            let holes = area.holes.into_iter().map(Ring::into_points);
            std::iter::once(area.exterior.into_clockwise()).chain(holes)
        });
        Ok(Self::of_rings(rings, true))
    }

    fn of_rings(rings: impl IntoIterator<Item = Vec<Vector>>, unbounded: bool) -> Self {
        let (mut points, mut ends) = (Vec::new(), Vec::new());
        for ring in rings {
            points.extend(ring);
            ends.push(points.len());
        }
        Self {
            points,
            ends,
            unbounded,
        }
    }

    /// The same body at another place, meters away.
    #[must_use]
    pub fn moved(mut self, by: Vector) -> Self {
        self.points.iter_mut().for_each(|point| *point += by);
        self
    }

    /// All corners, ring by ring.
    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    /// The corners of each ring, ordered so that the solid is on the left of every edge.
    pub fn rings(&self) -> impl Iterator<Item = &[Vector]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts
            .zip(&self.ends)
            .map(|(start, &end)| &self.points[start..end])
    }

    /// Whether everything outside the rings is solid, without bound.
    pub fn is_unbounded(&self) -> bool {
        self.unbounded
    }

    /// The area of the solid in m²; infinite if unbounded.
    pub fn area(&self) -> f64 {
        if self.unbounded {
            return f64::INFINITY;
        }
        self.rings().map(signed_area).sum()
    }

    /// The edges as (start, end), ring by ring, with the solid on the left.
    pub fn edges(&self) -> impl Iterator<Item = (Vector, Vector)> + '_ {
        self.rings().flat_map(sides)
    }

    /// Whether `p` is in the solid. Within rounding of the boundary either answer is possible.
    pub fn contains(&self, p: Vector) -> bool {
        let inside = self.rings().filter(|ring| encloses(ring, p)).count();
        (inside % 2 == 1) != self.unbounded
    }
}

/// Checks that no rings cross, that holes lie in their outlines and not in each other, and that no areas
/// overlap.
fn check(areas: &[Area]) -> Result<(), PolygonError> {
    let all: Vec<&Ring> = areas.iter().flat_map(Area::rings).collect();
    if all.len() == 1 {
        return Ok(());
    }
    if let Some((a, b)) = first_crossing(&all) {
        return Err(PolygonError::Crossing(a, b));
    }
    // Of two rings that do not cross, each lies entirely inside or entirely outside the other: one point decides.
    for area in areas {
        let holes = RingIndex::new(area.holes.iter().collect());
        let outline = RingIndex::new(vec![&area.exterior]);
        for (h, hole) in area.holes.iter().enumerate() {
            let place = hole.inner_point();
            let in_another = holes.around(place).into_iter().any(|other| other != h);
            if in_another || outline.around(place).is_empty() {
                return Err(PolygonError::StrayHole(hole.points()[0]));
            }
        }
    }
    let index = AreaIndex::new(areas);
    let sizes: Vec<f64> = areas.iter().map(|area| area.exterior.area()).collect();
    for (k, area) in areas.iter().enumerate() {
        // Only areas of at least this size matter here: a smaller area in this outline is checked in its own turn.
        let around = index.around(area.exterior.inner_point());
        if around.into_iter().any(|j| j != k && sizes[j] >= sizes[k]) {
            return Err(PolygonError::Overlap(area.exterior.points()[0]));
        }
    }
    Ok(())
}

/// The first points of two crossing edges of different rings.
fn first_crossing(rings: &[&Ring]) -> Option<(Vector, Vector)> {
    let edges = rings.iter().enumerate();
    let edges = edges.flat_map(|(r, ring)| sides(ring.points()).map(move |(a, b)| (r, a, b)));
    let edges: Vec<(usize, Vector, Vector)> = edges.collect();
    let bounds: Vec<Aabb> = edges.iter().map(|&(_, a, b)| bounds_of([a, b])).collect();
    let index = index_of(bounds.iter().copied());
    let touching = TOUCHING.max(TOUCHING_PART * index.root_aabb().extents().max_element());
    let parts = |line, edge| depth(line, edge) > touching;
    edges.iter().enumerate().find_map(|(i, &(r, a, b))| {
        let later = index.intersect_aabb(&bounds[i]).map(|j| j as usize);
        let mut crossed = later
            .filter(|&j| j > i && edges[j].0 != r)
            .map(|j| (edges[j].1, edges[j].2))
            .filter(|&other| parts((a, b), other) && parts(other, (a, b)));
        crossed.next().map(|(c, _)| (a, c))
    })
}

/// The depth to which the edge from `c` to `d` crosses the line through `a` and `b`: the distance of the nearer end
/// from the line, meters; negative if both ends lie on the same side.
fn depth((a, b): (Vector, Vector), (c, d): (Vector, Vector)) -> f64 {
    let along = (b - a) / (b - a).norm();
    let [c, d] = [c, d].map(|end| along.perp(&(end - a)));
    c.max(d).min(-c.min(d))
}
