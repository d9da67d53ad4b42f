//! Draws a sheet: panels with their axes, color bars, legends and titles.

use plotters::coord::Shift;
use plotters::prelude::*;

use super::axis::NUMBER;
use super::error::Drawn;
use super::font::{LINE, lines, width_of};
use super::ink::{Ink, fill};
use super::layout::{self, BAR_WIDTH, LABEL, Layout, PAD, SAMPLE, TICK, TITLE, height_of};
use super::marks::{self, Canvas};
use super::{Axis, BLACK, Cells, ColorBar, Corner, Mark, NO_DATA, Panel, Print, Sheet, Style};

const RIM: f64 = 0.6; // width of the lines around a panel
const LARGEST_DOT: f64 = 3.6; // radius of a dot in a legend
const SWATCH: f64 = 7.0; // side of the sample of a color

type Area<DB> = DrawingArea<DB, Shift>;

/// A rectangle of a sheet: the upper left corner and the size, points.
type Rect = ([f64; 2], [f64; 2]);

/// Draws a sheet.
pub fn draw<DB: DrawingBackend>(
    (sheet, layout): (&Sheet, &Layout),
    print: &Print,
    root: &Area<DB>,
    ink: Ink,
) -> Drawn {
    let page = Page { root, ink };
    let [width, height] = layout.panel;
    let middle = 0.5 * layout.size[0];
    page.centered(&layout.title, [middle, 5.0], TITLE)?;
    for (k, (panel, &[x, y])) in sheet.panels.iter().zip(&layout.corners).enumerate() {
        let rect = ([x, y], layout.panel);
        let lowest = k + layout.columns >= sheet.panels.len() || !sheet.shared_axes;
        let first = k.is_multiple_of(layout.columns) || !sheet.shared_axes;
        page.panel(panel, rect, [lowest, first])?;
        let title = layout::title_of(panel, sheet, print, width);
        let above = y - height_of(title.len(), LABEL) - 2.0;
        page.centered(&title, [x + 0.5 * width, above], LABEL)?;
        if let Some(bar) = &panel.bar {
            let gaps = layout::has_gaps(panel);
            page.bar(bar, ([x + width + 9.0, y], [BAR_WIDTH, height]), gaps)?;
        }
        if let Some(corner) = panel.legend
            && layout::has_own_legend(panel, layout.panel, print)
        {
            page.legend_inside(panel, corner, rect)?;
        }
    }
    let legend = layout::shared_entries(sheet, layout.panel, print);
    page.entries(&legend, layout.legend.0, layout.legend.1)?;
    let foot = layout
        .corners
        .last()
        .map_or(0.0, |corner| corner[1] + height);
    if let Some(bar) = &sheet.bar {
        let gaps = sheet.panels.iter().any(layout::has_gaps);
        page.bar(bar, (layout.bar, [BAR_WIDTH, foot - layout.bar[1]]), gaps)?;
    }
    let rows = layout.corners.iter().step_by(layout.columns);
    let inner = layout.corners.first().map_or(0.0, |corner| corner[0]);
    let numbers = sheet
        .panels
        .iter()
        .map(|panel| layout::beside(&panel.y, height));
    let left = inner - numbers.fold(0.0, f64::max) - PAD;
    for (title, [_, y]) in sheet.row_titles.iter().zip(rows) {
        let title = lines(title, LABEL, height);
        page.upward(&title, [left, y + 0.5 * height])?;
    }
    Ok(())
}

/// The sheet while it is drawn.
struct Page<'a, DB: DrawingBackend> {
    root: &'a Area<DB>,
    ink: Ink,
}

