//! What the numbers of a run are worth: the parts of their errors, as far as one run and experiments say them.

use crate::error::LabError;
use crate::model::Model;
use output::document::Block;
use output::table::as_precise;
use runs::summary::Summary;
use scenario::Scenario;
use scenario::quote::shown;

/// Numbers are written with as many digits as this share of them has in two: no error of them is smaller.
const PRECISION: f64 = 0.1;

/// The time at which 95 % of the people had left, and what measurements of the run say that experiments measure, too:
/// each with the parts of its error. Nothing for a run that nobody left and without such measurements.
///
/// # Errors
/// Data that ship with the program are invalid.
pub fn worth(scenario: &Scenario, summary: &Summary) -> Result<Vec<Block>, LabError> {
    let model = Model::of(scenario)?;
    let part = |name: &str, value| model.part(name, value, [summary].into_iter());
    let line = |name: &str, label: &str, unit: &str, value: f64| {
        let written = |number: f64| as_precise(number, PRECISION * value.abs());
        let of_model = match part(name, value) {
            Ok(part) => part.text(value, written),
            Err(unknown) => format!("model: not known, {unknown}"),
        };
        let value = written(value);
        format!("{label}: {value} {unit}; chance and step: not known from one run; {of_model}")
    };
    let out = summary
        .t95_secs
        .map(|secs| line("t95_secs", "95 % out", "s", secs));
    let quantities = scenario
        .measurements
        .iter()
        .flat_map(|one| one.quantities());
    let measured = quantities.filter_map(|quantity| {
        let value = summary.metric(&quantity.name)?;
        part(&quantity.name, value).ok()?;
        Some(line(
            &quantity.name,
            &shown(&quantity.name),
            quantity.unit,
            value,
        ))
    });
    let lines: Vec<String> = out.into_iter().chain(measured).collect();
    if lines.is_empty() {
        return Ok(Vec::new());
    }
    let about = "Model: the bounds within which what people do would lie if this scene were one more experiment like \
                 those of the validation. Chance and step: `sandbox estimate` says them, for example with \
                 `--error t95_secs=5%`.";
    Ok(vec![
        Block::heading("What the numbers are worth"),
        Block::List(lines),
        Block::text(about),
    ])
}
