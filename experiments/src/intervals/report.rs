//! Tables of how often intervals hold the value.

use serde_json::json;

use super::coverage::{CONFIDENCE, Coverage, Covered};
use sandbox::analysis::statistics::{Range, Share};
use sandbox::lab::error::LabError;
use sandbox::output::document::{Block, Document, Findings};
use sandbox::output::table::Table;

/// The name of the study of intervals, of its files, and of its table in documents.
pub const COVERAGE: &str = "coverage";

impl Coverage {
    /// The number of intervals that hold the value, of all.
    pub fn total(&self) -> Share {
        let held = self.rows.iter().map(|row| row.held).sum();
        Share::of(held, self.rows.iter().map(|row| row.estimates).sum())
    }

    /// Everything for readers and programs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let document = Document::of(
            "How often intervals hold the value",
            vec![Block::table(self.table()), Block::text(self.overview())],
        );
        let data = json!({ "confidence": CONFIDENCE, "pool_secs": self.secs, "rows": self.rows });
        Ok(Findings::new(COVERAGE, document, data).with_table(COVERAGE, &self.table())?)
    }

    /// The shares of intervals that hold the value on the scenes on which the method was made, and on the others.
    fn by_half(&self) -> [Share; 2] {
        [true, false].map(|made_on| {
            let rows = || self.rows.iter().filter(|row| row.is_made_on == made_on);
            let held = rows().map(|row| row.held).sum();
            Share::of(held, rows().map(|row| row.estimates).sum())
        })
    }

    /// The share of estimates whose number of runs is within the range that a plan without runs of the scene gives.
    fn planned(&self) -> Share {
        let rows = || self.rows.iter().filter(|row| row.planned.is_some());
        let inside = rows().map(|row| row.in_plan).sum();
        Share::of(inside, rows().map(|row| row.estimates).sum())
    }

    /// The shares of intervals that hold the value: of estimates with fewer than 40 runs, and of the others.
    fn by_runs(&self) -> [Share; 2] {
        let of = |counts: &dyn Fn(&Covered) -> [usize; 2]| {
            let sum = |k: usize| self.rows.iter().map(|row| counts(row)[k]).sum();
            Share::of(sum(0), sum(1))
        };
        [of(&|row| row.few), of(&|row| row.many)]
    }

    /// The scenes, each with the share of intervals that hold the value.
    fn scenes(&self) -> Vec<(&str, Share)> {
        let scenes = self.rows.chunk_by(|a, b| a.scene == b.scene);
        let share = |rows: &[Covered]| {
            let held = rows.iter().map(|row| row.held).sum();
            Share::of(held, rows.iter().map(|row| row.estimates).sum())
        };
        let named = scenes.map(|rows| (rows[0].scene.as_str(), share(rows)));
        named.collect()
    }

    fn overview(&self) -> String {
        let [few, many] = self.by_runs();
        let [made_on, written_after] = self.by_half();
        let scenes = self.scenes().into_iter();
        let scenes: Vec<String> = scenes
            .map(|(name, share)| format!("{name} {share}"))
            .collect();
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
            "{} % intervals hold the value in {} of all estimates: {made_on} on the scenes on which the method was \
             made, {written_after} on those written after it was fixed; {few} with fewer than 40 runs and {many} with \
             more; by scene: {}. The number of runs is in the range of a plan without runs of the scene in {}; worst \
             row {:.1} %. Median over the rows: {:.1} \
             times the runs and {:.1} times the time of an estimate for which spread and error of the step are known. \
             The pools of {} runs at each step took {:.2} hours on one core.",
            100.0 * CONFIDENCE,
            self.total(),
            scenes.join(", "),
            self.planned(),
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
}
