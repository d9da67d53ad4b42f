//! The JSON Schema of scenario files, from the same tables as the checks and the list of settings.

use serde_json::{Value, json};

use super::check::{GOAL_SCALE, UNTIL};
use super::crowd::{DISTANCE, EVERY, JITTER, MASS, RADIUS, VELOCITY};
use super::key::{Key, Kind, defined, object, pair};
use super::parameters::{self, DENSITY};
use super::range::{COORDINATE, Range, TIME};
use super::settings;
use crate::scenario::catalog::{ALIASES, NAMES};

/// Columns or rows of a grid.
const CELLS: Range = Range::at_least(1.0, u32::MAX as f64);
/// Numbers of arrivals that define a flow.
const ARRIVALS: Range = Range::at_least(2.0, u32::MAX as f64);

const PROFILE: Key = Key::new(
    "profile",
    Kind::Defined("profile", ""),
    "behavior; default: the scenario's profile",
);
const REMOVE_WITHIN: Key = Key::new(
    "remove_within",
    Kind::Number(DISTANCE),
    "agents leave within this distance of their goal; if missing, they stay",
)
.unit("m");
const COUNTED: Key = Key::new(
    "counted",
    Kind::Switch,
    "whether arrivals count as evacuated",
)
.default("true");
const NAME: Key = Key::new("name", Kind::Name, "name in reports");
const GOAL: Key = Key::new("goal", Kind::Point, "goal; default: the scenario's goal").unit("m");

const AGENT: [Key; 9] = [
    Key::new("position", Kind::Point, "start position")
        .unit("m")
        .required(),
    Key::new(
        "velocity",
        Kind::Pair(VELOCITY),
        "initial velocity; default: [0, 0]",
    )
    .unit("m/s"),
    Key::new("radius", Kind::Number(RADIUS), "D_i; default: random").unit("m"),
    Key::new(
        "mass",
        Kind::Number(MASS),
        "m_i, 1 for an average person; default: from the radius",
    ),
    GOAL,
    Key::new(
        "mean_density",
        Kind::Number(DENSITY),
        "ρ̂ of the previous frame",
    )
    .unit("P/m²"),
    PROFILE,
    REMOVE_WITHIN,
    COUNTED,
];

const GRID: [Key; 11] = [
    NAME,
    Key::new("min", Kind::Point, "lower left corner")
        .unit("m")
        .required(),
    Key::new("max", Kind::Point, "upper right corner")
        .unit("m")
        .required(),
    Key::new(
        "columns",
        Kind::Whole(CELLS),
        "cells along x; one agent at the center of each cell",
    )
    .required(),
    Key::new("rows", Kind::Whole(CELLS), "cells along y").required(),
    Key::new(
        "jitter",
        Kind::Number(JITTER),
        "each coordinate is shifted at random by up to ± this",
    )
    .unit("m")
    .default("0")
    .never_null(),
    GOAL,
    Key::new(
        "goal_offset",
        Kind::Point,
        "instead of a goal: the goal relative to each agent's start",
    )
    .unit("m"),
    PROFILE,
    REMOVE_WITHIN,
    COUNTED,
];

/// The keys that a source has in addition to those of a grid.
const AGAIN: [Key; 3] = [
    Key::new("start_secs", Kind::Number(TIME), "time of the first entry")
        .unit("s")
        .default("0")
        .never_null(),
    Key::new("every_secs", Kind::Number(EVERY), "time between entries")
        .unit("s")
        .required(),
    Key::new(
        "times",
        Kind::Unsigned(32),
        "number of entries; if missing, unlimited",
    ),
];

const EVENT: [Key; 7] = [
    NAME,
    Key::new("at_secs", Kind::Number(TIME), "time at which it begins")
        .unit("s")
        .required(),
    Key::new("for_secs", Kind::Number(TIME), "duration")
        .unit("s")
        .required(),
    Key::new(
        "region",
        Kind::Defined("region", ""),
        "agents in it at that time take part",
    )
    .required(),
    Key::new(
        "goal_scale",
        Kind::Number(GOAL_SCALE),
        "K^goal of these agents; default: unchanged",
    ),
    Key::new(
        "ignore_contact",
        Kind::Switch,
        "they feel no contact forces",
    )
    .default("false")
    .never_null(),
    Key::new("ignore_sph", Kind::Switch, "they feel no SPH forces")
        .default("false")
        .never_null(),
];

const STOP: [Key; 2] = [
    Key::new(
        "when_empty",
        Kind::Switch,
        "stop when no agents are left and none will enter",
    )
    .default("false")
    .never_null(),
    Key::new(
        "idle_secs",
        Kind::Number(UNTIL),
        "stop this long after the last counted arrival, or after the start",
    )
    .unit("s"),
];

const VIEW: [Key; 2] = [
    Key::new(
        "region",
        Kind::Defined("region", ""),
        "the visible part of the plane",
    )
    .required(),
    Key::new(
        "opens_at_secs",
        Kind::Number(TIME),
        "time at which the recording opens",
    )
    .unit("s")
    .default("0")
    .never_null(),
];

