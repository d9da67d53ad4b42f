//! The keys of buildings: levels and their joins.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use crate::floor_plan::Reading;
use crate::keys::names::{optional_word, word};
use crate::keys::shapes::{Outline, Point, Ring, floor_area, obstacles};

/// The lists whose elements lie on a level.
pub const ON_LEVELS: [&str; 14] = [
    "exits",
    "doors",
    "waypoints",
    "waiting_areas",
    "queues",
    "zones",
    "agents",
    "grids",
    "crowds",
    "sources",
    "entrances",
    "events",
    "labels",
    "measurements",
];
/// What a level is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LevelKind {
    /// Flat.
    #[default]
    Floor,
    /// A plane through its joins, on which people walk as on stairs.
    Stairs,
    /// A plane through its joins.
    Ramp,
    /// A plane through its joins that carries people from its lower to its upper end, or down.
    Escalator,
}

impl LevelKind {
    /// Whether people who may not use stairs cannot walk on it.
    pub fn has_steps(self) -> bool {
        matches!(self, Self::Stairs | Self::Escalator)
    }
}

/// How fast people walk up and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Speeds {
    /// Along the slope as fast as on a floor.
    Same,
    /// Seen from above, 0.610 m/s up and 0.694 m/s down for those who want 1.34 m/s (Weidmann 1993).
    Weidmann,
}

/// The direction of an escalator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Runs {
    /// From its lower to its upper end.
    Up,
    /// From its upper to its lower end.
    Down,
}

/// A level of a building: a floor, a landing, a flight of stairs or a ramp. Levels may lie above each other.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// The name, which places and people have as `level`.
    #[schemars(length(min = 1))]
    pub name: String,
    /// `floor` is flat; `stairs`, `ramp` and `escalator` are planes through their joins with flat levels.
    #[serde(default)]
    #[schemars(schema_with = "word::<LevelKind>")]
    pub kind: LevelKind,
    /// The height of a floor, meters. Stairs and ramps have those of the floors that they join.
    #[schemars(range(min = -10000, max = 10000))]
    pub elevation: Option<f64>,
    /// Where agents can walk, corners in the building's meters: a list of polygons, each a list of rings (the outline,
    /// then the holes), or the name of a floor plan file with this level.
    #[schemars(schema_with = "floor_area")]
    pub walkable_area: Vec<Vec<Ring>>,
    /// How the files of this level are read, in place of the same keys in the scenario's `plan`.
    #[serde(rename = "plan")]
    pub _plan: Option<Reading>, // `plan_levels::take` has read it
    /// Solid bodies on it, as in the scenario's `obstacles`.
    #[serde(default)]
    #[schemars(schema_with = "obstacles")]
    pub obstacles: Vec<Outline>,
    /// Of stairs and ramps: `weidmann`, 0.610 m/s up and 0.694 m/s down, seen from above, for those who want 1.34 m/s
    /// (Weidmann 1993), or `same`, along the slope as fast as on a floor. Default: `weidmann` for stairs, `same` for
    /// ramps.
    #[serde(default)]
    #[schemars(schema_with = "optional_word::<Speeds>")]
    pub speeds: Option<Speeds>,
    /// Of escalators, required: `up` or `down`.
    #[serde(default)]
    #[schemars(schema_with = "optional_word::<Runs>")]
    pub runs: Option<Runs>,
    /// Of escalators: the speed of the steps along the slope, m/s. Default: 0.5. People stand, unless `speed_factors`
    /// says that they walk.
    #[schemars(range(min = 0.05, max = 3))]
    pub belt_speed: Option<f64>,
    /// Instead of `speeds`: the preferred speed along the slope of those who walk up, and of those who walk down, over
    /// that on a floor.
    #[schemars(inner(range(min = 0, max = 10)))]
    pub speed_factors: Option<[f64; 2]>,
}

/// A list of levels, or the file that has them.
pub fn levels(generator: &mut SchemaGenerator) -> Schema {
    let description = "A file with all levels and their joins, relative to this file's folder: GeoJSON in the words of \
                       IMDF, also a folder or a zip archive of it, or JuPedSim XML.";
    let file = json_schema!({"type": "string", "description": description});
    let list = json_schema!({"type": "array", "items": generator.subschema_for::<Level>()});
    json_schema!({"anyOf": [file, list]})
}

/// An edge at which people walk from one level to another.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Join {
    /// The names of the two levels.
    pub levels: [String; 2],
    /// Its ends: an edge of both levels, which opens their walls. They have the same height there, within 5 cm.
    pub line: [Point; 2],
}
