//! Tables of how often intervals hold the value.

use serde_json::{Value, json};

use super::coverage::{CONFIDENCE, Coverage, Covered};
use crate::error::LabError;
use analysis::statistics::{Range, Share};
use output::table::Table;
use runs::store::Store;

impl Coverage {
    /// The number of intervals that hold the value, of all.
    pub fn total(&self) -> Share {
        let held = self.rows.iter().map(|row| row.held).sum();
        Share::of(held, self.rows.iter().map(|row| row.estimates).sum())
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        self.written(Table::markdown)
    }

    /// For a terminal.
    pub fn text(&self) -> String {
        self.written(Table::text)
    }

    fn written(&self, table: fn(&Table) -> String) -> String {
        let worst = self
            .rows
            .iter()
            .map(|row| 100.0 * row.held as f64 / row.estimates.max(1) as f64);
        let ratio = |k: usize, of: &dyn Fn(&Covered) -> f64| {
            let ratios = self
                .rows
                .iter()
                .filter_map(|row| Some(of(row) / row.known?[k]));
            Range::of(&ratios.collect::<Vec<_>>()).median
        };
        format!(
            "{}\n{} % intervals hold the value in {} of all estimates; worst row {:.1} %. Median over the rows: {:.1} \
             times the runs and {:.1} times the time of an estimate for which spread and error of the step are known. \
             The pools of {} runs at each step took {:.2} hours on one core.\n",
            table(&self.table()),
            100.0 * CONFIDENCE,
            self.total(),
            Range::of(&worst.collect::<Vec<_>>()).minimum,
            ratio(0, &|row| row.runs),
            ratio(1, &|row| row.secs),
            self.pool.seeds,
            self.secs / 3600.0,
        )
    }

    fn table(&self) -> Table {
        Table::of(&self.rows)
            .column("scene", |row| row.scene.as_str())
            .column("profile", |row| row.profile.as_str())
            .column("result", |row| row.result.as_str())
            .column("wanted", |row| row.wanted.as_str())
            .column("mean at the finest step", |row| {
                format!("{:.4} ± {:.4}", row.finest[0], row.finest[1])
            })
            .column("limit", |row| {
                format!("{:.4} ± {:.4}", row.limit[0], row.limit[1])
            })
            .fixed("holds the mean [%]", 1, |row| {
                100.0 * row.held as f64 / row.estimates.max(1) as f64
            })
            .fixed("the limit [%]", 1, |row| {
                100.0 * row.held_limit as f64 / row.estimates.max(1) as f64
            })
            .fixed("runs", 0, |row| row.runs)
            .fixed("if known", 0, |row| row.known.map(|known| known[0]))
            .fixed("time, times that if known", 1, |row| {
                row.known.map(|known| row.secs / known[1])
            })
            .fixed("predicted by another [%]", 0, |row| {
                100.0 * row.predicted[0]
            })
            .fixed("by the pool [%]", 0, |row| 100.0 * row.predicted[1])
            .column("unfinished", |row| row.unfinished)
            .table()
    }

    /// Writes `coverage.md` and `coverage.json` into the store's folder.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, store: &Store) -> Result<(), LabError> {
        store.write("coverage.md", self.markdown().as_bytes())?;
        store.write("coverage.json", format!("{:#}\n", self.json()).as_bytes())?;
        Ok(())
    }

    /// All results as one object.
    pub fn json(&self) -> Value {
        json!({ "confidence": CONFIDENCE, "pool_secs": self.secs, "rows": self.rows })
    }
}
