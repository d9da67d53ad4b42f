//! What runs with a preset alone would cost for the same errors.

use serde::Serialize;
use serde_json::json;

use super::limit::Limit;
use super::question::Question;
use super::series::{Means, Reached};
use crate::error::LabError;
use crate::jobs::{Results, finished};
use crate::sweep::plain;
use runs::case::{Case, RunResult};
use runs::error::RunError;
use runs::job::{self, Job, Listener};
use runs::store::Store;
use scenario::Preset;

/// The number of runs of each preset that are timed.
const TIMED: usize = 3;
/// The presets that are timed.
const PRESETS: [Preset; 3] = [Preset::Paper, Preset::Fast, Preset::Accurate];

/// Runs with a preset.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Timed {
    /// The preset.
    pub preset: Preset,
    /// Its time step, seconds.
    pub step: f64,
    /// The mean time of a run, seconds on one core.
    pub secs: f64,
}

/// What runs with a preset alone would give for a result. The error of the step is known from the runs of the estimate:
/// without these, it would not be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct OfPreset {
    /// The preset, and the time of a run.
    #[serde(flatten)]
    pub timed: Timed,
    /// The error of the step in the mean.
    pub error_of_step: f64,
    /// Half the width of the interval that the chance of a single run gives.
    pub chance: f64,
    /// The number of runs for the same error, if the error of the step is known; `None` if that alone is larger.
    pub runs: Option<f64>,
    /// The number of runs at this step and at half of it for the same error, if the error of the step is found from
    /// them: 2 y(h/2) − y(h), right for errors of first order, has the variance 5 σ² / n.
    pub runs_at_two_steps: f64,
}

/// What the errors of all results would cost with a preset.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Cost {
    /// The preset, and the time of a run.
    #[serde(flatten)]
    pub timed: Timed,
    /// The time of all runs, seconds on one core, if the error of the step is known; `None` if no number of runs gives
    /// these errors.
    pub all_secs: Option<f64>,
    /// The time of all runs at this step and at half of it, seconds on one core, if its error is found from them.
    pub two_steps_secs: f64,
}

impl Timed {
    /// Makes a few runs with each preset that are not in the store yet.
    ///
    /// # Errors
    /// A run fails, or results cannot be stored.
    pub(super) fn of_presets(
        question: &Question,
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<Vec<Self>, LabError> {
        let invalid = |error: RunError| LabError::of(question.title[0].clone(), error);
        let places = PRESETS
            .iter()
            .flat_map(|&of| (0..TIMED).map(move |k| (of, k)));
        let cases = places.clone().map(|(of, k)| question.with_preset(of, k));
        let cases: Vec<Case> = cases.collect::<Result<_, _>>().map_err(invalid)?;
        let jobs = cases.iter().zip(places);
        let jobs: Vec<Job> = jobs
            .map(|(case, (of, _))| case.job(format!("{}, seed {}", name(of), case.seed)))
            .collect();
        finished(&job::run(&jobs, store, question.memory(), listener)?)?;
        let results = Results(store);
        let timed = PRESETS.iter().zip(cases.chunks(TIMED));
        let timed = timed.map(|(&preset, cases)| {
            let scenario = cases[0].scenario();
            let scenario = scenario.map_err(|error| invalid(error.into()))?;
            let secs = cases.iter().map(|case| {
                let result: RunResult = results.of(&name(preset), &case.key)?;
                Ok(result.wall_secs)
            });
            let secs: Vec<f64> = secs.collect::<Result<_, LabError>>()?;
            Ok(Self {
                preset,
                step: scenario.scene.clock.time_step(),
                secs: secs.iter().sum::<f64>() / secs.len() as f64,
            })
        });
        timed.collect()
    }
}

impl OfPreset {
    /// From the runs of an estimate.
    pub(super) fn of(timed: Timed, means: &Means, limit: &Limit, asked: (Reached, f64)) -> Self {
        let (reached, confidence) = asked;
        let error_of_step = limit.error_at(timed.step);
        let chance = means.width(confidence) * means.variance.sqrt();
        let room = reached.error.powi(2) - error_of_step.powi(2);
        Self {
            timed,
            error_of_step,
            chance,
            runs: (room > 0.0).then(|| (chance * chance / room).max(1.0)),
            runs_at_two_steps: (5.0 * (chance / reached.error).powi(2)).max(2.0),
        }
    }

    /// The error of the mean of this number of runs: from chance, which falls with their number, and the step, which
    /// does not.
    pub fn error(&self, runs: f64) -> f64 {
        (self.chance / runs.sqrt()).hypot(self.error_of_step)
    }
}

impl Cost {
    /// What all results of an estimate would cost, from what each of them would.
    pub(super) fn of_all<'a>(results: impl Iterator<Item = &'a OfPreset>, timed: Timed) -> Self {
        let own = results.filter(|of| of.timed.preset == timed.preset && of.chance > 0.0);
        let own: Vec<&OfPreset> = own.collect();
        let at_two = own.iter().map(|of| of.runs_at_two_steps);
        let at_two = at_two.fold(2.0, f64::max).ceil();
        let runs = own.iter().map(|of| of.runs).collect::<Option<Vec<f64>>>();
        let most = runs.map(|runs| runs.into_iter().fold(1.0, f64::max).ceil());
        Self {
            timed,
            all_secs: most.map(|runs| runs * timed.secs),
            two_steps_secs: 3.0 * at_two * timed.secs, // half the step takes twice the time
        }
    }
}

/// The name of a preset.
pub(super) fn name(preset: Preset) -> String {
    plain(&json!(preset))
}
