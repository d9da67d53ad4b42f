//! The benchmarks' pictures: one panel with its legend beside it.

use crate::analysis::statistics::Range;
use crate::output::colors::Rgb;
use crate::output::plot::{Axis, Corner, LINES, Mark, Panel, Sheet, Style};

/// A sheet with one panel.
pub fn sheet(title: &str, x: Axis, y: Axis, marks: Vec<Mark>) -> Sheet {
    let mut panel = Panel::new("", x, y, marks);
    panel.legend = Some(Corner::Beside);
    Sheet {
        title: title.to_owned(),
        columns: 1,
        panel_size: [420.0, 280.0],
        panels: vec![panel],
        ..Sheet::default()
    }
}

/// The color of line or bar `k`: after seven colors the same follow lighter. Colors repeat after fourteen.
pub fn color(k: usize) -> Rgb {
    let color = LINES[k % LINES.len()];
    match k / LINES.len() % 2 {
        0 => color,
        _ => color.map(|part| part.midpoint(u8::MAX)),
    }
}

/// A dot at every median, and a vertical line from the minimum to the maximum.
pub fn dots(points: &[(f64, Range)], color: Rgb, label: &str) -> Vec<Mark> {
    let ends = |&(x, range): &(f64, Range)| {
        let ends = vec![[x, range.minimum], [x, range.maximum]];
        Mark::Line(ends, Style::full(color, 0.8, ""))
    };
    let dots = points.iter().map(|&(x, range)| [x, range.median]);
    let dots = Mark::dots(dots, Style::full(color, 2.2, label));
    points.iter().map(ends).chain([dots]).collect()
}

/// The same, with a line through the medians.
pub fn curve(points: &[(f64, Range)], color: Rgb, label: &str) -> Vec<Mark> {
    let line = points.iter().map(|&(x, range)| [x, range.median]);
    let mut marks = vec![Mark::Line(line.collect(), Style::full(color, 1.4, label))];
    marks.extend(dots(points, color, ""));
    marks
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
    let values = values.filter(|value| *value > 0.0 && value.is_finite());
    let range = Range::of(&values.collect::<Vec<_>>());
    match range.median.is_nan() {
        true => [1.0, 10.0],
        false => [range.minimum / factor, range.maximum * factor],
    }
}
