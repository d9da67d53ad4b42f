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
    Key::new("name", Kind::Name, "what the scenario is called").default("the file's name"),
    Key::new("description", Kind::Text, "what it shows, in a line"),
    Key::new("seed", SEED, "seed of all random numbers").default("1"),
    Key::new(
        "population_seed",
        SEED,
        "seed of who enters: bodies, and jitter of where they stand",
    )
    .default("seed"),
    Key::new(
        "behaviour_seed",
        SEED,
        "seed of what they do: candidate velocities of RVO",
    )
    .default("seed"),
    Key::new("duration_secs", Kind::Number(range::TIME), "how long to simulate")
        .unit("s")
        .default("60"),
    Key::new(
        "preset",
        Kind::Word(&["paper", "fast", "accurate"]),
        "numerics for what is not given otherwise: those of the paper, or what is cheaper or nearer to the \
         model's own limit (docs/accuracy.md)",
    )
    .default("paper")
    .never_null(),
    Key::new(
        "time_step_secs",
        Kind::Step(range::TIME_STEP),
        "Δt_fine, one frame; auto: the largest at which a crowd is sure to come to rest",
    )
    .unit("s")
    .default("0.02"),
    Key::new(
        "longest_step_secs",
        Kind::Number(range::TIME_STEP),
        "no step that `auto` takes is longer",
    )
    .unit("s")
    .default("0.1"),
    Key::new(
        "coarse_every",
        Kind::Whole(range::COARSE_EVERY),
        "Δt_coarse: RVO, sources and events; a whole number",
    )
    .unit("frames")
    .default("Δt_coarse nearest to 0.1 s"),
    Key::new(
        "integrator",
        Kind::Word(&["semi-implicit", "forward-euler", "velocity-verlet", "midpoint"]),
        "how the state is moved on",
    )
    .default("semi-implicit")
    .never_null(),
    Key::new(
        "wall_method",
        Kind::Word(&["representative", "exact", "union"]),
        "how walls enter SPH",
    )
    .default("representative")
    .never_null(),
    Key::new(
        "precision",
        Kind::Word(&["mixed", "double"]),
        "numbers for sums over pairs; mixed is faster and off by at most 1e-5",
    )
    .default("mixed")
    .never_null(),
    Key::new(
        "neighbor_lists",
        Kind::Word(&["complete", "coarse"]),
        "complete: nobody is missed; coarse: made every Δt_coarse without a margin, as in the paper",
    )
    .default("complete")
    .never_null(),
    Key::new(
        "preferred_speed",
        Kind::Number(range::PREFERRED_SPEED),
        "s_pref, speed at which agents want to walk",
    )
    .unit("m/s")
    .default("1.4"),
    Key::new("max_speed", Kind::Number(range::MAX_SPEED), "s_max, no agent is faster")
        .unit("m/s")
        .default("1.8"),
    Key::new(
        "profile",
        Kind::Defined(
            "profile",
            "a name (see `sandbox list`), or a profile or blend in full",
        ),
        "how agents behave that say nothing else",
    )
    .default("sph"),
    Key::new(
        "parameters",
        Kind::Defined("parameters", "an object of the parameters below"),
        "values that hold for every profile of the scenario",
    )
    .never_null(),
    Key::new(
        "walkable_area",
        Kind::Defined(
            "walkable_area",
            "a list of polygons, each a list of rings (the outline, then holes); or a WKT or GeoJSON file",
        ),
        "where people can walk, everything round it is solid; corners in metres",
    ),
    Key::new(
        "obstacles",
        Kind::Defined(
            "obstacles",
            "a list of polygons, each a list of corners, or of rings (the outline, then holes); or a file",
        ),
        "solid bodies; corners in metres, either orientation",
    )
    .never_null(),
    Key::new("goal", Kind::Point, "where agents go that say nothing else"),
    Key::new("agents", Kind::List("agent", "a list of objects"), "single agents").never_null(),
    Key::new(
        "grids",
        Kind::List("grid", "a list of objects"),
        "agents on grids, there from the start",
    )
    .never_null(),
    Key::new(
        "sources",
        Kind::List("source", "a list of objects"),
        "agents that enter on grids again and again",
    )
    .never_null(),
    Key::new(
        "events",
        Kind::List("event", "a list of objects"),
        "pushes: who stands in a region at one moment behaves differently for a while",
    )
    .never_null(),
    Key::new(
        "measurements",
        Kind::List(
            "measurement",
            "a list of density, flow_of_first, flow_until, evacuated",
        ),
        "what to report",
    )
    .never_null(),
    Key::new(
        "stop",
        Kind::Defined("stop", "an object: when_empty, idle_secs"),
        "when to stop before the end",
    )
    .never_null(),
    Key::new(
        "view",
        Kind::Defined("view", "an object: region, opens_at_secs"),
        "what a recording shows first",
    ),
    Key::new(
        "debug_agents",
        Kind::List("id", "a list of ids"),
        "agents that a recording lays open; without it a dozen",
    ),
];
