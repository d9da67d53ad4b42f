//! The benchmarks' pictures: one panel with its legend beside it.

use crate::analysis::statistics::Range;
use crate::output::colors::{Rgb, light};
use crate::output::plot::{Axis, Corner, LINES, Mark, Panel, Sheet, Style, line_color};

/// A sheet with one panel.
pub fn sheet(title: &str, x: Axis, y: Axis, marks: Vec<Mark>) -> Sheet {
    let panel = Panel::new("", x, y, marks).with_legend(Corner::Beside);
    Sheet::new(title, 1, [420.0, 280.0], vec![panel])
}

/// The color of line or bar `k`: after seven colors the same follow lighter. Colors repeat after fourteen.
pub fn color(k: usize) -> Rgb {
    let part = [1.0, 0.5][k / LINES.len() % 2];
    light(line_color(k), part)
}

/// A line through the medians with a dot at each, and vertical lines from the minima to the maxima.
pub fn medians(points: &[(f64, Range)], color: Rgb, label: &str) -> Vec<Mark> {
    let medians = || points.iter().map(|&(x, range)| [x, range.median]);
    let ends = points.iter().map(|&(x, range)| {
        let ends = [[x, range.minimum], [x, range.maximum]];
        Mark::line(ends, Style::full(color, 0.8, ""))
    });
    let line = Mark::line(medians(), Style::full(color, 1.4, label));
    let dots = Mark::dots(medians(), Style::full(color, 2.2, ""));
    [line].into_iter().chain(ends).chain([dots]).collect()
}

/// A legend entry for bars of this color.
pub fn key(color: Rgb, label: &str) -> Mark {
    Mark::line([], Style::full(color, 6.0, label))
}
