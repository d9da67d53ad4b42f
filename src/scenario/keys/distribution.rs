//! Distributions in a file, and the traits that are drawn from them.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use serde_untagged::UntaggedEnumVisitor;

use crate::keys::limits::LONGEST_TIME;
use engine::distribution::{AGES, LARGEST_SHAPE};

/// The largest parameter of a distribution.
const LARGEST: f64 = 1e9;
/// The word for the walking speeds of adults by age.
pub const WEIDMANN_AGE: &str = "weidmann_age";

/// The key of preferred speeds.
pub const SPEED: &str = "preferred_speed";
/// The range of preferred speeds, m/s.
pub const SPEEDS: [f64; 2] = [0.0, 100.0];
/// The range of radii, meters.
pub const RADII: [f64; 2] = [0.01, 10.0];
/// The range of masses.
pub const MASSES: [f64; 2] = [1e-6, 1e6];
/// The range of times before agents walk, seconds.
pub const WAITS: [f64; 2] = [0.0, LONGEST_TIME];

/// A number, or the distribution that it is drawn from for each agent.
#[derive(Debug, Clone)]
pub enum Draw {
    Number(f64),
    /// Walking speeds of adults by age.
    WeidmannAge,
    From(Box<Spread>),
}

/// A distribution, an object with one key
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Spread {
    /// All values between two are equally likely.
    Uniform(#[schemars(inner(range(min = -LARGEST, max = LARGEST)))] [f64; 2]),
    /// The normal distribution.
    Normal(Normal),
    /// The distribution of a variable whose logarithm is normal.
    Lognormal(Lognormal),
    /// The Weibull distribution.
    Weibull(Scaled),
    /// The gamma distribution.
    Gamma(Scaled),
    /// The exponential distribution: its mean, or an object with bounds.
    Exponential(Exponential),
    /// Values with their weights, as in [[20, 3], [40, 1]].
    Values(#[schemars(length(min = 1))] Vec<Weighted>),
    /// Walking speeds, m/s, of people whose ages are uniform between these two, years (Weidmann 1993).
    WeidmannAge(#[schemars(inner(range(min = AGES[0], max = AGES[1])))] [f64; 2]),
}

/// A value and its weight
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Weighted(#[schemars(inner(range(min = -LARGEST, max = LARGEST)))] pub [f64; 2]);

/// The bounds of a distribution.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub struct Bounds {
    /// No draw is below this. Default: the least value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    pub min: Option<f64>,
    /// No draw is above this. Default: the largest value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    pub max: Option<f64>,
}

/// The parameters of a normal distribution.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Normal {
    /// The mean.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    pub mean: f64,
    /// The standard deviation.
    #[schemars(range(min = 0, max = LARGEST))]
    pub std: f64,
    #[serde(flatten)]
    pub bounds: Bounds,
}

/// The parameters of a log-normal distribution: mean and standard deviation of the variable or of its logarithm.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Lognormal {
    /// The mean of the variable, with `std`.
    #[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))]
    pub mean: Option<f64>,
    /// The standard deviation of the variable, with `mean`.
    #[schemars(range(min = 0, max = LARGEST))]
    pub std: Option<f64>,
    /// The mean of the logarithm, with `log_std`.
    #[schemars(range(min = -100, max = 100))]
    pub log_mean: Option<f64>,
    /// The standard deviation of the logarithm, with `log_mean`.
    #[schemars(range(min = 0, max = 100))]
    pub log_std: Option<f64>,
    #[serde(flatten)]
    pub bounds: Bounds,
}

/// The parameters of a Weibull or gamma distribution.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Scaled {
    /// The scale, in the unit of the variable.
    #[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))]
    pub scale: f64,
    /// The shape.
    #[schemars(range(min = 0.01, max = LARGEST_SHAPE))]
    pub shape: f64,
    #[serde(flatten)]
    pub bounds: Bounds,
}

/// The mean of an exponential distribution, or an object with its bounds
#[derive(Debug, Clone, JsonSchema)]
#[schemars(untagged)]
pub enum Exponential {
    Mean(#[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))] f64),
    Bounded(BoundedExponential),
}

/// The parameters of an exponential distribution.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct BoundedExponential {
    /// The mean.
    #[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))]
    pub mean: f64,
    #[serde(flatten)]
    pub bounds: Bounds,
}

/// The schema of a number in `range` or a distribution.
fn draw(generator: &mut SchemaGenerator, [min, max]: [f64; 2], words: &[&str]) -> Schema {
    let mut alternatives = vec![
        serde_json::json!({"type": "number", "minimum": min, "maximum": max}),
        generator.subschema_for::<Spread>().to_value(),
        serde_json::json!({"type": "null"}),
    ];
    if !words.is_empty() {
        alternatives.insert(1, serde_json::json!({"type": "string", "enum": words}));
    }
    json_schema!({ "anyOf": Value::from(alternatives) })
}

pub fn speed(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, SPEEDS, &[WEIDMANN_AGE])
}

pub fn radius(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, RADII, &[])
}

pub fn mass(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, MASSES, &[])
}

pub fn wait(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, WAITS, &[])
}

/// Not derived, nor for [`Exponential`]: the errors of a derived untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for Draw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting("a number, or a distribution such as {\"uniform\": [1, 1.5]}")
            .f64(|number| Ok(Self::Number(number)))
            .u64(|number| Ok(Self::Number(number as f64)))
            .i64(|number| Ok(Self::Number(number as f64)))
            .string(|word| match word == WEIDMANN_AGE {
                true => Ok(Self::WeidmannAge),
                false => Err(Error::unknown_variant(word, &[WEIDMANN_AGE])),
            })
            .map(|keys| Ok(Self::From(Box::new(keys.deserialize()?))))
            .deserialize(deserializer)
    }
}

impl<'de> Deserialize<'de> for Exponential {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting("the mean, or an object with `mean`, `min` and `max`")
            .f64(|mean| Ok(Self::Mean(mean)))
            .u64(|mean| Ok(Self::Mean(mean as f64)))
            .i64(|mean| Ok(Self::Mean(mean as f64)))
            .map(|keys| Ok(Self::Bounded(keys.deserialize()?)))
            .deserialize(deserializer)
    }
}
