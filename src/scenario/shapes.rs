//! Points and polygons in a file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::file::FARTHEST;
use crate::engine::math::Vector;
use crate::scenario::floor_plan;

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

/// A polygon: its corners, or its rings
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Outline {
    Ring(Ring),
    Rings(#[schemars(length(min = 1))] Vec<Ring>),
}

impl Outline {
    /// The outline, then the holes.
    pub fn rings(&self) -> &[Ring] {
        match self {
            Self::Ring(ring) => std::slice::from_ref(ring),
            Self::Rings(rings) => rings,
        }
    }
}

/// The lower left and the upper right corner
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Corners(pub [Point; 2]);

/// A text at a point
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Label {
    /// The text.
    #[schemars(length(min = 1))]
    pub text: String,
    /// Its middle.
    pub at: Point,
    /// The width of its room, meters; a wider text is left out. Default: no limit.
    #[schemars(range(min = 0, max = FARTHEST))]
    pub width: Option<f64>,
}

impl From<&Label> for floor_plan::Label {
    fn from(given: &Label) -> Self {
        Self {
            text: given.text.clone(),
            at: given.at.into(),
            width: given.width,
        }
    }
}
