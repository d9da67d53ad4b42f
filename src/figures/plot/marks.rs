//! Draws the marks of a panel on its chart.

use std::vec::IntoIter;

use image::RgbImage;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::error::{Drawn, PlotError};
use super::ink::{Ink, fill};
use super::{Cells, Disc, LABEL_SIZE, Label, Mark, NO_DATA, Panel, Point, Style};
use crate::colors::Rgb;

/// More discs or cells than this are drawn as pixels: as separate shapes, they would make an SVG too large for
/// most viewers.
const MOST_SHAPES: usize = 2000;
const DASH: f64 = 3.0; // length of a dash and of the gap after it, points
const RIM: f64 = 0.7; // width of the white rim of labels, points
const ERROR_BAR: f64 = 0.8; // width of its lines, points
const SMALL: f64 = 1.8; // discs with smaller radii have no outline, points
const OUTLINE: f64 = 0.35; // width of the outline of a disc, points
/// A line with this number of points counts as one more shape.
const LINE_POINTS: usize = 20;

/// Right and up, from 0 to 1 inside of the plotting area.
type Place = (f64, f64);

/// The chart of a panel. Its coordinates are positions, not values: lines and areas are clipped where both scales are
/// linear.
type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A panel, and where its marks are drawn.
pub struct Canvas<'a, DB: DrawingBackend> {
    panel: &'a Panel,
    chart: Chart<'a, DB>,
    ink: Ink,
}

/// A dot, filled or hollow.
pub fn dot<C>(at: C, style: &Style, ink: Ink) -> Circle<C, i32> {
    let (radius, look) = match style.broken {
        // Half of the outline is outside of the circle.
        true => (
            0.8 * style.width,
            ink.stroke(style.color, 0.4 * style.width),
        ),
        false => (style.width, fill(style.color)),
    };
    Circle::new(at, ink.units(radius).max(1), look)
}

/// A line: dashed, or a single dash.
pub fn line<C: Clone>(
    path: Vec<C>,
    style: &Style,
    ink: Ink,
) -> DashedPathElement<IntoIter<C>, i32> {
    let dash = if style.broken {
        ink.units(DASH)
    } else {
        i32::MAX
    };
    DashedPathElement::new(
        path,
        dash,
        ink.units(DASH),
        ink.stroke(style.color, style.width),
    )
}

/// The number of shapes of a mark that may have many.
fn shapes(mark: &Mark, panel: &Panel) -> usize {
    match mark {
        Mark::Discs(discs) => panel.shown(discs, |disc| disc.center).len(),
        Mark::Cells(cells) | Mark::Overlay(cells) => cells.values.len(),
        Mark::Line(points, _) => points.len() / LINE_POINTS,
        Mark::Group(marks) => marks.iter().map(|mark| shapes(mark, panel)).sum(),
        _ => 0,
    }
}

/// Colors the pixels of cells; those without a value in the color `missing`, or not at all.
fn color_cells(cells: &Cells, panel: &Panel, image: &mut RgbImage, missing: Option<Rgb>) {
    let (width, height) = image.dimensions();
    let rows = cells.values.len() / cells.columns.max(1);
    let [low, high] = cells.extent.map(|corner| panel.place(corner));
    let index = |at: f64, low: f64, high: f64, count: usize| {
        let part = (at - low) / (high - low);
        (0.0..1.0)
            .contains(&part)
            .then_some((part * count as f64) as usize)
    };
    let column = |x: u32| {
        let at = (f64::from(x) + 0.5) / f64::from(width);
        index(at, low.0, high.0, cells.columns)
    };
    let columns: Vec<Option<usize>> = (0..width).map(column).collect();
    for y in 0..height {
        let at = 1.0 - (f64::from(y) + 0.5) / f64::from(height);
        let Some(row) = index(at, low.1, high.1, rows) else {
            continue;
        };
        for (x, column) in columns.iter().enumerate() {
            let value = column.map(|column| cells.values[row * cells.columns + column]);
            let color = value.and_then(|value| cells.color(value).or(missing));
            if let Some(color) = color {
                image.put_pixel(x as u32, y, image::Rgb(color));
            }
        }
    }
}

/// Colors the pixels of discs. plotters' circles are too coarse for small discs: their radii are whole pixels.
fn color_discs(discs: &[Disc], panel: &Panel, image: &mut RgbImage, ink: Ink) {
    let (width, height) = image.dimensions();
    for (disc, (x, y)) in panel.shown(discs, |disc| disc.center) {
        let (x, y) = (x * f64::from(width), (1.0 - y) * f64::from(height));
        let r = disc.radius * panel.scale(width);
        let inside = r - rim(r, ink);
        let span = |at: f64, end: u32| (at - r - 1.0) as u32..((at + r) as u32 + 2).min(end);
        for row in span(y, height) {
            for column in span(x, width) {
                let middle = f64::from(row / ink.alike * ink.alike) + 0.5 * f64::from(ink.alike);
                let distance = (f64::from(column) + 0.5 - x).hypot(middle - y);
                if distance <= r {
                    let color = match distance <= inside {
                        true => disc.color,
                        false => rim_color(disc.color),
                    };
                    image.put_pixel(column, row, image::Rgb(color));
                }
            }
        }
    }
}

