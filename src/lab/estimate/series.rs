//! The values of one measurement, and what they say about its limit.

use std::cell::RefCell;
use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use super::limit::{Level, Limit};
use super::prior::Prior;
use super::wanted::Tolerance;
use analysis::round;
use analysis::statistics::{MeanStd, student, upper_std};

/// Fewer runs than this do not say how far a result varies: an estimate that ends after the first of them that happen
/// to agree ends too early. 95 % of the results that have the same value in all of them have another value in at most
/// 14 % of runs.
pub(super) const FEWEST: usize = 20;
/// An estimate ends when an upper limit of the spread, which holds with this probability, makes its error small enough.
const CAUTION: f64 = 0.7;
/// The part by which skewness, over √n, widens the error from the seeds. Johnson's t (1978) has (1 + 2 t²)/6 t, about
/// this at 95 %, for the longer side; few runs know their skewness badly.
const SKEWED: f64 = 0.7;

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
    /// The skewness of single runs, over all levels; 0 if it is not known.
    pub(super) skewness: f64,
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
        let mut residuals = Vec::new();
        for (&step, values) in self.steps.iter().zip(&self.values) {
            let known: Vec<f64> = values.iter().flatten().copied().collect();
            let Some(of) = MeanStd::of(&known) else {
                continue;
            };
            let (runs, mean) = (of.count, of.mean);
            levels.push(Level { step, runs, mean });
            own_degrees += (runs - 1) as f64;
            residuals.extend(known.iter().map(|value| value - mean));
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
            skewness: skewness(&residuals),
        })
    }
}

/// A quantile that plans need many times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Quantile {
    Student,
    UpperStd,
}

/// A quantile with these degrees of freedom and this probability, computed once per thread.
fn remembered(kind: Quantile, degrees: usize, probability: f64) -> f64 {
    type Key = (Quantile, usize, u64);
    thread_local! {
        static KNOWN: RefCell<HashMap<Key, f64>> = RefCell::default();
    }
    let compute = || match kind {
        Quantile::Student => student(degrees, probability),
        Quantile::UpperStd => upper_std(degrees, probability),
    };
    KNOWN.with_borrow_mut(|known| {
        let key = (kind, degrees, probability.to_bits());
        *known
            .entry(key)
            .or_insert_with(|| compute().unwrap_or(f64::INFINITY))
    })
}

/// The skewness of values around 0: G₁ of Joanes and Gill (1998); 0 for fewer than three values or without spread.
fn skewness(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let moment = |power| values.iter().map(|value| value.powi(power)).sum::<f64>() / count;
    let spread = moment(2).sqrt();
    if count < 3.0 || spread == 0.0 {
        return 0.0;
    }
    moment(3) / spread.powi(3) * (count * (count - 1.0)).sqrt() / (count - 2.0)
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
            skewness: 0.0,
        })
    }

    /// The half width of a confidence interval, in standard errors.
    pub fn width(&self, confidence: f64) -> f64 {
        let degrees = (self.degrees as usize).max(1);
        remembered(Quantile::Student, degrees, confidence)
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
        let from_seeds = self.of_seeds(limit);
        Reached {
            value: limit.value,
            error: width * (of_step + from_seeds).sqrt(),
            seeds: width * from_seeds.sqrt(),
            step: width * of_step.sqrt(),
        }
    }

    /// The variance of a limit from the seeds, larger where the runs are skewed.
    fn of_seeds(&self, limit: &Limit) -> f64 {
        if self.variance == 0.0 {
            return limit.from_seeds;
        }
        let per_root_of_runs = (limit.from_seeds / self.variance).sqrt();
        let longer = 1.0 + SKEWED * self.skewness.abs() * per_root_of_runs;
        limit.from_seeds * longer.powi(2)
    }

    /// The factor by which the spread may be larger than these runs say.
    fn caution(&self) -> f64 {
        remembered(Quantile::UpperStd, (self.degrees as usize).max(1), CAUTION)
    }

    /// The standard deviation of the logarithm of the spread.
    pub(super) fn spread_uncertainty(&self) -> f64 {
        (0.5 / self.degrees.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// By how much the variance of the limit exceeds what the error allows, as a logarithm; 0 if it does not.
    pub fn excess(&self, tolerance: Tolerance, confidence: f64) -> f64 {
        let limit = self.limit();
        let error = self.errors(&limit, confidence).error * self.caution();
        match error > 0.0 {
            true => (error / tolerance.of(limit.value)).ln().max(0.0),
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
            let mean = expected.at(step);
            match after.levels.iter_mut().find(|level| level.step == step) {
                Some(level) => {
                    level.runs += runs;
                    level.mean += (mean - level.mean) * runs as f64 / level.runs as f64;
                    after.degrees += runs as f64;
                }
                None => {
                    after.degrees += (runs - 1) as f64;
                    after.levels.push(Level { step, runs, mean });
                }
            }
        }
        after.levels.sort_by(|a, b| a.step.total_cmp(&b.step));
        after
    }
}
