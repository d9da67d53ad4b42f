//! Obstacles and geometric queries on them. The only module that names parry2d.
//!
//! An obstacle is a [`Polygon`]: a solid body, possibly with holes, or everything outside the [`Area`]s that
//! people walk in. Each boundary edge is a [`Wall`] with one free side. [`Walls`] holds all walls in parry's
//! bounding volume hierarchy. A [`HiddenRegion`] is the part of an agent's kernel behind one wall (P_k in
//! §4.3), in closed form.

mod assemble;
mod clearance;
mod corners;
mod error;
mod hidden_region;
mod polygon;
mod ring;
mod ring_index;
mod shadows;
mod wall;
mod walls;

pub use assemble::assemble;
pub use clearance::{Clear, LineAmongWalls};
pub use error::PolygonError;
pub use hidden_region::HiddenRegion;
pub use polygon::Polygon;
pub use ring::{Area, Ring};
pub use ring_index::AreaIndex;
pub use shadows::visible_parts;
pub use wall::{NearestPoint, Wall, WallPart};
pub use walls::Walls;

use parry2d::bounding_volume::Aabb;
use parry2d::partitioning::{Bvh, BvhBuildStrategy};

use crate::math::Vector;

/// The bounding box of some points.
fn bounds_of(points: impl IntoIterator<Item = Vector>) -> Aabb {
    Aabb::from_points(points.into_iter().map(to_parry))
}

/// A bounding volume hierarchy over boxes.
fn index_of(bounds: impl IntoIterator<Item = Aabb>) -> Bvh {
    let bounds: Vec<Aabb> = bounds.into_iter().collect();
    Bvh::from_leaves(BvhBuildStrategy::Binned, &bounds)
}

/// Converts a vector to parry's type.
fn to_parry(v: Vector) -> parry2d::math::Vector {
    parry2d::math::Vector::new(v.x, v.y)
}

/// Converts a vector from parry's type.
fn from_parry(v: parry2d::math::Vector) -> Vector {
    Vector::new(v.x, v.y)
}
