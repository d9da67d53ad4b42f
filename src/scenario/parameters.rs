//! The parameters of profiles ([`Parameters`]), under `parameters` in a file, with unit, default, range and meaning.

use super::error::Problem;
use super::key::{Key, Kind};
use super::range::Range;
use crate::scenario::catalog::Parameters;

/// Interaction ranges, meters.
const REACH: Range = Range::at_least(0.01, 100.0);
/// Times in denominators, seconds.
const RELAXATION: Range = Range::at_least(1e-6, 1e6);
/// Strengths and stiffnesses; 0 switches a term off.
const STRENGTH: Range = Range::at_least(0.0, 1e9);
/// Densities, P/m².
pub(super) const DENSITY: Range = Range::at_least(0.0, 1000.0);

/// Every parameter.
pub(super) const PARAMETERS: [Key; 19] = [
    Key::new(
        "goal_scale",
        Kind::Number(STRENGTH),
        "K^goal, strength of the goal force (Eq. 17)",
    )
    .default("1"),
    Key::new(
        "relaxation_time",
        Kind::Number(RELAXATION),
        "τ, time in which the goal force corrects the velocity (Eq. 17)",
    )
    .unit("s")
    .default("0.5"),
    Key::new(
        "agent_strength",
        Kind::Number(STRENGTH),
        "V₀, strength of the social force between agents (Eq. 18)",
    )
    .unit("m²/s²")
    .default("2.1"),
    Key::new(
        "agent_range",
        Kind::Number(REACH),
        "σ, range of the social force between agents (Eq. 18)",
    )
    .unit("m")
    .default("0.3"),
    Key::new(
        "anticipation_time",
        Kind::Number(Range::at_least(0.0, 1e3)),
        "T, how far ahead the social force looks (Eq. 18)",
    )
    .unit("s")
    .default("2"),
    Key::new(
        "wall_strength",
        Kind::Number(STRENGTH),
        "U₀, strength of the social force of walls (Eq. 19)",
    )
    .unit("m²/s²")
    .default("2.1"),
    Key::new(
        "wall_range",
        Kind::Number(REACH),
        "R, range of the social force of walls (Eq. 19)",
    )
    .unit("m")
    .default("0.1"),
    Key::new(
        "avoidance_radius",
        Kind::Number(REACH),
        "distance up to which social forces and RVO see agents and walls",
    )
    .unit("m")
    .default("5"),
    Key::new(
        "avoidance_tolerance",
        Kind::Number(STRENGTH),
        "leave out social forces that are certainly smaller than this, for an agent of mass 1",
    )
    .unit("m/s²")
    .default("0"),
    Key::new(
        "collision_weight",
        Kind::Number(STRENGTH),
        "w, weight of the time to collision in RVO (Eq. 20)",
    )
    .unit("m")
    .default("1"),
    Key::new(
        "candidates",
        Kind::Whole(Range::at_least(1.0, 1e6)),
        "number of candidate velocities of RVO per agent and coarse frame; a whole number",
    )
    .default("250"),
    Key::new(
        "viscosity",
        Kind::Number(STRENGTH),
        "μ, viscosity (Eq. 2); 0: none",
    )
    .default("0"),
    Key::new(
        "agent_stiffness",
        Kind::Number(STRENGTH),
        "K^ag, stiffness of contacts between agents (Eq. 22); 0: no contact force",
    )
    .unit("1/s²")
    .default("1000; with SPH 50"),
    Key::new(
        "wall_stiffness",
        Kind::Number(STRENGTH),
        "K^obs, stiffness of contacts with walls (Eq. 23); 0: no contact force",
    )
    .unit("1/s²")
    .default("1000; with SPH 200"),
    Key::new(
        "support_radius",
        Kind::Number(REACH),
        "h, support radius of the SPH kernels",
    )
    .unit("m")
    .default("1"),
    Key::new(
        "gas_constant",
        Kind::Number(STRENGTH),
        "k, pressure per excess density (Eq. 5); 0: no pressure",
    )
    .default("200"),
    Key::new(
        "rest_density_min",
        Kind::Number(DENSITY),
        "ρ⁰min, lowest personal rest density",
    )
    .unit("P/m²")
    .default("0"),
    Key::new(
        "rest_density_max",
        Kind::Number(DENSITY),
        "ρ⁰max, highest personal rest density",
    )
    .unit("P/m²")
    .default("5"),
    Key::new(
        "averaging_time",
        Kind::Number(RELAXATION),
        "T^ρ, time in which the personal rest density adapts (Eq. 8)",
    )
    .unit("s")
    .default("0.1"),
];

/// Is `key` a parameter of profiles?
pub(super) fn is_parameter(key: &str) -> bool {
    PARAMETERS.iter().any(|known| known.key == key)
}

/// All given parameters with their keys.
pub(super) fn given(parameters: &Parameters) -> Vec<(&'static str, f64)> {
    let values = serde_json::to_value(parameters).unwrap_or_default();
    let value = |known: &Key| Some((known.key, values.get(known.key)?.as_f64()?));
    PARAMETERS.iter().filter_map(value).collect()
}

/// Checks the ranges of all given parameters.
pub(super) fn check(parameters: &Parameters) -> Result<(), Problem> {
    for (key, value) in given(parameters) {
        for known in PARAMETERS.iter().filter(|known| known.key == key) {
            if let Kind::Number(range) | Kind::Whole(range) = known.kind {
                range.check(key, value)?;
            }
        }
    }
    Ok(())
}
