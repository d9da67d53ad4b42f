//! Presets: numerics by one name, measured in `docs/accuracy.md`.

use serde::Deserialize;
use serde_json::{Value, json};

/// How exactly, and how fast, a scenario is computed where it says nothing else.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// What reproduces the paper: semi-implicit Euler, Δt = 0.02 s, representative points, nobody left out.
    #[default]
    Paper,
    /// Twice the paper's step where the crowd bears it, and no social forces that hardly matter.
    Fast,
    /// Near to where the model's motion tends as Δt → 0, with walls integrated exactly.
    Accurate,
}

impl Preset {
    /// All of them, with their names.
    pub const ALL: [(&'static str, Self); 3] = [
        ("paper", Self::Paper),
        ("fast", Self::Fast),
        ("accurate", Self::Accurate),
    ];

    /// The keys that it gives a value, as at the top of a file.
    pub fn document(self) -> Value {
        match self {
            Self::Paper => json!({}),
            Self::Fast => json!({
                "time_step_secs": "auto",
                "longest_step_secs": 0.04,
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

/// The document with what its preset stands for, wherever it says nothing itself.
pub(super) fn fill(document: &Value) -> Value {
    let mut filled = document.clone();
    let named = document.get("preset").and_then(Value::as_str);
    let mut presets = Preset::ALL.into_iter();
    if let Some((_, preset)) = presets.find(|(name, _)| Some(*name) == named) {
        complete(&mut filled, preset.document());
    }
    filled
}

/// Puts those values into an object that it lacks, and into objects in it.
fn complete(given: &mut Value, values: Value) {
    let (Value::Object(given), Value::Object(values)) = (given, values) else {
        return;
    };
    for (key, value) in values {
        match given.get_mut(&key) {
            Some(present) => complete(present, value),
            None => {
                given.insert(key, value);
            }
        }
    }
}
