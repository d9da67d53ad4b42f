//! A study as tables: all cells, and means over seeds.

use super::cell::{Cell, plain, short};
use super::gathered::{Combination, Gathered, State};
use super::{Shard, Study};
use crate::output::table::{self, Columns, Table};
use crate::runs::case::RunResult;
use crate::scenario::quote::shown;

/// A column about the run itself.
type Count = (&'static str, fn(&RunResult) -> table::Cell);

/// Columns about the run itself, between the metrics and the computing time.
const COUNTS: [Count; 8] = [
    ("entered", |result| result.summary.agents.into()),
    ("remaining", |result| result.remaining.into()),
    ("frames", |result| result.summary.frames.into()),
    ("time_secs", |result| result.summary.time_secs.into()),
    ("contained_moves", |result| {
        result.summary.contained_moves.into()
    }),
    ("clamped_speeds", |result| {
        result.summary.clamped_speeds.into()
    }),
    ("displaced_agents", |result| {
        result.summary.displaced_agents.into()
    }),
    ("state_sha256", |result| {
        result.summary.state_sha256.clone().into()
    }),
];

/// One row per cell.
pub(super) fn cells(gathered: &Gathered) -> Table {
    let rows: Vec<Row> = gathered.study.cells.iter().zip(&gathered.states).collect();
    let metrics = gathered.metrics();
    let mut columns = first_columns(gathered.study, &rows, &gathered.study.axes, false);
    for name in &metrics {
        columns = columns.column(name, |(_, state)| {
            let metric = |result: &RunResult| result.summary.metrics.get(name).map(plain);
            state
                .result()
                .and_then(metric)
                .filter(|text| text != "null")
        });
    }
    if metrics.iter().all(|name| name != "evacuated") {
        columns = columns.column("evacuated", |(_, state)| {
            state.result().map(|r| r.evacuated)
        });
    }
    for (name, count) in COUNTS {
        columns = columns.column(name, |(_, state)| state.result().map(count));
    }
    let error = |state: &State| match state {
        State::Failed(message) => Some(message.clone()),
        State::Finished(_) | State::Missing => None,
    };
    columns
        .column("wall_secs", |(_, state)| {
            state.result().map(|r| format!("{:.3}", r.wall_secs))
        })
        .column("error", |(_, state)| error(state))
        .table()
}

/// One row per combination of settings: the means, half their 95 % confidence intervals, and the numbers of values.
pub(super) fn summary(gathered: &Gathered) -> Table {
    let rows = gathered.combinations();
    let mut columns = with_axes(&rows, &gathered.study.axes, false);
    for (k, name) in gathered.numbers().iter().enumerate() {
        let mean = |row: &Combination| row.means[k];
        columns = columns
            .column(&format!("{name}_mean"), |row| {
                mean(row).map(|mean| mean.mean)
            })
            .column(&format!("{name}_ci95"), |row| mean(row)?.interval_95())
            .column(&format!("{name}_n"), |row| {
                mean(row).map_or(0, |mean| mean.count)
            });
    }
    columns.table()
}

/// The same for a terminal: mean ± half the confidence interval.
pub(super) fn text(gathered: &Gathered) -> String {
    let rows = gathered.combinations();
    let mut columns = with_axes(&rows, &gathered.study.short_axes(), true);
    for (k, name) in gathered.numbers().iter().enumerate() {
        columns = columns.fixed(name, 3, |row| {
            row.means[k].map(|mean| table::Cell::Spread(mean.mean, mean.interval_95()))
        });
    }
    columns.table().text()
}

impl Study {
    /// The names of the result files: one row per cell, means over seeds, and everything as JSON.
    pub fn files(&self) -> [String; 3] {
        ["csv", "summary.csv", "results.json"].map(|end| match end {
            "csv" => format!("{}.csv", self.name),
            end => format!("{}-{end}", self.name),
        })
    }
}

impl Gathered<'_> {
    /// The cells of a shard with their states, for a terminal.
    pub fn list(&self, shard: Shard) -> String {
        let cells = self.study.cells.iter().zip(&self.states);
        let rows: Vec<Row> = cells.filter(|(cell, _)| shard.has(cell.number)).collect();
        first_columns(self.study, &rows, &self.study.short_axes(), true)
            .table()
            .text()
    }
}

type Row<'a> = (&'a Cell, &'a State);

/// The number, the varied settings, the seed and the status.
fn first_columns<'r>(
    study: &Study,
    rows: &'r [Row],
    axes: &[String],
    is_short: bool,
) -> Columns<'r, Row<'r>> {
    let mut columns = Table::of(rows).column("cell", |(cell, _)| cell.number.to_string());
    for axis in axes {
        columns = columns.column(&head(axis, is_short), |(cell, _)| {
            value(cell, axis, is_short)
        });
    }
    if !study.varies_seed() {
        columns = columns.column("seed", |(cell, _)| cell.case.seed.to_string());
    }
    columns.column("status", |(_, state)| state.name())
}

/// The varied settings and the number of finished runs.
fn with_axes<'r>(
    rows: &'r [Combination],
    axes: &[String],
    is_short: bool,
) -> Columns<'r, Combination<'r>> {
    let mut columns = Table::of(rows);
    for axis in axes {
        columns = columns.column(&head(axis, is_short), |row| {
            row.cells
                .first()
                .map_or(String::new(), |cell| value(cell, axis, is_short))
        });
    }
    columns.column("runs", |row| row.results.len())
}

/// The head of a setting's column; short for a terminal.
fn head(axis: &str, is_short: bool) -> String {
    if is_short {
        shown(axis)
    } else {
        axis.to_owned()
    }
}

/// The value of a varied setting, short for a terminal; empty if the cell does not have the setting.
fn value(cell: &Cell, axis: &str, is_short: bool) -> String {
    let write = if is_short { short } else { plain };
    cell.value(axis).map_or(String::new(), write)
}
