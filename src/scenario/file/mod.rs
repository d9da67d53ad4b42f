//! A scenario file as a whole. From its struct and the [`keys`](super::keys) come the JSON Schema, the range checks,
//! the keys of `--set` and their descriptions in `sandbox list --settings`: each key is described once. The keys of
//! measurements are in [`measurements`](super::measurements).

mod brackets;
mod keyed;
pub mod listed;
pub mod meant;
pub mod range;
pub mod schema;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::floor_plan::Reading;
use crate::keys::catalog::Parameters;
use crate::keys::curve::Curve;
use crate::keys::from::FromData;
use crate::keys::goals::{Aim, WayFinding};
use crate::keys::interventions::Intervention;
use crate::keys::levels::{Join, Level, levels};
use crate::keys::limits::{DEFAULT_DURATION, DEFAULT_PROFILE, LONGEST_TIME, STRONGEST};
use crate::keys::names::{optional_word, word};
use crate::keys::numerics::{IntegratorChoice, TimeStep};
use crate::keys::people::{Agent, Crowd, Entrance, Grid};
use crate::keys::periodic::Periodic;
use crate::keys::places::{Door, Exit, Journey, Lift, Queue, WaitingArea, Waypoint, Zone};
use crate::keys::preset::Preset;
use crate::keys::profiles::ProfileChoice;
use crate::keys::shapes::{Corners, Label, Outline, Point, Ring, obstacles, walkable_area};
use crate::measurements::Measurement;
use engine::boundary::WallMethod;
use engine::clock::PAPER_TIME_STEP;
use engine::neighbors::ListPolicy;
use engine::pairs::Precision;
use engine::scene::{Knowledge, RouteChoice, Scene};

/// A scenario for `sandbox run`.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(title = "sandbox scenario")]
pub struct File {
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
    /// `accurate` (close to the model's limit for small steps); see docs/guide/estimate.md.
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
    /// How much agents hurry, from 0 (calm) to 1 (told to hurry), unless their own key says otherwise: with the walking
    /// law `headings` they then keep shorter gaps. Evacuations: 1.
    #[serde(default)]
    #[schemars(range(min = 0, max = 1))]
    pub motivation: f64,
    /// How agents find their routes: `paths` around walls, or `straight` toward the goal, as in the paper, where agents
    /// stop at walls. Without walls between, both are the same to the last bit.
    #[schemars(schema_with = "word::<WayFinding>")]
    pub navigation: WayFinding,
    /// By what agents choose routes around walls: `shortest`, or `quickest`, the least expected time, with the people
    /// who wait before doors, in aisles and in other openings of up to 6 m.
    #[schemars(schema_with = "optional_word::<RouteChoice>", extend("default" = RouteChoice::default()))]
    pub route_choice: Option<RouteChoice>,
    /// What agents know about waiting times, for `quickest`: those of the whole `floor`, or those in `sight`, before
    /// the openings of the room where they are.
    #[schemars(schema_with = "word::<Knowledge>")]
    pub knowledge: Knowledge,
    /// Narrower passages are closed for `paths`, meters. Lower: agents also take gaps in which they get stuck. Default:
    /// the width of the widest body; 10 % more with RVO, 20 % less with profiles that turn shoulders (`steer+sph`).
    #[schemars(range(min = 0, max = 100))]
    pub min_passage_width: Option<f64>,
    /// The behavior of agents that name no profile of their own.
    #[schemars(extend("default" = DEFAULT_PROFILE))]
    pub profile: Option<ProfileChoice>,
    /// Parameters of all profiles; they override those given in a profile.
    pub parameters: Parameters,
    /// Where agents can walk, corners in meters: a list of polygons, each a list of rings (the outline, then the
    /// holes), or the name of a DXF, GeoJSON, WKT or JuPedSim XML file. Everything around it is solid. Default:
    /// everywhere.
    #[schemars(schema_with = "walkable_area")]
    pub walkable_area: Option<Vec<Vec<Ring>>>,
    /// How the files of `walkable_area`, `obstacles` and `levels` are read: what they do not say themselves.
    pub plan: Option<Reading>,
    /// Solid bodies, corners in meters, in either orientation: a list of polygons, each a list of corners or of rings
    /// (the outline, then the holes), or the name of a DXF, GeoJSON, WKT or JuPedSim XML file. Corners that enclose
    /// no area, such as two points, are a wall of 1 cm.
    #[schemars(schema_with = "obstacles")]
    pub obstacles: Vec<Outline>,
    /// The levels of a building, instead of `walkable_area` and `obstacles`. Places, people, labels and measurements
    /// then have a `level`. A list, or the name of a file that has all of them and their joins: GeoJSON in the words of
    /// IMDF, also a folder or a zip archive of it, or JuPedSim XML.
    #[schemars(schema_with = "levels")]
    pub levels: Vec<Level>,
    /// The edges at which people walk from one level to another, besides those of a file under `levels`.
    pub joins: Vec<Join>,
    /// Lifts between levels.
    pub lifts: Vec<Lift>,
    /// The scene repeats itself without end.
    pub periodic: Option<Periodic>,
    /// The goal of agents that have none of their own. Default in a periodic scene: along the axis.
    pub goal: Option<Aim>,
    /// Lines at which people leave. People without goal and journey walk to the nearest one.
    pub exits: Vec<Exit>,
    /// Doors between rooms that people pass in one direction only, or that close for some time.
    pub doors: Vec<Door>,
    /// Lines and disks on people's routes.
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
    /// Changes at given times: exits and doors open and close, waiting areas are released, and pushes, in which agents
    /// that are in a region at one moment behave differently for a while.
    pub events: Vec<Event>,
    /// Changes at given frames: people enter, are removed, or get other goals, journeys and speeds; pushes, doors,
    /// limits, rates and zones. A simulation that is controlled from outside records what was done to it here.
    pub interventions: Vec<Intervention>,
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

/// A change at a given time: an exit opens or closes, a waiting area is released, or agents in a region behave
/// differently for a while.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Event {
    /// The name in reports. Default: its place in the file.
    #[schemars(length(min = 1))]
    pub name: Option<String>,
    /// The time at which it begins, seconds; it acts from the next coarse frame.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub at_secs: f64,
    /// The name of an exit or door that opens.
    pub open: Option<String>,
    /// The name of an exit or door that closes.
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
    /// Of a push: a force on these agents from outside, over their mass: seconds since `at_secs` and m/s², in straight
    /// lines; or the name of a text file with two such columns, relative to this file's folder. Default: none.
    pub acceleration: Option<Curve>,
    /// The direction of `acceleration`. Default: along x.
    pub direction: Option<Point>,
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
pub struct View {
    /// The visible part of the plane. Default: the whole scene.
    pub region: Option<Corners>,
    /// The time at which a recording opens, seconds. Default: the moment of the highest density.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    pub opens_at_secs: Option<f64>,
    /// The densities with the first and the last color, P/m². Default: 0 and 1.2 rest_density_max, at most 10, rounded
    /// up.
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
