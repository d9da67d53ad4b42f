//! Every key that `--set` takes at the top of a scenario: unit, default, range, meaning.

use super::parameters;
use super::range;

/// One line of the list of settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingDoc {
    /// As in `--set key=value` and in the file.
    pub key: &'static str,
    /// The unit of its value; empty where it has none.
    pub unit: &'static str,
    /// The value without it: the paper's, where the paper gives one.
    pub default: &'static str,
    /// Which values are allowed.
    pub range: String,
    /// What it is.
    pub description: &'static str,
}

/// Keys of the file whose value is text, never parsed as JSON.
pub(super) const TEXTS: [&str; 2] = ["name", "description"];

/// Every key: those of the file, then the parameters of profiles.
pub fn settings() -> Vec<SettingDoc> {
    scalars()
        .into_iter()
        .chain(containers())
        .chain(parameters::docs())
        .collect()
}

fn scalars() -> [SettingDoc; 17] {
    let doc = |key, unit, default, range: &dyn ToString, description| SettingDoc {
        key,
        unit,
        default,
        range: range.to_string(),
        description,
    };
    [
        doc(
            "name",
            "",
            "the file's name",
            &"text",
            "what the scenario is called",
        ),
        doc(
            "description",
            "",
            "none",
            &"text",
            "what it shows, in a line",
        ),
        doc(
            "seed",
            "",
            "1",
            &"a whole number from 0 to 2^64 - 1",
            "seed of all random numbers",
        ),
        doc(
            "population_seed",
            "",
            "seed",
            &"a whole number from 0 to 2^64 - 1",
            "seed of who enters: bodies, and jitter of where they stand",
        ),
        doc(
            "behaviour_seed",
            "",
            "seed",
            &"a whole number from 0 to 2^64 - 1",
            "seed of what they do: candidate velocities of RVO",
        ),
        doc(
            "duration_secs",
            "s",
            "60",
            &range::TIME,
            "how long to simulate",
        ),
        doc(
            "preset",
            "",
            "paper",
            &"paper, fast or accurate",
            "numerics for what is not given otherwise: those of the paper, or what is cheaper or nearer to the \
             model's own limit (docs/accuracy.md)",
        ),
        doc(
            "time_step_secs",
            "s",
            "0.02",
            &format!("{}, or auto", range::TIME_STEP),
            "Δt_fine, one frame; auto: the largest at which a crowd is sure to come to rest",
        ),
        doc(
            "longest_step_secs",
            "s",
            "0.1",
            &range::TIME_STEP,
            "no step that `auto` takes is longer",
        ),
        doc(
            "coarse_every",
            "frames",
            "Δt_coarse nearest to 0.1 s",
            &range::COARSE_EVERY,
            "Δt_coarse: RVO, sources and events; a whole number",
        ),
        doc(
            "integrator",
            "",
            "semi-implicit",
            &"semi-implicit, forward-euler, velocity-verlet or midpoint",
            "how the state is moved on",
        ),
        doc(
            "wall_method",
            "",
            "representative",
            &"representative, exact or union",
            "how walls enter SPH",
        ),
        doc(
            "precision",
            "",
            "mixed",
            &"mixed or double",
            "numbers for sums over pairs; mixed is faster and off by at most 1e-5",
        ),
        doc(
            "neighbor_lists",
            "",
            "complete",
            &"complete or coarse",
            "complete: nobody is missed; coarse: made every Δt_coarse without a margin, as in the paper",
        ),
        doc(
            "preferred_speed",
            "m/s",
            "1.4",
            &range::PREFERRED_SPEED,
            "s_pref, speed at which agents want to walk",
        ),
        doc(
            "max_speed",
            "m/s",
            "1.8",
            &range::MAX_SPEED,
            "s_max, no agent is faster",
        ),
        doc(
            "profile",
            "",
            "sph",
            &"a name (see `sandbox list`), or a profile or blend in full",
            "how agents behave that say nothing else",
        ),
    ]
}

fn containers() -> [SettingDoc; 12] {
    let doc = |key, range: &str, description| SettingDoc {
        key,
        unit: "",
        default: "none",
        range: range.to_owned(),
        description,
    };
    [
        doc(
            "parameters",
            "an object of the parameters below",
            "values that hold for every profile of the scenario",
        ),
        doc(
            "walkable_area",
            "a list of polygons, each a list of rings (the outline, then holes); or a WKT or GeoJSON file",
            "where people can walk, everything round it is solid; corners in metres",
        ),
        doc(
            "obstacles",
            "a list of polygons, each a list of corners, or of rings (the outline, then holes); or a file",
            "solid bodies; corners in metres, either orientation",
        ),
        doc(
            "goal",
            "a point [x, y], metres",
            "where agents go that say nothing else",
        ),
        doc("agents", "a list of objects", "single agents"),
        doc(
            "grids",
            "a list of objects",
            "agents on grids, there from the start",
        ),
        doc(
            "sources",
            "a list of objects",
            "agents that enter on grids again and again",
        ),
        doc(
            "events",
            "a list of objects",
            "pushes: who stands in a region at one moment behaves differently for a while",
        ),
        doc(
            "measurements",
            "a list of density, flow_of_first, flow_until, evacuated",
            "what to report",
        ),
        doc(
            "stop",
            "an object: when_empty, idle_secs",
            "when to stop before the end",
        ),
        doc(
            "view",
            "an object: region, opens_at_secs",
            "what a recording shows first",
        ),
        doc(
            "debug_agents",
            "a list of ids",
            "agents that a recording lays open; without it a dozen",
        ),
    ]
}
