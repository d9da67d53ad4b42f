//! The answer to a question: values with their errors, and what they cost.

use serde::Serialize;
use serde_json::{Value, json};

use super::bounds::Bounded;
use super::ensemble::{Ensemble, ParametersPart};
use super::limit::Limit;
use super::plan::Goal;
use super::run::Runs;
use super::series::{Reached, Series};
use super::wanted::Wanted;
use crate::error::LabError;
use crate::model::{Model, ModelPart};
use analysis::statistics::{MeanStd, Share};
use engine::clock::PAPER_TIME_STEP;
use runs::drive::End;
use runs::identity::ENGINE;
use scenario::Preset;

/// What ± means, in one sentence for all reports.
pub const ABOUT: &str = "± is the error from chance (seeds) and from the time step. The error of the model, its \
                         difference from people, is not in it.";

/// A wanted result.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// The value in the limit of fine steps, with the half widths of its confidence intervals.
    #[serde(flatten)]
    pub reached: Reached,
    /// The half width asked for, as typed.
    pub wanted: String,
    /// Whether the half width is at most that, and all runs have a value: without one the mean is that of other runs.
    pub is_reached: bool,
    /// The order of the error in the time step that fits the runs best, averaged over what is possible.
    pub order: f64,
    /// The standard deviation of runs at the same step, over all steps.
    pub deviation: f64,
    /// The means at each step with runs.
    pub steps: Vec<AtStep>,
    /// The number of runs without a value.
    pub missing: usize,
    /// The runs with a value among those without an error.
    pub with_value: Share,
    /// What the default settings would give: the preset `paper`.
    pub default: OfPreset,
    /// The spread over the parameter sets of the profile, if it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameters: Option<ParametersPart>,
    /// The error of the model; the reason in words if no experiment says it, `None` if it was not looked up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<ModelError>,
    /// What the means at other steps are expected to be.
    #[serde(skip)]
    pub limit: Limit,
}

/// What experiments say of the error of the model in a result.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub enum ModelError {
    /// Its bounds.
    Known(ModelPart),
    /// Why it is not known.
    Unknown {
        /// In words.
        unknown: String,
    },
}

/// A result at one time step.
#[derive(Debug, Clone, Serialize)]
pub struct AtStep {
    /// The step, seconds.
    pub step: f64,
    /// The number of runs with a value.
    pub runs: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation; `None` for fewer than two.
    pub deviation: Option<f64>,
    /// The error of the step in the mean: that the fit expects at this step, minus the value in the limit.
    pub error_of_step: f64,
    /// The values in the order of the seeds.
    pub values: Vec<Option<f64>>,
}

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

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct Answer {
    /// The scenario's name.
    pub scenario: String,
    /// Its profile.
    pub profile: String,
    /// The settings beside time step and seed.
    pub settings: Vec<String>,
    /// The probability with which the intervals hold the values.
    pub confidence: f64,
    /// The first seed.
    pub first_seed: u64,
    /// The wanted results that have values.
    pub results: Vec<Row>,
    /// Why other wanted results and bounds have no value, or one of some runs alone.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<String>,
    /// The wanted bounds.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bounds: Vec<Bounded>,
    /// The number of runs, and how they ended.
    pub runs: Counts,
    /// The computing time of all runs, seconds on one core.
    pub secs: f64,
    /// Why no more runs were made; `None` if all errors are as small as asked for.
    pub stopped: Option<String>,
}

/// How many runs there were, and how they ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Counts {
    /// The number of runs.
    pub all: usize,
    /// Those with an error.
    pub failed: usize,
    /// Those at whose end agents were stuck.
    pub stuck: usize,
    /// Those that ended because no agent arrived for some time.
    pub idle: usize,
}

impl Counts {
    /// The counts that a reader should know of, each with its name.
    pub fn notable(&self) -> impl Iterator<Item = (&'static str, Share)> {
        let named = [
            ("failed", self.failed),
            ("had stuck agents at the end", self.stuck),
            ("ended because no agent arrived for some time", self.idle),
        ];
        let all = self.all;
        let counts = named.into_iter().filter(|(_, count)| *count > 0);
        counts.map(move |(name, count)| (name, Share::of(count, all)))
    }
}

impl Answer {
    /// The answer of some runs.
    pub fn of(runs: &Runs) -> Self {
        let question = runs.question;
        let results = runs.all_results();
        let finished = || results.clone().flatten();
        let wanted = question.request.wanted.iter().zip(&runs.wanted);
        let rows = wanted.clone().filter_map(|(wanted, (series, goal))| {
            Some(Row::of(runs, wanted, series, goal.as_ref()?))
        });
        let rows: Vec<Row> = rows.collect();
        let partial = rows.iter().filter(|row| row.missing > 0).map(Row::lacking);
        let partial: Vec<String> = partial.collect();
        let asked = question.request.bounds.iter();
        let bounds: Vec<Bounded> = asked.map(|bound| runs.bounded(bound)).collect();
        let missing = wanted.filter(|(_, (_, goal))| goal.is_none());
        let valueless = missing.map(|(wanted, _)| runs.without_values(&wanted.name));
        let lost = bounds.iter().filter(|bound| bound.is_lost());
        let unbounded = lost.map(|of| format!("{}: {}", of.bound.name, of.lost()));
        let is_idle = |end| end == Some(End::Idle);
        let [scenario, profile] = question.title.clone();
        Self {
            scenario,
            profile,
            settings: question.settings.clone(),
            confidence: question.request.confidence,
            first_seed: question.first_seed,
            results: rows,
            without: valueless.chain(partial).chain(unbounded).collect(),
            bounds,
            runs: Counts {
                all: results.clone().count(),
                failed: results.clone().filter(|result| result.is_err()).count(),
                stuck: finished().filter(|run| run.summary.stuck > 0).count(),
                idle: finished().filter(|run| is_idle(run.summary.end)).count(),
            },
            secs: runs.measured_secs(),
            stopped: runs.stopped.clone(),
        }
    }

