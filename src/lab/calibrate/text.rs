//! The results of a calibration for readers and programs.

use super::pictures;
use super::report::{Errors, ParameterResult, Report, ValueResult};
use super::residual::residual;
use super::scene::Set;
use super::search::Stage;
use crate::error::LabError;
use output::document::{Block, Document, Findings, Names};
use output::table::Table;

/// The name of the files with all results, and of the table of all points.
const NAME: &str = "result";
const EVALUATIONS: &str = "evaluations";

/// The names of all files with results.
pub fn names() -> Names {
    Names::new(
        NAME,
        &[EVALUATIONS],
        &["convergence", "errors", "screening"],
    )
}

/// Correlations above this are named in the text.
const CORRELATED: f64 = 0.7;

impl Errors {
    /// The mean and the error, for readers.
    fn written(&self) -> String {
        let failed = match self.failures.len() {
            0 => String::new(),
            count => format!("; {count} failed"),
        };
        match self.mean.zip(self.error) {
            Some((mean, error)) => format!("{mean:.3} ({:+.0} %{failed})", 100.0 * error),
            None => format!("–{failed}"),
        }
    }
}

impl Report<'_> {
    /// Everything for readers and programs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let values = self.values();
        let sets = self.sets().into_iter().map(|of| {
            format!(
                "{}: {:.2} tolerances (root mean square; {:.2} at the start), {} of {} values within the tolerance",
                of.set.name(),
                of.best,
                of.start,
                of.within,
                of.values
            )
        });
        let mut blocks = vec![
            Block::List(sets.collect()),
            Block::text(self.effort()),
            Block::table(self.parameter_table()),
        ];
        for (pair, value) in self.correlated() {
            blocks.push(Block::Text(format!("Correlated: {pair} ({value:+.2}).")));
        }
        blocks.push(Block::table(value_table(&values)));
        let failed = failed(&values);
        if !failed.is_empty() {
            blocks.push(Block::text("Failed runs at the best point:"));
            blocks.push(Block::List(failed));
        }
        let figures = pictures::sheets(self).into_iter();
        blocks.extend(figures.map(|(name, sheet)| Block::figure(name, sheet, "")));
        let document = Document::of(&self.calibration.name, blocks);
        let findings = Findings::new(NAME, document, self.json());
        Ok(findings.with_table(EVALUATIONS, &self.evaluations())?)
    }

    /// How many points were computed.
    fn effort(&self) -> String {
        let of = self.calibration;
        let [search, points, failures] = self.counts();
        let generations = self.found.generations.len();
        format!(
            "{points} points, {search} of them in {generations} generations, with {} seed(s); errors with {} seed(s). \
             {failures} time(s) a run gave no value.",
            of.seeds.len(),
            of.final_seeds.len(),
        )
    }

    fn parameter_table(&self) -> Table {
        let rows = self.parameters();
        let digits = |value: f64| format!("{:.3e}", value).parse().unwrap_or(value);
        let range = |[low, high]: [f64; 2]| format!("{} to {}", digits(low), digits(high));
        let verdict = |row: &ParameterResult| {
            let verdict = match (row.covers, row.identified) {
                (None, _) => "not searched",
                (_, true) => "identified",
                (_, false) => "not identified",
            };
            let bound = if row.at_bound { ", at a bound" } else { "" };
            format!("{verdict}{bound}")
        };
        let table = Table::of(&rows)
            .column("parameter", |row| row.name.as_str())
            .column("bounds", |row| range(row.bounds))
            .column("start", |row| digits(row.start))
            .column("best", |row| digits(row.best))
            .column("95 % interval", |row| row.interval.map(range))
            .column("covers", |row| {
                row.covers.map(|part| format!("{:.0} %", 100.0 * part))
            })
            .column("", verdict);
        table.table()
    }

    /// The searched parameters with correlated errors.
    fn correlated(&self) -> Vec<(String, f64)> {
        let searched = &self.found.searched;
        let name = |k: usize| &self.calibration.parameters[searched[k]].name;
        let numbers = (0..searched.len()).flat_map(|a| (0..a).map(move |b| (b, a)));
        let pairs = numbers.map(|(a, b)| {
            let correlation = self.found.knowledge.correlation(a, b);
            (format!("{} and {}", name(a), name(b)), correlation)
        });
        pairs
            .filter(|(_, value)| value.abs() > CORRELATED)
            .collect()
    }

    /// All points: parameters, misfit and the residuals of the fit.
    fn evaluations(&self) -> Table {
        let of = self.calibration;
        let mut columns = Table::of(&self.found.trials)
            .column("stage", |trial| trial.stage.name())
            .column("generation", |trial| match trial.stage {
                Stage::Generation(number) => Some(number),
                _ => None,
            })
            .column("misfit", |trial| trial.misfit)
            .column("values_missing", |trial| trial.evaluated.failures());
        for (k, parameter) in of.parameters.iter().enumerate() {
            columns = columns.column(&parameter.name, |trial| {
                parameter.value(trial.evaluated.point[k])
            });
        }
        let fitted = of.targets.iter().filter(|target| target.set == Set::Fit);
        for (k, target) in fitted.enumerate() {
            let name = format!("residual of {}: {}", target.of, target.quantity);
            columns = columns.column(&name, |trial| {
                residual(&trial.evaluated.samples[k], target, &of.rule)
            });
        }
        columns.table()
    }
}

fn value_table(values: &[ValueResult]) -> Table {
    let table = Table::of(values)
        .column("", |value| value.set.name())
        .column("scene", |value| value.of.as_str())
        .column("quantity", |value| value.quantity.as_str())
        .column("measured", |value| {
            format!(
                "{} ± {} %",
                value.measured,
                (1e3 * value.tolerance).round() / 10.0
            )
        })
        .column("start", |value| value.start.written())
        .column("best", |value| value.best.written())
        .fixed("tolerances", 1, |value| value.best.residual)
        .fixed("seeds' noise", 1, |value| value.best.noise);
    table.table()
}

/// The reasons of failed runs at the best point.
fn failed(values: &[ValueResult]) -> Vec<String> {
    let said = values.iter().flat_map(|value| {
        let reasons = value.best.failures.iter();
        reasons.map(move |why| format!("{}: {why}", value.of))
    });
    let mut lines: Vec<String> = said.collect();
    lines.dedup();
    lines
}
