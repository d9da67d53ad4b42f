//! The keys of a scenario file. From these structs come the JSON Schema, the range checks, the keys of `--set` and
//! their descriptions in `sandbox list --settings`: each key is described once, here. The keys of profiles are in
//! [`profiles`](super::profiles) and [`catalog`](super::catalog), the keys of measurements in
//! [`measurements`](super::measurements).

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::{Value, json};

use super::crowds::Crowd;
use super::distribution::{self, Draw};
use super::entrances::Entrance;
use super::from::FromData;
use super::goals::Aim;
use super::measurements::Measurement;
use super::numerics::{IntegratorChoice, TimeStep};
use super::periodic::Periodic;
use super::places::{Exit, Journey, Queue, WaitingArea, Waypoint, Zone};
use super::preset::Preset;
use super::profiles::ProfileChoice;
use super::schema::word;
use super::shapes::{Corners, Label, Outline, Point, Ring};
use super::ways::WayFinding;
use crate::engine::boundary::WallMethod;
use crate::engine::clock::PAPER_TIME_STEP;
use crate::engine::neighbors::ListPolicy;
use crate::engine::pairs::Precision;
use crate::engine::scene::Scene;
use crate::scenario::catalog::{HIGHEST_DENSITY, Parameters, STRONGEST};

/// Default duration, seconds.
pub(super) const DEFAULT_DURATION: f64 = 60.0;
/// Default profile.
pub(super) const DEFAULT_PROFILE: &str = "sph";
/// The longest time, seconds.
pub(super) const LONGEST_TIME: f64 = 1e7;
/// The largest coordinate, meters. Beyond this, walls and contacts lose precision.
pub(super) const FARTHEST: f64 = 1e6;

