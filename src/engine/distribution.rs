//! Distributions of the properties that differ between agents: speeds, radii, times.
//!
//! A draw is the quantile of one uniform random number. Truncated distributions are therefore exact and never reject a
//! draw, and each agent uses one number of its own stream.

mod quantiles;

use libm::{exp, expm1, log, log1p, pow};
use rand::Rng;
use rand::distr::Open01;

use quantiles::{Gamma, Normal};

use crate::random::{self, Purpose};

/// The least share of a distribution that its bounds may keep: below this, a draw would be rounding error.
pub const LEAST_SHARE: f64 = 1e-6;

/// The largest shape of a gamma distribution: its values differ by 1 % there, and the time of a draw grows with its
/// root.
pub const LARGEST_SHAPE: f64 = 1e4;

/// Weidmann (1993), Transporttechnik der Fussgänger: walking speed by age, in years and m/s. The values are not from
/// the original but a digitization of its curve as the RiMEA guideline prints it.
const WEIDMANN: [[f64; 2]; 10] = [
    [3.0, 0.56],
    [10.0, 1.17],
    [20.0, 1.60],
    [30.0, 1.53],
    [40.0, 1.48],
    [50.0, 1.41],
    [60.0, 1.26],
    [70.0, 1.06],
    [80.0, 0.70],
    [85.0, 0.55],
];

/// The ages that the curve covers, years.
pub const AGES: [f64; 2] = [WEIDMANN[0][0], WEIDMANN[WEIDMANN.len() - 1][0]];
/// The ages of [`Family::WeidmannAge`] if none are given, years.
pub const ADULTS: [f64; 2] = [20.0, 80.0];

/// The kind of a distribution, with its parameters.
#[derive(Debug, Clone, PartialEq)]
pub enum Family {
    /// Always this value.
    Constant(f64),
    /// All values between two are equally likely.
    Uniform([f64; 2]),
    /// Mean and standard deviation.
    Normal([f64; 2]),
    /// Mean and standard deviation of the logarithm.
    LogNormal([f64; 2]),
    /// Scale and shape.
    Weibull([f64; 2]),
    /// Shape and scale.
    Gamma([f64; 2]),
    /// Mean.
    Exponential(f64),
    /// Values with their weights.
    Values(Vec<[f64; 2]>),
    /// Walking speeds, m/s, of people whose ages are uniform between two, years (Weidmann 1993).
    WeidmannAge([f64; 2]),
}

/// A distribution between two bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    shape: Shape,
    bounds: [f64; 2],
    /// The distribution function at the bounds.
    shares: [f64; 2],
}

/// A [`Family`], prepared for draws.
#[derive(Debug, Clone, PartialEq)]
enum Shape {
    Uniform([f64; 2]),
    Normal(Normal),
    LogNormal(Normal),
    Weibull([f64; 2]),
    /// The distribution of scale 1, and the scale.
    Gamma(Gamma, f64),
    Exponential(f64),
    /// Values in ascending order, each with the share of the values up to it.
    Values(Vec<[f64; 2]>),
    WeidmannAge([f64; 2]),
}

/// Why there is no such distribution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DistributionError {
    /// A parameter is not above 0, or not finite.
    #[error("{0} must be above 0, not {1}")]
    NotPositive(&'static str, f64),
    /// A parameter is not finite.
    #[error("{0} must be a finite number, not {1}")]
    NotFinite(&'static str, f64),
    /// The lower end lies above the upper one.
    #[error("the smaller number comes first: {0} is above {1}")]
    Order(f64, f64),
    /// The lower bound is not below the upper one.
    #[error(
        "min {0} is not below max {1}; swap them, or give one number in place of the distribution"
    )]
    Bounds(f64, f64),
    /// There are no values, or all weights are 0.
    #[error("needs at least one value with a weight above 0")]
    NoValues,
    /// Ages that the table lacks.
    #[error("ages are known from {low} to {high} years, not {0}", low = AGES[0], high = AGES[1])]
    Age(f64),
    /// The shape of a gamma distribution is too large.
    #[error(
        "a gamma distribution of shape {0} is as good as normal; give \"normal\", or a shape up to {LARGEST_SHAPE}"
    )]
    Shape(f64),
    /// The bounds leave nothing to draw from.
    #[error(
        "fewer than one in a million draws lie between {low} and {high}; move the distribution there, or widen its \
         bounds"
    )]
    Empty {
        /// The lower bound.
        low: f64,
        /// The upper bound.
        high: f64,
    },
    /// A value lies outside of the bounds.
    #[error("{value} is not between {low} and {high}")]
    Outside {
        /// The value.
        value: f64,
        /// The lower bound.
        low: f64,
        /// The upper bound.
        high: f64,
    },
}

