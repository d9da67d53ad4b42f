//! The results of a calibration as Markdown, and its points as CSV.

use super::report::{Errors, ParameterResult, Report, ValueResult};
use super::residual::residual;
use super::scene::Set;
use super::search::Stage;
use crate::error::LabError;
use output::table::Table;

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
    /// The results as Markdown.
    pub fn markdown(&self) -> String {
        let of = self.calibration;
        let values = self.values();
        let mut text = format!("# {}\n\n", of.name);
        for of in self.sets() {
            text += &format!(
                "- {}: {:.2} tolerances (root mean square; {:.2} at the start), {} of {} values within the tolerance\n",
                of.set.name(),
                of.best,
                of.start,
                of.within,
                of.values
            );
        }
        let [search, points, failures] = self.counts();
        let generations = self.found.generations.len();
        text += &format!(
            "\n{points} points, {search} of them in {generations} generations, with {} seed(s); errors with {} \
             seed(s). {failures} time(s) a run gave no value.\n\n{}",
            of.seeds.len(),
            of.final_seeds.len(),
            self.parameter_table(),
        );
        for (pair, value) in self.correlated() {
            text += &format!("\nCorrelated: {pair} ({value:+.2}).\n");
        }
        text + "\n" + &value_table(&values) + &failed(&values)
    }

    fn parameter_table(&self) -> String {
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
        table.table().markdown()
    }

    /// The searched parameters with correlated errors.
    fn correlated(&self) -> Vec<(String, f64)> {
        let searched = &self.found.searched;
        let name = |k: usize| &self.calibration.parameters[searched[k]].name;
        let pairs = (0..searched.len()).flat_map(|a| (0..a).map(move |b| (b, a)));
        let pairs = pairs.map(|(a, b)| {
            let correlation = self.found.knowledge.correlation(a, b);
            (format!("{} and {}", name(a), name(b)), correlation)
        });
        pairs
            .filter(|(_, value)| value.abs() > CORRELATED)
            .collect()
    }

    /// All points as CSV: parameters, misfit and the residuals of the fit.
    pub(super) fn csv(&self) -> Result<Vec<u8>, LabError> {
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
        Ok(columns.table().csv()?)
    }
}

fn value_table(values: &[ValueResult]) -> String {
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
    table.table().markdown()
}

/// The reasons of failed runs at the best point.
fn failed(values: &[ValueResult]) -> String {
    let lines = values.iter().flat_map(|value| {
        let reasons = value.best.failures.iter();
        reasons.map(move |why| format!("- {}: {why}\n", value.of))
    });
    let mut lines: Vec<String> = lines.collect();
    lines.dedup();
    match lines.is_empty() {
        true => String::new(),
        false => format!("\nFailed runs at the best point:\n\n{}", lines.concat()),
    }
}
