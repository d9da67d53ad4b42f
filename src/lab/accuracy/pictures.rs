//! Work-precision diagrams: error against cost, one curve per choice.

use super::results::{Point as Setting, SceneResults};
use super::scenes::Kind;
use crate::gallery::{curve, positive, with_legend};
use output::plot::{Axis, BLACK, Mark, Panel, Sheet, Style};

/// The quantities drawn for scenes of motion: positions at all samples, velocity and density at the middle one, and the
/// position error by the choice alone.
const MOTION: [usize; 6] = [0, 1, 2, 4, 7, 9];
/// The ends of the axes, relative to the smallest and the largest value.
const ENDS: [f64; 2] = [0.6, 1.6];

/// A panel for each quantity.
pub fn sheet(found: &SceneResults) -> Sheet {
    let costs = positive(found.points.iter().map(|point| point.cost.median), ENDS);
    let quantities = match found.scene.kind {
        Kind::Motion => MOTION.to_vec(),
        Kind::Statistics => (0..found.quantities.len()).collect(),
    };
    let columns = quantities.len().div_ceil(2).max(1);
    let drawn = quantities.into_iter().map(|k| panel(found, k, costs));
    let panels = with_legend(drawn.collect(), columns);
    let title = format!("{}: {}", found.scene.name, found.scene.about());
    Sheet::new(&title, columns, [225.0, 195.0], panels)
}

fn panel(found: &SceneResults, quantity: usize, costs: [f64; 2]) -> Panel {
    // At its error or, if that is larger, at the error's confidence interval.
    let place = |point: &Setting| {
        let bound = point.errors[quantity]?.bound();
        (bound > 0.0).then_some([point.cost.median, bound])
    };
    let heights = found.points.iter().filter_map(place).map(|at| at[1]);
    let errors = positive(heights, ENDS);
    let choices = found.points.chunk_by(|a, b| a.trial.shares_curve(&b.trial));
    let mut marks = Vec::new();
    for (number, choice) in choices.enumerate() {
        let points: Vec<[f64; 2]> = choice.iter().filter_map(place).collect();
        if !points.is_empty() {
            let style = Style::nth(number, 1.2, &choice[0].trial.curve);
            marks.extend(curve(points, style, 2.6));
        }
    }
    let point = found.points.iter().find(|point| point.trial.is_default);
    let default = point.and_then(place);
    marks.extend(default.map(|at| Mark::dots([at], Style::broken(BLACK, 6.0, "default"))));
    let shown = &found.quantities[quantity];
    let x = Axis::log("cost [ms per simulated second]", costs);
    let y = Axis::log(&format!("error [{}]", shown.unit), errors);
    Panel::new(&shown.name, x, y, marks)
}
