//! The spread of a result over the parameter sets of a profile: sets that meet the experiments as well as each other.

use serde::Serialize;

use super::question::Question;
use super::run::{Outcomes, Runs};
use crate::error::LabError;
use crate::model::SHARE;
use crate::sweep::number;
use analysis::round;
use analysis::statistics::{MeanStd, student};
use runs::case::Case;
use runs::error::RunError;
use runs::job::Listener;
use runs::store::Store;
use scenario::calibrated;
use scenario::quote::shown;

/// The runs with each set.
const SEEDS: usize = 2;

/// The runs with each parameter set of a profile, at the step of the preset.
pub struct Ensemble {
    sets: Vec<Outcomes>,
}

/// The part of the parameters in the error of a result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ParametersPart {
    /// The bounds of the value over the sets, in the unit of the result.
    pub low: f64,
    /// The upper one.
    pub high: f64,
    /// The share of such sets between the bounds.
    pub share: f64,
    /// The number of sets with a value.
    pub sets: usize,
    /// The number of runs with them.
    pub runs: usize,
}

impl Ensemble {
    /// Why a question has no ensemble; `None` if it has one.
    pub fn refused(question: &Question) -> Result<Option<String>, LabError> {
        let profile = &question.title[1];
        let scenario = question.scenario()?;
        if calibrated::ensemble(profile).is_empty() {
            let name = shown(profile);
            return Ok(Some(format!(
                "the profile `{name}` has no parameter sets; `steer+sph` has"
            )));
        }
        Ok(crate::model::changes_profile(&scenario).then(|| {
            "the scenario has `parameters` of its own, which the sets would replace; remove them".to_owned()
        }))
    }

    /// Makes the runs.
    ///
    /// # Errors
    /// Results cannot be stored, or a run is invalid.
    pub fn of(runs: &Runs, store: &Store, listener: &dyn Listener) -> Result<Self, LabError> {
        let question = runs.question;
        let sets = calibrated::ensemble(&question.title[1]);
        let cases = (0..sets.len() * SEEDS).map(|k| {
            let (set, seed) = (k / SEEDS, k % SEEDS);
            let case = question.with_parameters(&sets[set], seed)?;
            Ok((
                case,
                format!("parameter set {}, seed {}", set + 1, question.seed(seed)),
            ))
        });
        let cases: Vec<Result<(Case, String), RunError>> = cases.collect();
        let results = runs.results_of(cases, store, listener)?;
        let mut results = results.into_iter();
        let sets = (0..sets.len()).map(|_| results.by_ref().take(SEEDS).collect());
        Ok(Self {
            sets: sets.collect(),
        })
    }

    /// The time of all runs, seconds on one core.
    pub fn secs(&self) -> f64 {
        let finished = self.sets.iter().flatten().flatten();
        finished.map(|result| result.wall_secs).sum()
    }

    /// The part of the parameters in a result of which single runs have this variance; `None` with fewer than two sets
    /// with values. The spread of the sets' means has the chance of their few runs in it, which is taken away.
    pub fn part(&self, name: &str, variance: f64) -> Option<ParametersPart> {
        let of_set = |set: &Outcomes| -> Vec<f64> {
            let finished = set.iter().flatten();
            finished.filter_map(|result| number(result, name)).collect()
        };
        let values: Vec<Vec<f64>> = self.sets.iter().map(of_set).collect();
        let valued = || values.iter().filter(|values| !values.is_empty());
        let means: Vec<f64> = valued()
            .filter_map(|values| Some(MeanStd::of(values)?.mean))
            .collect();
        let over_sets = MeanStd::of(&means)?;
        let chance = valued().map(|values| variance / values.len() as f64);
        let chance = chance.sum::<f64>() / means.len() as f64;
        let spread = (over_sets.std()?.powi(2) - chance).max(0.0).sqrt();
        let width = spread * student(means.len() - 1, SHARE)?;
        Some(ParametersPart {
            low: over_sets.mean - width,
            high: over_sets.mean + width,
            share: SHARE,
            sets: means.len(),
            runs: values.iter().map(Vec::len).sum(),
        })
    }
}

impl ParametersPart {
    /// In words, around this value, with numbers written as `written` does.
    pub fn text(&self, value: f64, written: impl Fn(f64) -> String) -> String {
        let [low, high] = crate::model::around(value, [self.low, self.high], written);
        format!(
            "parameters {low} … {high} ({} %; {} sets, {} runs)",
            round::brief(100.0 * self.share),
            self.sets,
            self.runs
        )
    }
}