/// A scenario for `sandbox run`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(title = "sandbox scenario")]
pub(super) struct File {
    /// The name in reports. Default: the file's name.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// What the scenario shows, in one line.
    pub description: Option<String>,
    /// The seed of all random numbers: the one key that sets both seeds below. The same seed gives the same run, bit
    /// by bit.
    #[schemars(extend("default" = Scene::default().seed))]
    pub seed: Option<u64>,
    /// The seed of the agents' radii and of the jitter of their start positions. Default: `seed`.
    pub population_seed: Option<u64>,
    /// The seed of RVO's candidate velocities. Default: `seed`.
    pub behavior_seed: Option<u64>,
    /// The simulated time, seconds. `stop` can end a run earlier.
    #[schemars(range(min = 0, max = LONGEST_TIME), extend("default" = DEFAULT_DURATION))]
    pub duration_secs: Option<f64>,
    /// Numerical settings for the keys that are not given: `paper` (as published), `fast` (cheaper, larger steps) or
    /// `accurate` (close to the model's limit for small steps); see docs/accuracy.md.
    #[serde(rename = "preset")]
    pub _preset: Preset, // `preset::fill` has expanded it
    /// Δt_fine, seconds: the length of a frame. `auto` is the longest step that is safely stable, at most
    /// `longest_step_secs` and, unless `coarse_every` is given, a whole fraction of 0.1 s. Shorter steps are more
    /// accurate and cost more. Beyond the stable step (0.028 s for the profiles without SPH) agents shake.
    #[schemars(extend("default" = PAPER_TIME_STEP))]
    pub time_step_secs: Option<TimeStep>,
    /// The upper limit on the step that `time_step_secs=auto` chooses, seconds. No effect on other steps. `auto` is the
    /// longest step at which Table 1 stays within the noise of its seeds: 0.025 s, or 0.02 s where agents avoid each
    /// other in dense crowds. Where agents stay it is 0.05 s. With 0.1 the step is the longest stable one, and flows
    /// may be off by half.
    #[schemars(extend("default" = "auto"))]
    pub longest_step_secs: Option<TimeStep>,
    /// Δt_coarse, frames: how often RVO chooses velocities, sources let agents enter and events begin. It is part of
    /// RVO's model: if agents choose in every frame, they stand 6 % less densely. Default: the number nearest to
    /// 0.1 s.
    #[schemars(range(min = 1, max = 1e6))]
    pub coarse_every: Option<u32>,
    /// The method of time integration. `semi-implicit` reproduces the paper's results; `velocity-verlet` is more
    /// accurate where agents press or stand, at the same cost; `midpoint` costs twice as much and gains nothing over
    /// it; `forward-euler`, which the paper names, is off by 18 % in flow. `auto` is `velocity-verlet` in scenes where
    /// agents stay (none avoids others, has a walking law or leaves) and `semi-implicit` in all others.
    #[schemars(schema_with = "word::<IntegratorChoice>")]
    pub integrator: IntegratorChoice,
    /// How walls enter SPH: `representative` (one point per wall, as in the paper), `exact` (integrals over what each
    /// wall hides) or `union` (the same, overlaps counted once). Exact walls raise the flow through a door by 6 %.
    #[schemars(schema_with = "word::<WallMethod>")]
    pub wall_method: WallMethod,
    /// The number format of sums over pairs. `mixed` is faster, with relative errors of at most 1e-5.
    #[schemars(schema_with = "word::<Precision>")]
    pub precision: Precision,
    /// `complete` lists never miss a neighbor; `coarse` ones are rebuilt every Δt_coarse without a margin, as in the
    /// paper, and miss a few.
    #[schemars(schema_with = "word::<ListPolicy>")]
    pub neighbor_lists: ListPolicy,
    /// s_pref (§5.6), m/s: the speed at which agents want to walk. Higher: they walk faster and push harder; above
    /// `max_speed`, they only push harder.
    #[schemars(range(min = 0, max = 100), extend("default" = Scene::default().preferred_speed))]
    pub preferred_speed: Option<f64>,
    /// s_max (§5.6), m/s: the upper limit on speeds. Results report how often a speed was clamped to it.
    #[schemars(range(max = 100), extend("exclusiveMinimum" = 0, "default" = Scene::default().max_speed))]
    pub max_speed: Option<f64>,
    /// How agents find their ways: `paths` around walls, or `straight` toward the goal, as in the paper, where agents
    /// stop at walls. Without walls between, both are the same to the last bit.
    #[schemars(schema_with = "word::<WayFinding>")]
    pub navigation: WayFinding,
    /// Narrower passages are closed for `paths`, meters. Lower: agents also take gaps in which they get stuck. Default:
    /// the width of the widest body; 10 % more with RVO, 20 % less with `walk+sph`, which turns shoulders.
    #[schemars(range(min = 0, max = 100))]
    pub min_passage_width: Option<f64>,
    /// The behavior of agents that name no profile of their own.
    #[schemars(extend("default" = DEFAULT_PROFILE))]
    pub profile: Option<ProfileChoice>,
    /// Parameters of all profiles; they override those given in a profile.
    pub parameters: Parameters,
    /// Where agents can walk, corners in meters: a list of polygons, each a list of rings (the outline, then the
    /// holes), or the name of a WKT, GeoJSON or JuPedSim XML file. Everything around it is solid. Default: everywhere.
    #[schemars(schema_with = "walkable_area")]
    pub walkable_area: Option<Vec<Vec<Ring>>>,
    /// Solid bodies, corners in meters, in either orientation: a list of polygons, each a list of corners or of rings
    /// (the outline, then the holes), or the name of a WKT, GeoJSON or JuPedSim XML file.
    #[schemars(schema_with = "obstacles")]
    pub obstacles: Vec<Outline>,
    /// The scene repeats itself without end.
    pub periodic: Option<Periodic>,
    /// The goal of agents that have none of their own. Default in a periodic scene: along the axis.
    pub goal: Option<Aim>,
    /// Lines at which people leave. People without goal and journey walk to the nearest one.
    pub exits: Vec<Exit>,
    /// Lines and disks on people's ways.
    pub waypoints: Vec<Waypoint>,
    /// Areas in which people wait.
    pub waiting_areas: Vec<WaitingArea>,
    /// Queues.
    pub queues: Vec<Queue>,
    /// What people do one after the other.
    pub journeys: Vec<Journey>,
    /// Areas in which people walk slower or faster, such as stairs.
    pub zones: Vec<Zone>,
    /// The people of a trajectory file at one time, and those who appear in it later.
    pub from: Option<FromData>,
    /// Single agents.
    pub agents: Vec<Agent>,
    /// Agents that stand on grids at the start.
    #[schemars(schema_with = "grids")]
    pub grids: Vec<Grid>,
    /// Agents that stand anywhere in an area at the start.
    pub crowds: Vec<Crowd>,
    /// Agents that enter on grids repeatedly.
    #[schemars(schema_with = "sources")]
    pub sources: Vec<Grid>,
    /// Lines through which agents come in, each where there is room.
    pub entrances: Vec<Entrance>,
    /// Changes at given times: exits open and close, waiting areas are released, and pushes, in which agents that are
    /// in a region at one moment behave differently for a while.
    pub events: Vec<Event>,
    /// Values to report.
    pub measurements: Vec<Measurement>,
    /// Conditions for stopping early.
    pub stop: Stop,
    /// What pictures and recordings show.
    pub view: Option<View>,
    /// Texts in pictures and recordings. The names in floor plan files are added.
    pub labels: Vec<Label>,
    /// Ids of the agents whose forces a recording shows. Default: a dozen, spread over all agents.
    pub debug_agents: Option<Vec<u32>>,
}

