//! Presets: named choices of the numerics, measured in `docs/findings/accuracy.md`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::keys::names::names;

/// The numerics for keys that a scenario does not give: a trade-off between accuracy and run time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Reproduces the paper: semi-implicit Euler, Δt = 0.02 s, representative points, no social force left out.
    #[default]
    Paper,
    /// Up to 2.5 times the paper's step, where that is stable and keeps Table 1 within the noise of its seeds; velocity
    /// Verlet where agents stay; leaves out tiny social forces.
    Fast,
    /// Close to the limit of the model's motion as Δt → 0, with walls integrated exactly.
    Accurate,
}

impl Preset {
    /// Their names.
    pub fn names() -> &'static [&'static str] {
        names::<Self>()
    }

    /// The top-level keys that it sets, with their values.
    pub fn document(self) -> Value {
        match self {
            Self::Paper => json!({}),
            Self::Fast => json!({
                "time_step_secs": "auto",
                "integrator": "auto",
                "parameters": { "avoidance_tolerance": 1e-3 }
            }),
            Self::Accurate => json!({
                "time_step_secs": 0.005,
                "integrator": "velocity-verlet",
                "wall_method": "union"
            }),
        }
    }
}
