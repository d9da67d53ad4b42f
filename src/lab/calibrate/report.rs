//! The report of a calibration.

use serde::Serialize;
use serde_json::{Map, Value, json};

use super::evaluate::Sample;
use super::residual::{noise, residual, root_mean_square};
use super::scene::{Set, Target};
use super::search::{Calibrated, Stage, Trial};
use super::study::Calibration;
use runs::identity::ENGINE;

/// A parameter is not identified if its interval covers more than this fraction of its bounds.
const MOST: f64 = 0.5;
/// A parameter is at a bound if it is closer to it than this fraction of the bounds.
const NEAR: f64 = 0.02;

/// A calibration with its results.
pub struct Report<'a> {
    /// The calibration.
    pub calibration: &'a Calibration,
    /// The results.
    pub found: Calibrated,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterResult {
    /// Its name.
    pub name: String,
    /// Its value at the start.
    pub start: f64,
    /// Its value at the best point.
    pub best: f64,
    /// The bounds.
    pub bounds: [f64; 2],
    /// Its 95 % interval; `None` if it was not searched.
    pub interval: Option<[f64; 2]>,
    /// The fraction of the bounds that the interval covers, on the scale of the search.
    pub covers: Option<f64>,
    /// Whether the values determine it: its interval covers at most half of the bounds.
    pub identified: bool,
    /// Whether it is at a bound. Then its optimum may lie outside.
    pub at_bound: bool,
}

/// The deviation of the runs of one point from one measured value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Errors {
    /// The mean over the seeds that gave a value.
    pub mean: Option<f64>,
    /// Its difference from the measured value, as a fraction of the measured value.
    pub error: Option<f64>,
    /// The residual, tolerances.
    pub residual: Option<f64>,
    /// The standard deviation over the seeds.
    pub deviation: Option<f64>,
    /// The standard error of the mean, tolerances.
    pub noise: Option<f64>,
    /// The reasons of the failed runs, by seed.
    pub failures: Vec<String>,
}

/// A measured value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValueResult {
    /// What it is compared for.
    pub set: Set,
    /// Its case or scenario.
    pub of: String,
    /// The quantity.
    pub quantity: String,
    /// The measured value.
    pub measured: f64,
    /// The tolerance, as a fraction of the measured value.
    pub tolerance: f64,
    /// With the starting point.
    pub start: Errors,
    /// With the best point.
    pub best: Errors,
}

/// The values of one set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SetResult {
    /// The set.
    pub set: Set,
    /// The number of its values.
    pub values: usize,
    /// The root mean square of the residuals with the starting point, tolerances.
    pub start: f64,
    /// The same with the best point.
    pub best: f64,
    /// The number of values within the tolerance with the best point.
    pub within: usize,
}

impl Errors {
    fn of(sample: &Sample, target: &Target, calibration: &Calibration) -> Self {
        let values = sample.values();
        let failures = sample.runs.iter().filter_map(|run| run.as_ref().err());
        Self {
            mean: values.map(|of| of.mean),
            error: values.map(|of| of.mean / target.measured - 1.0),
            residual: residual(sample, target, &calibration.rule),
            deviation: values.and_then(|of| of.std()),
            noise: noise(sample, target),
            failures: failures.cloned().collect(),
        }
    }

    /// Whether the value is within the tolerance with all seeds.
    fn is_within(&self, tolerance: f64) -> bool {
        let error = self.error.is_some_and(|error| error.abs() <= tolerance);
        error && self.failures.is_empty()
    }
}

