//! Open questions of crowd physics: the behavior of the model's crowds in situations with known experiments. Each
//! question is a study, a table and a picture; docs/findings/questions.md has the known results and the conclusions.

mod oscillations;
mod queue_pushes;
mod start_waves;
mod swaying;

mod phenomena;

use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use sandbox::analysis::statistics::{Estimate, MeanStd};
use sandbox::lab::error::LabError;
use sandbox::lab::gallery::distinct;
use sandbox::lab::reproduce::Product;
use sandbox::lab::sweep::{Combination, Gathered};
use sandbox::output::document::{Block, Findings};
use sandbox::output::plot::Sheet;
use sandbox::output::table::Table;

/// All products.
pub const PRODUCTS: [&Product; 6] = [
    &oscillations::PRODUCT,
    &swaying::PRODUCT,
    &swaying::RATES,
    &start_waves::PRODUCT,
    &queue_pushes::PRODUCT,
    &phenomena::PRODUCT,
];

/// A table and a picture of the only study of a product.
fn found(
    product: &Product,
    studies: &[Gathered],
    table: fn(&[Combination]) -> Table,
    sheet: fn(&[Combination]) -> Sheet,
) -> Result<Findings, LabError> {
    let rows = studies[0].combinations();
    let figure = Block::figure(product.name, sheet(&rows), product.about);
    of_studies(product, studies, vec![Block::table(table(&rows)), figure])
}

/// Findings of all runs of these studies, with their tables.
fn of_studies(
    product: &Product,
    studies: &[Gathered],
    blocks: Vec<Block>,
) -> Result<Findings, LabError> {
    let data: Vec<Value> = studies.iter().map(Gathered::json).collect();
    let findings = product.findings(blocks, json!(data));
    studies
        .iter()
        .try_fold(findings, |findings, study| study.add_tables(findings))
}

/// The profile of a combination: its name, or its base and the parameters that distinguish it.
fn profile(row: &Combination) -> String {
    let value = row.value("profile");
    let parameter = |key: &str| value?.get("parameters")?.get(key);
    let base = value.and_then(|value| value.get("base").unwrap_or(value).as_str());
    let law = parameter("walking_law").and_then(Value::as_str);
    let number = |key: &str, sign: &str, unit: &str| {
        parameter(key).map(|value| format!("{sign} = {value}{unit}"))
    };
    let parts = [
        Some(base.unwrap_or("default").to_owned()),
        law.map(str::to_owned),
        number("headway_anticipation", "t", " s"),
        number("gas_constant", "k", ""),
        number("support_radius", "h", " m"),
        number("rest_density_min", "ρ⁰min", ""),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// What a measurement of the first run found.
fn first<T: DeserializeOwned>(row: &Combination, name: &str) -> Option<T> {
    row.results.first()?.summary.data(name)
}

/// The mean of a value over seeds, with its deviation; `None` without values.
fn mean(row: &Combination, metric: &str) -> Option<MeanStd> {
    let values = row.values(metric).into_iter().flatten();
    MeanStd::of(&values.collect::<Vec<f64>>())
}

/// The mean speed of the front over seeds, with the mean standard error of the fits.
fn front_speed(row: &Combination) -> Option<Estimate> {
    Some(Estimate {
        value: mean(row, "front_speed_m_per_s")?.mean,
        error: mean(row, "front_speed_error_m_per_s")?.mean,
    })
}

/// Combinations in groups with the same name, in the order of their first members.
fn grouped<'r, 'a>(
    rows: &'r [Combination<'a>],
    name: impl Fn(&Combination) -> String,
) -> Vec<(String, Vec<&'r Combination<'a>>)> {
    let group = |of: String| {
        let own = rows.iter().filter(|row| name(row) == of).collect();
        (of, own)
    };
    let names = distinct(rows.iter().map(&name));
    names.into_iter().map(group).collect()
}
