//! A study as tables: all cells, and means over seeds.

use serde_json::Value;

use super::cell::{Cell, plain, short};
use super::gathered::{Gathered, Mean, State};
use super::{Shard, Study};
use crate::output::table::OldTable as Table;
use crate::runs::case::RunResult;
use crate::scenario::quote::shown;

/// Columns about the run itself, between the metrics and the computing time.
const COUNTS: [&str; 8] = [
    "entered",
    "remaining",
    "frames",
    "time_secs",
    "contained_moves",
    "clamped_speeds",
    "displaced_agents",
    "state_sha256",
];

/// One row per cell.
pub(super) fn cells(gathered: &Gathered) -> Table {
    let metrics = gathered.metrics();
    let evacuated = "evacuated".to_owned();
    let is_measured = metrics.contains(&evacuated);
    let mut head = columns(gathered.study, &gathered.study.axes);
    head.push("status".to_owned());
    head.extend(metrics.iter().cloned());
    head.extend((!is_measured).then_some(evacuated));
    head.extend(COUNTS.map(str::to_owned));
    head.extend(["wall_secs", "error"].map(str::to_owned));
    let rows = gathered.study.cells.iter().zip(&gathered.states);
    let rows = rows.map(|(cell, state)| {
        let mut row = values(gathered.study, &gathered.study.axes, cell, plain);
        row.push(state.name().to_owned());
        match state {
            State::Finished(result) => {
                let metric = |name| {
                    result
                        .summary
                        .metrics
                        .get(name)
                        .map_or("".to_owned(), number)
                };
                row.extend(metrics.iter().map(metric));
                row.extend((!is_measured).then(|| result.evacuated.to_string()));
                row.extend(counts(result));
                row.push(format!("{:.3}", result.wall_secs));
            }
            State::Failed(message) => {
                row.resize(head.len() - 1, String::new());
                row.push(message.clone());
            }
            State::Missing => {}
        }
        row.resize(head.len(), String::new());
        row
    });
    Table {
        words: 0,
        rows: rows.collect(),
        head,
    }
}

/// One row per combination of settings: the means, half their 95 % confidence intervals, and the numbers of values.
pub(super) fn summary(gathered: &Gathered) -> Table {
    let mut head = gathered.study.axes.clone();
    head.push("runs".to_owned());
    for name in gathered.numbers() {
        head.extend(["mean", "ci95", "n"].map(|what| format!("{name}_{what}")));
    }
    let rows = gathered.combinations().into_iter().map(|combination| {
        let mut row = axes(&gathered.study.axes, combination.cells.first(), plain);
        row.push(combination.results.len().to_string());
        for mean in combination.means {
            row.push(mean.map_or(String::new(), |m| m.mean.to_string()));
            row.push(
                mean.and_then(|m| m.interval)
                    .map_or(String::new(), |i| i.to_string()),
            );
            row.push(mean.map_or(0, |m| m.count).to_string());
        }
        row
    });
    Table {
        words: 0,
        rows: rows.collect(),
        head,
    }
}

/// The same for a terminal: mean ± half the confidence interval.
pub(super) fn text(gathered: &Gathered) -> Table {
    let names = gathered.study.short_axes();
    let mut head: Vec<String> = names.iter().map(|axis| shown(axis)).collect();
    head.push("runs".to_owned());
    head.extend(gathered.numbers());
    let rows = gathered.combinations().into_iter().map(|combination| {
        let mut row = axes(&names, combination.cells.first(), short);
        row.push(combination.results.len().to_string());
        row.extend(combination.means.into_iter().map(readable));
        row
    });
    Table {
        words: names.len(),
        rows: rows.collect(),
        head,
    }
}

impl Study {
    /// The names of the result files: one row per cell, means over seeds, and everything as JSON.
    pub fn files(&self) -> [String; 3] {
        let name = &self.name;
        [
            format!("{name}.csv"),
            format!("{name}-summary.csv"),
            format!("{name}-results.json"),
        ]
    }
}

impl Gathered<'_> {
    /// The cells of a shard with their states, for a terminal.
    pub fn list(&self, shard: Shard) -> String {
        let axes = self.study.short_axes();
        let cells = self.study.cells.iter().zip(&self.states);
        let rows = cells
            .filter(|(cell, _)| shard.has(cell.number))
            .map(|(cell, state)| {
                let mut row = values(self.study, &axes, cell, short);
                row.push(state.name().to_owned());
                row
            });
        let names = columns(self.study, &axes);
        let mut head: Vec<String> = names.iter().map(|name| shown(name)).collect();
        head.push("status".to_owned());
        let table = Table {
            words: head.len(),
            rows: rows.collect(),
            head,
        };
        table.text()
    }
}

/// The names of the first columns: the number, the varied settings, and the seed.
fn columns(study: &Study, axes: &[String]) -> Vec<String> {
    let mut names = vec!["cell".to_owned()];
    names.extend(axes.iter().cloned());
    names.extend((!study.varies_seed()).then(|| "seed".to_owned()));
    names
}

/// The values of these columns.
fn values(
    study: &Study,
    names: &[String],
    cell: &Cell,
    write: fn(&Value) -> String,
) -> Vec<String> {
    let mut row = vec![cell.number.to_string()];
    row.extend(axes(names, Some(cell), write));
    row.extend((!study.varies_seed()).then(|| cell.case.seed.to_string()));
    row
}

/// The values of the varied settings; empty if a cell does not have the setting.
fn axes(names: &[String], cell: Option<&Cell>, write: fn(&Value) -> String) -> Vec<String> {
    let value = |name: &String| {
        cell.and_then(|cell| cell.value(name))
            .map_or(String::new(), write)
    };
    names.iter().map(value).collect()
}

fn counts(result: &RunResult) -> [String; COUNTS.len()] {
    let summary = &result.summary;
    [
        summary.agents.to_string(),
        result.remaining.to_string(),
        summary.frames.to_string(),
        summary.time_secs.to_string(),
        summary.contained_moves.to_string(),
        summary.clamped_speeds.to_string(),
        summary.displaced_agents.to_string(),
        summary.state_sha256.clone(),
    ]
}

/// A metric with all its digits; empty if it has no value.
fn number(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        value => plain(value),
    }
}

fn readable(mean: Option<Mean>) -> String {
    match mean {
        None => "–".to_owned(),
        Some(Mean {
            mean,
            interval: Some(interval),
            ..
        }) => format!("{mean:.3} ± {interval:.3}"),
        Some(Mean { mean, .. }) => format!("{mean:.3}"),
    }
}