impl Report<'_> {
    pub(super) fn best(&self) -> &Trial {
        &self.found.trials[self.found.best]
    }

    /// The parameters.
    pub fn parameters(&self) -> Vec<ParameterResult> {
        let point = &self.best().evaluated.point;
        let all = self.calibration.parameters.iter().zip(point).enumerate();
        let result = |(k, (parameter, &at)): (usize, (&super::Parameter, &f64))| {
            let searched = self.found.searched.iter().position(|&own| own == k);
            let ends = searched.map(|k| {
                let half = self.found.knowledge.half_width(k);
                [at - half, at + half].map(|end| end.clamp(0.0, 1.0))
            });
            let covers = ends.map(|[low, high]| high - low);
            ParameterResult {
                name: parameter.name.clone(),
                start: parameter.start,
                best: parameter.value(at),
                bounds: parameter.bounds,
                interval: ends.map(|ends| ends.map(|end| parameter.value(end))),
                covers,
                identified: covers.is_some_and(|part| part <= MOST),
                at_bound: searched.is_some() && !(NEAR..=1.0 - NEAR).contains(&at),
            }
        };
        all.map(result).collect()
    }

    /// The values of all sets.
    pub fn values(&self) -> Vec<ValueResult> {
        let of = self.calibration;
        let result = |(k, target): (usize, &Target)| {
            let [start, best] = self.found.compared.each_ref().map(|at| &at.samples[k]);
            ValueResult {
                set: target.set,
                of: target.of.clone(),
                quantity: target.quantity.clone(),
                measured: target.measured,
                tolerance: target.tolerance,
                start: Errors::of(start, target, of),
                best: Errors::of(best, target, of),
            }
        };
        of.targets.iter().enumerate().map(result).collect()
    }

    /// How close the runs come to the values of each set that has any.
    pub fn sets(&self) -> Vec<SetResult> {
        let (of, values) = (self.calibration, self.values());
        let result = |set: Set| {
            let [start, best] = self.found.compared.each_ref().map(|at| {
                let own = at.samples.iter().zip(&of.targets);
                root_mean_square(own.filter(|(_, target)| target.set == set), &of.rule)
            });
            let own = || values.iter().filter(|value| value.set == set);
            let within = own().filter(|value| value.best.is_within(value.tolerance));
            Some(SetResult {
                set,
                values: own().count(),
                start: start?,
                best: best?,
                within: within.count(),
            })
        };
        Set::ALL.into_iter().filter_map(result).collect()
    }

    /// The number of trials of the search, the number of all trials, and the number of their runs without a value.
    pub(super) fn counts(&self) -> [usize; 3] {
        let trials = &self.found.trials;
        let in_search = |trial: &&Trial| matches!(trial.stage, Stage::Generation(_));
        let failures = trials.iter().map(|trial| trial.evaluated.failures()).sum();
        [
            trials.iter().filter(in_search).count(),
            trials.len(),
            failures,
        ]
    }

    /// All results as one object. It contains no times and no paths, so equal calibrations give equal bytes.
    pub fn json(&self) -> Value {
        let of = self.calibration;
        let [_, points, failures] = self.counts();
        let searched = 0..self.found.searched.len();
        let correlations = searched.clone().map(|a| {
            let of = &self.found.knowledge;
            let row = searched.clone().map(|b| of.correlation(a, b));
            row.collect::<Vec<_>>()
        });
        let names = of.parameters.iter().map(|one| one.name.as_str());
        let screening = self.found.screened.as_ref().map(|screened| {
            json!({"parameters": names.collect::<Vec<_>>(), "misfit": screened.misfit, "values": screened.values})
        });
        let generations = self.found.generations.iter().map(|generation| {
            json!({"misfits": generation.misfits, "best": generation.best, "spread": generation.spread})
        });
        json!({
            "calibration": of.name,
            "file": of.document,
            "engine": ENGINE,
            "settings": self.settings(),
            "parameters": self.parameters(),
            "searched": self.found.searched.iter().map(|&k| &of.parameters[k].name).collect::<Vec<_>>(),
            "correlations": correlations.collect::<Vec<_>>(),
            "misfits": self.sets(),
            "values": self.values(),
            "screening": screening,
            "generations": generations.collect::<Vec<_>>(),
            "points": points,
            "values_missing": failures,
        })
    }

    /// The keys of the best point with their values, as a scenario's settings.
    fn settings(&self) -> Value {
        let parameters = self.calibration.parameters.iter();
        let both = parameters.zip(&self.best().evaluated.point);
        let keys = both.flat_map(|(parameter, &at)| {
            let value = parameter.written(parameter.value(at));
            let keys = parameter.keys.iter();
            keys.map(move |key| (key.clone(), value.clone()))
        });
        Value::Object(keys.collect::<Map<_, _>>())
    }
}
