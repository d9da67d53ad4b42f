//! The layout of a sheet.

use plotters::prelude::DrawingBackend;

use super::canvas::{Anchor, Canvas, Font, Place};
use super::marks::{self, Frame};
use super::output::PlotError;
use super::{BLACK, ColorBar, Corner, Mark, Panel, Sheet, Style};

const TITLE: Font = Font {
    size: 12.0,
    bold: true,
    color: BLACK,
};
const PANEL_TITLE: Font = Font {
    size: 8.5,
    bold: false,
    color: BLACK,
};
const LABEL: Font = Font {
    size: 8.5,
    bold: false,
    color: BLACK,
};
const TICK: Font = Font {
    size: 7.5,
    bold: false,
    color: BLACK,
};

/// Margin around the sheet, points.
const MARGIN: f64 = 8.0;
/// Space left of axes with numbers, points.
const LEFT: f64 = 44.0;
/// Space below axes with numbers, points.
const BELOW: f64 = 28.0;
/// Space between panels without numbers between them, points.
const GAP: f64 = 7.0;
/// Space above a panel for its title, points.
const ABOVE: f64 = 18.0;
/// Space for a color bar with its numbers and label, points.
const BAR: f64 = 58.0;
/// Space for a legend beside a panel, points.
const LEGEND: f64 = 165.0;
/// Width of the color bar itself, points.
const BAR_WIDTH: f64 = 9.0;
/// Length of a tick, points.
const TICK_LENGTH: f64 = 2.5;

/// Horizontal and vertical distance between the axes of adjacent panels, points.
fn pitch(sheet: &Sheet) -> [f64; 2] {
    let [width, height] = sheet.panel_size;
    let titled = sheet.panels.iter().any(|panel| !panel.title.is_empty());
    let above = if titled { ABOVE } else { GAP };
    if sheet.shared_axes {
        return [width + GAP, height + above];
    }
    // Labels beside the last column need no space between panels.
    let inner = sheet.panels.iter().enumerate();
    let inner = inner.filter(|(k, _)| k % sheet.columns != sheet.columns - 1);
    let right = inner.map(|(_, panel)| beside(panel)).fold(GAP, f64::max);
    [LEFT + width + right, above + height + BELOW]
}

/// Space right of a panel for its legend or color bar, points.
fn beside(panel: &Panel) -> f64 {
    if panel.legend == Some(Corner::Beside) {
        LEGEND
    } else if panel.bar.is_some() {
        BAR
    } else {
        GAP
    }
}

/// Upper left corner of the first panel's axes.
fn origin(sheet: &Sheet) -> Place {
    let titled = sheet.panels.iter().any(|panel| !panel.title.is_empty());
    let title = if sheet.title.is_empty() { 0.0 } else { 20.0 };
    let rows = if sheet.row_titles.is_empty() {
        0.0
    } else {
        14.0
    };
    [
        MARGIN + rows + LEFT,
        MARGIN + title + if titled { ABOVE } else { GAP },
    ]
}

fn rows(sheet: &Sheet) -> usize {
    sheet.panels.len().div_ceil(sheet.columns.max(1))
}

/// The sheet's width and height, points.
pub fn size(sheet: &Sheet) -> [f64; 2] {
    let ([x, y], [dx, dy]) = (origin(sheet), pitch(sheet));
    let columns = sheet.columns.min(sheet.panels.len()).max(1);
    let [width, height] = sheet.panel_size;
    let bar = if sheet.bar.is_some() { BAR } else { GAP };
    let beside = sheet.panels.iter().map(beside).fold(bar, f64::max);
    let right = x + (columns - 1) as f64 * dx + width;
    let below = y + rows(sheet).saturating_sub(1) as f64 * dy + height;
    [right + beside + MARGIN, below + BELOW + MARGIN]
}

