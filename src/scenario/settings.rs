//! Every key that `--set` takes at the top of a scenario: unit, default, range, meaning.

use super::error::Problem;
use super::range::{self, Range};
use crate::catalog::Parameters;

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

/// A parameter of profiles ([`Parameters`]); in a file it stands under `parameters`.
struct ParameterDoc {
    key: &'static str,
    unit: &'static str,
    default: &'static str,
    range: Range,
    description: &'static str,
}

/// Lengths over which agents act on each other, metres.
const REACH: Range = Range::at_least(0.01, 100.0);
/// Times that divide, seconds.
const RELAXATION: Range = Range::at_least(1e-6, 1e6);
/// Strengths and stiffnesses; 0 switches a term off.
const STRENGTH: Range = Range::at_least(0.0, 1e9);
/// Densities, P/m².
pub(super) const DENSITY: Range = Range::at_least(0.0, 1000.0);

const PARAMETERS: [ParameterDoc; 19] = [
    parameter(
        "goal_scale",
        "",
        "1",
        STRENGTH,
        "K^goal, strength of the goal force (Eq. 17)",
    ),
    parameter(
        "relaxation_time",
        "s",
        "0.5",
        RELAXATION,
        "τ, in which the goal force corrects the velocity (Eq. 17)",
    ),
    parameter(
        "agent_strength",
        "m²/s²",
        "2.1",
        STRENGTH,
        "V₀, strength of the social force of agents (Eq. 18)",
    ),
    parameter(
        "agent_range",
        "m",
        "0.3",
        REACH,
        "σ, range of the social force of agents (Eq. 18)",
    ),
    parameter(
        "anticipation_time",
        "s",
        "2",
        Range::at_least(0.0, 1e3),
        "T, how far ahead the social force looks (Eq. 18)",
    ),
    parameter(
        "wall_strength",
        "m²/s²",
        "2.1",
        STRENGTH,
        "U₀, strength of the social force of walls (Eq. 19)",
    ),
    parameter(
        "wall_range",
        "m",
        "0.1",
        REACH,
        "R, range of the social force of walls (Eq. 19)",
    ),
    parameter(
        "avoidance_radius",
        "m",
        "5",
        REACH,
        "social force and RVO look this far",
    ),
    parameter(
        "avoidance_tolerance",
        "m/s²",
        "0",
        STRENGTH,
        "social forces that are certainly below this, on a person of mass 1, are left out",
    ),
    parameter(
        "collision_weight",
        "m",
        "1",
        STRENGTH,
        "w, weight of the time to collision in RVO (Eq. 20)",
    ),
    parameter(
        "candidates",
        "",
        "250",
        Range::at_least(1.0, 1e6),
        "candidate velocities of RVO per agent and coarse frame; a whole number",
    ),
    parameter("viscosity", "", "0", STRENGTH, "μ (Eq. 2); 0: none"),
    parameter(
        "agent_stiffness",
        "1/s²",
        "1000; with SPH 50",
        STRENGTH,
        "K^ag, contact between agents (Eq. 22); 0: none",
    ),
    parameter(
        "wall_stiffness",
        "1/s²",
        "1000; with SPH 200",
        STRENGTH,
        "K^obs, contact with walls (Eq. 23); 0: none",
    ),
    parameter(
        "support_radius",
        "m",
        "1",
        REACH,
        "h, support radius of the SPH kernels",
    ),
    parameter(
        "gas_constant",
        "",
        "200",
        STRENGTH,
        "k, pressure per excess density (Eq. 5); 0: no pressure",
    ),
    parameter(
        "rest_density_min",
        "P/m²",
        "0",
        DENSITY,
        "ρ⁰min, lowest personal rest density",
    ),
    parameter(
        "rest_density_max",
        "P/m²",
        "5",
        DENSITY,
        "ρ⁰max, highest personal rest density",
    ),
    parameter(
        "averaging_time",
        "s",
        "0.1",
        RELAXATION,
        "T^ρ, over which the personal rest density adapts (Eq. 8)",
    ),
];

const fn parameter(
    key: &'static str,
    unit: &'static str,
    default: &'static str,
    range: Range,
    description: &'static str,
) -> ParameterDoc {
    ParameterDoc {
        key,
        unit,
        default,
        range,
        description,
    }
}

/// Keys of the file whose value is text, never parsed as JSON.
pub(super) const TEXTS: [&str; 2] = ["name", "description"];

/// Every key: those of the file, then the parameters of profiles.
pub fn settings() -> Vec<SettingDoc> {
    let parameters = PARAMETERS.iter().map(|doc| SettingDoc {
        key: doc.key,
        unit: doc.unit,
        default: doc.default,
        range: doc.range.to_string(),
        description: doc.description,
    });
    scalars()
        .into_iter()
        .chain(containers())
        .chain(parameters)
        .collect()
}

fn scalars() -> [SettingDoc; 12] {
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
            "duration_secs",
            "s",
            "60",
            &range::TIME,
            "how long to simulate",
        ),
        doc(
            "time_step_secs",
            "s",
            "0.02",
            &format!("{}, or auto", range::TIME_STEP),
            "Δt_fine, one frame; auto: the largest at which a crowd is sure to come to rest",
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
            &"semi-implicit or forward-euler",
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

fn containers() -> [SettingDoc; 11] {
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
            "obstacles",
            "a list of simple polygons",
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

/// Is `key` a parameter of profiles?
pub(super) fn is_parameter(key: &str) -> bool {
    PARAMETERS.iter().any(|doc| doc.key == key)
}

/// Every given parameter with its key.
pub(super) fn given(parameters: &Parameters) -> Vec<(&'static str, f64)> {
    let values = serde_json::to_value(parameters).unwrap_or_default();
    let value = |doc: &ParameterDoc| Some((doc.key, values.get(doc.key)?.as_f64()?));
    PARAMETERS.iter().filter_map(value).collect()
}

/// Is every given parameter in range?
pub(super) fn check(parameters: &Parameters) -> Result<(), Problem> {
    for (key, value) in given(parameters) {
        for doc in PARAMETERS.iter().filter(|doc| doc.key == key) {
            doc.range.check(key, value)?;
        }
    }
    Ok(())
}
