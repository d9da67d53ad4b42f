//! The results of a run as a document or JSON.

mod overview;

use std::collections::BTreeMap;

use serde::Deserialize as _;
use serde_json::{Map, Value, json};

use crate::cli::failure::Failure;
use lab::reproduce::published_for;
use output::document::{Block, Document, Findings};
use output::results as tables;
use output::table::{Cell, Table};
use runs::drive::{End, Run};
use runs::identity::Identity;
use runs::summary::{Summary, value};
use scenario::measurements::{Integrity, Metric};

/// The summary, with version, identity, all settings, threads and run times.
pub fn json(run: &Run) -> Value {
    let spent = run.simulation.stages().ms_per_frame();
    let stages = spent.map(|(stage, ms)| (stage.name().to_owned(), json!(ms)));
    let [ms, real_time_factor] = speed(run);
    let mut report = json!(Summary::of(run));
    report["version"] = json!(env!("CARGO_PKG_VERSION"));
    report["identity"] = json!(Identity::of_run(&run.scenario));
    report["settings"] = run.scenario.settings();
    let published: BTreeMap<_, _> = published_for(&run.scenario).into_iter().collect();
    if !published.is_empty() {
        report["paper"] = json!(published);
    }
    report["interrupted"] = json!(run.end == Some(End::Interrupted));
    report["threads"] = json!(rayon::current_num_threads());
    report["ms_per_frame"] = json!(ms);
    report["real_time_factor"] = json!(real_time_factor);
    report["stages_ms"] = Value::Object(stages.collect::<Map<_, _>>());
    report
}

/// The results of a run with this document: a table of its values, and everything for programs.
pub fn findings(run: &Run, document: Document) -> Result<Findings, Failure> {
    let metrics = run.metrics.results(&run.simulation);
    let table = Table::of(&metrics)
        .column("measurement", |metric| metric.name.as_str())
        .column("value", |metric| metric.value)
        .column("unit", |metric| metric.unit)
        .table();
    let name = &run.scenario.name;
    let findings = Findings::new(name, document, json(run)).with_table(name, &table);
    findings.map_err(|error| Failure::Output(error.to_string()))
}

/// The width of lines of names.
const LINE: usize = 100;

/// What an engineer asks first, the measurements, the tables of journeys and places, and the run time; with the stages
/// of a frame if `verbose`.
pub fn document(run: &Run, verbose: bool) -> Document {
    let summary = Summary::of(run);
    let blocks = [
        vec![
            Block::text(overview::beginning(run, &summary)),
            Block::table(tables::pairs(&overview::facts(&summary))),
        ],
        measured(run),
        remarks(run),
        journeys(&summary),
        computing(run, verbose),
    ];
    let title = format!("Results of the run {}", run.scenario.name);
    Document::of(title, blocks.concat())
}

/// A table of the values of the measurements, group by group; below it the names of those that are alike in a group:
/// values of 0, and missing ones.
fn measured(run: &Run) -> Vec<Block> {
    let metrics = run.metrics.results(&run.simulation);
    let (mut rows, mut names): (Vec<Option<&Metric>>, Vec<String>) = (Vec::new(), Vec::new());
    let mut before = 0;
    for group in metrics.chunk_by(|one, other| one.measurement == other.measurement) {
        let alike = |value| group.iter().filter(move |metric| metric.value == value);
        let mut folded = vec![("0", Some(0.0)), ("–", None)];
        folded.retain(|(_, value)| alike(*value).count() > 1);
        let lines = folded.iter().map(|one| names_of(one.0, alike(one.1)));
        names.extend(lines);
        let stands = |metric: &&Metric| folded.iter().all(|(_, value)| metric.value != *value);
        let shown: Vec<Option<&Metric>> = group.iter().filter(stands).map(Some).collect();
        if shown.is_empty() {
            continue;
        }
        if !rows.is_empty() && before.max(shown.len()) > 1 {
            // Groups stand apart.
            rows.push(None);
        }
        before = shown.len();
        rows.extend(shown);
    }
    let table = || Block::table(values(&rows, &published_for(&run.scenario)));
    let shown = (!rows.is_empty()).then(table);
    let folded = Block::text(names.join("\n"));
    shown.into_iter().chain([folded]).collect()
}

