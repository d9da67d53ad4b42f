//! Finds which of many rings or areas contain a point.

use std::cell::OnceCell;

use parry2d::partitioning::Bvh;

use super::ring::{Area, Ring};
use super::{bounds_of, index_of};
use crate::math::{Vector, sides};

/// Rings with more corners than this get an index of their edges.
const FEW: usize = 32;

/// Bounding volume hierarchies over rings, and over the edges of rings with many corners.
pub struct RingIndex<'a> {
    rings: Vec<&'a Ring>,
    bounds: Bvh,
    /// One per ring, built when first needed.
    edges: Vec<OnceCell<Bvh>>,
}

impl<'a> RingIndex<'a> {
    /// Numbers the rings in their order, from 0.
    pub fn new(rings: Vec<&'a Ring>) -> Self {
        let around = |ring: &&Ring| bounds_of(ring.points().iter().copied());
        Self {
            bounds: index_of(rings.iter().map(around)),
            edges: rings.iter().map(|_| OnceCell::new()).collect(),
            rings,
        }
    }

    /// The numbers of the rings that contain `p`, in no particular order. Within rounding of an edge either answer
    /// is possible.
    pub fn around(&self, p: Vector) -> Vec<usize> {
        let here = bounds_of([p]);
        let near = self.bounds.intersect_aabb(&here).map(|k| k as usize);
        near.filter(|&k| self.encloses(k, p)).collect()
    }

    fn encloses(&self, k: usize, p: Vector) -> bool {
        let points = self.rings[k].points();
        let edge = |i: usize| (points[i], points[(i + 1) % points.len()]);
        if points.len() <= FEW {
            return sides(points).filter(|&edge| crosses(edge, p)).count() % 2 == 1;
        }
        let index = self.edges[k].get_or_init(|| {
            let bounds = sides(points).map(|(a, b)| bounds_of([a, b]));
            index_of(bounds)
        });
        let far = Vector::new(index.root_aabb().maxs.x.max(p.x), p.y);
        let ray = bounds_of([p, far]);
        let met = index.intersect_aabb(&ray).map(|i| edge(i as usize));
        met.filter(|&edge| crosses(edge, p)).count() % 2 == 1
    }
}

/// Finds which of several areas contain a point.
pub struct AreaIndex<'a> {
    rings: RingIndex<'a>,
    /// The number of the area to which each ring belongs.
    owner: Vec<usize>,
}

impl<'a> AreaIndex<'a> {
    /// Numbers the areas in their order, from 0.
    pub fn new(areas: &'a [Area]) -> Self {
        let count = |(k, area): (usize, &Area)| std::iter::repeat_n(k, 1 + area.holes.len());
        Self {
            rings: RingIndex::new(areas.iter().flat_map(Area::rings).collect()),
            owner: areas.iter().enumerate().flat_map(count).collect(),
        }
    }

    /// The numbers of the areas that contain `p`, in ascending order. Within rounding of an edge either answer is
    /// possible.
    pub fn around(&self, p: Vector) -> Vec<usize> {
        let rings = self.rings.around(p);
        let mut areas: Vec<usize> = rings.into_iter().map(|ring| self.owner[ring]).collect();
        areas.sort_unstable();
        // A point in an outline and in one of its holes is in two rings of the area, and not in the area.
        let once = areas
            .chunk_by(|a, b| a == b)
            .filter(|rings| rings.len() == 1);
        once.map(|rings| rings[0]).collect()
    }
}

/// Whether the edge crosses the ray from `p` in the direction of positive x.
fn crosses((a, b): (Vector, Vector), p: Vector) -> bool {
    (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y))
}