/// Draws a sheet.
pub fn draw<DB: DrawingBackend>(sheet: &Sheet, canvas: &Canvas<DB>) -> Result<(), PlotError> {
    let ([x, y], [dx, dy]) = (origin(sheet), pitch(sheet));
    let [width, height] = sheet.panel_size;
    canvas.text([x, MARGIN + 7.0], &sheet.title, Anchor::Left, TITLE)?;
    for (k, panel) in sheet.panels.iter().enumerate() {
        let (column, row) = (k % sheet.columns, k / sheet.columns);
        let frame = Frame {
            panel,
            corner: [x + column as f64 * dx, y + row as f64 * dy],
            size: sheet.panel_size,
        };
        draw_panel(&frame, canvas)?;
        let lowest = k + sheet.columns >= sheet.panels.len();
        draw_x_axis(&frame, lowest || !sheet.shared_axes, canvas)?;
        draw_y_axis(&frame, column == 0 || !sheet.shared_axes, canvas)?;
    }
    for (row, title) in sheet.row_titles.iter().enumerate() {
        let middle = y + row as f64 * dy + height / 2.0;
        let font = Font {
            bold: true,
            ..LABEL
        };
        canvas.text([MARGIN + 5.0, middle], title, Anchor::Upwards, font)?;
    }
    if let Some(bar) = &sheet.bar {
        let columns = sheet.columns.min(sheet.panels.len()).max(1);
        let right = x + (columns - 1) as f64 * dx + width;
        let total = rows(sheet).saturating_sub(1) as f64 * dy + height;
        let length = total.min(260.0);
        draw_bar(
            bar,
            [right + 10.0, y + (total - length) / 2.0],
            length,
            canvas,
        )?;
    }
    Ok(())
}

fn draw_panel<DB: DrawingBackend>(frame: &Frame, canvas: &Canvas<DB>) -> Result<(), PlotError> {
    let ([x, y], [width, height]) = (frame.corner, frame.size);
    for mark in &frame.panel.marks {
        marks::draw(mark, frame, canvas)?;
    }
    let corners = [
        [x, y],
        [x + width, y],
        [x + width, y + height],
        [x, y + height],
        [x, y],
    ];
    canvas.line(&corners, 0.6, BLACK)?;
    let middle = [x + width / 2.0, y - 6.5];
    canvas.text(middle, &frame.panel.title, Anchor::Center, PANEL_TITLE)?;
    if let Some(bar) = &frame.panel.bar {
        draw_bar(bar, [x + width + 8.0, y], height, canvas)?;
    }
    match frame.panel.legend {
        Some(corner) => draw_legend(frame, corner, canvas),
        None => Ok(()),
    }
}

fn draw_x_axis<DB: DrawingBackend>(
    frame: &Frame,
    labelled: bool,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    let (axis, [x, y], [width, height]) = (&frame.panel.x, frame.corner, frame.size);
    let foot = y + height;
    for (value, label) in axis.ticks((width / 32.0) as usize) {
        let place = x + axis.place(value) * width;
        if axis.ticks.is_empty() {
            canvas.line(&[[place, foot], [place, foot + TICK_LENGTH]], 0.6, BLACK)?;
        }
        if labelled {
            canvas.text([place, foot + 8.0], &label, Anchor::Center, TICK)?;
        }
    }
    if labelled {
        let middle = [x + width / 2.0, foot + 19.0];
        canvas.text(middle, &axis.label, Anchor::Center, LABEL)?;
    }
    Ok(())
}

fn draw_y_axis<DB: DrawingBackend>(
    frame: &Frame,
    labelled: bool,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    let (axis, [x, y], [_, height]) = (&frame.panel.y, frame.corner, frame.size);
    for (value, label) in axis.ticks((height / 24.0) as usize) {
        let place = y + (1.0 - axis.place(value)) * height;
        if axis.ticks.is_empty() {
            canvas.line(&[[x - TICK_LENGTH, place], [x, place]], 0.6, BLACK)?;
        }
        if labelled {
            canvas.text([x - 5.0, place], &label, Anchor::Right, TICK)?;
        }
    }
    if labelled {
        let middle = [x - 34.0, y + height / 2.0];
        canvas.text(middle, &axis.label, Anchor::Upwards, LABEL)?;
    }
    Ok(())
}