impl Family {
    /// The log-normal distribution of a variable with this mean and standard deviation.
    pub fn log_normal_with(mean: f64, std: f64) -> Self {
        let variance = log1p((std / mean).powi(2));
        Self::LogNormal([log(mean) - 0.5 * variance, variance.sqrt()])
    }

    fn shape(&self) -> Result<Shape, DistributionError> {
        Ok(match *self {
            Self::Constant(value) => Shape::Values(cumulative(&[[value, 1.0]])?),
            Self::Uniform(ends) => Shape::Uniform(ascending(ends)?),
            Self::Normal([mean, 0.0]) => Self::Constant(mean).shape()?,
            Self::Normal([mean, std]) => Shape::Normal(normal("mean", mean, std)?),
            Self::LogNormal([mean, 0.0]) => Self::Constant(exp(mean)).shape()?,
            Self::LogNormal([mean, std]) => Shape::LogNormal(normal("log_mean", mean, std)?),
            Self::Weibull([scale, shape]) => {
                Shape::Weibull([positive("scale", scale)?, positive("shape", shape)?])
            }
            Self::Gamma([shape, scale]) => {
                let scale = positive("scale", scale)?;
                if positive("shape", shape)? > LARGEST_SHAPE {
                    return Err(DistributionError::Shape(shape));
                }
                // Of scale 1: the distribution function knows no product of bound and rate that rounds to 0 or
                // infinity.
                Shape::Gamma(Gamma { shape }, scale)
            }
            Self::Exponential(mean) => Shape::Exponential(positive("the mean", mean)?),
            Self::Values(ref values) => Shape::Values(cumulative(values)?),
            Self::WeidmannAge(ages) => {
                let unknown = ages
                    .into_iter()
                    .find(|age| !(AGES[0]..=AGES[1]).contains(age));
                match unknown {
                    Some(age) => return Err(DistributionError::Age(age)),
                    None => Shape::WeidmannAge(ascending(ages)?),
                }
            }
        })
    }
}

impl Distribution {
    /// Always `value`, which must be finite.
    pub fn constant(value: f64) -> Self {
        Self {
            shape: Shape::Values(vec![[value, 1.0]]),
            bounds: [value; 2],
            shares: [0.0, 1.0],
        }
    }

    /// The part of a distribution between two bounds. Continuous distributions without end are truncated there; all
    /// values of the others must lie between the bounds.
    ///
    /// # Errors
    /// Impossible parameters, values out of bounds, or a truncation that leaves less than [`LEAST_SHARE`].
    pub fn new(family: &Family, bounds: [f64; 2]) -> Result<Self, DistributionError> {
        let shape = family.shape()?;
        let [low, high] = bounds;
        if let Some([least, most]) = shape.ends() {
            if least < low || most > high {
                let value = if least < low { least } else { most };
                return Err(DistributionError::Outside { value, low, high });
            }
            let (bounds, shares) = ([least, most], [0.0, 1.0]);
            return Ok(Self {
                shape,
                bounds,
                shares,
            });
        }
        if low.is_nan() || high.is_nan() || low >= high {
            return Err(DistributionError::Bounds(low, high));
        }
        let shares = bounds.map(|bound| shape.cdf(bound));
        let share = shares[1] - shares[0];
        if share.is_nan() || share < LEAST_SHARE {
            return Err(DistributionError::Empty { low, high });
        }
        Ok(Self {
            shape,
            bounds,
            shares,
        })
    }

    /// The value below which a share of `u` of all draws lies; 0 < u < 1.
    pub fn quantile(&self, u: f64) -> f64 {
        let [low, high] = self.shares;
        // Not 0 or 1, where a distribution without end is infinite.
        let share = (low + u * (high - low)).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON / 2.0);
        self.shape
            .quantile(share)
            .clamp(self.bounds[0], self.bounds[1])
    }

    /// The share of all draws up to `x`, by bisection of the quantiles.
    pub fn share_up_to(&self, x: f64) -> f64 {
        const HALVINGS: usize = 50;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match self.quantile(middle) <= x {
                true => low = middle,
                false => high = middle,
            }
        }
        low
    }

    /// The mean, from a thousand quantiles.
    pub fn mean(&self) -> f64 {
        const QUANTILES: u32 = 1000;
        let shares = (0..QUANTILES).map(|k| (f64::from(k) + 0.5) / f64::from(QUANTILES));
        shares.map(|share| self.quantile(share)).sum::<f64>() / f64::from(QUANTILES)
    }

    /// The draw of one agent for one purpose.
    pub fn draw(&self, seed: u64, purpose: Purpose, agent: u32) -> f64 {
        self.quantile(random::stream(seed, purpose, agent, 0).sample(Open01))
    }
}

