//! Distributions of a file → those of a scene, and the traits that are drawn from them.

use crate::error::numbers::brief;
use crate::error::{Problem, Under};
use crate::keys::distribution::{
    Bounds, Draw, Exponential, Lognormal, MASSES, RADII, SPEED, SPEEDS, Spread, WAITS,
    WEIDMANN_AGE, Weighted,
};
use crate::keys::people::People;
use engine::distribution::{ADULTS, Distribution, DistributionError, Family};
use engine::traits::Traits;

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
        let made = |name: &str, family: &Family, given: Option<Bounds>| {
            let [low, high] = range;
            let (min, max) = given.map_or((None, None), |given| (given.min, given.max));
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
            Self::Number(value) => return made("", &Family::Constant(*value), None),
            Self::WeidmannAge => return made("", &Family::WeidmannAge(ADULTS), None),
            Self::From(from) => from.as_ref(),
        };
        match from {
            Spread::Uniform(ends) => made("uniform", &Family::Uniform(*ends), None),
            Spread::Normal(of) => {
                let family = Family::Normal([of.mean, of.std]);
                made("normal", &family, Some(of.bounds))
            }
            Spread::Lognormal(of) => made(
                "lognormal",
                &of.family().under("lognormal")?,
                Some(of.bounds),
            ),
            Spread::Weibull(of) => {
                let family = Family::Weibull([of.scale, of.shape]);
                made("weibull", &family, Some(of.bounds))
            }
            Spread::Gamma(of) => {
                let family = Family::Gamma([of.shape, of.scale]);
                made("gamma", &family, Some(of.bounds))
            }
            Spread::Exponential(Exponential::Mean(mean)) => {
                made("exponential", &Family::Exponential(*mean), None)
            }
            Spread::Exponential(Exponential::Bounded(of)) => {
                let family = Family::Exponential(of.mean);
                made("exponential", &family, Some(of.bounds))
            }
            Spread::Values(values) => {
                let values = values.iter().map(|&Weighted(pair)| pair).collect();
                made("values", &Family::Values(values), None)
            }
            Spread::WeidmannAge(ages) => made("weidmann_age", &Family::WeidmannAge(*ages), None),
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
    pub fn times(&self) -> Result<Distribution, Problem> {
        match self.is_of_speeds() {
            true => {
                let reason = format!("`{WEIDMANN_AGE}` is for `{SPEED}` only");
                Err(Problem::new("", reason))
            }
            false => self.distribution(WAITS),
        }
    }
}

/// The traits of agents.
pub fn traits(given: &People) -> Result<Traits, Problem> {
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
        preferred_speed: of(SPEED, &given.preferred_speed, SPEEDS)?,
        radius: of("radius", &given.radius, RADII)?,
        mass: of("mass", &given.mass, MASSES)?,
        premovement: of("premovement_secs", &given.premovement_secs, WAITS)?,
    })
}
