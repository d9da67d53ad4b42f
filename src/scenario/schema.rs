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
    "how it behaves; default: the scenario's profile",
);
const REMOVE_WITHIN: Key = Key::new(
    "remove_within",
    Kind::Number(DISTANCE),
    "who is so near to the goal leaves; without it nobody does",
)
.unit("m");
const COUNTED: Key =
    Key::new("counted", Kind::Switch, "do arrivals count as evacuated?").default("true");
const NAME: Key = Key::new("name", Kind::Name, "what it is called in reports");
const GOAL: Key = Key::new(
    "goal",
    Kind::Point,
    "where to go; default: the scenario's goal",
)
.unit("m");

const AGENT: [Key; 9] = [
    Key::new("position", Kind::Point, "where it starts")
        .unit("m")
        .required(),
    Key::new(
        "velocity",
        Kind::Pair(VELOCITY),
        "of the start; default: [0, 0]",
    )
    .unit("m/s"),
    Key::new("radius", Kind::Number(RADIUS), "D_i; default: by the seed").unit("m"),
    Key::new(
        "mass",
        Kind::Number(MASS),
        "m_i, 1 for an average person; default: by the radius",
    ),
    GOAL,
    Key::new(
        "mean_density",
        Kind::Number(DENSITY),
        "ρ̂ of the frame before",
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
        "cells along x, an agent at the centre of each",
    )
    .required(),
    Key::new("rows", Kind::Whole(CELLS), "cells along y").required(),
    Key::new(
        "jitter",
        Kind::Number(JITTER),
        "each coordinate is moved by up to ± this",
    )
    .unit("m")
    .default("0")
    .never_null(),
    GOAL,
    Key::new(
        "goal_offset",
        Kind::Point,
        "in place of a goal: where to go, from each agent's start",
    )
    .unit("m"),
    PROFILE,
    REMOVE_WITHIN,
    COUNTED,
];

/// The keys that a source has in addition to those of a grid.
const AGAIN: [Key; 3] = [
    Key::new("start_secs", Kind::Number(TIME), "first entry")
        .unit("s")
        .default("0")
        .never_null(),
    Key::new("every_secs", Kind::Number(EVERY), "time between entries")
        .unit("s")
        .required(),
    Key::new(
        "times",
        Kind::Unsigned(32),
        "how many entries; without it, no end",
    ),
];

const EVENT: [Key; 7] = [
    NAME,
    Key::new("at_secs", Kind::Number(TIME), "when it begins")
        .unit("s")
        .required(),
    Key::new("for_secs", Kind::Number(TIME), "for how long")
        .unit("s")
        .required(),
    Key::new(
        "region",
        Kind::Defined("region", ""),
        "who stands here then takes part",
    )
    .required(),
    Key::new(
        "goal_scale",
        Kind::Number(GOAL_SCALE),
        "K^goal of those who take part",
    ),
    Key::new("ignore_contact", Kind::Switch, "no contact forces on them")
        .default("false")
        .never_null(),
    Key::new("ignore_sph", Kind::Switch, "no SPH forces on them")
        .default("false")
        .never_null(),
];

const STOP: [Key; 2] = [
    Key::new(
        "when_empty",
        Kind::Switch,
        "when nobody is there and nobody will come",
    )
    .default("false")
    .never_null(),
    Key::new(
        "idle_secs",
        Kind::Number(UNTIL),
        "so long after the last counted arrival, or the start",
    )
    .unit("s"),
];

const VIEW: [Key; 2] = [
    Key::new(
        "region",
        Kind::Defined("region", ""),
        "the part of the plane",
    )
    .required(),
    Key::new("opens_at_secs", Kind::Number(TIME), "the moment")
        .unit("s")
        .default("0")
        .never_null(),
];

const DENSITY_AT: [Key; 2] = [
    Key::new("at_secs", Kind::Number(TIME), "when")
        .unit("s")
        .required(),
    Key::new(
        "region",
        Kind::Defined("region", ""),
        "where; default: everywhere",
    ),
];
const FLOW_OF_FIRST: [Key; 1] =
    [Key::new("arrivals", Kind::Whole(ARRIVALS), "of how many").required()];
