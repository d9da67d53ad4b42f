//! Points and polygons in a file.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::{Value, json};
use serde_untagged::UntaggedEnumVisitor;

use crate::error::Problem;
use crate::floor_plan;
use crate::keys::limits::FARTHEST;
use engine::geometry::Ring as Checked;
use engine::math::Vector;
use engine::scene::Region;

/// A point [x, y] in meters
#[derive(Debug, Clone, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Point(#[schemars(inner(range(min = -FARTHEST, max = FARTHEST)))] pub [f64; 2]);

impl From<Point> for Vector {
    fn from(Point(point): Point) -> Self {
        point.into()
    }
}

/// A ring: its corners in order, in either orientation
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Ring(#[schemars(length(min = 3))] pub Vec<Point>);

impl From<&Checked> for Ring {
    fn from(ring: &Checked) -> Self {
        Self(ring.points().iter().map(|&p| Point(p.into())).collect())
    }
}

/// A polygon: its corners, or its rings
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Outline {
    Ring(Ring),
    Rings(#[schemars(length(min = 1))] Vec<Ring>),
}

/// Not derived: the errors of a derived untagged enum do not say what is expected.
impl<'de> Deserialize<'de> for Outline {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting("a ring [[x, y], …], or a list of rings")
            .seq(|list| {
                let list: Vec<Value> = list.deserialize()?;
                let is_ring = list.first().is_none_or(|first| first[0].is_number());
                let list = Value::from(list);
                let found = match is_ring {
                    true => Ring::deserialize(list).map(Self::Ring),
                    false => Deserialize::deserialize(list).map(Self::Rings),
                };
                found.map_err(Error::custom)
            })
            .deserialize(deserializer)
    }
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
pub struct Label {
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

/// The region of corners that [`region`] has checked.
impl From<Corners> for Region {
    fn from(Corners([min, max]): Corners) -> Self {
        let (min, max) = (min.into(), max.into());
        Self { min, max }
    }
}

/// A region from its lower left and upper right corner, which must be in this order.
pub fn region(key: &str, corners: Corners) -> Result<Region, Problem> {
    let region = Region::from(corners);
    let (min, max) = (region.min, region.max);
    if min.x <= max.x && min.y <= max.y {
        return Ok(region);
    }
    let reason = format!(
        "the lower left corner comes first: ({}, {}) is not below and left of ({}, {})",
        min.x, min.y, max.x, max.y
    );
    Err(Problem::new(key, reason))
}

/// A region with an area.
pub fn wide_region(key: &str, corners: Corners) -> Result<Region, Problem> {
    let found = region(key, corners)?;
    match found.area() {
        0.0 => Err(Problem::new(key, "has no area")),
        _ => Ok(found),
    }
}

/// Polygons to walk on, or the file that has them, or null.
pub fn walkable_area(generator: &mut SchemaGenerator) -> Schema {
    json_schema!({"anyOf": [floor_area(generator), {"type": "null"}]})
}

/// Polygons to walk on, or the file that has them.
pub fn floor_area(generator: &mut SchemaGenerator) -> Schema {
    let polygon = json_schema!({
        "description": "Rings: the outline, then the holes.",
        "type": "array", "items": generator.subschema_for::<Ring>(), "minItems": 1,
    });
    json_schema!({"anyOf": [floor_plan(), {"type": "array", "items": polygon, "minItems": 1}]})
}

/// Solid bodies, or the file that has them.
pub fn obstacles(generator: &mut SchemaGenerator) -> Schema {
    let corners = json_schema!({
        "description": "A ring: its corners in order, in either orientation; two points are a wall.",
        "type": "array", "items": generator.subschema_for::<Point>(), "minItems": 2,
    });
    let rings =
        json_schema!({"type": "array", "items": generator.subschema_for::<Ring>(), "minItems": 1});
    let obstacle = json_schema!({"description": "A polygon: its corners, or its rings", "anyOf": [corners, rings]});
    json_schema!({"anyOf": [floor_plan(), {"type": "array", "items": obstacle}]})
}

fn floor_plan() -> Value {
    let description = "A DXF, GeoJSON, WKT or JuPedSim XML file, relative to this file's folder.";
    json!({"type": "string", "description": description})
}
