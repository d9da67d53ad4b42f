//! The means of regions, for readers and programs.

use serde_json::{Map, Value, json};

use super::{Class, Density, Diagram, Measured};
use analysis::statistics::MeanStd;
use engine::scene::Region;
use output::document::Block;
use output::table::{Cell, Table};

/// The means of a region by one density.
struct RegionMeans<'m> {
    /// The number of the region, from 1.
    number: usize,
    region: Region,
    diagram: &'m Diagram,
    kind: Density,
    means: Class,
}

/// One row per region and density.
fn region_means(measured: &Measured) -> Vec<RegionMeans<'_>> {
    let regions = measured.diagrams.iter().zip(1..);
    let rows = regions.flat_map(|(diagram, number)| {
        let row = move |kind| {
            Some(RegionMeans {
                number,
                region: diagram.region?,
                diagram,
                kind,
                means: diagram.means(kind, measured.overview.frames)?,
            })
        };
        Density::ALL.into_iter().filter_map(row)
    });
    rows.collect()
}

/// The means of regions; nothing without regions.
pub fn block(measured: &Measured) -> Option<Block> {
    let rows = region_means(measured);
    let [from, until] = measured.overview.times;
    let table = Table::of(&rows)
        .column("region", |row| row.number)
        .fixed("walkable [m²]", 2, |row| row.diagram.walkable)
        .column("by", |row| row.kind.name())
        .fixed("density [P/m²]", 3, |row| spread(row.means.density))
        .fixed("speed [m/s]", 3, |row| spread(row.means.speed))
        .fixed("flow [1/(m s)]", 3, |row| spread(row.means.flow))
        .table();
    let caption = format!(
        "Regions, means over {} frames from {from:.2} s to {until:.2} s.",
        measured.overview.frames,
    );
    (!rows.is_empty()).then_some(Block::Table(table, caption))
}

/// The means of regions as a table for programs.
pub fn table(measured: &Measured) -> Table {
    let [from, until] = measured.overview.times;
    let rows = region_means(measured);
    let parts = ["_mean", "_std"];
    Table::of(&rows)
        .column("region", |row| row.number)
        .column("walkable_m2", |row| row.diagram.walkable)
        .column("from_secs", |_| from)
        .column("until_secs", |_| until)
        .column("by", |row| row.kind.key())
        .spread("density", 3, parts, |row| spread(row.means.density))
        .spread("speed", 3, parts, |row| spread(row.means.speed))
        .spread("flow", 3, parts, |row| spread(row.means.flow))
        .table()
}

/// As JSON, one object per region.
pub fn json(measured: &Measured) -> Vec<Value> {
    let rows = region_means(measured);
    let regions = rows.chunk_by(|a, b| a.number == b.number);
    let region = |rows: &[RegionMeans]| {
        let classes = rows.iter();
        let means = classes.map(|row| (row.kind.key().to_owned(), of_class(&row.means)));
        json!({
            "region": corners(&rows[0].region),
            "walkable_m2": rows[0].diagram.walkable,
            "means": means.collect::<Map<_, _>>(),
        })
    };
    regions.map(region).collect()
}

/// The means of a class as JSON.
pub fn of_class(class: &Class) -> Value {
    json!({
        "density": mean_and_std(&class.density),
        "speed": mean_and_std(&class.speed),
        "flow": mean_and_std(&class.flow),
    })
}

/// The corners of a region.
pub fn corners(region: &Region) -> [[f64; 2]; 2] {
    [region.min, region.max].map(|p| [p.x, p.y])
}

/// A mean and its standard deviation; `None` without values.
pub fn spread(of: MeanStd) -> Option<Cell> {
    (of.count > 0).then(|| Cell::Spread(of.mean, Some(of.population_std())))
}

/// `null` without values.
pub fn mean_and_std(of: &MeanStd) -> Option<Value> {
    (of.count > 0).then(|| json!({"mean": of.mean, "std": of.population_std()}))
}
