//! The values of one measurement, and what they say about its limit.

use serde::{Deserialize, Serialize};

use super::limit::{Level, Limit};
use super::prior::Prior;
use super::wanted::Tolerance;
use analysis::round;
use analysis::statistics::{MeanStd, student};

/// The values of one measurement at each step, from the finest to the coarsest, in the order of the seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The steps, seconds.
    pub steps: Vec<f64>,
    /// The values at each step; `None` for runs without one.
    pub values: Vec<Vec<Option<f64>>>,
}

/// A value with its errors: half widths of confidence intervals.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reached {
    /// The value.
    pub value: f64,
    /// The half width from the seeds and the step together.
    pub error: f64,
    /// That from the seeds alone.
    pub seeds: f64,
    /// That from the step alone.
    pub step: f64,
}

/// The runs of a measurement in short: the mean at each step, and one variance.
#[derive(Debug, Clone, PartialEq)]
pub struct Means {
    /// The levels with values.
    pub levels: Vec<Level>,
    /// The variance of single runs, over all levels.
    pub variance: f64,
    /// Its degrees of freedom.
    pub(super) degrees: f64,
    /// Those that come from these runs, and not from what was known before.
    pub(super) own_degrees: f64,
    /// What was known before.
    pub(super) prior: Prior,
}

impl Reached {
    /// The half width in percent of the value, as `2.1 %`; `None` if the value is 0.
    pub fn percent(&self) -> Option<String> {
        let part = 100.0 * self.error / self.value.abs();
        part.is_finite()
            .then(|| format!("{} %", round::brief(part)))
    }
}

impl Series {
    /// Mean at each step and variance, of which `prior` was known; `None` with fewer than two values at any step.
    pub fn means(&self, prior: &Prior) -> Option<Means> {
        let (mut levels, mut squares, mut own_degrees) = (Vec::new(), 0.0, 0.0);
        for (&step, values) in self.steps.iter().zip(&self.values) {
            let known: Vec<f64> = values.iter().flatten().copied().collect();
            let Some(of) = MeanStd::of(&known) else {
                continue;
            };
            let (runs, mean) = (of.count, of.mean);
            levels.push(Level { step, runs, mean });
            own_degrees += (runs - 1) as f64;
            squares += of.std().map_or(0.0, |std| (runs - 1) as f64 * std * std);
        }
        let finest = levels.first().filter(|_| own_degrees > 0.0)?;
        let [variance, degrees] = prior.variance(squares, own_degrees, finest.mean);
        Some(Means {
            levels,
            variance,
            degrees,
            own_degrees,
            prior: prior.clone(),
        })
    }
}

impl Means {
    /// The means before the first run, of a result whose value is 1; `None` if no spread is known.
    pub fn expected(prior: &Prior) -> Option<Self> {
        let (spread, degrees) = prior.spread()?;
        Some(Self {
            levels: Vec::new(),
            variance: spread * spread,
            degrees,
            own_degrees: 0.0,
            prior: prior.clone(),
        })
    }

    /// The half width of a confidence interval, in standard errors.
    pub fn width(&self, confidence: f64) -> f64 {
        student((self.degrees as usize).max(1), confidence).unwrap_or(f64::INFINITY)
    }

    /// The value in the limit of fine steps.
    pub fn limit(&self) -> Limit {
        Limit::of(&self.levels, self.variance, &self.prior.shares)
    }

    /// The value in the limit of fine steps with its errors.
    pub fn reached(&self, confidence: f64) -> Reached {
        self.errors(&self.limit(), confidence)
    }

    /// The same from the limit of these means.
    pub fn errors(&self, limit: &Limit, confidence: f64) -> Reached {
        let width = self.width(confidence);
        let of_step = (limit.variance - limit.from_seeds).max(0.0);
        Reached {
            value: limit.value,
            error: width * limit.variance.sqrt(),
            seeds: width * limit.from_seeds.sqrt(),
            step: width * of_step.sqrt(),
        }
    }

    /// By how much the variance of the limit exceeds what the error allows, as a logarithm; 0 if it does not.
    pub fn excess(&self, tolerance: Tolerance, confidence: f64) -> f64 {
        let limit = self.limit();
        let allowed = tolerance.of(limit.value) / self.width(confidence);
        match limit.variance > 0.0 {
            true => (limit.variance.sqrt() / allowed).ln().max(0.0),
            false => 0.0,
        }
    }

    /// Means of these numbers of runs at each of `steps`, whose means are as expected and whose spread is known.
    pub fn afresh(&self, expected: &Limit, steps: &[f64], counts: &[usize]) -> Self {
        let none = Self {
            levels: Vec::new(),
            degrees: self.prior.degrees(),
            ..self.clone()
        };
        none.with(expected, steps, counts)
    }

    /// The same after further runs at each of `steps`, whose means are as expected.
    pub fn with(&self, expected: &Limit, steps: &[f64], further: &[usize]) -> Self {
        let mut after = self.clone();
        for (&step, &runs) in steps.iter().zip(further).filter(|(_, runs)| **runs > 0) {
            match after.levels.iter_mut().find(|level| level.step == step) {
                Some(level) => {
                    level.runs += runs;
                    after.degrees += runs as f64;
                }
                None => {
                    after.degrees += (runs - 1) as f64;
                    let mean = expected.at(step);
                    after.levels.push(Level { step, runs, mean });
                }
            }
        }
        after.levels.sort_by(|a, b| a.step.total_cmp(&b.step));
        after
    }
}