/// A single agent.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Agent {
    /// The start position.
    pub position: Point,
    /// The initial velocity, m/s, at most `max_speed`. Default: at rest.
    #[schemars(inner(range(min = -100, max = 100)))]
    pub velocity: Option<[f64; 2]>,
    /// D_i, meters. Default: random, from 0.215 to 0.265 (§5.6).
    #[schemars(range(min = 0.01, max = 10))]
    pub radius: Option<f64>,
    /// m_i, 1 for an average person. Lighter agents need shorter time steps. Default: (D_i / 0.24)².
    #[schemars(range(min = 1e-6, max = 1e6))]
    pub mass: Option<f64>,
    /// s_pref, m/s. Default: the scenario's `preferred_speed`.
    #[schemars(range(min = 0, max = 100))]
    pub preferred_speed: Option<f64>,
    /// The time until the agent walks, seconds. Default: 0.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub premovement_secs: Option<f64>,
    /// The goal. Default: the scenario's goal.
    pub goal: Option<Aim>,
    /// Instead of `goal`: the name of the journey.
    pub journey: Option<String>,
    /// ρ̂ (Eq. 8) of the previous frame, P/m². Default: the density from agents alone in its first frame.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
    pub mean_density: Option<f64>,
    /// The behavior. Default: the scenario's profile.
    pub profile: Option<ProfileChoice>,
    /// The agent leaves within this distance of its goal, meters. Default: it stays.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0))]
    pub remove_within: Option<f64>,
    /// Whether its arrival counts as evacuated.
    #[schemars(extend("default" = true))]
    pub counted: Option<bool>,
}

/// Agents on a grid, one at the center of each cell.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Grid {
    /// The name in reports. Default: its place in the file.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// The lower left corner.
    pub min: Point,
    /// The upper right corner.
    pub max: Point,
    /// The number of cells along x.
    #[schemars(range(min = 1))]
    pub columns: u32,
    /// The number of cells along y.
    #[schemars(range(min = 1))]
    pub rows: u32,
    /// Each coordinate is shifted at random by up to ± this, meters.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1e6))]
    pub jitter: f64,
    /// The goal. Default: the scenario's goal.
    pub goal: Option<Aim>,
    /// Instead of `goal`: the goal relative to each agent's start.
    pub goal_offset: Option<Point>,
    /// Instead of `goal`: the name of the journey.
    pub journey: Option<String>,
    /// The behavior. Default: the scenario's profile.
    pub profile: Option<ProfileChoice>,
    /// Agents leave within this distance of their goal, meters. Default: they stay.
    #[schemars(range(max = 1e6), extend("exclusiveMinimum" = 0))]
    pub remove_within: Option<f64>,
    /// Whether arrivals count as evacuated.
    #[schemars(extend("default" = true))]
    pub counted: Option<bool>,
    /// s_pref, m/s: a number, or a distribution to draw from for each agent. Default: the scenario's `preferred_speed`.
    #[serde(default)]
    #[schemars(schema_with = "distribution::speed")]
    pub preferred_speed: Option<Draw>,
    /// D_i, meters: a number, or a distribution. Default: uniform from 0.215 to 0.265 (§5.6).
    #[serde(default)]
    #[schemars(schema_with = "distribution::radius")]
    pub radius: Option<Draw>,
    /// m_i, 1 for an average person: a number, or a distribution. Lighter agents need shorter time steps. Default:
    /// (D_i / 0.24)².
    #[serde(default)]
    #[schemars(schema_with = "distribution::mass")]
    pub mass: Option<Draw>,
    /// The time from its entry until an agent walks, seconds: a number, or a distribution. Default: 0.
    #[serde(default)]
    #[schemars(schema_with = "distribution::wait")]
    pub premovement_secs: Option<Draw>,
    /// The time of the first entry, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME), extend("default" = 0))]
    pub start_secs: Option<f64>,
    /// The time between entries, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    pub every_secs: Option<f64>,
    /// The number of entries. Default: unlimited.
    pub times: Option<u32>,
}

