//! The parameters of profiles ([`Parameters`]), which stand under `parameters` in a file: unit, default,
//! range, meaning.

use super::error::Problem;
use super::range::Range;
use super::settings::SettingDoc;
use crate::catalog::Parameters;

/// One of them.
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

/// Every parameter, for the list of settings.
pub(super) fn docs() -> impl Iterator<Item = SettingDoc> {
    PARAMETERS.iter().map(|doc| SettingDoc {
        key: doc.key,
        unit: doc.unit,
        default: doc.default,
        range: doc.range.to_string(),
        description: doc.description,
    })
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
