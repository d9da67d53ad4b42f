//! Points and polygons in a file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::file::FARTHEST;
use crate::engine::math::Vector;

/// A point [x, y] in meters
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Point(#[schemars(inner(range(min = -FARTHEST, max = FARTHEST)))] pub [f64; 2]);

impl From<Point> for Vector {
    fn from(Point(point): Point) -> Self {
        point.into()
    }
}

/// A ring: its corners in order, in either orientation
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(transparent)]
pub(super) struct Ring(#[schemars(length(min = 3))] pub Vec<Point>);

/// A solid body: its corners, or its rings
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Obstacle {
    Ring(Ring),
    Polygon(#[schemars(length(min = 1))] Vec<Ring>),
}

/// The lower left and the upper right corner
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Corners(pub [Point; 2]);
