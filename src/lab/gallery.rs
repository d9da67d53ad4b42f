//! What the pictures of studies share: curves with dots, medians, maps with text, bands, ranges of axes, and one legend
//! for all panels. The pictures of each study only say what is on which axis.

use analysis::statistics::{Estimate, Range};
use output::colors::{Rgb, light};
use output::plot::{
    Axis, BLACK, Cells, ColorBar, Corner, LINES, Mark, Panel, Point, Sheet, Style, line_color,
};

/// Gray, for bands of measured values.
pub const BAND: Rgb = [225, 225, 225];

/// A sheet with one panel and its legend beside it.
pub fn single(title: &str, x: Axis, y: Axis, marks: Vec<Mark>) -> Sheet {
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

/// One legend for all panels, beside the last one of the first row.
pub fn with_legend(mut panels: Vec<Panel>, columns: usize) -> Vec<Panel> {
    if let Some(last) = panels.iter_mut().take(columns).last() {
        last.legend = Some(Corner::Beside);
    }
    panels
}

/// A line through values, and a dot with an error bar at each of them. The label stands beside a dot.
pub fn curve<P: Into<Point>>(
    values: impl IntoIterator<Item = P>,
    style: Style,
    radius: f64,
) -> [Mark; 2] {
    let points: Vec<Point> = values.into_iter().map(P::into).collect();
    let dots = Style {
        width: radius,
        ..style.clone()
    };
    let line = Style {
        label: String::new(),
        ..style
    };
    let path = points.iter().map(|point| [point.x, point.y]);
    [Mark::line(path, line), Mark::Points(points, dots)]
}

/// A point with an error bar for each row that has both values.
pub fn points<'r, R: 'r>(
    rows: impl IntoIterator<Item = &'r R>,
    x: impl Fn(&R) -> Option<f64>,
    y: impl Fn(&R) -> Option<Estimate>,
) -> Vec<Point> {
    let point = |row: &'r R| {
        let Estimate { value, error } = y(row)?;
        let (x, y) = (x(row)?, value);
        Some(Point { x, y, error })
    };
    rows.into_iter().filter_map(point).collect()
}

/// The area between two curves, each from left to right.
pub fn band(one: &[[f64; 2]], other: &[[f64; 2]], color: Rgb) -> Mark {
    let around = one.iter().chain(other.iter().rev());
    Mark::Area(around.copied().collect(), color)
}

/// A map over two axes of names, row by row from the lower end.
pub fn map(title: &str, [x, y]: [Axis; 2], values: Vec<Option<f64>>, bar: ColorBar) -> Panel {
    let columns = x.ticks.len();
    let rows = values.len() / columns.max(1);
    let cells = Mark::Cells(Cells {
        extent: [[0.0; 2], [columns as f64, rows as f64]],
        columns,
        values,
        map: bar.map.clone(),
    });
    Panel::new(title, x, y, vec![cells]).with_bar(bar)
}

/// Text in a cell of a map: black on a light color, white on a dark one.
pub fn in_cell([column, row]: [usize; 2], text: String, is_light: bool) -> Mark {
    let color = if is_light { BLACK } else { [255; 3] };
    Mark::Text([column as f64 + 0.5, row as f64 + 0.5], text, color)
}

/// The smallest and the largest positive value, times these factors, for a logarithmic axis.
pub fn positive(values: impl IntoIterator<Item = f64>, [lower, upper]: [f64; 2]) -> [f64; 2] {
    let values = values.into_iter().filter(|&v| v > 0.0 && v.is_finite());
    let range = Range::of(&values.collect::<Vec<_>>());
    match range.median.is_nan() {
        true => [0.1, 1.0],
        false => [lower * range.minimum, upper * range.maximum],
    }
}

/// The same, moved outward by a factor.
pub fn around(values: impl IntoIterator<Item = f64>, factor: f64) -> [f64; 2] {
    positive(values, [1.0 / factor, factor])
}

/// A range around all values, with a margin of 5 %, for a linear axis.
pub fn spanned(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
        [low.min(x), high.max(x)]
    });
    let [low, high] = if ends[0] <= ends[1] { ends } else { [0.0, 1.0] };
    let margin = match 0.05 * (high - low) {
        margin if margin > 0.0 => margin,
        _ => 0.05 * low.abs().max(1.0),
    };
    [low - margin, high + margin]
}

/// At most about `most` of many items, at equal distances: more marks would hide each other.
pub fn thinned<T>(items: &[T], most: usize) -> impl Iterator<Item = &T> {
    items.iter().step_by(items.len().div_ceil(most).max(1))
}

/// Each item once, in the order of their first places.
pub fn distinct<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for item in items {
        if !found.contains(&item) {
            found.push(item);
        }
    }
    found
}
