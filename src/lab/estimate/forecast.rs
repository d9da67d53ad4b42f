//! What an estimate is expected to need, from finished runs of the same scenario and profile.

use rayon::current_num_threads;
use serde::Serialize;

use super::plan::{Goal, MOST_PREDICTED, pilot, predicted, range};
use super::question::Question;
use super::run::Runs;
use super::series::Reached;
use crate::error::LabError;
use analysis::round;
use runs::case::RunResult;
use runs::store::Store;

/// What an estimate is expected to need.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Forecast {
    /// The scenario, if its own runs say this; `None` if these are results of other scenes that ship with the program.
    pub based_on: Option<String>,
    /// The number of these runs or results.
    pub known: usize,
    /// The expected steps, seconds, with their numbers of runs.
    pub runs: Vec<(f64, usize)>,
    /// The numbers of runs in all between which it is in nine of ten cases, as far as the spread of runs is known.
    pub range: [usize; 2],
    /// The expected time on one core, seconds; without runs of the scenario, if all runs last for its duration.
    pub secs: f64,
    /// The results whose errors are expected to be larger than asked for with the most runs that are allowed, with
    /// these errors.
    pub short: Vec<(String, String)>,
}

impl Forecast {
    /// From the finished runs of the same scenario and profile in `store`; if these do not have all wanted results,
    /// from similar results in other scenes. `None` if there are none for one of the wanted results, if an error is
    /// then asked for in the result's unit, and if only bounds are asked for.
    ///
    /// # Errors
    /// The scenario has become invalid.
    pub fn of(question: &Question, store: &Store) -> Result<Option<Self>, LabError> {
        if question.request.wanted.is_empty() {
            return Ok(None);
        }
        let mut runs = Runs::none(question, &[], None)?;
        let step = |run: &RunResult| run.summary.time_secs / run.summary.frames as f64;
        let mut own: Vec<RunResult> = store.all();
        own.retain(|RunResult { summary, .. }| {
            [&summary.scenario, &summary.profile] == question.title.each_ref() && summary.frames > 0
        });
        for level in &mut runs.levels {
            let is_at = |run: &&RunResult| (step(run) / level.rung.step - 1.0).abs() < 1e-6;
            level.results = own.iter().filter(is_at).cloned().map(Ok).collect();
        }
        runs.look();
        let Some(goals) = runs
            .goals()
            .map(Option::<&Goal>::cloned)
            .collect::<Option<Vec<Goal>>>()
        else {
            let known = runs.priors.iter().map(|prior| prior.similar).sum();
            let goals = runs.expected();
            return Ok(goals.map(|goals| Self {
                known,
                ..Self::from_goals(&runs, &goals)
            }));
        };
        let start = &runs.levels[question.start];
        let measured = own.iter().map(|run| run.wall_secs * step(run));
        let per_step = measured.sum::<f64>() / own.len() as f64 / start.rung.step;
        let expected = Self::from_goals(&runs, &goals);
        Ok(Some(Self {
            based_on: Some(question.title[0].clone()),
            known: own.len(),
            secs: expected.secs * (per_step / start.expected_secs),
            ..expected
        }))
    }

    fn from_goals(runs: &Runs, goals: &[Goal]) -> Self {
        let request = &runs.question.request;
        let offers = runs.offers();
        let known = runs.first_round();
        let first = known.unwrap_or_else(|| pilot(&offers, runs.question.start));
        let most = request.limits.runs.min(MOST_PREDICTED);
        let asked = (request.confidence, most);
        let range = range(goals, &offers, &first, asked);
        let (counts, errors) = predicted(goals, &offers, first, asked);
        let used = offers.iter().zip(counts).filter(|(_, runs)| *runs > 0);
        let mut short = Vec::new();
        for ((wanted, goal), error) in request.wanted.iter().zip(goals).zip(errors) {
            let reached = Reached {
                error,
                ..goal.reached(request.confidence)
            };
            if error > wanted.error.of(reached.value) {
                let percent = reached.percent();
                let error = percent.unwrap_or_else(|| round::brief(error));
                short.push((wanted.name.clone(), error));
            }
        }
        Self {
            based_on: None,
            known: 0,
            range,
            runs: used
                .clone()
                .map(|(offer, runs)| (offer.step, runs))
                .collect(),
            secs: used.map(|(offer, runs)| offer.secs * runs as f64).sum(),
            short,
        }
    }

    /// In words, for a terminal.
    pub fn text(&self) -> String {
        let all: usize = self.runs.iter().map(|(_, runs)| runs).sum();
        let threads = current_num_threads();
        let minutes = round::brief(self.secs / 60.0 / threads as f64);
        let [low, high] = self.range;
        let (limit, known) = match &self.based_on {
            Some(scenario) => ("", format!("runs of {scenario}")),
            // No run has shown whether the scenario ends before its duration.
            None => ("up to ", "similar results in other scenes".to_owned()),
        };
        let at = |(step, runs): &(f64, usize)| {
            format!("{runs} with a step of {} s", round::brief(*step))
        };
        let steps: Vec<String> = self.runs.iter().map(at).collect();
        let misses = self.short.iter();
        let short =
            misses.map(|(name, error)| format!("; with these, {name} reaches ± {error} only"));
        format!(
            "expected: {all} runs ({low} to {high} in 9 of 10 cases), {limit}{minutes} min on {threads} threads, \
             from {} {known}: {}{}\n",
            self.known,
            steps.join(", "),
            short.collect::<String>()
        )
    }
}