const FLOW_UNTIL: [Key; 1] = [Key::new("until_secs", Kind::Number(UNTIL), "until when")
    .unit("s")
    .required()];

/// What a profile may be called.
fn names() -> Vec<&'static str> {
    let aliases = ALIASES.into_iter().map(|(alias, _)| alias);
    NAMES.into_iter().chain(aliases).collect()
}

const FULL_PROFILE: [Key; 6] = [
    Key::new("name", Kind::Name, "what it is called"),
    Key::new(
        "base",
        Kind::Word(&NAMES),
        "a profile of the catalogue to begin with",
    ),
    Key::new(
        "navigation",
        Kind::Word(&["goal", "social", "rvo"]),
        "how agents find their way",
    ),
    Key::new(
        "sph",
        Kind::Switch,
        "with `navigation`: are they a fluid, too?",
    )
    .default("true"),
    Key::new("blend", Kind::List("blend_step", ""), "profiles by density"),
    Key::new(
        "parameters",
        Kind::Defined("parameters", ""),
        "values for it",
    )
    .never_null(),
];

const STEP: [Key; 2] = [
    Key::new(
        "at_density",
        Kind::Number(DENSITY),
        "where it counts alone; between two, both",
    )
    .unit("P/m²")
    .required(),
    Key::new(
        "profile",
        Kind::Defined("profile", ""),
        "a plain profile, no blend",
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
        json!({"type": "string", "description": "where this schema is, for editors"});
    schema["$defs"] = json!({
        "point": pair(COORDINATE),
        "region": {
            "description": "lower left and upper right corner [m]",
            "type": "array", "items": defined("point"), "minItems": 2, "maxItems": 2,
        },
        "ring": {
            "description": "corners in turn, either way round",
            "type": "array", "items": defined("point"), "minItems": 3,
        },
        "polygon": {
            "description": "rings: the outline, then the holes",
            "type": "array", "items": defined("ring"), "minItems": 1,
        },
        "walkable_area": {
            "anyOf": [
                {"type": "string", "description": "a WKT or GeoJSON file, from this one's folder"},
                {"type": "array", "items": defined("polygon"), "minItems": 1},
            ],
        },
        "obstacles": {
            "anyOf": [
                {"type": "string", "description": "a WKT or GeoJSON file, from this one's folder"},
                {"type": "array", "items": {"anyOf": [defined("ring"), defined("polygon")]}},
            ],
        },
        "profile": {"anyOf": [{"enum": names()}, defined("full_profile")]},
        "full_profile": full_profile(),
        "blend_step": object(&STEP, "one profile of a blend"),
        "parameters": object(&parameters::PARAMETERS, "parameters of profiles (§5.5)"),
        "agent": object(&AGENT, "one person"),
        "grid": object(&GRID, "people on a grid, there from the start"),
        "source": object(&source, "people who enter on a grid again and again"),
        "event": object(&EVENT, "a push"),
        "measurement": measurement(),
        "stop": object(&STOP, "when to stop before the end"),
        "view": object(&VIEW, "what a recording shows first"),
        "id": {"type": "integer", "minimum": 0, "maximum": u32::MAX},
    });
    schema
}

/// A profile in full: exactly one of three keys is given.
fn full_profile() -> Value {
    let given =
        |key: &str| json!({"required": [key], "properties": {key: {"not": {"type": "null"}}}});
    let mut schema = object(&FULL_PROFILE, "a profile or blend in full");
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
            "flow of the first who arrive",
        ),
        (
            "flow_until",
            &FLOW_UNTIL,
            "flow of those who arrive in time",
        ),
        ("evacuated", &[], "how many have arrived"),
    ];
    let way = |(key, keys, description): (&str, &[Key], &str)| {
        json!({
            "type": "object",
            "properties": {key: object(keys, description)},
            "required": [key],
            "additionalProperties": false,
        })
    };
    json!({"description": "something to measure", "oneOf": ways.map(way)})
}
