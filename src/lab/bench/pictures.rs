//! Helpers for the benchmarks' pictures.

use crate::output::colors::Rgb;
use crate::output::plot::{Axis, Corner, LINES, Mark, Panel, Point, Sheet, Style};

/// A sheet with one panel and its legend beside it.
pub fn sheet(title: String, x: Axis, y: Axis, marks: Vec<Mark>) -> Sheet {
    let panel = Panel {
        title: String::new(),
        x,
        y,
        marks,
        bar: None,
        legend: Some(Corner::Beside),
    };
    Sheet {
        title,
        columns: 1,
        panel_size: [420.0, 280.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: None,
        panels: vec![panel],
    }
}

/// The color of line `k`; colors repeat after seven.
pub fn color(k: usize) -> Rgb {
    LINES[k % LINES.len()]
}

/// A line with a dot at every point.
pub fn dotted(points: &[[f64; 2]], color: Rgb, label: &str) -> [Mark; 2] {
    let dots = points.iter().map(|&[x, y]| Point { x, y, error: 0.0 });
    [
        Mark::Line(points.to_vec(), Style::full(color, 1.4, label)),
        Mark::Points(dots.collect(), Style::full(color, 2.2, "")),
    ]
}

/// A vertical line from the minimum to the maximum.
pub fn range(x: f64, [low, high]: [f64; 2], color: Rgb) -> Mark {
    Mark::Line(vec![[x, low], [x, high]], Style::full(color, 0.8, ""))
}

/// An upright bar.
pub fn bar([left, right]: [f64; 2], [low, high]: [f64; 2], color: Rgb) -> Mark {
    let corners = vec![[left, low], [right, low], [right, high], [left, high]];
    Mark::Area(corners, color)
}

/// A legend entry for bars of this color.
pub fn key(color: Rgb, label: &str) -> Mark {
    Mark::Line(Vec::new(), Style::full(color, 6.0, label))
}

/// The smallest and the largest value, moved outward by a factor, for a logarithmic axis.
pub fn around(values: impl Iterator<Item = f64>, factor: f64) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for value in values.filter(|value| *value > 0.0 && value.is_finite()) {
        (low, high) = (low.min(value), high.max(value));
    }
    if low > high {
        return [1.0, 10.0];
    }
    [low / factor, high * factor]
}
