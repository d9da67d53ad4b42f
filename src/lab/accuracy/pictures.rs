//! Work-precision diagrams: error against cost, one curve per knob.

use super::found::{Found, Point as Setting};
use super::report::Report;
use super::scenes::Kind;
use crate::analysis::statistics::Range;
use crate::lab::error::LabError;
use crate::output::plot::{Axis, BLACK, Corner, LINES, Mark, Panel, Sheet, Style};
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
    Ok(())
}

fn sheet(found: &Found) -> Sheet {
    let costs = range(found.points.iter().map(|point| point.cost.median));
    let quantities = match found.scene.kind {
        Kind::Motion => MOTION.to_vec(),
        Kind::Statistics => (0..found.quantities.len()).collect(),
    };
    let columns = quantities.len().div_ceil(2).max(1);
    let panels = quantities.into_iter().enumerate();
    let panels = panels.map(|(place, k)| panel(found, k, costs, place + 1 == columns));
    Sheet {
        title: format!("{}: {}", found.scene.name, found.scene.about()),
        columns,
        panel_size: [225.0, 195.0],
        panels: panels.collect(),
        ..Sheet::default()
    }
}

/// A range that is slightly wider than all positive values.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let positive = values.filter(|&v| v > 0.0 && v.is_finite());
    let range = Range::of(&positive.collect::<Vec<_>>());
    match range.median.is_nan() {
        true => [0.1, 1.0],
        false => [0.6 * range.minimum, 1.6 * range.maximum],
    }
}

fn panel(found: &Found, quantity: usize, costs: [f64; 2], legend: bool) -> Panel {
    // At its error or, if that is larger, at the error's confidence interval.
    let place = |point: &Setting| {
        let bound = point.errors[quantity]?.bound();
        (bound > 0.0).then_some([point.cost.median, bound])
    };
    let errors = found.points.iter().filter_map(place);
    let errors = range(errors.map(|[_, error]| error));
    let curves = found.points.chunk_by(|a, b| a.trial.shares_curve(&b.trial));
    let mut marks = Vec::new();
    for (number, curve) in curves.enumerate() {
        let points: Vec<[f64; 2]> = curve.iter().filter_map(place).collect();
        if points.is_empty() {
            continue;
        }
        let (color, label) = (LINES[number % LINES.len()], &curve[0].trial.curve);
        let style: fn(_, _, &str) -> _ = match number < LINES.len() {
            true => Style::full,
            false => Style::broken,
        };
        marks.push(Mark::Line(points.clone(), style(color, 1.2, "")));
        marks.push(Mark::dots(points, style(color, 2.6, label)));
    }
    let default = found.points.iter().find(|point| point.trial.is_default);
    let default = default.and_then(place);
    marks.extend(default.map(|at| Mark::dots([at], Style::broken(BLACK, 6.0, "default"))));
    let shown = &found.quantities[quantity];
    let x = Axis::log("cost [ms per simulated second]", costs);
    let y = Axis::log(&format!("error [{}]", shown.unit), errors);
    Panel {
        legend: legend.then_some(Corner::Beside),
        ..Panel::new(&shown.name, x, y, marks)
    }
}