/// The width of the dark rim of a disc with this radius, in units; small discs have none.
fn rim(radius: f64, ink: Ink) -> f64 {
    let points = radius / ink.scale;
    if points < SMALL {
        0.0
    } else {
        OUTLINE * ink.scale
    }
}

fn rim_color(color: Rgb) -> Rgb {
    color.map(|value| (f64::from(value) * 0.5) as u8)
}

impl<'a, DB: DrawingBackend> Canvas<'a, DB> {
    /// The canvas on an area.
    pub fn on(
        area: &DrawingArea<DB, Shift>,
        panel: &'a Panel,
        ink: Ink,
    ) -> Result<Self, PlotError> {
        let chart = ChartBuilder::on(area).build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
        Ok(Self { panel, chart, ink })
    }

    /// Draws one mark. Pixels cover earlier marks even where they are white.
    pub fn draw(&mut self, mark: &Mark) -> Drawn {
        if shapes(mark, self.panel) <= MOST_SHAPES {
            return self.shapes(mark);
        }
        let size @ (width, height) = self.chart.plotting_area().dim_in_pixel();
        let mut image = RgbImage::from_pixel(width, height, image::Rgb([255; 3]));
        let marks = match mark {
            Mark::Group(marks) => marks,
            mark => std::slice::from_ref(mark),
        };
        for mark in marks {
            match mark {
                Mark::Discs(discs) => color_discs(discs, self.panel, &mut image, self.ink),
                Mark::Cells(cells) => color_cells(cells, self.panel, &mut image, Some(NO_DATA)),
                Mark::Overlay(cells) => color_cells(cells, self.panel, &mut image, None),
                mark => {
                    let area = BitMapBackend::with_buffer(&mut image, size).into_drawing_area();
                    Canvas::on(&area, self.panel, self.ink)?.shapes(mark)?;
                }
            }
        }
        self.chart
            .draw_series(BitMapElement::with_ref((0.0, 1.0), size, &image))?;
        Ok(())
    }

    /// Draws one mark, shape by shape.
    fn shapes(&mut self, mark: &Mark) -> Drawn {
        match mark {
            Mark::Discs(discs) => self.discs(discs)?,
            Mark::Area(corners, color) => {
                let path = self.panel.path(corners.iter().chain(corners.first()));
                let rim: Vec<Place> = path.into_iter().map(bounded).collect();
                self.chart.draw_series([Polygon::new(rim, fill(*color))])?;
            }
            Mark::Line(points, style) => {
                let path = self.panel.path(points.iter());
                let parts = path.split(|place| !is_inside(place));
                self.chart
                    .draw_series(parts.map(|part| line(part.to_vec(), style, self.ink)))?;
            }
            Mark::Points(points, style) => self.points(points, style)?,
            Mark::Cells(cells) => self.cells(cells, Some(NO_DATA))?,
            Mark::Overlay(cells) => self.cells(cells, None)?,
            Mark::Label(label) => self.label(label)?,
            Mark::Group(marks) => {
                for mark in marks {
                    self.shapes(mark)?;
                }
            }
            Mark::Text(at, text, color) => {
                let style = self.ink.text(LABEL_SIZE, *color, [0, 0]);
                let at = bounded(self.panel.place(*at));
                self.chart
                    .draw_series([Text::new(text.clone(), at, style)])?;
            }
        }
        Ok(())
    }

    fn discs(&mut self, discs: &[Disc]) -> Drawn {
        let (panel, ink, chart) = (self.panel, self.ink, &mut self.chart);
        let scale = panel.scale(chart.plotting_area().dim_in_pixel().0);
        let circle = |at: Place, radius: f64, color: Rgb| {
            Circle::new(at, radius.round().max(1.0) as i32, fill(color))
        };
        for (disc, at) in panel.shown(discs, |disc| disc.center) {
            let radius = disc.radius * scale;
            let rim = rim(radius, ink);
            let outer = (rim > 0.0).then(|| circle(at, radius, rim_color(disc.color)));
            let inner = circle(at, radius - rim, disc.color);
            chart.draw_series(outer.into_iter().chain([inner]))?;
        }
        Ok(())
    }