impl Grid {
    /// The time of the first entry and the time between entries, seconds; agents of `grids` enter once.
    pub(super) fn schedule(&self) -> [f64; 2] {
        let start = self.start_secs.unwrap_or(0.0);
        [start, self.every_secs.unwrap_or(f64::INFINITY)]
    }
}

/// A change at a given time: an exit opens or closes, a waiting area is released, or agents in a region behave
/// differently for a while.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Event {
    /// The name in reports. Default: its place in the file.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// The time at which it begins, seconds; it acts from the next coarse frame.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub at_secs: f64,
    /// The name of an exit that opens.
    pub open: Option<String>,
    /// The name of an exit that closes.
    pub close: Option<String>,
    /// The name of a waiting area: from then on, agents do not wait there.
    pub release: Option<String>,
    /// Of a push: the duration, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub for_secs: Option<f64>,
    /// Of a push: agents that are here when it begins take part.
    pub region: Option<Corners>,
    /// K^goal (Eq. 17) of these agents. Default: unchanged.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub goal_scale: Option<f64>,
    /// Whether they feel no contact forces.
    #[serde(default)]
    pub ignore_contact: bool,
    /// Whether they feel no SPH forces.
    #[serde(default)]
    pub ignore_sph: bool,
}

/// Conditions for stopping early.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Stop {
    /// Stop when no agents are left and none will enter.
    pub when_empty: bool,
    /// Stop this long after the last counted arrival, or after the start, seconds. Default: never.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    pub idle_secs: Option<f64>,
}

/// What pictures and recordings show.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct View {
    /// The visible part of the plane. Default: the whole scene.
    pub region: Option<Corners>,
    /// The time at which a recording opens, seconds. Default: the moment of the highest density.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub opens_at_secs: Option<f64>,
    /// The densities with the first and the last color, P/m². Default: 0 and 1.2 rest_density_max, at most 10, rounded up.
    #[schemars(inner(range(min = 0, max = 1e6)))]
    pub density_range: Option<[f64; 2]>,
    /// The speeds with the first and the last color, m/s. Default: 0 and the 99th percentile of the preferred speeds,
    /// rounded up.
    #[schemars(inner(range(min = 0, max = 1e6)))]
    pub speed_range: Option<[f64; 2]>,
}

/// Grids whose agents enter once.
fn grids(generator: &mut SchemaGenerator) -> Schema {
    let mut grid = Grid::json_schema(generator);
    if let Some(keys) = grid.get_mut("properties") {
        for key in ["start_secs", "every_secs", "times"] {
            keys[key] = json!({"type": "null", "description": "A key of `sources`."});
        }
    }
    json_schema!({"type": "array", "items": grid})
}

/// Grids whose agents enter repeatedly.
fn sources(generator: &mut SchemaGenerator) -> Schema {
    let mut source = Grid::json_schema(generator);
    if let Some(Value::Array(required)) = source.get_mut("required") {
        required.push("every_secs".into());
    }
    json_schema!({"type": "array", "items": source})
}

fn walkable_area(generator: &mut SchemaGenerator) -> Schema {
    let polygon = json_schema!({
        "description": "Rings: the outline, then the holes.",
        "type": "array", "items": generator.subschema_for::<Ring>(), "minItems": 1,
    });
    json_schema!({"anyOf": [floor_plan(), {"type": "array", "items": polygon, "minItems": 1}, {"type": "null"}]})
}

fn obstacles(generator: &mut SchemaGenerator) -> Schema {
    let obstacle = generator.subschema_for::<Outline>();
    json_schema!({"anyOf": [floor_plan(), {"type": "array", "items": obstacle}]})
}

fn floor_plan() -> Value {
    json!({"type": "string", "description": "A WKT, GeoJSON or JuPedSim XML file, relative to this file's folder."})
}