    /// The same with the error of the model, and of the parameters if there are runs with several sets of them.
    ///
    /// # Errors
    /// The scenario or data that ship with the program are invalid.
    pub fn with_model(mut self, runs: &Runs, sets: Option<&Ensemble>) -> Result<Self, LabError> {
        let model = Model::of(&runs.question.scenario()?)?;
        for row in &mut self.results {
            let finished = runs.all_at_steps().flatten().map(|result| &result.summary);
            row.model = Some(match model.part(&row.name, row.reached.value, finished) {
                Ok(part) => ModelError::Known(part),
                Err(unknown) => ModelError::Unknown { unknown },
            });
            row.parameters = sets.and_then(|sets| sets.part(&row.name, row.deviation.powi(2)));
        }
        self.secs += sets.map_or(0.0, Ensemble::secs);
        Ok(self)
    }

    /// The wanted result with this name, if it has values.
    pub fn row(&self, name: &str) -> Option<&Row> {
        self.results.iter().find(|row| row.name == name)
    }

    /// Everything as one object.
    pub fn json(&self) -> Value {
        json!({ "estimate": self, "about": ABOUT, "engine": ENGINE })
    }
}

impl Row {
    fn of(runs: &Runs, wanted: &Wanted, series: &Series, goal: &Goal) -> Self {
        let Goal { means, limit, .. } = goal;
        let confidence = runs.question.request.confidence;
        let reached = goal.reached(confidence);
        let levels = series.steps.iter().zip(&series.values);
        let steps = levels.filter_map(|(&step, values)| {
            let known: Vec<f64> = values.iter().flatten().copied().collect();
            let of = MeanStd::of(&known)?;
            Some(AtStep {
                step,
                runs: of.count,
                mean: of.mean,
                deviation: of.std(),
                error_of_step: limit.error_at(step),
                values: values.clone(),
            })
        });
        let deviation = means.variance.sqrt();
        let default = Timed {
            preset: Preset::Paper,
            step: PAPER_TIME_STEP,
            secs: secs_at(runs, PAPER_TIME_STEP),
        };
        let chance = means.width(confidence) * deviation;
        let values = series.values.iter().flatten();
        let missing = values.filter(|value| value.is_none()).count();
        let finished = runs.all_at_steps().flatten().count();
        let valued: usize = means.levels.iter().map(|level| level.runs).sum();
        Self {
            name: wanted.name.clone(),
            reached,
            wanted: wanted.error.to_string(),
            is_reached: missing == 0 && reached.error <= wanted.error.of(reached.value),
            order: limit.order,
            deviation,
            steps: steps.collect(),
            missing,
            with_value: Share::of(valued, finished),
            default: OfPreset::new(default, limit, [chance, reached.error]),
            parameters: None,
            model: None,
            limit: limit.clone(),
        }
    }

    /// What it means that some runs have no value.
    fn lacking(&self) -> String {
        let (name, with) = (&self.name, self.with_value);
        format!(
            "{name}: {} of {} runs have a value, {with}; the mean is theirs alone, so it is not reached. A longer \
             duration may give all runs one, and in `--bound {name}=95%` runs without one count as beyond all others",
            with.count, with.of
        )
    }

    /// The number of runs with a value.
    pub(super) fn runs(&self) -> usize {
        self.steps.iter().map(|at| at.runs).sum()
    }
}

impl OfPreset {
    /// For the error that a result has.
    pub fn of(timed: Timed, row: &Row) -> Self {
        Self::new(timed, &row.limit, [row.default.chance, row.reached.error])
    }

    fn new(timed: Timed, limit: &Limit, [chance, error]: [f64; 2]) -> Self {
        let error_of_step = limit.error_at(timed.step);
        let room = error.powi(2) - error_of_step.powi(2);
        Self {
            timed,
            error_of_step,
            chance,
            runs: (room > 0.0).then(|| (chance * chance / room).max(1.0)),
            runs_at_two_steps: (5.0 * (chance / error).powi(2)).max(2.0),
        }
    }

    /// The error of the mean of this number of runs: from chance, which falls with their number, and the step, which
    /// does not.
    pub fn error(&self, runs: f64) -> f64 {
        (self.chance / runs.sqrt()).hypot(self.error_of_step)
    }
}

/// The time of a run at this step, seconds on one core: that of the runs made, in proportion to their frames.
fn secs_at(runs: &Runs, step: f64) -> f64 {
    let start = &runs.levels[runs.question.start];
    runs.measured_factor() * start.expected_secs * start.rung.step / step
}
