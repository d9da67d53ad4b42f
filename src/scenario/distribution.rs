//! Distributions in a file, and the traits that are drawn from them.

use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde_json::Value;

use super::error::{Problem, Under};
use super::file::LONGEST_TIME;
use super::range::brief;
use crate::engine::distribution::{
    ADULTS, AGES, Distribution, DistributionError, Family, LARGEST_SHAPE,
};
use crate::engine::traits::Traits;

/// The largest parameter of a distribution.
const LARGEST: f64 = 1e9;
/// The word for the walking speeds of adults by age.
const WEIDMANN_AGE: &str = "weidmann_age";

/// The key of preferred speeds.
const SPEED: &str = "preferred_speed";
/// The range of preferred speeds, m/s.
const SPEEDS: [f64; 2] = [0.0, 100.0];
/// The range of radii, meters.
const RADII: [f64; 2] = [0.01, 10.0];
/// The range of masses.
const MASSES: [f64; 2] = [1e-6, 1e6];
/// The range of times before agents walk, seconds.
const WAITS: [f64; 2] = [0.0, LONGEST_TIME];

/// A number, or the distribution that it is drawn from for each agent.
#[derive(Debug, Clone)]
pub(super) enum Draw {
    Number(f64),
    /// Walking speeds of adults by age.
    WeidmannAge,
    From(Box<Spread>),
}

/// A distribution, an object with one key.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Spread {
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
pub(super) struct Weighted(#[schemars(inner(range(min = -LARGEST, max = LARGEST)))] [f64; 2]);

/// The parameters of a normal distribution.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Normal {
    /// The mean.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    mean: f64,
    /// The standard deviation.
    #[schemars(range(min = 0, max = LARGEST))]
    std: f64,
    /// No draw is below this. Default: the least value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    min: Option<f64>,
    /// No draw is above this. Default: the largest value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    max: Option<f64>,
}

/// The parameters of a log-normal distribution: mean and standard deviation of the variable or of its logarithm.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Lognormal {
    /// The mean of the variable, with `std`.
    #[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))]
    mean: Option<f64>,
    /// The standard deviation of the variable, with `mean`.
    #[schemars(range(min = 0, max = LARGEST))]
    std: Option<f64>,
    /// The mean of the logarithm, with `log_std`.
    #[schemars(range(min = -100, max = 100))]
    log_mean: Option<f64>,
    /// The standard deviation of the logarithm, with `log_mean`.
    #[schemars(range(min = 0, max = 100))]
    log_std: Option<f64>,
    /// No draw is below this. Default: the least value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    min: Option<f64>,
    /// No draw is above this. Default: the largest value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    max: Option<f64>,
}

/// The parameters of a Weibull or gamma distribution.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Scaled {
    /// The scale, in the unit of the variable.
    #[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))]
    scale: f64,
    /// The shape.
    #[schemars(range(min = 0.01, max = LARGEST_SHAPE))]
    shape: f64,
    /// No draw is below this. Default: the least value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    min: Option<f64>,
    /// No draw is above this. Default: the largest value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    max: Option<f64>,
}

/// The mean of an exponential distribution, or an object with its bounds
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum Exponential {
    Mean(#[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))] f64),
    Bounded(BoundedExponential),
}

/// The parameters of an exponential distribution.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct BoundedExponential {
    /// The mean.
    #[schemars(range(max = LARGEST), extend("exclusiveMinimum" = 0))]
    mean: f64,
    /// No draw is below this. Default: the least value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    min: Option<f64>,
    /// No draw is above this. Default: the largest value of the key.
    #[schemars(range(min = -LARGEST, max = LARGEST))]
    max: Option<f64>,
}

/// The schema of a number in `range` or a distribution.
fn draw(generator: &mut SchemaGenerator, [min, max]: [f64; 2], words: &[&str]) -> Schema {
    let mut ways = vec![
        serde_json::json!({"type": "number", "minimum": min, "maximum": max}),
        generator.subschema_for::<Spread>().to_value(),
        serde_json::json!({"type": "null"}),
    ];
    if !words.is_empty() {
        ways.insert(1, serde_json::json!({"type": "string", "enum": words}));
    }
    json_schema!({ "anyOf": Value::from(ways) })
}

pub(super) fn speed(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, SPEEDS, &[WEIDMANN_AGE])
}

pub(super) fn radius(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, RADII, &[])
}

pub(super) fn mass(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, MASSES, &[])
}

pub(super) fn wait(generator: &mut SchemaGenerator) -> Schema {
    draw(generator, WAITS, &[])
}

/// Implemented by hand: the errors of an untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for Draw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(DrawVisitor)
    }
}

struct DrawVisitor;