/// A table of values, beside those that are published; rows without a value stay empty.
fn values(rows: &[Option<&Metric>], published: &[(&str, f64)]) -> Table {
    let empty = || Cell::Text(String::new());
    let table = Table::of(rows)
        .column("measurement", |row| {
            row.map_or("", |metric| metric.name.as_str())
        })
        .fixed("value", 3, |row| {
            row.map_or_else(empty, |metric| match value(metric) {
                Value::Number(count) if count.is_u64() => Cell::Text(count.to_string()),
                _ => metric.value.into(),
            })
        })
        .column("unit", |row| row.map_or("", |metric| metric.unit));
    if published.is_empty() {
        return table.table();
    }
    let paper = |row: &Option<&Metric>| {
        let is_its = |name: &str| row.is_some_and(|metric| metric.name == name);
        let found = published.iter().find(|(name, _)| is_its(name));
        found.map_or_else(empty, |(_, value)| Cell::Number(*value))
    };
    table.column("paper, Table 1", paper).table()
}

/// The names of values that are alike, in lines.
fn names_of<'a>(head: &str, metrics: impl Iterator<Item = &'a Metric>) -> String {
    let mut lines: Vec<String> = Vec::new();
    for Metric { name, .. } in metrics {
        match lines.last_mut() {
            Some(line) if line.len() + name.len() < LINE => {
                line.extend([", ", name]);
            }
            None => lines.push(format!("{head}: {name}")),
            _ => lines.push(format!("   {name}")),
        }
    }
    lines.join(",\n")
}

/// Remarks on the values: the agents that `integrity` has found in walls, and where thresholds are from.
fn remarks(run: &Run) -> Vec<Block> {
    let found = run
        .metrics
        .data()
        .find(|(name, _)| *name == Integrity::NAME);
    let ids = found.and_then(|(_, ids)| Vec::<u32>::deserialize(ids).ok());
    let in_walls = ids.map(|ids| {
        let first = ids
            .iter()
            .map(u32::to_string)
            .collect::<Vec<_>>()
            .join(", ");
        format!(
            "Through walls, by id (at most ten): {first}; `sandbox inspect --agent` shows them."
        )
    });
    let mut measurements = run.scenario.measurements.iter();
    let has_thresholds = measurements.any(|one| one.about().has_thresholds);
    let words =
        "Thresholds are from the literature, not safety limits: docs/reference/measurements.md";
    let thresholds = has_thresholds.then(|| words.to_owned());
    in_walls
        .into_iter()
        .chain(thresholds)
        .map(Block::text)
        .collect()
}

/// Tables of the journeys and places; empty without journeys.
fn journeys(summary: &Summary) -> Vec<Block> {
    let tables = [
        tables::journeys(&summary.journeys),
        tables::places(&summary.places),
    ];
    match summary.journeys.is_empty() {
        true => Vec::new(),
        false => tables.map(Block::table).into(),
    }
}

/// The run time, with the stages of a frame if `verbose`.
fn computing(run: &Run, verbose: bool) -> Vec<Block> {
    let threads = rayon::current_num_threads();
    let [ms, real_time_factor] = speed(run);
    let whole =
        format!("{ms:.3} ms per frame on {threads} thread(s), {real_time_factor:.1} × real time");
    let mut blocks = vec![Block::text(whole)];
    if verbose {
        let stages: Vec<_> = run.simulation.stages().ms_per_frame().collect();
        let table = Table::of(&stages)
            .column("stage", |(stage, _)| stage.name())
            .fixed("ms per frame", 4, |(_, ms)| *ms);
        blocks.push(Block::table(table.table()));
    }
    blocks
}

/// Milliseconds per frame without output files, and the simulated time divided by the run time.
fn speed(run: &Run) -> [f64; 2] {
    let ms = run.simulation.stages().total_ms_per_frame();
    [ms, 1e3 * run.simulation.frame().clock.time_step() / ms]
}
