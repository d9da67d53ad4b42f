//! What an estimate is expected to need, from finished runs of the same profile.

use std::fmt::Write;

use rayon::current_num_threads;
use serde::Serialize;

use super::limit::Limit;
use super::plan::{Goal, Hope, MOST_PREDICTED, Offer, predicted};
use super::question::Question;
use super::run::Runs;
use super::series::{Reached, Series};
use super::wanted::{Request, Tolerance, Wanted};
use crate::error::LabError;
use crate::sweep::number;
use analysis::round;
use runs::case::RunResult;
use runs::store::Store;

/// What an estimate is expected to need.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Forecast {
    /// The scenario with the runs that it is based on; `None` if these are results of other scenes that ship with the
    /// program.
    pub based_on: Option<String>,
    /// The number of these runs or results.
    pub known: usize,
    /// The expected steps, seconds, with their numbers of runs.
    pub runs: Vec<(f64, usize)>,
    /// The expected time on one core, seconds; without runs of a scenario, if all runs last for its duration.
    pub secs: f64,
    /// The results whose errors are expected to be larger than asked for with the most runs that are allowed, with
    /// these errors.
    pub short: Vec<(String, String)>,
}

impl Forecast {
    /// From the finished runs in `store`: those of the same scenario and profile, or else of the scenario with the most
    /// runs of this profile that has all wanted results, if all errors are relative. Without such runs, from similar
    /// results in other scenes. `None` without these, and if only bounds are asked for.
    ///
    /// # Errors
    /// The scenario has become invalid.
    pub fn of(question: &Question, store: &Store) -> Result<Option<Self>, LabError> {
        if question.request.wanted.is_empty() {
            return Ok(None);
        }
        let runs = Runs::none(question, &[], None)?;
        let [scenario, profile] = &question.title;
        let mut known: Vec<RunResult> = store.all();
        known.retain(|run| run.summary.profile == *profile && run.summary.frames > 0);
        let wanted = &question.request.wanted;
        let is_relative = wanted
            .iter()
            .all(|wanted| matches!(wanted.error, Tolerance::Relative(_)));
        let has_all = |run: &&RunResult| {
            wanted
                .iter()
                .all(|wanted| number(run, &wanted.name).is_some())
        };
        let mut scenes: Vec<&str> = known
            .iter()
            .filter(has_all)
            .map(|run| run.summary.scenario.as_str())
            .collect();
        scenes.sort_unstable();
        let others = scenes.chunk_by(|a, b| a == b).max_by_key(|runs| runs.len());
        let others = others.filter(|_| is_relative).map(|runs| runs[0]);
        let own = scenes
            .iter()
            .any(|scene| scene == scenario)
            .then_some(scenario.as_str());
        let Some(based_on) = own.or(others).map(str::to_owned) else {
            return Ok(Self::of_similar(&runs));
        };
        known.retain(|run| run.summary.scenario == based_on);
        let offers = runs.offers();
        let steps: Vec<f64> = offers.iter().map(|offer| offer.step).collect();
        let step = |run: &RunResult| run.summary.time_secs / run.summary.frames as f64;
        let goals = wanted.iter().zip(&runs.priors).map(|(wanted, prior)| {
            let values = steps.iter().map(|offered| {
                let own = known
                    .iter()
                    .filter(|run| (step(run) / offered - 1.0).abs() < 1e-6);
                own.map(|run| number(run, &wanted.name)).collect()
            });
            let series = Series {
                steps: steps.clone(),
                values: values.collect(),
            };
            let means = series.means(prior)?;
            let tolerance = wanted.error;
            let limit = means.limit();
            Some((Goal { means, tolerance }, limit))
        });
        let Some(goals) = goals.collect::<Option<Vec<(Goal, Limit)>>>() else {
            return Ok(Self::of_similar(&runs));
        };
        let (counts, errors) = predicted(&goals, &offers, runs.first_round(None), asked(question));
        let short = short(wanted, &goals, &errors);
        let start = &offers[question.start];
        let per_step = known.iter().map(|run| run.wall_secs * step(run));
        let per_step = per_step.sum::<f64>() / known.len() as f64 / start.step / start.secs;
        let is_own = based_on == *scenario;
        let secs = offers
            .iter()
            .zip(&counts)
            .map(|(offer, runs)| offer.secs * *runs as f64);
        let secs = secs.sum::<f64>() * if is_own { per_step } else { 1.0 };
        Ok(Some(Self {
            based_on: Some(based_on),
            known: known.len(),
            runs: used(&offers, &counts),
            secs,
            short,
        }))
    }

