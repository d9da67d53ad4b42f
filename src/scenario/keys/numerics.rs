//! The keys of the time step and of the method of time integration.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use engine::clock::SHORTEST_TIME_STEP;

/// A time step in seconds, or `auto`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "must be a number of seconds, or \"auto\"")]
pub enum TimeStep {
    Fixed(#[schemars(range(min = SHORTEST_TIME_STEP, max = 1))] f64),
    Auto(Auto),
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(inline)]
pub enum Auto {
    Auto,
}

/// The method of time integration, or `auto`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorChoice {
    #[default]
    SemiImplicit,
    ForwardEuler,
    VelocityVerlet,
    Midpoint,
    Auto,
}
