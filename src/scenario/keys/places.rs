//! The keys of exits, waypoints, waiting areas, queues, journeys and zones.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer};
use serde_untagged::UntaggedEnumVisitor;

use crate::error::quote::shown;
use crate::error::{Problem, suggestion};
use crate::keys::distribution;
use crate::keys::distribution::Draw;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::shapes::{Point, Ring};
use engine::journeys::Journey as Built;

/// A line at which people leave.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Exit {
    /// The name in journeys and reports.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Its ends. On the edge of the walkable area, the line opens the wall.
    pub line: [Point; 2],
    /// Times between which agents cannot pass, seconds: a list of [from, until]. Until 1e7: until an intervention opens
    /// it.
    #[serde(default)]
    #[schemars(inner(inner(range(min = 0, max = LONGEST_TIME))))]
    pub closed_secs: Vec<[f64; 2]>,
    /// The most people that pass per second. Default: unlimited.
    #[schemars(range(max = 1e4), extend("exclusiveMinimum" = 0))]
    pub most_per_sec: Option<f64>,
}

/// A door between rooms: a line from wall to wall.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Door {
    /// The name in events and reports.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Its ends, at walls.
    pub line: [Point; 2],
    /// The direction [x, y] in which people can pass. Default: both.
    #[schemars(inner(range(min = -1e6, max = 1e6)))]
    pub one_way: Option<[f64; 2]>,
    /// Times between which people cannot pass, seconds: a list of [from, until]. Until 1e7: until an intervention opens
    /// it.
    #[serde(default)]
    #[schemars(inner(inner(range(min = 0, max = LONGEST_TIME))))]
    pub closed_secs: Vec<[f64; 2]>,
}

/// A line that people cross, or a disk that they enter, on their way.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// The name in journeys and reports.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The ends of the line.
    pub line: Option<[Point; 2]>,
    /// Instead of `line`: the center of the disk.
    pub at: Option<Point>,
    /// The radius of the disk, meters.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0, "default" = 0.5))]
    pub within: Option<f64>,
}

/// An area in which people wait. They go on at the earliest of the times given here, and when an event releases them.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaitingArea {
    /// The name in journeys and reports.
    #[schemars(length(min = 1))]
    pub name: String,
    /// Where they wait.
    pub area: Ring,
    /// The spots nearest to this point are taken first. Default: people spread evenly.
    pub facing: Option<Point>,
    /// Until when they wait, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub until_secs: Option<f64>,
    /// How long each waits, seconds.
    #[serde(default)]
    #[schemars(schema_with = "distribution::wait")]
    pub for_secs: Option<Draw>,
}

/// A queue.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Queue {
    /// The name in journeys and reports.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The line on which people stand, from the front. A longer queue goes on in the direction of its end.
    #[schemars(length(min = 2))]
    pub path: Vec<Point>,
    /// The distance between people, meters.
    #[schemars(range(min = 0.3, max = 10), extend("default" = 0.5))]
    pub spacing: Option<f64>,
    /// How many people are served at a time.
    #[schemars(range(min = 1), extend("default" = 1))]
    pub servers: Option<u32>,
    /// How long each is served, seconds.
    #[schemars(schema_with = "distribution::wait")]
    pub service_secs: Draw,
}

/// What people do one after the other.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Journey {
    /// The name in reports.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The stages in order: names of places, or choices between places.
    #[schemars(length(min = 1))]
    pub stages: Vec<Stage>,
}

/// A stage of a journey: the name of a place, or a choice between places
#[derive(Debug, Clone, JsonSchema)]
#[schemars(untagged)]
pub enum Stage {
    /// This place.
    Place(String),
    /// One of several.
    Choice(Choice),
}

/// Not derived: the errors of a derived untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for Stage {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting(
                "the name of a place, or a choice: one of {\"nearest\": [names]}, {\"quickest\": [names]}, \
                 {\"fewest\": [names]}, {\"shares\": {name: weight}} or {\"lifts\": [names], \"to\": level}",
            )
            .string(|name| Ok(Self::Place(name.to_owned())))
            .map(|choice| Ok(Self::Choice(choice.deserialize()?)))
            .deserialize(deserializer)
    }
}

/// A choice between places: exactly one of these keys, or `lifts` with `to`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Choice {
    /// The place with the shortest way.
    #[schemars(length(min = 1), inner(length(min = 1)))]
    pub nearest: Option<Vec<String>>,
    /// The place that a person expects to pass first, from the way to it and the crowd before it. People look again
    /// every 2 to 5 s.
    #[schemars(length(min = 1), inner(length(min = 1)))]
    pub quickest: Option<Vec<String>>,
    /// The place that the fewest people have chosen.
    #[schemars(length(min = 1), inner(length(min = 1)))]
    pub fewest: Option<Vec<String>>,
    /// At random, with these weights.
    #[schemars(extend("additionalProperties" = {"type": "number", "minimum": 0, "maximum": 1e9}))]
    pub shares: Option<BTreeMap<String, f64>>,
    /// A ride by the lift with the nearest waiting area, of those with these names, to the level `to`.
    #[schemars(length(min = 1), inner(length(min = 1)))]
    pub lifts: Option<Vec<String>>,
    /// With `lifts`: the name of the level.
    #[schemars(length(min = 1))]
    pub to: Option<String>,
}

/// A lift of a building.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lift {
    /// The name in journeys and reports.
    #[schemars(length(min = 1))]
    pub name: String,
    /// The cabin: an area of the building that is a part of the floor of each level at which the lift stops.
    pub cabin: Ring,
    /// The names of the waiting areas before it, one on each of these levels.
    #[schemars(length(min = 2))]
    pub stops: Vec<String>,
    /// How many people it takes.
    #[schemars(range(min = 1, max = 200))]
    pub capacity: u32,
    /// Its speed, m/s.
    #[serde(default = "usual_speed_of_lifts")]
    #[schemars(range(min = 0.01, max = 30))]
    pub speed: f64,
    /// How long its doors take to open, and to close, seconds.
    #[serde(default = "usual_time_of_doors")]
    #[schemars(range(min = 0, max = 600))]
    pub door_secs: f64,
}

fn usual_speed_of_lifts() -> f64 {
    1.0
}

fn usual_time_of_doors() -> f64 {
    3.0
}

/// An area in which people walk slower or faster, such as stairs, or hurry.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Zone {
    /// The name in reports. Default: its place in the file.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// Where.
    pub area: Ring,
    /// The preferred speed is multiplied by this. Where zones overlap, the least factor holds.
    #[serde(default = "unchanged")]
    #[schemars(range(min = 0.01, max = 10))]
    pub speed_factor: f64,
    /// The least motivation of people here, from 0 to 1. Where zones overlap, the greatest holds.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub motivation: f64,
    /// When the zone begins to act, seconds.
    #[serde(default)]
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub from_secs: f64,
    /// When it ceases to act, seconds. Default: never.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub until_secs: Option<f64>,
}

/// The factor of zones that leave the preferred speed as it is.
fn unchanged() -> f64 {
    1.0
}

/// The number of a journey.
pub fn journey_named(journeys: &[Built], name: &str) -> Result<u16, Problem> {
    let found = journeys.iter().position(|journey| journey.name == name);
    found.map(|k| k as u16).ok_or_else(|| {
        let known = journeys.iter().map(|journey| journey.name.as_str());
        let near = suggestion(name, known);
        let reason = format!("there is no journey named `{}`{near}", shown(name));
        Problem::new("", reason)
    })
}
