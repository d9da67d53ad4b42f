//! The state of a study: its cells, finished, failed or missing, and means over seeds.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::Study;
use super::cell::Cell;
use crate::error::LabError;
use crate::gallery::distinct;
use crate::jobs::Results;
use analysis::statistics::MeanStd;
use runs::case::RunResult;
use runs::identity::ENGINE;
use runs::store::Store;

/// The state of a cell.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// The cell has a result.
    Finished(Box<RunResult>),
    /// The cell failed, with the reason.
    Failed(String),
    /// The cell has not run yet.
    Missing,
}

impl State {
    /// The name of the state.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Finished(_) => "finished",
            Self::Failed(_) => "failed",
            Self::Missing => "missing",
        }
    }

    /// The result, if there is one.
    pub fn result(&self) -> Option<&RunResult> {
        match self {
            Self::Finished(result) => Some(result),
            Self::Failed(_) | Self::Missing => None,
        }
    }
}

/// A study with the states of all cells.
#[derive(Debug, Clone)]
pub struct Gathered<'a> {
    /// The study.
    pub study: &'a Study,
    /// The states, in the order of the cells.
    pub states: Vec<State>,
}

/// One combination of settings, with all its seeds.
pub struct Combination<'a> {
    /// Its cells.
    pub cells: &'a [Cell],
    /// The results of its finished cells.
    pub results: Vec<&'a RunResult>,
    /// The means of all numbers, in the order of the tables; `None` if no run gave a value.
    pub means: Vec<Option<MeanStd>>,
}

impl<'a> Gathered<'a> {
    /// The state of a study according to `store`.
    pub fn of(study: &'a Study, store: &Store) -> Self {
        let state = |cell: &Cell| match Results(store).outcome(&cell.case.key) {
            Some(Ok(result)) => State::Finished(Box::new(result)),
            Some(Err(message)) => State::Failed(message),
            None => State::Missing,
        };
        Self {
            study,
            states: study.cells.iter().map(state).collect(),
        }
    }

    /// All results as one object.
    pub fn json(&self) -> Value {
        let names = self.numbers();
        let all = self.study.cells.iter().zip(&self.states);
        let cells = all.map(|(cell, state)| {
            let mut entry = json!({
                "cell": cell.number,
                "settings": settings(cell),
                "seed": cell.case.seed,
                "status": state.name(),
            });
            match state {
                State::Finished(result) => entry["result"] = json!(result),
                State::Failed(message) => entry["error"] = json!(message),
                State::Missing => {}
            }
            entry
        });
        let combinations = self.combinations();
        let means = combinations.iter().map(|combination| {
            let entry = |mean: &MeanStd| {
                json!({ "mean": mean.mean, "ci95": mean.interval_95(), "n": mean.count })
            };
            let means = combination.means.iter();
            let entries = means.map(|mean| mean.as_ref().map_or(Value::Null, entry));
            json!({
                "settings": combination.cells.first().map(settings),
                "runs": combination.results.len(),
                "means": names.iter().cloned().zip(entries).collect::<Map<_, _>>(),
            })
        });
        json!({
            "study": self.study.name,
            "file": self.study.document,
            "engine": ENGINE,
            "cells": cells.collect::<Vec<_>>(),
            "summary": means.collect::<Vec<_>>(),
        })
    }

    /// The names of all metrics, in alphabetical order.
    pub(super) fn metrics(&self) -> Vec<String> {
        let results = self.states.iter().filter_map(State::result);
        let names: BTreeSet<&String> = results.flat_map(|r| r.summary.metrics.keys()).collect();
        names.into_iter().cloned().collect()
    }

    /// The names of all numbers that are averaged over seeds.
    pub(crate) fn numbers(&self) -> Vec<String> {
        let mut names = self.metrics();
        names.extend(["evacuated", "time_secs"].map(str::to_owned));
        distinct(names)
    }

    /// The combinations of settings in the order of their cells.
    pub fn combinations(&'a self) -> Vec<Combination<'a>> {
        let names = self.numbers();
        let size = self.study.seeds;
        let groups = self.study.cells.chunks(size).zip(self.states.chunks(size));
        let combination = |(cells, states): (&'a [Cell], &'a [State])| {
            let results: Vec<&RunResult> = states.iter().filter_map(State::result).collect();
            let mean = |name: &String| {
                let values = results.iter().filter_map(|result| number(result, name));
                MeanStd::of(&values.collect::<Vec<f64>>())
            };
            Combination {
                cells,
                means: names.iter().map(mean).collect(),
                results,
            }
        };
        groups.map(combination).collect()
    }

    /// The first cell with this label, and its result.
    ///
    /// # Errors
    /// There is no such cell, or it is not finished.
    pub fn labeled(&self, label: &str) -> Result<(&Cell, &RunResult), LabError> {
        let mut cells = self.study.cells.iter().zip(&self.states);
        let found = cells.find(|(cell, _)| cell.label() == Some(label));
        let missing = || LabError::missing(format!("{}, {label}", self.study.name), "result");
        let finished = found.and_then(|(cell, state)| Some((cell, state.result()?)));
        finished.ok_or_else(missing)
    }
}

impl<'a> Combination<'a> {
    /// The value of a varied setting.
    pub fn value(&self, key: &str) -> Option<&'a Value> {
        self.cells.first()?.value(key)
    }

    /// The label; empty for none.
    pub fn label(&self) -> &'a str {
        let cell = self.cells.first();
        cell.and_then(Cell::label).unwrap_or_default()
    }

    /// A metric of each finished cell, in the order of the seeds.
    pub fn values(&self, metric: &str) -> Vec<Option<f64>> {
        let results = self.results.iter();
        results.map(|result| number(result, metric)).collect()
    }
}

/// The varied settings as an object.
fn settings(cell: &Cell) -> Value {
    Value::Object(cell.values.iter().cloned().collect())
}

/// A metric of a run, or one of its counts.
pub(crate) fn number(result: &RunResult, name: &str) -> Option<f64> {
    match (result.summary.metrics.get(name), name) {
        (Some(value), _) => value.as_f64(),
        (None, "evacuated") => Some(result.evacuated as f64),
        (None, "time_secs") => Some(result.summary.time_secs),
        (None, name) => result.summary.first(name),
    }
}