    /// Draws points with the bars of their errors.
    fn points(&mut self, points: &[Point], style: &Style) -> Drawn {
        let (panel, ink, chart) = (self.panel, self.ink, &mut self.chart);
        let shown = panel.shown(points, |point| [point.x, point.y]);
        let dots = |style: Style| shown.iter().map(move |&(_, at)| dot(at, &style, ink));
        let look = ink.stroke(style.color, ERROR_BAR);
        let ends = ink.units(1.6 * style.width) as u32;
        let uncertain = shown.iter().filter(|(point, _)| point.error > 0.0);
        chart.draw_series(uncertain.map(|&(point, (x, y))| {
            let low = panel.y.place(point.y - point.error).max(0.0);
            let high = panel.y.place(point.y + point.error).min(1.0);
            ErrorBar::new_vertical(x, low, y, high, look, ends)
        }))?;
        if style.broken {
            // Error bars and lines do not show through hollow dots.
            chart.draw_series(dots(Style::full([255; 3], 0.8 * style.width, "")))?;
        }
        chart.draw_series(dots(style.clone()))?;
        Ok(())
    }

    /// Draws cells; those without a value in the color `missing`, or not at all.
    fn cells(&mut self, cells: &Cells, missing: Option<Rgb>) -> Drawn {
        let (panel, chart) = (self.panel, &mut self.chart);
        let [low, high] = cells.extent;
        let counts = [cells.columns, cells.values.len() / cells.columns.max(1)];
        let corner = |index: [usize; 2]| {
            let part = |k: usize| index[k] as f64 / counts[k] as f64;
            bounded(panel.place([0, 1].map(|k| low[k] + part(k) * (high[k] - low[k]))))
        };
        let values = cells.values.iter().enumerate();
        chart.draw_series(values.filter_map(|(k, value)| {
            let (column, row) = (k % cells.columns, k / cells.columns);
            let corners = [corner([column, row]), corner([column + 1, row + 1])];
            let color = cells.color(*value).or(missing)?;
            Some(Rectangle::new(corners, fill(color)))
        }))?;
        Ok(())
    }

    /// Draws the text in white around its place, then in its color.
    fn label(&mut self, label: &Label) -> Drawn {
        let (panel, ink, chart) = (self.panel, self.ink, &mut self.chart);
        let (x, y) = panel.place(label.at);
        let (width, height) = chart.plotting_area().dim_in_pixel();
        let rim = f64::from(ink.units(RIM));
        let white = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|to| (to, [255; 3]));
        for ((right, up), color) in white.into_iter().chain([((0.0, 0.0), label.color)]) {
            let style = ink.text(LABEL_SIZE, color, label.side);
            let [aside, above] = [right * rim / f64::from(width), up * rim / f64::from(height)];
            let at = (x + aside, y + above);
            chart.draw_series([Text::new(label.text.clone(), bounded(at), style)])?;
        }
        Ok(())
    }
}

/// A place that does not overflow a backend's units.
fn bounded((x, y): Place) -> Place {
    (x.clamp(-9.0, 9.0), y.clamp(-9.0, 9.0))
}

fn is_inside(&(x, y): &Place) -> bool {
    let inside = -1e-9..=1.0 + 1e-9;
    inside.contains(&x) && inside.contains(&y)
}

/// A path with additional points where it crosses a side of the plotting area or its extension. plotters moves points
/// outside to the rim: with the additional points this clips the path, without them it would bend it.
fn with_crossings(mut path: Vec<Place>) -> Vec<Place> {
    let [x, y]: [fn(Place) -> f64; 2] = [|place| place.0, |place| place.1];
    for (axis, limit) in [(x, 0.0), (x, 1.0), (y, 0.0), (y, 1.0)] {
        let mut longer: Vec<Place> = Vec::with_capacity(path.len());
        for to in path {
            if let Some(&from) = longer.last()
                && (axis(from) < limit) != (axis(to) < limit)
            {
                let part = (limit - axis(from)) / (axis(to) - axis(from));
                let between = |of: fn(Place) -> f64| of(from) + part * (of(to) - of(from));
                longer.push((between(x), between(y)));
            }
            longer.push(to);
        }
        path = longer;
    }
    path
}

impl Cells {
    fn color(&self, value: Option<f64>) -> Option<Rgb> {
        value.map(|value| self.map.color(value as f32))
    }
}

impl Panel {
    fn place(&self, [x, y]: [f64; 2]) -> Place {
        (self.x.place(x), self.y.place(y))
    }

    fn path<'a>(&self, points: impl Iterator<Item = &'a [f64; 2]>) -> Vec<Place> {
        with_crossings(points.map(|&point| self.place(point)).collect())
    }

    /// The items inside of the plotting area with their places.
    fn shown<'a, T>(&self, items: &'a [T], at: fn(&T) -> [f64; 2]) -> Vec<(&'a T, Place)> {
        let placed = items.iter().map(|item| (item, self.place(at(item))));
        placed.filter(|(_, place)| is_inside(place)).collect()
    }

    /// Pixels per unit of the x axis.
    fn scale(&self, width: u32) -> f64 {
        f64::from(width) / (self.x.range[1] - self.x.range[0])
    }
}
