//! The top-level keys of a scenario, which `--set` takes, with unit, default, range and meaning.

use super::key::{Key, Kind};
use super::parameters;
use super::range;

/// One line of the list of settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingDoc {
    /// The key, as in `--set key=value` and in the file.
    pub key: &'static str,
    /// The unit of its value; empty if it has none.
    pub unit: &'static str,
    /// The default: the paper's value, if the paper gives one.
    pub default: &'static str,
    /// The allowed values, in words.
    pub range: String,
    /// Its meaning.
    pub description: &'static str,
}

impl From<&Key> for SettingDoc {
    fn from(key: &Key) -> Self {
        Self {
            key: key.key,
            unit: key.unit,
            default: key.default,
            range: key.kind.words(),
            description: key.description,
        }
    }
}

/// Keys whose value is text and never parsed as JSON.
pub(super) const TEXTS: [&str; 2] = ["name", "description"];

/// All keys: those at the top of the file, then the parameters of profiles.
pub fn settings() -> Vec<SettingDoc> {
    let keys = KEYS.iter().chain(&parameters::PARAMETERS);
    keys.map(SettingDoc::from).collect()
}

const SEED: Kind = Kind::Unsigned(64);

/// The keys at the top of a file.
pub(super) const KEYS: [Key; 29] = [
    Key::new("name", Kind::Name, "name of the scenario in reports").default("the file's name"),
    Key::new("description", Kind::Text, "what the scenario shows, in one line"),
    Key::new("seed", SEED, "seed of all random numbers").default("1"),
    Key::new(
        "population_seed",
        SEED,
        "seed of the agents' radii and of the jitter of their start positions",
    )
    .default("seed"),
    Key::new(
        "behaviour_seed",
        SEED,
        "seed of the candidate velocities of RVO",
    )
    .default("seed"),
    Key::new("duration_secs", Kind::Number(range::TIME), "simulated time")
        .unit("s")
        .default("60"),
    Key::new(
        "preset",
        Kind::Word(&["paper", "fast", "accurate"]),
        "defaults of the numerical settings: paper (as published), fast (cheaper) or accurate (closer to the \
         model's limit for small steps); see docs/accuracy.md",
    )
    .default("paper")
    .never_null(),
    Key::new(
        "time_step_secs",
        Kind::Step(range::TIME_STEP),
        "Δt_fine, the length of a frame; auto: the largest step that is safely stable",
    )
    .unit("s")
    .default("0.02"),
    Key::new(
        "longest_step_secs",
        Kind::Number(range::TIME_STEP),
        "upper limit on the step that auto chooses",
    )
    .unit("s")
    .default("0.1"),
    Key::new(
        "coarse_every",
        Kind::Whole(range::COARSE_EVERY),
        "Δt_coarse, the interval at which RVO, sources and events act; a whole number",
    )
    .unit("frames")
    .default("the number nearest to 0.1 s"),
    Key::new(
        "integrator",
        Kind::Word(&["semi-implicit", "forward-euler", "velocity-verlet", "midpoint"]),
        "method of time integration",
    )
    .default("semi-implicit")
    .never_null(),
    Key::new(
        "wall_method",
        Kind::Word(&["representative", "exact", "union"]),
        "how walls enter SPH: at one point per wall as in the paper, by exact integrals for each wall, or by exact \
         integrals in which overlaps count once",
    )
    .default("representative")
    .never_null(),
    Key::new(
        "precision",
        Kind::Word(&["mixed", "double"]),
        "number format of sums over pairs; mixed is faster, with relative errors of at most 1e-5",
    )
    .default("mixed")
    .never_null(),
    Key::new(
        "neighbor_lists",
        Kind::Word(&["complete", "coarse"]),
        "complete: no neighbor is ever missed; coarse: rebuilt every Δt_coarse without a margin, as in the paper",
    )
    .default("complete")
    .never_null(),
    Key::new(
        "preferred_speed",
        Kind::Number(range::PREFERRED_SPEED),
        "s_pref, the speed at which agents want to walk",
    )
    .unit("m/s")
    .default("1.4"),
    Key::new("max_speed", Kind::Number(range::MAX_SPEED), "s_max, the upper limit on speeds")
        .unit("m/s")
        .default("1.8"),
    Key::new(
        "profile",
        Kind::Defined(
            "profile",
            "a name (see `sandbox list`), or a profile or blend defined in full",
        ),
        "behavior of agents that name no profile of their own",
    )
    .default("sph"),
    Key::new(
        "parameters",
        Kind::Defined("parameters", "an object of the parameters below"),
        "parameters of all profiles; they override those given in a profile",
    )
    .never_null(),
    Key::new(
        "walkable_area",
        Kind::Defined(
            "walkable_area",
            "a list of polygons, each a list of rings (the outline, then holes); or a WKT or GeoJSON file",
        ),
        "where agents can walk; everything around it is solid; corners in meters",
    )
    .default("everywhere"),
    Key::new(
        "obstacles",
        Kind::Defined(
            "obstacles",
            "a list of polygons, each a list of corners, or of rings (the outline, then holes); or a file",
        ),
        "solid bodies; corners in meters, in either orientation",
    )
    .never_null(),
    Key::new("goal", Kind::Point, "goal of agents that give none of their own"),
    Key::new("agents", Kind::List("agent", "a list of objects"), "single agents").never_null(),
    Key::new(
        "grids",
        Kind::List("grid", "a list of objects"),
        "agents that stand on grids at the start",
    )
    .never_null(),
    Key::new(
        "sources",
        Kind::List("source", "a list of objects"),
        "agents that enter on grids repeatedly",
    )
    .never_null(),
    Key::new(
        "events",
        Kind::List("event", "a list of objects"),
        "pushes: agents in a region at one moment behave differently for a while",
    )
    .never_null(),
    Key::new(
        "measurements",
        Kind::List(
            "measurement",
            "a list of density, flow_of_first, flow_until, evacuated",
        ),
        "values to report",
    )
    .never_null(),
    Key::new(
        "stop",
        Kind::Defined("stop", "an object: when_empty, idle_secs"),
        "conditions for stopping early",
    )
    .never_null(),
    Key::new(
        "view",
        Kind::Defined("view", "an object: region, opens_at_secs"),
        "initial view of a recording",
    )
    .default("the whole scene"),
    Key::new(
        "debug_agents",
        Kind::List("id", "a list of ids"),
        "agents whose forces a recording shows; a dozen if missing",
    ),
];
