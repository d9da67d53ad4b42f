//! The file of a calibration, as written.

use serde::de::value::MapAccessDeserializer;
use serde::{Deserialize, Deserializer};
use serde_untagged::UntaggedEnumVisitor;

use crate::sweep::{Entries, Seeds};

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct File {
    #[serde(default)]
    pub name: Option<String>,
    #[serde(default, rename = "description")]
    pub _description: Option<String>,
    #[serde(default)]
    pub settings: Entries,
    pub parameters: Vec<ParameterKeys>,
    pub fit: Vec<SceneKeys>,
    #[serde(default)]
    pub hold_out: Vec<SceneKeys>,
    #[serde(default)]
    pub transfer: Vec<SceneKeys>,
    #[serde(default)]
    pub seeds: Option<Seeds>,
    #[serde(default)]
    pub final_seeds: Option<Seeds>,
    #[serde(default)]
    pub residual: Rule,
    #[serde(default)]
    pub screening: Option<Screening>,
    #[serde(default)]
    pub search: Search,
}

/// A parameter.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterKeys {
    pub name: String,
    #[serde(default)]
    pub keys: Option<Vec<String>>,
    pub bounds: [f64; 2],
    #[serde(default)]
    pub start: Option<f64>,
    #[serde(default)]
    pub scale: Scale,
    #[serde(default)]
    pub half_width: Option<f64>,
    #[serde(default)]
    pub frozen: bool,
}

/// The scale on which a parameter is searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Equal differences are equal steps.
    #[default]
    Linear,
    /// Equal ratios are equal steps.
    Log,
}

/// A scene: a case of the validation, or a scenario.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneKeys {
    #[serde(default)]
    pub case: Option<String>,
    #[serde(default)]
    pub scenario: Option<String>,
    #[serde(default)]
    pub name: Option<String>,
    #[serde(default)]
    pub settings: Entries,
    #[serde(default)]
    pub values: Option<Vec<ValueKeys>>,
}

/// A value of a scene; a text stands for its quantity.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, remote = "Self")]
pub(super) struct ValueKeys {
    pub quantity: String,
    pub value: Option<f64>,
    pub tolerance: Option<f64>,
}

impl ValueKeys {
    /// The value that a case has for this quantity.
    pub fn of(quantity: &str) -> Self {
        Self {
            quantity: quantity.to_owned(),
            value: None,
            tolerance: None,
        }
    }
}

/// Not derived: the errors of a derived untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for ValueKeys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting(
                "the name of a quantity, or an object with `quantity`, `value` and `tolerance`",
            )
            .string(|quantity| Ok(Self::of(quantity)))
            .map(|keys| Self::deserialize(MapAccessDeserializer::new(keys))) // the derived one
            .deserialize(deserializer)
    }
}

/// The residuals of runs.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rule {
    /// The largest residual of a run that gives a value, tolerances.
    pub clip: f64,
    /// The residual of a failed run, tolerances.
    pub penalty: f64,
    /// A run has failed if people remain at its end and none has left in this many seconds before it.
    pub stuck_secs: f64,
}

impl Default for Rule {
    fn default() -> Self {
        Self {
            clip: 20.0,
            penalty: 30.0,
            stuck_secs: 10.0,
        }
    }
}

/// The screening.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Screening {
    /// The number of trajectories.
    pub trajectories: usize,
    /// Parameters whose range changes no value by more than this are not searched, tolerances.
    pub drop_below: f64,
    /// The seed of the trajectories.
    pub seed: u64,
}

impl Default for Screening {
    fn default() -> Self {
        Self {
            trajectories: 4,
            drop_below: 0.0,
            seed: 1,
        }
    }
}

/// The search.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Search {
    /// Points per generation; `None`: by the number of parameters.
    pub population: Option<usize>,
    /// Most generations.
    pub generations: usize,
    /// The standard deviation of the first generation, as a fraction of the bounds.
    pub spread: f64,
    /// The seed of the points.
    pub seed: u64,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            population: None,
            generations: 40,
            spread: 0.2,
            seed: 1,
        }
    }
}