impl Shape {
    /// The least and the largest value, if there are both.
    fn ends(&self) -> Option<[f64; 2]> {
        match self {
            Self::Uniform(ends) => Some(*ends),
            Self::Values(values) => Some([values.first()?[0], values.last()?[0]]),
            Self::WeidmannAge([from, to]) => {
                let inside = WEIDMANN
                    .iter()
                    .filter(|[age, _]| (*from..=*to).contains(age));
                let speeds = inside.map(|&[_, speed]| speed);
                let ends = [from, to].map(|&age| speed_at(age));
                let range = |[low, high]: [f64; 2], speed: f64| [low.min(speed), high.max(speed)];
                Some(speeds.chain(ends).fold([f64::INFINITY, 0.0], range))
            }
            _ => None,
        }
    }

    /// The distribution function, of shapes without [`ends`](Self::ends).
    fn cdf(&self, x: f64) -> f64 {
        match self {
            Self::Normal(normal) => normal.share_up_to(x),
            Self::LogNormal(normal) => normal.share_up_to(log(x.max(0.0))),
            Self::Weibull([scale, shape]) => -expm1(-pow(x.max(0.0) / scale, *shape)),
            Self::Gamma(gamma, scale) => gamma.share_up_to(x.max(0.0) / scale),
            Self::Exponential(mean) => -expm1(-x.max(0.0) / mean),
            Self::Uniform(_) | Self::Values(_) | Self::WeidmannAge(_) => f64::NAN,
        }
    }

    fn quantile(&self, share: f64) -> f64 {
        match self {
            Self::Uniform([low, high]) => low + share * (high - low),
            Self::Normal(normal) => normal.quantile(share),
            Self::LogNormal(normal) => exp(normal.quantile(share)),
            Self::Weibull([scale, shape]) => scale * pow(-log1p(-share), 1.0 / shape),
            Self::Gamma(gamma, scale) => scale * gamma.quantile(share),
            Self::Exponential(mean) => -mean * log1p(-share),
            Self::Values(values) => {
                let place = values.partition_point(|&[_, up_to]| up_to <= share);
                values[place.min(values.len() - 1)][0]
            }
            Self::WeidmannAge([from, to]) => speed_at(to - share * (to - from)),
        }
    }
}

/// The walking speed at an age in years, m/s: the curve, linear in between.
fn speed_at(age: f64) -> f64 {
    let spans = WEIDMANN.windows(2).map(|span| (span[0], span[1]));
    let mut spans = spans.filter(|&(_, [to, _])| age <= to);
    let ([from, first], [to, last]) = spans.next().unwrap_or((WEIDMANN[8], WEIDMANN[9]));
    first + (last - first) * (age - from) / (to - from)
}

/// The values in ascending order, each with the share of the values up to it.
fn cumulative(values: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, DistributionError> {
    let mut sorted = Vec::with_capacity(values.len());
    for &[value, weight] in values {
        let value = finite("a value", value)?;
        if !weight.is_finite() || weight < 0.0 {
            return Err(DistributionError::NotPositive("a weight", weight));
        }
        if weight > 0.0 {
            sorted.push([value, weight]);
        }
    }
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let whole: f64 = sorted.iter().map(|[_, weight]| weight).sum();
    let mut up_to = 0.0;
    for [_, weight] in &mut sorted {
        up_to += *weight;
        *weight = up_to / whole;
    }
    match sorted.is_empty() {
        true => Err(DistributionError::NoValues),
        false => Ok(sorted),
    }
}

fn normal(name: &'static str, mean: f64, std: f64) -> Result<Normal, DistributionError> {
    let mean = finite(name, mean)?;
    let std = positive("std", std)?;
    Ok(Normal { mean, std })
}

fn finite(name: &'static str, value: f64) -> Result<f64, DistributionError> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(DistributionError::NotFinite(name, value)),
    }
}

fn positive(name: &'static str, value: f64) -> Result<f64, DistributionError> {
    match value.is_finite() && value > 0.0 {
        true => Ok(value),
        false => Err(DistributionError::NotPositive(name, value)),
    }
}

fn ascending([low, high]: [f64; 2]) -> Result<[f64; 2], DistributionError> {
    let (low, high) = (finite("an end", low)?, finite("an end", high)?);
    match low <= high {
        true => Ok([low, high]),
        false => Err(DistributionError::Order(low, high)),
    }
}
