//! The means of regions over time, as text, CSV, JSON and a picture.

use serde_json::{Value, json};

use super::report::{mean_and_std, spread};
use super::{Class, Density, Diagram, FrameMean, Measured};
use crate::lab::gallery::thinned;
use crate::output::plot::{Axis, Corner, Mark, Panel, Sheet, Style, line_color};
use crate::output::table::Table;

/// Maximum number of points of a curve.
const MOST_POINTS: usize = 2000;

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

/// The densities and speeds of each region over time, side by side; `None` without regions.
pub fn picture(measured: &Measured) -> Option<Sheet> {
    let regions = measured.diagrams.iter().zip(1..);
    let regions = regions.filter(|(diagram, _)| diagram.region.is_some());
    let [first, last] = measured.overview.times;
    let panels = regions.flat_map(|(diagram, number)| {
        let panel = |what: &str, label: &str, kinds: &[Density], value: ByDensity| {
            let curves = kinds.iter().map(|&kind| {
                let frames = thinned(&diagram.frames, MOST_POINTS);
                let points = frames.filter_map(|frame| Some([frame.time, value(frame, kind)?]));
                (kind, points.collect::<Vec<[f64; 2]>>())
            });
            let curves: Vec<(Density, Vec<[f64; 2]>)> = curves.collect();
            let values = curves.iter().flat_map(|(_, points)| points).map(|p| p[1]);
            let top = 1.35 * values.fold(0.1, f64::max); // room for the legend
            let marks = curves.into_iter().map(|(kind, points)| {
                let name = match (kind, what) {
                    (Density::SphAtPeople, "speed") => "mean of the people",
                    _ => kind.name(),
                };
                Mark::Line(points, Style::full(line_color(kind as usize), 1.0, name))
            });
            let time = Axis::linear("t [s]", [first, last.max(first + 1.0)]);
            let value = Axis::linear(label, [0.0, top]);
            let title = format!("region {number}: {what}");
            Panel::new(&title, time, value, marks.collect()).with_legend(Corner::UpperRight)
        };
        let speeds = [Density::SphAtPeople, Density::Voronoi];
        [
            panel(
                "density",
                "density [P/m²]",
                &Density::ALL,
                |frame, kind| frame.density(kind),
            ),
            panel("speed", "speed [m/s]", &speeds, |frame, kind| {
                frame.speed(kind)
            }),
        ]
    });
    let panels: Vec<Panel> = panels.collect();
    (!panels.is_empty()).then(|| Sheet::new("", 2, [260.0, 190.0], panels))
}

/// A value of a frame by a density.
type ByDensity = fn(&FrameMean, Density) -> Option<f64>;
