//! A study as tables: all cells, and means over seeds.

use serde_json::Value;

use super::cell::{Cell, plain, short};
use super::gathered::{Combination, Gathered, State};
use super::{Shard, Study};
use crate::error::LabError;
use output::document::{Block, Document, Findings, Names};
use output::plot::Sheet;
use output::table::{self, Columns, Table};
use runs::case::RunResult;

/// A column about the run itself.
type Count = (&'static str, fn(&RunResult) -> table::Cell);

/// Columns about the run itself, between the metrics and the computing time.
const COUNTS: [Count; 9] = [
    ("entered", |result| result.summary.agents.into()),
    ("remaining", |result| result.summary.remaining.into()),
    ("stuck", |result| result.summary.stuck.into()),
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

type Row<'a> = (&'a Cell, &'a State);

impl Study {
    /// The names of the files with results: one row per cell, means over seeds, and mean curves if the runs measure
    /// any.
    pub fn names(&self) -> Names {
        let curves = self.curves_name();
        Names::new(
            &self.results_name(),
            &[&self.name, &self.summary_name(), &curves],
            &[&self.name, &curves],
        )
    }

    /// The name of the files with all of it: the study's own file may be called `NAME.json`.
    fn results_name(&self) -> String {
        format!("{}-results", self.name)
    }

    fn summary_name(&self) -> String {
        format!("{}-summary", self.name)
    }

    pub(super) fn curves_name(&self) -> String {
        format!("{}-curves", self.name)
    }
}

impl Gathered<'_> {
    /// Everything for readers and programs, with this picture.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self, sheet: Option<Sheet>) -> Result<Findings, LabError> {
        let name = &self.study.name;
        let (means, about) = self.means_table();
        let mut blocks = vec![Block::table(means), Block::text(about)];
        blocks.extend(sheet.map(|sheet| Block::figure(name, sheet, "")));
        let curves = self.mean_curves();
        blocks.extend(curves.sheet().map(|sheet| {
            let caption = "Mean curves over the seeds.";
            Block::figure(&self.study.curves_name(), sheet, caption)
        }));
        let document = Document::of(format!("Results of the study {name}"), blocks);
        let whole = Findings::new(&self.study.results_name(), document, self.json());
        let mut findings = self.add_tables(whole)?;
        if let Some(rows) = curves.csv()? {
            findings.tables.push((self.study.curves_name(), rows));
        }
        Ok(findings)
    }

    /// Adds the tables of all cells and of the means over seeds.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn add_tables(&self, findings: Findings) -> Result<Findings, LabError> {
        let findings = findings.with_table(&self.study.name, &self.cells_table())?;
        let summary = self.study.summary_name();
        Ok(findings.with_table(&summary, &self.summary_table())?)
    }

    /// All cells, one row each.
    fn cells_table(&self) -> Table {
        let rows: Vec<Row> = self.study.cells.iter().zip(&self.states).collect();
        let metrics = self.metrics();
        let mut columns = self.first_columns(&rows, &self.study.axes, plain);
        for name in &metrics {
            columns = columns.column(name, |(_, state)| {
                let metrics = &state.result()?.summary.metrics;
                metrics
                    .get(name)
                    .filter(|value| !value.is_null())
                    .map(plain)
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
        let columns = columns
            .column("wall_secs", |(_, state)| {
                state.result().map(|r| format!("{:.3}", r.wall_secs))
            })
            .column("error", |(_, state)| match state {
                State::Failed(message) => Some(message.clone()),
                State::Finished(_) | State::Missing => None,
            });
        columns.table()
    }

    /// The means over seeds for programs, one row per combination of settings: half the 95 % confidence intervals and
    /// the numbers of values.
    pub fn summary_table(&self) -> Table {
        let rows = self.combinations();
        let mut columns = combined(&rows, &self.study.axes, plain);
        for (k, name) in self.numbers().iter().enumerate() {
            let count = |row: &Combination| row.means[k].map_or(0, |mean| mean.count);
            columns = columns
                .spread(name, 3, ["_mean", "_ci95"], |row| confident(row, k))
                .column(&format!("{name}_n"), count);
        }
        columns.table()
    }

    /// The same for readers: mean ± half the confidence interval, and what this means.
    fn means_table(&self) -> (Table, String) {
        let rows = self.combinations();
        let mut columns = combined(&rows, &self.study.short_axes(), short);
        let mut about =
            "± is half the 95 % confidence interval of the mean over seeds (Student's t)."
                .to_owned();
        for (k, name) in self.numbers().iter().enumerate() {
            if rows.iter().all(|row| lacking(row, k).is_none()) {
                columns = columns.fixed(name, 3, |row| confident(row, k));
                continue;
            }
            columns = columns.column(name, |row| {
                let mean = table::Cell::from(confident(row, k)).fixed(3);
                mean + &lacking(row, k).unwrap_or_default()
            });
            about = format!("{}{LACKING}", about.trim_end_matches(LACKING));
        }
        (columns.table(), about)
    }

    /// The cells of a shard with their states, for a terminal.
    pub fn list(&self, shard: Shard) -> String {
        let cells = self.study.cells.iter().zip(&self.states);
        let rows: Vec<Row> = cells.filter(|(cell, _)| shard.has(cell.number)).collect();
        let columns = self.first_columns(&rows, &self.study.short_axes(), short);
        columns.table().text()
    }

    /// The number, the varied settings, the seed and the status.
    fn first_columns<'r>(
        &self,
        rows: &'r [Row],
        axes: &[String],
        write: fn(&Value) -> String,
    ) -> Columns<'r, Row<'r>> {
        let numbered = Table::of(rows).column("cell", |(cell, _)| cell.number.to_string());
        let mut columns = with_axes(numbered, axes, write, |(cell, _)| Some(cell));
        if !self.study.varies_seed() {
            columns = columns.column("seed", |(cell, _)| cell.case.seed.to_string());
        }
        columns.column("status", |(_, state)| state.name())
    }
}

/// The `k`-th mean with half its confidence interval.
fn confident(row: &Combination, k: usize) -> Option<table::Cell> {
    row.means[k].map(|mean| table::Cell::Spread(mean.mean, mean.interval_95()))
}

/// What a number of runs after a mean says.
const LACKING: &str = " [n of m]: the mean of the n runs that have a value, such as those that all people leave; \
                           with the others it would be another one.";

/// How many of the finished runs have the `k`-th value, if some do not.
fn lacking(row: &Combination, k: usize) -> Option<String> {
    let (count, all) = (row.means[k].map_or(0, |mean| mean.count), row.results.len());
    (count < all).then(|| format!(" [{count} of {all}]"))
}

/// The varied settings and the number of finished runs.
fn combined<'r>(
    rows: &'r [Combination],
    axes: &[String],
    write: fn(&Value) -> String,
) -> Columns<'r, Combination<'r>> {
    let columns = with_axes(Table::of(rows), axes, write, |row| row.cells.first());
    columns.column("runs", |row| row.results.len())
}

/// Adds the varied settings, with heads and values as `write` writes them; empty if a cell does not have the setting.
fn with_axes<'r, R>(
    mut columns: Columns<'r, R>,
    axes: &[String],
    write: fn(&Value) -> String,
    cell: fn(&'r R) -> Option<&'r Cell>,
) -> Columns<'r, R> {
    for axis in axes {
        let head = write(&Value::from(axis.as_str()));
        columns = columns.column(&head, |row| {
            let value = cell(row).and_then(|cell| cell.value(axis));
            value.map_or(String::new(), write)
        });
    }
    columns
}
