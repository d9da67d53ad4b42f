//! The answer to a question: values with their errors, and what they cost.

use serde::Serialize;
use serde_json::{Value, json};

use super::bounds::Bounded;
use super::costs::{Cost, OfPreset, Timed};
use super::limit::Limit;
use super::run::Runs;
use super::series::Reached;
use super::validated::Validated;
use super::wanted::Wanted;
use analysis::statistics::{MeanStd, Share};
use engine::clock::PAPER_TIME_STEP;
use runs::drive::End;
use runs::identity::ENGINE;
use scenario::Preset;

/// What ± means, in one sentence for all reports.
pub const ABOUT: &str = "± is the error from chance (seeds) and from the time step. It is not the error of the model: \
                         docs/findings/validation.md compares that with experiments.";

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
    /// Whether the half width is at most that.
    pub is_reached: bool,
    /// The order of the error in the time step that fits the runs best, averaged over what is possible.
    pub order: f64,
    /// The standard deviation of runs at the same step, over all steps.
    pub deviation: f64,
    /// The means at each step with runs.
    pub steps: Vec<AtStep>,
    /// The number of runs without a value.
    pub missing: usize,
    /// What the default settings would give: the preset `paper`.
    pub default: OfPreset,
    /// What each preset would give, if its runs were timed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub presets: Vec<OfPreset>,
    /// What the means at other steps are expected to be.
    #[serde(skip)]
    pub limit: Limit,
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
    /// Why the other wanted results and bounds have none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub without: Vec<String>,
    /// The wanted bounds.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bounds: Vec<Bounded>,
    /// The number of runs, and how they ended.
    pub runs: Counts,
    /// The computing time of all runs, seconds on one core.
    pub secs: f64,
    /// What the errors of all results would cost with each preset, if its runs were timed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<Cost>,
    /// What is known of the error of the model; empty if it was not looked up.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub validation: Vec<Validated>,
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
        let counts = [
            ("failed", self.failed),
            ("had stuck agents at the end", self.stuck),
            ("ended because no agent arrived for some time", self.idle),
        ];
        let all = self.all;
        let counts = counts.into_iter().filter(|(_, count)| *count > 0);
        counts.map(move |(name, count)| (name, Share::of(count, all)))
    }
}

impl Answer {
    /// The answer of some runs.
    pub fn of(runs: &Runs) -> Self {
        let question = runs.question;
        let results = runs.all_results();
        let finished = || results.clone().flatten();
        let wanted = question.request.wanted.iter().enumerate();
        let rows: Vec<Row> = wanted
            .clone()
            .filter_map(|(k, wanted)| Row::of(runs, k, wanted))
            .collect();
        let bounds = question.request.bounds.iter();
        let bounds: Vec<Bounded> = bounds.map(|bound| runs.bounded(bound)).collect();
        let without = wanted.filter(|(k, _)| runs.series(*k).means(&runs.priors[*k]).is_none());
        let without = without.map(|(_, wanted)| runs.without_values(&wanted.name));
        let unbounded = bounds.iter().filter(|bound| bound.is_lost());
        let unbounded = unbounded.map(|bound| format!("{}: {}", bound.name, bound.lost()));
        let without = without.chain(unbounded).collect();
        let of_presets = || rows.iter().flat_map(|row| &row.presets);
        let costs = runs.timed.iter();
        let costs = costs.map(|&timed| Cost::of_all(of_presets(), timed));
        let costs = costs.collect();
        let [scenario, profile] = question.title.clone();
        Self {
            scenario,
            profile,
            settings: question.settings.clone(),
            confidence: question.request.confidence,
            first_seed: question.first_seed,
            results: rows,
            without,
            bounds,
            runs: Counts {
                all: results.clone().count(),
                failed: results.clone().filter(|result| result.is_err()).count(),
                stuck: finished().filter(|result| result.summary.stuck > 0).count(),
                idle: finished()
                    .filter(|result| result.summary.end == Some(End::Idle))
                    .count(),
            },
            secs: runs.measured_secs(),
            costs,
            validation: Vec::new(),
            stopped: runs.stopped.clone(),
        }
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
    fn of(runs: &Runs, k: usize, wanted: &Wanted) -> Option<Self> {
        let series = runs.series(k);
        let means = series.means(&runs.priors[k])?;
        let confidence = runs.question.request.confidence;
        let (reached, limit) = means.reached(confidence);
        let levels = runs.levels.iter().zip(&series.values);
        let steps = levels.filter_map(|(level, values)| {
            let known: Vec<f64> = values.iter().flatten().copied().collect();
            let of = MeanStd::of(&known)?;
            Some(AtStep {
                step: level.rung.step,
                runs: of.count,
                mean: of.mean,
                deviation: of.std(),
                error_of_step: limit.error_at(level.rung.step),
                values: values.clone(),
            })
        });
        let of = |timed| OfPreset::of(timed, &means, &limit, (reached, confidence));
        let default = Timed {
            preset: Preset::Paper,
            step: PAPER_TIME_STEP,
            secs: secs_at(runs, PAPER_TIME_STEP),
        };
        let presets: Vec<OfPreset> = runs.timed.iter().copied().map(of).collect();
        let missing = series
            .values
            .iter()
            .flatten()
            .filter(|value| value.is_none());
        Some(Self {
            name: wanted.name.clone(),
            reached,
            wanted: wanted.error.to_string(),
            is_reached: reached.error <= wanted.error.of(reached.value),
            order: limit.order,
            deviation: means.variance.sqrt(),
            limit: limit.clone(),
            steps: steps.collect(),
            missing: missing.count(),
            default: presets.first().copied().unwrap_or_else(|| of(default)),
            presets,
        })
    }
}

/// The time of a run at this step, seconds on one core: that of the runs made, in proportion to their frames.
fn secs_at(runs: &Runs, step: f64) -> f64 {
    let start = &runs.levels[runs.question.start];
    runs.measured_factor() * start.expected_secs * start.rung.step / step
}
