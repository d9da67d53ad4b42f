//! The keys of buildings: levels and their joins.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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

/// A level of a building: a floor, a landing, a flight of stairs or a ramp. Levels may lie above each other.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Level {
    /// The name, which places and people have as `level`.
    #[schemars(length(min = 1))]
    pub name: String,
    /// `floor` is flat; `stairs` and `ramp` are planes through their joins with flat levels.
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
    /// Instead of `speeds`: the preferred speed along the slope of those who walk up, and of those who walk down, over
    /// that on a floor.
    #[schemars(inner(range(min = 0.01, max = 10)))]
    pub speed_factors: Option<[f64; 2]>,
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