impl<'de> Visitor<'de> for DrawVisitor {
    type Value = Draw;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number, or a distribution such as {\"uniform\": [1, 1.5]}")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Draw, E> {
        Ok(Draw::Number(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Draw, E> {
        Ok(Draw::Number(number as f64))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Draw, E> {
        Ok(Draw::Number(number as f64))
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<Draw, E> {
        match word == WEIDMANN_AGE {
            true => Ok(Draw::WeidmannAge),
            false => Err(E::unknown_variant(word, &[WEIDMANN_AGE])),
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<Draw, A::Error> {
        let from = Spread::deserialize(MapAccessDeserializer::new(entries))?;
        Ok(Draw::From(Box::new(from)))
    }
}

impl Draw {
    /// Whether it gives walking speeds.
    fn is_of_speeds(&self) -> bool {
        match self {
            Self::Number(_) => false,
            Self::WeidmannAge => true,
            Self::From(from) => matches!(**from, Spread::WeidmannAge(_)),
        }
    }

    /// The distribution, truncated to `range`.
    fn distribution(&self, range: [f64; 2]) -> Result<Distribution, Problem> {
        let made = |name: &str, family: &Family, min: Option<f64>, max: Option<f64>| {
            let [low, high] = range;
            let bounds = [min.unwrap_or(low).max(low), max.unwrap_or(high).min(high)];
            Distribution::new(family, bounds).map_err(|error| {
                let reason = match error {
                    DistributionError::Outside { value, .. } => {
                        let (low, high) = (brief(low), brief(high));
                        format!("{value} is not between {low} and {high}, the range of this key")
                    }
                    DistributionError::Empty { low, high } => format!(
                        "fewer than one in a million draws lie between {} and {}; move the distribution there, or \
                         widen its bounds",
                        brief(low),
                        brief(high)
                    ),
                    error => error.to_string(),
                };
                Problem::new(name, reason)
            })
        };
        let from = match self {
            Self::Number(value) => return made("", &Family::Constant(*value), None, None),
            Self::WeidmannAge => return made("", &Family::WeidmannAge(ADULTS), None, None),
            Self::From(from) => from.as_ref(),
        };
        match from {
            Spread::Uniform(ends) => made("uniform", &Family::Uniform(*ends), None, None),
            Spread::Normal(of) => {
                let family = Family::Normal([of.mean, of.std]);
                made("normal", &family, of.min, of.max)
            }
            Spread::Lognormal(of) => made(
                "lognormal",
                &of.family().under("lognormal")?,
                of.min,
                of.max,
            ),
            Spread::Weibull(of) => {
                let family = Family::Weibull([of.scale, of.shape]);
                made("weibull", &family, of.min, of.max)
            }
            Spread::Gamma(of) => {
                let family = Family::Gamma([of.shape, of.scale]);
                made("gamma", &family, of.min, of.max)
            }
            Spread::Exponential(Exponential::Mean(mean)) => {
                made("exponential", &Family::Exponential(*mean), None, None)
            }
            Spread::Exponential(Exponential::Bounded(of)) => {
                let family = Family::Exponential(of.mean);
                made("exponential", &family, of.min, of.max)
            }
            Spread::Values(values) => {
                let values = values.iter().map(|&Weighted(pair)| pair).collect();
                made("values", &Family::Values(values), None, None)
            }
            Spread::WeidmannAge(ages) => {
                made("weidmann_age", &Family::WeidmannAge(*ages), None, None)
            }
        }
    }
}

impl Lognormal {
    fn family(&self) -> Result<Family, Problem> {
        match (self.mean, self.std, self.log_mean, self.log_std) {
            (Some(mean), Some(std), None, None) => Ok(Family::log_normal_with(mean, std)),
            (None, None, Some(mean), Some(std)) => Ok(Family::LogNormal([mean, std])),
            _ => {
                let reason = "needs either `mean` and `std`, or `log_mean` and `log_std`";
                Err(Problem::new("", reason))
            }
        }
    }
}

impl Draw {
    /// The distribution of a time in seconds.
    pub(super) fn times(&self) -> Result<Distribution, Problem> {
        match self.is_of_speeds() {
            true => {
                let reason = format!("`{WEIDMANN_AGE}` is for `{SPEED}` only");
                Err(Problem::new("", reason))
            }
            false => self.distribution(WAITS),
        }
    }
}

/// The traits of agents, from the keys `preferred_speed`, `radius`, `mass` and `premovement_secs`.
pub(super) fn traits(
    [preferred_speed, radius, mass, premovement_secs]: [&Option<Draw>; 4],
) -> Result<Traits, Problem> {
    let of = |key: &str, draw: &Option<Draw>, range| {
        let made = draw
            .as_ref()
            .map(|draw| match draw.is_of_speeds() && key != SPEED {
                true => Err(Problem::new(
                    "",
                    format!("`{WEIDMANN_AGE}` is for `{SPEED}` only"),
                )),
                false => draw.distribution(range),
            });
        made.transpose().under(key)
    };
    Ok(Traits {
        preferred_speed: of(SPEED, preferred_speed, SPEEDS)?,
        radius: of("radius", radius, RADII)?,
        mass: of("mass", mass, MASSES)?,
        premovement: of("premovement_secs", premovement_secs, WAITS)?,
    })
}