    /// From the spreads and the errors of the step of similar results in other scenes; `None` if there are none for one
    /// of the wanted results, or if an error is asked for in the result's unit.
    fn of_similar(runs: &Runs) -> Option<Self> {
        let (question, offers) = (runs.question, runs.offers());
        let goals: Option<Vec<Goal>> = runs.hopes().iter().map(Hope::goal).collect();
        let goals = goals?.into_iter().map(|goal| (goal, Limit::exact(1.0)));
        let goals: Vec<(Goal, Limit)> = goals.collect();
        let (counts, errors) = predicted(&goals, &offers, runs.first_round(None), asked(question));
        let secs = offers.iter().zip(&counts);
        Some(Self {
            based_on: None,
            known: runs.priors.iter().map(|prior| prior.similar).sum(),
            runs: used(&offers, &counts),
            secs: secs.map(|(offer, runs)| offer.secs * *runs as f64).sum(),
            short: short(&question.request.wanted, &goals, &errors),
        })
    }

    /// In words, for a terminal.
    pub fn text(&self) -> String {
        let all: usize = self.runs.iter().map(|(_, runs)| runs).sum();
        let threads = current_num_threads();
        let mut text = format!(
            "expected: {all} runs, {}{} min on {threads} threads, from {} {}",
            // No run has shown whether the scenario ends before its duration.
            if self.based_on.is_none() {
                "up to "
            } else {
                ""
            },
            round::brief(self.secs / 60.0 / threads as f64),
            self.known,
            match &self.based_on {
                Some(scenario) => format!("runs of {scenario}"),
                None => "similar results in other scenes".to_owned(),
            }
        );
        for (k, (step, runs)) in self.runs.iter().enumerate() {
            let before = if k == 0 { ": " } else { ", " };
            write!(
                text,
                "{before}{runs} with a step of {} s",
                round::brief(*step)
            )
            .ok();
        }
        for (name, error) in &self.short {
            write!(text, "; with these, {name} reaches ± {error} only").ok();
        }
        text + "\n"
    }
}

/// The confidence, and the most runs that are predicted.
fn asked(question: &Question) -> (f64, usize) {
    let Request {
        confidence, limits, ..
    } = question.request;
    (confidence, limits.runs.min(MOST_PREDICTED))
}

/// The steps with runs, seconds, and their numbers of runs.
fn used(offers: &[Offer], counts: &[usize]) -> Vec<(f64, usize)> {
    let used = offers.iter().zip(counts).filter(|(_, runs)| **runs > 0);
    used.map(|(offer, runs)| (offer.step, *runs)).collect()
}

/// The results whose expected errors are larger than asked for, with these errors.
fn short(wanted: &[Wanted], goals: &[(Goal, Limit)], errors: &[f64]) -> Vec<(String, String)> {
    let short = wanted.iter().zip(goals).zip(errors);
    let short = short.filter_map(|((wanted, (_, limit)), &error)| {
        let value = limit.value;
        let reached = Reached {
            value,
            error,
            seeds: 0.0,
            step: 0.0,
        };
        let percent = || reached.percent().unwrap_or_else(|| round::brief(error));
        (error > wanted.error.of(value)).then(|| (wanted.name.clone(), percent()))
    });
    short.collect()
}