impl<DB: DrawingBackend> Page<'_, DB> {
    fn text(&self, text: &str, at: [f64; 2], size: f64, side: [i8; 2]) -> Drawn {
        let style = self.ink.text(size, BLACK, side);
        Ok(self.root.draw_text(text, &style, self.ink.at(at))?)
    }

    /// Lines of text, centered below a place.
    fn centered(&self, texts: &[String], [x, y]: [f64; 2], size: f64) -> Drawn {
        for (k, text) in texts.iter().enumerate() {
            self.text(text, [x, y + height_of(k, size)], size, [0, -1])?;
        }
        Ok(())
    }

    /// Lines of text that run upward, the last of them left of a place.
    fn upward(&self, texts: &[String], [x, y]: [f64; 2]) -> Drawn {
        let upright = self.ink.text(LABEL, BLACK, [0, 0]);
        let style = upright.transform(FontTransform::Rotate270);
        for (k, text) in texts.iter().rev().enumerate() {
            let x = x - (k as f64 + 0.5) * LABEL * LINE;
            self.root.draw_text(text, &style, self.ink.at([x, y]))?;
        }
        Ok(())
    }

    fn line(&self, ends: [[f64; 2]; 2]) -> Drawn {
        let ends = ends.map(|end| self.ink.at(end));
        let line = self.ink.stroke(BLACK, RIM);
        Ok(self.root.draw(&PathElement::new(ends, line))?)
    }

    fn rim(&self, ([x, y], [width, height]): Rect) -> Drawn {
        let (right, foot) = (x + width, y + height);
        let places = [[x, foot], [right, foot], [right, y], [x, y], [x, foot]];
        let corners = places.map(|corner| self.ink.at(corner));
        let line = self.ink.stroke(BLACK, RIM);
        Ok(self.root.draw(&PathElement::new(corners, line))?)
    }

    /// A panel's marks and axes; `labeled`: the axis below and the one on the left.
    fn panel(&self, panel: &Panel, rect: Rect, [below, left]: [bool; 2]) -> Drawn {
        let ([x, y], [width, height]) = rect;
        self.marks(panel, rect)?;
        if below {
            self.x_axis(&panel.x, [x, y + height], width)?;
        }
        if left {
            self.y_axis(&panel.y, rect, true)?;
        }
        self.rim(rect)
    }

    fn marks(&self, panel: &Panel, (corner, size): Rect) -> Drawn {
        let whole = self.root.clone();
        let area = whole.shrink(self.ink.at(corner), self.ink.at(size));
        let mut canvas = Canvas::on(&area, panel, self.ink)?;
        let mut marks = panel.marks.iter();
        marks.try_for_each(|mark| canvas.draw(mark))
    }

    fn x_axis(&self, axis: &Axis, [left, y]: [f64; 2], width: f64) -> Drawn {
        let fitted = axis.fitted(width, true);
        let turned = fitted.is_crowded(width);
        let style = match turned {
            true => (self.ink.text(NUMBER, BLACK, [-1, 0])).transform(FontTransform::Rotate270),
            false => self.ink.text(NUMBER, BLACK, [0, -1]),
        };
        for (value, text) in &fitted.ticks {
            let x = left + axis.place(*value) * width;
            self.line([[x, y], [x, y + TICK]])?;
            let at = self.ink.at([x, y + TICK + PAD]);
            self.root.draw_text(text, &style, at)?;
        }
        let label = lines(&axis.label, LABEL, width);
        let below = y + layout::numbers_below(axis, width);
        self.centered(&label, [left + 0.5 * width, below], LABEL)
    }

    /// The axis of a panel on its left, or that of a color bar on its right.
    fn y_axis(&self, axis: &Axis, (corner, [width, height]): Rect, is_left: bool) -> Drawn {
        let [x, y] = corner;
        let fitted = axis.fitted(height, false);
        let (x, out) = if is_left { (x, -1.0) } else { (x + width, 1.0) };
        for (value, text) in &fitted.ticks {
            let y = y + (1.0 - axis.place(*value)) * height;
            self.line([[x, y], [x + out * TICK, y]])?;
            let side = [if is_left { -1 } else { 1 }, 0];
            self.text(text, [x + out * (TICK + PAD), y], NUMBER, side)?;
        }
        let label = lines(&axis.label, LABEL, height);
        let room = TICK + PAD + fitted.widest() + PAD;
        let right = match is_left {
            true => x - room,
            false => x + room + height_of(label.len(), LABEL),
        };
        self.upward(&label, [right, y + 0.5 * height])
    }

    /// A color bar with its axis; below it, the color of cells without a value if there are some.
    fn bar(&self, bar: &ColorBar, rect: Rect, has_gaps: bool) -> Drawn {
        let steps = bar.map.bands().unwrap_or(64);
        let axis = layout::bar_axis(bar);
        let [first, last] = axis.range;
        let value = |step| first + (last - first) * (f64::from(step) + 0.5) / f64::from(steps);
        let colors = Panel {
            x: Axis::linear("", [0.0, 1.0]),
            y: axis.clone(),
            marks: vec![Mark::Cells(Cells {
                extent: [[0.0, first], [1.0, last]],
                columns: 1,
                values: (0..steps).map(value).map(Some).collect(),
                map: bar.map.clone(),
            })],
            ..Panel::default()
        };
        self.marks(&colors, rect)?;
        self.rim(rect)?;
        self.y_axis(&axis, rect, false)?;
        if has_gaps {
            let ([x, y], [_, height]) = rect;
            let place = [x, y + height + TICK + PAD];
            self.swatch((place, [SWATCH; 2]))?;
            let beside = [x + BAR_WIDTH + PAD, place[1] + 0.5 * SWATCH];
            self.text(layout::NO_DATA, beside, NUMBER, [1, 0])?;
        }
        Ok(())
    }

    fn swatch(&self, rect: Rect) -> Drawn {
        let ([x, y], [width, height]) = rect;
        let corners = [[x, y], [x + width, y + height]].map(|corner| self.ink.at(corner));
        self.root.draw(&Rectangle::new(corners, fill(NO_DATA)))?;
        self.rim(rect)
    }

    /// The legend in a corner of a panel.
    fn legend_inside(&self, panel: &Panel, corner: Corner, rect: Rect) -> Drawn {
        let entries = layout::entries(panel);
        if entries.is_empty() {
            return Ok(());
        }
        let ([x, y], [width, height]) = rect;
        let size = layout::legend_size(&entries);
        let (right, foot) = (x + width - size[0] - PAD, y + height - size[1] - PAD);
        let [x, y] = match corner {
            Corner::UpperLeft | Corner::Beside => [x + PAD, y + PAD],
            Corner::UpperRight => [right, y + PAD],
            Corner::LowerLeft => [x + PAD, foot],
            Corner::LowerRight => [right, foot],
        };
        let corners = [[x, y], [x + size[0], y + size[1]]].map(|corner| self.ink.at(corner));
        self.root.draw(&Rectangle::new(corners, WHITE.filled()))?;
        self.entries(&entries, [x + PAD, y + 0.5 * PAD], size[0])
    }

    /// The entries of a legend.
    fn entries(&self, entries: &[(&Style, bool)], corner: [f64; 2], width: f64) -> Drawn {
        let each = layout::entry_width(entries);
        let columns = layout::per_row(each, width);
        let rows = entries.len().div_ceil(columns);
        for (k, (style, is_line)) in entries.iter().enumerate() {
            let x = corner[0] + (k / rows.max(1)) as f64 * (each + 9.0);
            let y = corner[1] + (k % rows.max(1)) as f64 * NUMBER * LINE + 0.5 * NUMBER * LINE;
            match is_line {
                true => {
                    let ends = [[x, y], [x + SAMPLE, y]].map(|end| self.ink.at(end));
                    self.root
                        .draw(&marks::line(ends.to_vec(), style, self.ink))?;
                }
                false => {
                    let at = self.ink.at([x + 0.5 * SAMPLE, y]);
                    let mut sample = (*style).clone();
                    sample.width = sample.width.min(LARGEST_DOT);
                    self.root.draw(&marks::dot(at, &sample, self.ink))?;
                }
            }
            self.text(&style.label, [x + SAMPLE + 4.0, y], NUMBER, [1, 0])?;
        }
        Ok(())
    }
}

/// The width of a label, points.
pub fn label_width(text: &str) -> f64 {
    width_of(text, super::LABEL_SIZE)
}

/// The lines of a label that is broken at blanks so that it fits into `most` points, if its words do.
pub fn label_lines(text: &str, most: f64) -> Vec<String> {
    lines(text, super::LABEL_SIZE, most)
}
