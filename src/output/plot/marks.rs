//! Draws the marks of a panel.

use plotters::prelude::DrawingBackend;

use super::canvas::{Anchor, Canvas, Font, Place};
use super::output::PlotError;
use super::{Cells, Disc, Mark, Panel, Point, Style, clip, raster};
use crate::output::colors::Rgb;

/// More discs or cells than this are drawn as pixels: as separate shapes, they would make an SVG too large for
/// most viewers.
const MOST_SHAPES: usize = 2000;
/// Length of a dash and of the gap after it, points.
const DASH: f64 = 3.0;

/// Where a panel's axes are on the sheet.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    pub panel: &'a Panel,
    /// Upper left corner.
    pub corner: Place,
    /// Width and height, points.
    pub size: [f64; 2],
}

impl Frame<'_> {
    /// Axis values to positions in the unit square.
    fn unit(&self, [x, y]: [f64; 2]) -> Place {
        [self.panel.x.place(x), self.panel.y.place(y)]
    }

    /// Positions in the unit square to the sheet.
    fn on_sheet(&self, [x, y]: Place) -> Place {
        let [width, height] = self.size;
        [
            self.corner[0] + x * width,
            self.corner[1] + (1.0 - y) * height,
        ]
    }

    /// Axis values to the sheet.
    pub fn place(&self, values: [f64; 2]) -> Place {
        self.on_sheet(self.unit(values))
    }

    fn shows(&self, values: [f64; 2]) -> bool {
        let inside = |part: f64| (-1e-9..=1.0 + 1e-9).contains(&part);
        self.unit(values).into_iter().all(inside)
    }

    /// Points per unit of the x axis.
    fn per_unit(&self) -> f64 {
        let [first, last] = self.panel.x.range;
        self.size[0] / (last - first)
    }

    /// Size of the axes in backend units.
    fn units(&self, scale: f64) -> [u32; 2] {
        self.size.map(|points| (points * scale).round() as u32)
    }
}

/// Draws one mark.
pub fn draw<DB: DrawingBackend>(
    mark: &Mark,
    frame: &Frame,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    match mark {
        Mark::Discs(discs) => draw_discs(discs, frame, canvas),
        Mark::Area(corners, color) => draw_area(corners, *color, frame, canvas),
        Mark::Line(points, style) => draw_line(points, style, frame, canvas),
        Mark::Points(points, style) => draw_points(points, style, frame, canvas),
        Mark::Cells(cells) => draw_cells(cells, frame, canvas),
        Mark::Text(at, text, color) => {
            let font = Font {
                size: 7.0,
                bold: false,
                color: *color,
            };
            canvas.text(frame.place(*at), text, Anchor::Center, font)
        }
    }
}

fn draw_discs<DB: DrawingBackend>(
    discs: &[Disc],
    frame: &Frame,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    let shown = || discs.iter().filter(|disc| frame.shows(disc.center));
    if shown().count() <= MOST_SHAPES {
        return shown().try_for_each(|disc| {
            let radius = disc.radius * frame.per_unit();
            canvas.disc(frame.place(disc.center), radius, disc.color)
        });
    }
    let scale = canvas.scale;
    let in_pixels = shown().map(|disc| {
        let place = frame.place(disc.center);
        Disc {
            center: [0, 1].map(|k| (place[k] - frame.corner[k]) * scale),
            radius: disc.radius * frame.per_unit() * scale,
            color: disc.color,
        }
    });
    let pixels = raster::discs(frame.units(scale), in_pixels);
    canvas.pixels(frame.corner, &pixels)
}

fn draw_area<DB: DrawingBackend>(
    corners: &[[f64; 2]],
    color: Rgb,
    frame: &Frame,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    let corners: Vec<Place> = corners.iter().map(|&c| frame.unit(c)).collect();
    let kept = clip::polygon(&corners);
    if kept.len() < 3 {
        return Ok(());
    }
    let kept: Vec<Place> = kept.into_iter().map(|p| frame.on_sheet(p)).collect();
    canvas.area(&kept, color)
}

fn draw_line<DB: DrawingBackend>(
    points: &[[f64; 2]],
    style: &Style,
    frame: &Frame,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    let mut path: Vec<Place> = Vec::new();
    for pair in points.windows(2) {
        let kept = clip::segment(frame.unit(pair[0]), frame.unit(pair[1]));
        let Some([from, to]) = kept.map(|ends| ends.map(|p| frame.on_sheet(p))) else {
            continue;
        };
        if path.last() != Some(&from) {
            stroke(&std::mem::take(&mut path), style, canvas)?;
            path.push(from);
        }
        path.push(to);
    }
    stroke(&path, style, canvas)
}