const DENSITY_AT: [Key; 2] = [
    Key::new("at_secs", Kind::Number(TIME), "time of the measurement")
        .unit("s")
        .required(),
    Key::new(
        "region",
        Kind::Defined("region", ""),
        "region of the measurement; default: everywhere",
    ),
];
const FLOW_OF_FIRST: [Key; 1] =
    [Key::new("arrivals", Kind::Whole(ARRIVALS), "number of arrivals").required()];
const FLOW_UNTIL: [Key; 1] =
    [
        Key::new("until_secs", Kind::Number(UNTIL), "end of the measurement")
            .unit("s")
            .required(),
    ];

/// What a profile may be called.
fn names() -> Vec<&'static str> {
    let aliases = ALIASES.into_iter().map(|(alias, _)| alias);
    NAMES.into_iter().chain(aliases).collect()
}

const FULL_PROFILE: [Key; 6] = [
    Key::new("name", Kind::Name, "name of the profile"),
    Key::new("base", Kind::Word(&NAMES), "a named profile to start from"),
    Key::new(
        "navigation",
        Kind::Word(&["goal", "social", "rvo"]),
        "method of navigation",
    ),
    Key::new(
        "sph",
        Kind::Switch,
        "with `navigation`: whether SPH forces act, too",
    )
    .default("true"),
    Key::new("blend", Kind::List("blend_step", ""), "profiles by density"),
    Key::new(
        "parameters",
        Kind::Defined("parameters", ""),
        "parameters of the profile",
    )
    .never_null(),
];

const STEP: [Key; 2] = [
    Key::new(
        "at_density",
        Kind::Number(DENSITY),
        "density at which this profile acts alone; between two densities both are blended",
    )
    .unit("P/m²")
    .required(),
    Key::new(
        "profile",
        Kind::Defined("profile", ""),
        "a plain profile, not a blend",
    )
    .required(),
];

/// The JSON Schema (draft 2020-12) of scenario files. Every file that the program accepts is valid. The schema does
/// not check relations between values (order of corners, at least one goal).
pub fn schema() -> Value {
    let source: Vec<Key> = GRID.iter().chain(&AGAIN).copied().collect();
    let mut schema = object(&settings::KEYS, "A scenario for `sandbox run`");
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = "sandbox scenario".into();
    schema["properties"]["$schema"] =
        json!({"type": "string", "description": "location of this schema, for editors"});
    schema["$defs"] = json!({
        "point": pair(COORDINATE),
        "region": {
            "description": "lower left and upper right corner [m]",
            "type": "array", "items": defined("point"), "minItems": 2, "maxItems": 2,
        },
        "ring": {
            "description": "corners in order, in either orientation",
            "type": "array", "items": defined("point"), "minItems": 3,
        },
        "polygon": {
            "description": "rings: the outline, then the holes",
            "type": "array", "items": defined("ring"), "minItems": 1,
        },
        "walkable_area": {
            "anyOf": [
                {"type": "string", "description": "a WKT or GeoJSON file, relative to this file's folder"},
                {"type": "array", "items": defined("polygon"), "minItems": 1},
            ],
        },
        "obstacles": {
            "anyOf": [
                {"type": "string", "description": "a WKT or GeoJSON file, relative to this file's folder"},
                {"type": "array", "items": {"anyOf": [defined("ring"), defined("polygon")]}},
            ],
        },
        "profile": {"anyOf": [{"enum": names()}, defined("full_profile")]},
        "full_profile": full_profile(),
        "blend_step": object(&STEP, "one profile of a blend"),
        "parameters": object(&parameters::PARAMETERS, "parameters of profiles (§5.5)"),
        "agent": object(&AGENT, "a single agent"),
        "grid": object(&GRID, "agents that stand on a grid at the start"),
        "source": object(&source, "agents that enter on a grid repeatedly"),
        "event": object(&EVENT, "a push: agents in a region behave differently for a while"),
        "measurement": measurement(),
        "stop": object(&STOP, "conditions for stopping early"),
        "view": object(&VIEW, "initial view of a recording"),
        "id": {"type": "integer", "minimum": 0, "maximum": u32::MAX},
    });
    schema
}

/// A profile in full: exactly one of three keys is given.
fn full_profile() -> Value {
    let given =
        |key: &str| json!({"required": [key], "properties": {key: {"not": {"type": "null"}}}});
    let mut schema = object(&FULL_PROFILE, "a profile or blend defined in full");
    schema["oneOf"] = ["base", "navigation", "blend"].map(given).to_vec().into();
    schema["properties"]["blend"]["minItems"] = 1.into();
    schema
}

/// An object with exactly one key.
fn measurement() -> Value {
    let ways: [(&str, &[Key], &str); 4] = [
        (
            "density",
            &DENSITY_AT,
            "mean and standard deviation of the density",
        ),
        (
            "flow_of_first",
            &FLOW_OF_FIRST,
            "flow of the first arrivals",
        ),
        (
            "flow_until",
            &FLOW_UNTIL,
            "flow of the arrivals until a given time",
        ),
        ("evacuated", &[], "number of counted arrivals"),
    ];
    let way = |(key, keys, description): (&str, &[Key], &str)| {
        json!({
            "type": "object",
            "properties": {key: object(keys, description)},
            "required": [key],
            "additionalProperties": false,
        })
    };
    json!({"description": "a measurement", "oneOf": ways.map(way)})
}
