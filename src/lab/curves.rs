//! Mean curves of repeated runs with their bands: passages over time (N(t)) of each `line_flow`, and speed by density
//! of `speed_by_density`.

use std::collections::BTreeSet;

use crate::error::LabError;
use crate::gallery::{band, spanned};
use analysis::bootstrap::{MeanPoint, mean_curve};
use output::colors::{Rgb, light};
use output::plot::{Axis, Mark, Panel, Style};
use output::table::Table;
use runs::case::RunResult;

/// What the bands are, for titles and tables.
pub const BAND: &str = "band: 95 % of the mean at each point, bootstrap over runs";
/// The number of points of a curve over time.
const POINTS: u32 = 100;
/// The color of a band, as a part of its line's.
const LIGHT: f64 = 0.25;

/// The mean curve of some runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What it is about: the name of a line, or `speed by density`.
    pub name: String,
    /// The labels of its axes.
    pub axes: [&'static str; 2],
    /// The number of runs.
    pub runs: usize,
    /// Its points: positions on the horizontal axis, means and bands.
    pub points: Vec<(f64, MeanPoint)>,
}

/// The curves of some runs of the same scenario; empty if it measures none. Times end with the last passage of all
/// runs.
pub fn curves(runs: &[&RunResult]) -> Vec<Curve> {
    let names: BTreeSet<&String> = runs
        .iter()
        .flat_map(|run| run.summary.data.keys())
        .collect();
    let passages = names.into_iter().filter_map(|name| passages(runs, name));
    passages.chain(by_density(runs)).collect()
}

/// The number of passages over time; `None` if the data of this name are not times.
fn passages(runs: &[&RunResult], name: &str) -> Option<Curve> {
    let times = runs.iter().map(|run| run.summary.data(name));
    Curve::of_passages(name, &times.collect::<Option<Vec<_>>>()?)
}

/// The mean speed by density; `None` without the measurement.
fn by_density(runs: &[&RunResult]) -> Option<Curve> {
    let found = runs.first()?.summary.metrics.keys().filter_map(|name| {
        let ends = name.strip_prefix("speed_at_")?.strip_suffix("_per_m2")?;
        let (low, high) = ends.split_once("_to_")?;
        let [low, high]: [f64; 2] = [low.parse().ok()?, high.parse().ok()?];
        Some((0.5 * (low + high), name))
    });
    let mut bins: Vec<(f64, &String)> = found.collect();
    bins.sort_by(|a, b| a.0.total_cmp(&b.0));
    let of_runs = runs.iter().map(|run| {
        let value = |(_, name): &(f64, &String)| run.summary.metric(name);
        bins.iter().map(value).collect()
    });
    let values: Vec<Vec<Option<f64>>> = of_runs.collect();
    let at: Vec<f64> = bins.iter().map(|(at, _)| *at).collect();
    let labels = ["density [P/m²]", "speed [m/s]"];
    let curve = Curve::of("speed by density".to_owned(), labels, &at, &values);
    (curve.points.len() > 1).then_some(curve)
}

impl Curve {
    fn of(name: String, axes: [&'static str; 2], at: &[f64], values: &[Vec<Option<f64>>]) -> Self {
        let points = at.iter().copied().zip(mean_curve(values));
        Self {
            name,
            axes,
            runs: values.len(),
            points: points
                .filter_map(|(at, point)| Some((at, point?)))
                .collect(),
        }
    }

    /// The number of passages over time, from the times of some runs; `None` without passages, or if the times are not
    /// in order.
    pub fn of_passages(name: &str, times: &[Vec<f64>]) -> Option<Self> {
        let last = times.iter().flatten().copied().fold(0.0, f64::max);
        if last <= 0.0 || !times.iter().all(|times| times.is_sorted()) {
            return None;
        }
        let at: Vec<f64> = (0..=POINTS)
            .map(|k| last * f64::from(k) / f64::from(POINTS))
            .collect();
        let of_runs = times.iter().map(|times| {
            let until = |at: &f64| times.partition_point(|time| time <= at);
            at.iter().map(|at| Some(until(at) as f64)).collect()
        });
        let counts: Vec<Vec<Option<f64>>> = of_runs.collect();
        let labels = ["time [s]", "passages"];
        Some(Self::of(name.to_owned(), labels, &at, &counts))
    }

    /// Its band and its line.
    pub fn marks(&self, color: Rgb, label: &str) -> [Mark; 2] {
        let end = |k: usize| -> Vec<[f64; 2]> {
            let points = self.points.iter();
            points.map(|(at, point)| [*at, point.band[k]]).collect()
        };
        let line = self.points.iter().map(|(at, point)| [*at, point.mean]);
        [
            band(&end(1), &end(0), light(color, LIGHT)),
            Mark::line(line, Style::full(color, 1.2, label)),
        ]
    }
}

/// A panel with curves of the same name: each with a color and a label. The bands are behind all lines.
pub fn panel(curves: &[(&Curve, Rgb, String)]) -> Option<Panel> {
    let (first, ..) = curves.first()?;
    let (mut bands, mut lines) = (Vec::new(), Vec::new());
    for (curve, color, label) in curves {
        let [band, line] = curve.marks(*color, label);
        bands.push(band);
        lines.push(line);
    }
    let points = || curves.iter().flat_map(|(curve, ..)| &curve.points);
    let ends = points().flat_map(|(_, point)| point.band);
    let [x, y] = first.axes;
    let x = Axis::linear(x, spanned(points().map(|(at, _)| *at)));
    let y = Axis::linear(y, spanned(ends));
    let marks = bands.into_iter().chain(lines).collect();
    Some(Panel::new(&first.name, x, y, marks))
}

/// A point of a curve, as a line of a table.
struct Line<'a> {
    settings: &'a str,
    curve: &'a Curve,
    at: f64,
    point: MeanPoint,
}

/// All points as CSV: curves with the settings that they belong to. `low` and `high` are the ends of the band.
///
/// # Errors
/// The table cannot be written.
pub fn csv(curves: &[(String, Curve)]) -> Result<Vec<u8>, LabError> {
    let lines = curves.iter().flat_map(|(settings, curve)| {
        let line = move |&(at, point): &(f64, MeanPoint)| Line {
            settings,
            curve,
            at,
            point,
        };
        curve.points.iter().map(line)
    });
    let lines: Vec<Line> = lines.collect();
    let table = Table::of(&lines)
        .column("settings", |line| line.settings)
        .column("curve", |line| line.curve.name.as_str())
        .column("x", |line| line.at)
        .column("mean", |line| line.point.mean)
        .column("low_95", |line| line.point.band[0])
        .column("high_95", |line| line.point.band[1])
        .column("n", |line| line.point.runs);
    Ok(table.table().csv()?)
}
