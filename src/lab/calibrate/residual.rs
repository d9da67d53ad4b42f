//! The residuals of runs: their distances from the measured values, in tolerances.

use super::evaluate::{Evaluated, Sample};
use super::file::Rule;
use super::scene::Target;
use crate::suite::in_tolerances;

/// The ratio of a value to the measured one in tolerances.
pub fn ratio(value: f64, target: &Target) -> f64 {
    in_tolerances(value, [target.measured, target.tolerance])
}

/// The residual of the mean over the seeds that gave a value, clipped; `None` without values.
pub fn residual(sample: &Sample, target: &Target, rule: &Rule) -> Option<f64> {
    let mean = sample.values()?.mean;
    Some(ratio(mean, target).clamp(-rule.clip, rule.clip))
}

/// The square of the residual; failed runs enter with the penalty.
pub fn square(sample: &Sample, target: &Target, rule: &Rule) -> f64 {
    let failed = sample.failed();
    let own = residual(sample, target, rule).unwrap_or(rule.penalty);
    (1.0 - failed) * own * own + failed * rule.penalty * rule.penalty
}

/// The root of the mean square over some targets, tolerances: what the search minimizes, over the targets of the fit.
/// `None` without targets.
pub fn root_mean_square<'a>(
    samples: impl Iterator<Item = (&'a Sample, &'a Target)>,
    rule: &Rule,
) -> Option<f64> {
    let squares: Vec<f64> = samples
        .map(|(sample, target)| square(sample, target, rule))
        .collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (!squares.is_empty()).then(|| mean.sqrt())
}

/// The standard error of the mean over seeds, in tolerances; `None` for fewer than two values.
pub fn noise(sample: &Sample, target: &Target) -> Option<f64> {
    let values = sample.values().filter(|values| values.count > 1)?;
    Some(values.error() / values.mean / target.tolerance.ln_1p())
}

impl Evaluated {
    /// The root of the mean square over these targets, to which its samples belong.
    pub fn misfit(&self, targets: &[&Target], rule: &Rule) -> f64 {
        let samples = self.samples.iter().zip(targets.iter().copied());
        root_mean_square(samples, rule).unwrap_or(f64::INFINITY)
    }

    /// The number of runs that gave no value, summed over the values.
    pub fn failures(&self) -> usize {
        let runs = self.samples.iter().flat_map(|sample| &sample.runs);
        runs.filter(|run| run.is_err()).count()
    }
}