/// Draws a path on the sheet, solid or dashed.
pub fn stroke<DB: DrawingBackend>(
    path: &[Place],
    style: &Style,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    if path.len() < 2 {
        return Ok(());
    }
    if !style.broken {
        // The backend draws a spike where a thick line turns back, so we split the path there.
        let pieces = path.len() - 1;
        let sharp = (1..pieces).filter(|&k| turns_back([path[k - 1], path[k], path[k + 1]]));
        let ends: Vec<usize> = std::iter::once(0).chain(sharp).chain([pieces]).collect();
        return ends
            .windows(2)
            .try_for_each(|ends| canvas.line(&path[ends[0]..=ends[1]], style.width, style.color));
    }
    dashes(path)
        .iter()
        .try_for_each(|dash| canvas.line(dash, style.width, style.color))
}

/// Whether the path turns by more than 90° at its middle point.
fn turns_back([a, b, c]: [Place; 3]) -> bool {
    (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < 0.0
}

/// Splits a path into dashes of [`DASH`] points with gaps of the same length.
fn dashes(path: &[Place]) -> Vec<[Place; 2]> {
    let mut found = Vec::new();
    let mut walked = 0.0;
    for pair in path.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let at = |along: f64| {
            let part = along / length;
            [0, 1].map(|k| from[k] + part * (to[k] - from[k]))
        };
        let mut along = 0.0;
        while along < length {
            let phase = (walked + along) % (2.0 * DASH);
            let left = if phase < DASH {
                DASH - phase
            } else {
                2.0 * DASH - phase
            };
            let end = (along + left.max(1e-6)).min(length);
            if phase < DASH {
                found.push([at(along), at(end)]);
            }
            along = end;
        }
        walked += length;
    }
    found
}

fn draw_points<DB: DrawingBackend>(
    points: &[Point],
    style: &Style,
    frame: &Frame,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    for point in points.iter().filter(|p| frame.shows([p.x, p.y])) {
        if point.error > 0.0 {
            let [low, high] = [-1.0, 1.0].map(|sign| [point.x, point.y + sign * point.error]);
            draw_line(&[low, high], &bar_style(style), frame, canvas)?;
        }
        marker(frame.place([point.x, point.y]), style, canvas)?;
    }
    Ok(())
}

fn bar_style(style: &Style) -> Style {
    Style::full(style.color, 0.8, "")
}

/// Draws a dot on the sheet, filled or hollow.
pub fn marker<DB: DrawingBackend>(
    at: Place,
    style: &Style,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    canvas.disc(at, style.width, style.color)?;
    if style.broken {
        canvas.disc(at, 0.6 * style.width, [255; 3])?;
    }
    Ok(())
}

fn draw_cells<DB: DrawingBackend>(
    cells: &Cells,
    frame: &Frame,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    let [low, high] = cells.extent.map(|corner| frame.place(corner));
    let (columns, rows) = (cells.columns, cells.rows());
    if columns * rows > MOST_SHAPES {
        let size = [high[0] - low[0], low[1] - high[1]];
        let size = size.map(|points| (points * canvas.scale).round() as u32);
        let pixels = raster::cells(size, cells);
        return canvas.pixels([low[0], high[1]], &pixels);
    }
    let corner = |column: usize, row: usize| {
        let parts = [column as f64 / columns as f64, row as f64 / rows as f64];
        [0, 1].map(|k| low[k] + parts[k] * (high[k] - low[k]))
    };
    for (k, value) in cells.values.iter().enumerate() {
        if let Some(value) = value {
            let (column, row) = (k % columns, k / columns);
            let ends = [corner(column, row + 1), corner(column + 1, row)];
            canvas.rectangle(ends, cells.map.color(*value as f32))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_go_round_corners() {
        let found = dashes(&[[0.0, 0.0], [7.0, 0.0], [7.0, 6.0]]);
        let length: f64 = found
            .iter()
            .map(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1]))
            .sum();
        assert!((length - 7.0).abs() < 1e-9, "{length}");
        assert_eq!(found[0], [[0.0, 0.0], [3.0, 0.0]]);
        assert_eq!(found[1], [[6.0, 0.0], [7.0, 0.0]]);
    }
}
