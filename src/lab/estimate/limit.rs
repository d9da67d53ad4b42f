//! The limit of fine time steps, from runs at several steps.
//!
//! A measurement of a run at the time step h is modeled as
//!
//! y = μ + β (h/h₁)^p + ε,  h₁ = 0.02 s,
//!
//! with μ its mean in the limit, β the error of the paper's step, and ε the chance of the seed, normal with a standard
//! deviation σ that does not depend on h. μ has a flat prior; p is one of nine orders between 0.4 and 2.5, of which 1
//! is the most likely at first; β is normal with mean 0 and a standard deviation of 0.1, 0.3, 1, 3 or 10 σ, whose
//! weights are the shares of such sizes among results that were measured before (`prior.rs`). Given p and the size of
//! β, the posterior of (μ, β) is normal; the posterior of μ is the mixture over all p and sizes, weighted by how likely
//! they make the data.
//!
//! Steps may be too long for any order: social forces in a jam change the flow by half from one step to the next. So
//! with a prior weight of 0.1 the coarsest of three or more steps does not belong to the others, and its mean may be
//! anywhere within 10 σ.
//!
//! No sum of orders is exactly true: an eighth of the error that the finest step still has by this model counts as a
//! standard error on top. At 95 % this is the safety factor 1.25 of the grid convergence index (Roache 1994).

use std::f64::consts::TAU;

/// h₁, seconds.
pub(super) const REFERENCE_STEP: f64 = engine::clock::PAPER_TIME_STEP;
/// The orders p, and their weights.
const ORDERS: [(f64, f64); 9] = [
    (0.4, 0.04),
    (0.5, 0.07),
    (0.63, 0.11),
    (0.79, 0.16),
    (1.0, 0.22),
    (1.26, 0.16),
    (1.58, 0.12),
    (2.0, 0.08),
    (2.5, 0.04),
];
/// Sizes of the error β in standard deviations of a run; `prior.rs` has their weights.
pub(super) const SIZES: [f64; 5] = [0.1, 0.3, 1.0, 3.0, 10.0];
/// The prior weight of a coarsest step that is too long, and the range of its mean, in standard deviations of a run.
const TOO_LONG: (f64, f64) = (0.1, 20.0);
/// The part of the finest step's error that counts as a standard error.
const UNMODELED: f64 = 0.125;
/// The smallest standard deviation over runs that sizes refer to, as a part of the value: for runs without chance.
const LEAST_SPREAD: f64 = 1e-3;
/// The smallest standard deviation over runs, as a part of the value: that of rounding.
const ROUNDING: f64 = 1e-12;

/// The runs at one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// The time step, seconds.
    pub step: f64,
    /// The number of runs, at least 1.
    pub runs: usize,
    /// The mean of their values.
    pub mean: f64,
}

/// What is known about a measurement in the limit of fine steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// The components of the mixture.
    components: Vec<Component>,
    /// The mean in the limit.
    pub value: f64,
    /// The variance of `value`.
    pub variance: f64,
    /// The part of this variance that comes from the seeds.
    pub from_seeds: f64,
    /// The mean order p.
    pub order: f64,
}

/// The posterior for one order and size.
#[derive(Debug, Clone, PartialEq)]
struct Component {
    weight: f64,
    order: f64,
    /// The posterior mean of μ.
    value: f64,
    /// Its variance.
    variance: f64,
    /// The posterior mean of β.
    error: f64,
    /// The weights of the levels' means in `value`; the last one is missing if its step is too long.
    shares: Vec<f64>,
}

impl Limit {
    /// The limit of measurements at some levels, from the finest to the coarsest. `variance` is that of single runs.
    /// `shares` are the weights of `SIZES`.
    pub fn of(levels: &[Level], variance: f64, shares: &[f64; SIZES.len()]) -> Self {
        // In standard deviations of a run, from the finest level's mean: sums of squares of the values themselves would
        // lose digits.
        let origin = levels.first().map_or(0.0, |level| level.mean);
        let unit = variance.sqrt().max(ROUNDING * origin.abs());
        if unit == 0.0 {
            return Self::exact(origin);
        }
        let scaled = levels.iter().map(|level| Level {
            mean: (level.mean - origin) / unit,
            ..*level
        });
        let levels: Vec<Level> = scaled.collect();
        let spread = (LEAST_SPREAD * origin.abs() / unit).max(1.0);
        let components = mixture(&levels, spread, shares);
        let mean = |of: &dyn Fn(&Component) -> f64| -> f64 {
            components.iter().map(|c| c.weight * of(c)).sum()
        };
        let value = mean(&|c| c.value);
        let finest = levels.first().map_or(REFERENCE_STEP, |level| level.step);
        let unmodeled = UNMODELED * mean(&|c| c.at(finest) - c.value);
        let spread_of_value = mean(&|c| c.variance + (c.value - value).powi(2));
        let from_seeds = levels.iter().enumerate().map(|(k, level)| {
            mean(&|c| c.shares.get(k).copied().unwrap_or(0.0)).powi(2) / level.runs as f64
        });
        let in_unit_of_values = |c: &Component| Component {
            value: origin + unit * c.value,
            error: unit * c.error,
            ..c.clone()
        };
        Self {
            value: origin + unit * value,
            variance: unit * unit * (spread_of_value + unmodeled.powi(2)),
            from_seeds: unit * unit * from_seeds.sum::<f64>(),
            order: mean(&|c| c.order),
            components: components.iter().map(in_unit_of_values).collect(),
        }
    }

