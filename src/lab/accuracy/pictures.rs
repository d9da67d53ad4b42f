//! Work-precision diagrams: error against cost, one curve per knob.

use super::found::{Found, Point as Setting};
use super::report::{Report, WALLS};
use super::scenes::Kind;
use crate::lab::error::LabError;
use crate::output::plot::{Axis, Corner, LINES, Mark, Panel, Point, Sheet, Style};
use crate::runs::store::Store;

/// The quantities drawn for scenes of motion: positions at all samples, velocity and density at the middle one, and the
/// position error by the knob alone.
const MOTION: [usize; 6] = [0, 1, 2, 4, 7, 9];

/// Draws `accuracy-SCENE.svg` and `.png`.
pub fn save(report: &Report, store: &Store) -> Result<(), LabError> {
    for found in &report.scenes {
        let stem = format!("accuracy-{}", found.scene.name);
        sheet(found).save(&store.path(&stem))?;
    }
    if let Some(walls) = &report.walls {
        let stem = format!("accuracy-{WALLS}");
        walls.sheet().save(&store.path(&stem))?;
    }
    Ok(())
}

fn sheet(found: &Found) -> Sheet {
    let costs = range(found.points.iter().map(|point| point.cost.median));
    let quantities = match found.scene.kind {
        Kind::Motion => MOTION.to_vec(),
        Kind::Statistics => (0..found.quantities.len()).collect(),
    };
    let columns = quantities.len().div_ceil(2).max(1);
    Sheet {
        title: format!("{}: {}", found.scene.name, found.scene.about()),
        columns,
        panel_size: [225.0, 195.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels: quantities
            .into_iter()
            .enumerate()
            .map(|(place, k)| panel(found, k, costs, place + 1 == columns))
            .collect(),
    }
}

/// A range that is slightly wider than all positive values.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let positive = values.filter(|&v| v > 0.0 && v.is_finite());
    let [low, high] = positive.fold([f64::INFINITY, 0.0], |[low, high], v| {
        [v.min(low), v.max(high)]
    });
    if low > high {
        return [0.1, 1.0];
    }
    [0.6 * low, 1.6 * high]
}

fn panel(found: &Found, quantity: usize, costs: [f64; 2], legend: bool) -> Panel {
    let shown = |point: &&Setting| point.errors[quantity].is_some_and(|error| error.bound() > 0.0);
    let errors = found
        .points
        .iter()
        .filter_map(|point| point.errors[quantity]);
    let errors = range(errors.map(|error| error.bound()));
    let curves = found.points.chunk_by(|a, b| a.trial.shares_curve(&b.trial));
    let mut marks = Vec::new();
    for (number, curve) in curves.enumerate() {
        let style = style(number, &curve[0].trial.curve);
        let own = curve.iter().filter(shown);
        let points: Vec<Point> = own.filter_map(|point| at(point, quantity)).collect();
        if points.is_empty() {
            continue;
        }
        let line = points.iter().map(|point| [point.x, point.y]).collect();
        let unnamed = Style {
            label: String::new(),
            ..style.clone()
        };
        marks.push(Mark::Line(line, unnamed));
        marks.push(Mark::Points(
            points,
            Style {
                width: 2.6,
                ..style
            },
        ));
    }
    let default = found.points.iter().find(|point| point.trial.is_default);
    let default = default.filter(shown).and_then(|point| at(point, quantity));
    marks.extend(default.map(|point| {
        Mark::Points(
            vec![Point {
                error: 0.0,
                ..point
            }],
            Style::broken(crate::output::plot::BLACK, 6.0, "default"),
        )
    }));
    let shown = &found.quantities[quantity];
    Panel {
        title: shown.name.clone(),
        x: Axis::log("cost [ms per simulated second]", costs),
        y: Axis::log(&format!("error [{}]", shown.unit), errors),
        marks,
        bar: None,
        legend: legend.then_some(Corner::Beside),
    }
}

/// The position of a point in the panel: at its error or, if that is larger, at the error's confidence interval.
fn at(point: &Setting, quantity: usize) -> Option<Point> {
    let error = point.errors[quantity]?;
    Some(Point {
        x: point.cost.median,
        y: error.bound(),
        error: 0.0,
    })
}

fn style(number: usize, label: &str) -> Style {
    let color = LINES[number % LINES.len()];
    if number < LINES.len() {
        Style::full(color, 1.2, label)
    } else {
        Style::broken(color, 1.2, label)
    }
}
