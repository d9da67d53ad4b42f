//! The means of regions over time, as text, CSV and JSON.

use serde_json::{Value, json};

use super::report::{mean_and_std, spread};
use super::{Class, Density, Diagram, Measured};
use crate::output::table::Table;

/// One density of a region.
struct Row {
    /// The number of the region, from 1.
    region: usize,
    walkable: Option<f64>,
    kind: Density,
    means: Class,
}

/// One row per region and density.
fn rows(measured: &Measured) -> Vec<Row> {
    let regions = measured.diagrams.iter().zip(1..);
    let regions = regions.filter(|(diagram, _)| diagram.region.is_some());
    let rows = regions.flat_map(|(diagram, region)| {
        let means = means(measured, diagram);
        means.map(move |(kind, means)| Row {
            region,
            walkable: diagram.walkable,
            kind,
            means,
        })
    });
    rows.collect()
}

/// The means of a region by all densities that are known.
fn means(measured: &Measured, diagram: &Diagram) -> impl Iterator<Item = (Density, Class)> {
    let frames = measured.overview.frames;
    let kinds = Density::ALL.into_iter();
    let known = kinds.filter_map(move |kind| Some((kind, diagram.means(kind, frames)?)));
    known.collect::<Vec<_>>().into_iter()
}

/// As text for a terminal; empty without regions.
pub fn text(measured: &Measured) -> String {
    let rows = rows(measured);
    if rows.is_empty() {
        return String::new();
    }
    let [from, until] = measured.overview.times;
    let table = Table::of(&rows)
        .column("region", |row| row.region)
        .fixed("walkable [m²]", 2, |row| row.walkable)
        .column("by", |row| row.kind.name())
        .fixed("density [P/m²]", 3, |row| spread(row.means.density))
        .fixed("speed [m/s]", 3, |row| spread(row.means.speed))
        .fixed("flow [1/(m s)]", 3, |row| spread(row.means.flow))
        .table();
    format!(
        "\nregions, means over {} frames from {from:.2} s to {until:.2} s\n{}",
        measured.overview.frames,
        table.text()
    )
}

/// As a table for programs.
pub fn table(measured: &Measured) -> Table {
    let [from, until] = measured.overview.times;
    let rows = rows(measured);
    let parts = ["_mean", "_std"];
    Table::of(&rows)
        .column("region", |row| row.region)
        .column("walkable_m2", |row| row.walkable)
        .column("from_secs", |_| from)
        .column("until_secs", |_| until)
        .column("by", |row| row.kind.key())
        .spread("density", 3, parts, |row| spread(row.means.density))
        .spread("speed", 3, parts, |row| spread(row.means.speed))
        .spread("flow", 3, parts, |row| spread(row.means.flow))
        .table()
}

/// As a JSON array.
pub fn json(measured: &Measured) -> Vec<Value> {
    let regions = measured.diagrams.iter();
    let regions = regions.filter_map(|diagram| Some((diagram, diagram.region?)));
    let region = |(diagram, region): (&Diagram, crate::engine::scene::Region)| {
        let means = means(measured, diagram).map(|(kind, means)| {
            let values = json!({
                "density": mean_and_std(&means.density),
                "speed": mean_and_std(&means.speed),
                "flow": mean_and_std(&means.flow),
            });
            (kind.key().to_owned(), values)
        });
        let means: serde_json::Map<String, Value> = means.collect();
        let corners = [region.min, region.max].map(|p| [p.x, p.y]);
        json!({
            "region": corners,
            "walkable_m2": diagram.walkable,
            "means": means,
        })
    };
    regions.map(region).collect()
}