    /// The limit that has this value, at all steps.
    pub(super) fn exact(value: f64) -> Self {
        Self {
            components: Vec::new(),
            value,
            variance: 0.0,
            from_seeds: 0.0,
            order: 1.0,
        }
    }

    /// The mean that is expected at this step.
    pub fn at(&self, step: f64) -> f64 {
        if self.components.is_empty() {
            return self.value;
        }
        let parts = self.components.iter();
        parts
            .map(|component| component.weight * component.at(step))
            .sum()
    }

    /// The error that is expected at this step: the mean there minus that in the limit.
    pub fn error_at(&self, step: f64) -> f64 {
        self.at(step) - self.value
    }
}

impl Component {
    fn at(&self, step: f64) -> f64 {
        self.value + self.error * (step / REFERENCE_STEP).powf(self.order)
    }
}

/// The posteriors for all orders and sizes, with their weights: of all levels, and of all but the coarsest of three or
/// more. The standard deviation of runs is 1, sizes are in units of `spread`.
fn mixture(levels: &[Level], spread: f64, shares: &[f64; SIZES.len()]) -> Vec<Component> {
    let (weight, range) = TOO_LONG;
    let apart = levels.split_last().filter(|(_, others)| others.len() > 1);
    // The last level's share in how likely the data are.
    let (belongs, free) = apart.map_or((0.0, None), |(last, others)| {
        let runs = last.runs as f64;
        let density = 0.5 * (runs / TAU).ln() - 0.5 * runs * last.mean * last.mean;
        let free = f64::ln(weight / (range * spread));
        (f64::ln(1.0 - weight) + density, Some((free, others)))
    });
    let (mut logs, mut components) = (Vec::new(), Vec::new());
    for (log, used) in [Some((belongs, levels)), free].into_iter().flatten() {
        for (order, likely) in ORDERS {
            for (size, prior) in SIZES.into_iter().zip(shares) {
                let (of_data, component) = component(used, order, size * spread);
                logs.push(log + of_data + f64::ln(likely * prior));
                components.push(component);
            }
        }
    }
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = logs.iter().map(|log| (log - most).exp()).sum();
    for (component, log) in components.iter_mut().zip(&logs) {
        component.weight = (log - most).exp() / sum;
    }
    components
}

/// The posterior for this order, and a standard deviation `size` of β; and the logarithm of how likely they make the
/// data. The standard deviation of runs is 1.
fn component(levels: &[Level], order: f64, size: f64) -> (f64, Component) {
    // The inverse of the covariance matrix of (μ, β) is [[a, b], [b, d]]. Sums of differences keep their digits where β
    // may be far larger than the spread.
    let x: Vec<f64> = levels
        .iter()
        .map(|level| (level.step / REFERENCE_STEP).powf(order))
        .collect();
    let weights = || levels.iter().map(|level| level.runs as f64).zip(&x);
    let means = || levels.iter().map(|level| level.mean);
    let free = 1.0 / (size * size);
    let a: f64 = weights().map(|(weight, _)| weight).sum();
    let d = free + weights().map(|(weight, x)| weight * x * x).sum::<f64>();
    let middle = weights().map(|(weight, x)| weight * x).sum::<f64>() / a;
    let apart = weights().map(|(weight, x)| weight * (x - middle).powi(2));
    let determinant = a * (free + apart.sum::<f64>());
    let share = |(weight, own): (f64, &f64)| {
        let others = weights().map(|(weight, x)| weight * x * (x - own));
        (free + others.sum::<f64>()) / determinant * weight
    };
    let shares: Vec<f64> = weights().map(share).collect();
    let parts = shares.iter().zip(means());
    let value: f64 = parts.map(|(share, mean)| share * mean).sum();
    let off = |((weight, x), mean): ((f64, &f64), f64)| weight * (x - middle) * mean;
    let error = a * weights().zip(means()).map(off).sum::<f64>() / determinant;
    let fit = |((weight, x), mean): ((f64, &f64), f64)| weight * mean * (value + x * error);
    let fitted: f64 = weights().zip(means()).map(fit).sum();
    let log = 0.5 * fitted - 0.5 * (size * size * determinant).ln();
    let component = Component {
        weight: 0.0,
        order,
        value,
        variance: d / determinant,
        error,
        shares,
    };
    (log, component)
}