/// Draws a color bar down from its upper left corner.
fn draw_bar<DB: DrawingBackend>(
    bar: &ColorBar,
    [x, y]: Place,
    length: f64,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    const STEPS: usize = 64;
    let [first, last] = bar.map.range().map(f64::from);
    for step in 0..STEPS {
        let value = first + (last - first) * (step as f64 + 0.5) / STEPS as f64;
        let upper = y + length * (1.0 - (step + 1) as f64 / STEPS as f64);
        let lower = y + length * (1.0 - step as f64 / STEPS as f64);
        canvas.rectangle(
            [[x, upper], [x + BAR_WIDTH, lower]],
            bar.map.color(value as f32),
        )?;
    }
    let right = x + BAR_WIDTH;
    let rim = [
        [x, y],
        [right, y],
        [right, y + length],
        [x, y + length],
        [x, y],
    ];
    canvas.line(&rim, 0.5, BLACK)?;
    let axis = super::Axis::linear(&bar.label, [first, last]);
    for (value, label) in axis.ticks((length / 24.0) as usize) {
        let place = y + length * (1.0 - axis.place(value));
        canvas.line(&[[right, place], [right + TICK_LENGTH, place]], 0.6, BLACK)?;
        canvas.text([right + 5.0, place], &label, Anchor::Left, TICK)?;
    }
    let middle = [right + 34.0, y + length / 2.0];
    canvas.text(middle, &bar.label, Anchor::Upwards, LABEL)
}

/// Draws a legend: each labeled mark of the panel with a sample.
fn draw_legend<DB: DrawingBackend>(
    frame: &Frame,
    corner: Corner,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    const LINE: f64 = 11.0;
    let entries: Vec<&Mark> = frame
        .panel
        .marks
        .iter()
        .filter(|mark| style_of(mark).is_some_and(|style| !style.label.is_empty()))
        .collect();
    let ([x, y], [width, height]) = (frame.corner, frame.size);
    let top = match corner {
        Corner::UpperLeft | Corner::UpperRight | Corner::Beside => y + 5.0,
        Corner::LowerLeft | Corner::LowerRight => y + height - 5.0 - LINE * entries.len() as f64,
    };
    let left = matches!(
        corner,
        Corner::UpperLeft | Corner::LowerLeft | Corner::Beside
    );
    draw_legend_box(frame, &entries, [top, LINE], corner, canvas)?;
    let sample = match corner {
        Corner::UpperLeft | Corner::LowerLeft => x + 6.0,
        Corner::UpperRight | Corner::LowerRight => x + width - 24.0,
        Corner::Beside => x + width + 8.0,
    };
    for (k, mark) in entries.into_iter().enumerate() {
        let Some(style) = style_of(mark) else {
            continue;
        };
        let middle = top + LINE * (k as f64 + 0.5);
        match mark {
            Mark::Points(..) => marks::marker([sample + 9.0, middle], style, canvas)?,
            _ => marks::stroke(&[[sample, middle], [sample + 18.0, middle]], style, canvas)?,
        }
        let (at, anchor) = if left {
            (sample + 22.0, Anchor::Left)
        } else {
            (sample - 4.0, Anchor::Right)
        };
        canvas.text([at, middle], &style.label, anchor, TICK)?;
    }
    Ok(())
}

/// Draws a white box behind a legend. Its width is an estimate, because the text is not measured before drawing.
fn draw_legend_box<DB: DrawingBackend>(
    frame: &Frame,
    entries: &[&Mark],
    [top, line]: [f64; 2],
    corner: Corner,
    canvas: &Canvas<DB>,
) -> Result<(), PlotError> {
    const LETTER: f64 = 0.46;
    let letters = |mark: &&Mark| style_of(mark).map_or(0, |style| style.label.chars().count());
    let Some(most) = entries.iter().map(letters).max() else {
        return Ok(());
    };
    let wide = 32.0 + LETTER * TICK.size * most as f64;
    let [x, width] = [frame.corner[0], frame.size[0]];
    let from = match corner {
        Corner::UpperLeft | Corner::LowerLeft => x + 3.0,
        Corner::UpperRight | Corner::LowerRight => x + width - 3.0 - wide,
        Corner::Beside => return Ok(()),
    };
    let low = top + line * entries.len() as f64 + 2.0;
    canvas.rectangle([[from, top - 2.0], [from + wide, low]], [255; 3])
}

fn style_of(mark: &Mark) -> Option<&Style> {
    match mark {
        Mark::Line(_, style) | Mark::Points(_, style) => Some(style),
        _ => None,
    }
}
