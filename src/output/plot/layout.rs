//! The layout of a sheet.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::output::Drawn;
use super::{Axis, Cells, ColorBar, Corner, Mark, Panel, Sheet, marks};

/// Units of a picture per point. Backends draw in whole units, so there are several for each point.
pub const SCALE: u32 = 4;

// Lengths in points.
const MARGIN: f64 = 8.0; // around the sheet
const TITLE: f64 = 20.0; // for the title of the sheet
const ROW_TITLE: f64 = 18.0; // for the titles of rows
const ABOVE: f64 = 20.0; // above a panel, for its title
const LEFT: f64 = 42.0; // left of an axis with numbers
const BELOW: f64 = 25.0; // below an axis with numbers
const GAP: f64 = 9.0; // between panels, color bars and legends
const BAR: f64 = 48.0; // for a color bar with its numbers and label
const BAR_WIDTH: f64 = 9.0; // of the color bar itself
const LEGEND: f64 = 165.0; // for a legend beside a panel
const SAMPLE: f64 = 18.0; // of a line in a legend
const RIM: f64 = 0.6; // width of the lines around a panel
const TICK: f64 = 2.5; // of a tick
const LABEL: f64 = 8.5; // size of titles of panels and labels of axes
const NUMBER: f64 = 7.5; // size of numbers and legends

type Area<DB> = DrawingArea<DB, Shift>;
/// The chart of a panel.
pub type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<Axis, Axis>>;

pub fn centered(style: TextStyle) -> TextStyle {
    style.pos(Pos::new(HPos::Center, VPos::Center))
}

/// A length in units of the picture.
pub fn units(points: f64) -> i32 {
    (points * f64::from(SCALE)).round() as i32
}

/// The font of a text.
pub fn font(points: f64) -> FontDesc<'static> {
    let size = points * f64::from(SCALE);
    FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal)
}

fn only(when: bool, points: f64) -> f64 {
    if when { points } else { 0.0 }
}

/// Where the panels of a sheet are.
pub struct Layout {
    columns: usize,
    /// Upper left corners of the panels' axes, points.
    corners: Vec<[f64; 2]>,
    /// Width and height of the sheet, points.
    pub size: [u32; 2],
}

impl Layout {
    pub fn new(sheet: &Sheet) -> Self {
        let ([width, height], count) = (sheet.panel_size, sheet.panels.len().max(1));
        let columns = sheet.columns.clamp(1, count);
        let any = |has: fn(&Panel) -> bool| sheet.panels.iter().any(has);
        let above = only(any(|panel| !panel.title.is_empty()), ABOVE).max(GAP);
        let bar = GAP + only(any(|panel| panel.bar.is_some()), BAR + GAP);
        let step = match sheet.shared_axes {
            true => [width + GAP, above + height],
            false => [LEFT + width + bar, above + height + BELOW],
        };
        let left = MARGIN + only(!sheet.row_titles.is_empty(), ROW_TITLE) + LEFT;
        let top = MARGIN + only(!sheet.title.is_empty(), TITLE) + above;
        let at = |column, row| [left + column as f64 * step[0], top + row as f64 * step[1]];
        let [right, foot] = at(columns - 1, (count - 1) / columns);
        let legend = only(any(|panel| panel.legend == Some(Corner::Beside)), LEGEND);
        let beside = bar
            .max(legend)
            .max(only(sheet.bar.is_some(), GAP + BAR + GAP))
            + MARGIN;
        let size = [right + width + beside, foot + height + BELOW + MARGIN];
        Self {
            columns,
            corners: (0..count).map(|k| at(k % columns, k / columns)).collect(),
            size: size.map(|length| length.ceil() as u32),
        }
    }
}

/// The part of an area with this upper left corner and this size, points.
fn part<DB: DrawingBackend>(area: &Area<DB>, corner: [f64; 2], size: [f64; 2]) -> Area<DB> {
    let [(x, y), (width, height)] = [corner, size].map(|lengths| lengths.map(units).into());
    area.clone().shrink((x, y), (width, height))
}

/// Draws a sheet. Crowds are drawn as pixels, in groups of `alike` identical rows.
pub fn draw<DB: DrawingBackend>(sheet: &Sheet, root: &Area<DB>, alike: u32) -> Drawn {
    let layout = Layout::new(sheet);
    let [width, height] = sheet.panel_size;
    let [right, foot] = layout.size.map(|length| f64::from(length) - MARGIN);
    part(root, [MARGIN; 2], [right - MARGIN, TITLE]).titled(&sheet.title, font(12.0))?;
    for (k, (panel, &[x, y])) in sheet.panels.iter().zip(&layout.corners).enumerate() {
        let lowest = k + layout.columns >= sheet.panels.len();
        let left = only(k % layout.columns == 0 || !sheet.shared_axes, LEFT);
        let below = only(lowest || !sheet.shared_axes, BELOW);
        let area = part(root, [x - left, y], [left + width, height + below]);
        draw_chart(panel, &area, [left, below, 0.0], alike)?;
        part(root, [x, y - 12.0], [width, 12.0]).titled(&panel.title, font(LABEL))?;
        if let Some(bar) = &panel.bar {
            draw_bar(bar, &part(root, [x + width + GAP, y], [BAR, height]))?;
        }
        if let Some(corner) = panel.legend {
            let x = x + only(corner == Corner::Beside, width + GAP);
            draw_legend(panel, corner, &part(root, [x, y], sheet.panel_size))?;
        }
    }
    let top = layout.corners[0][1];
    if let Some(bar) = &sheet.bar {
        let corner = [right - GAP - BAR, top];
        draw_bar(bar, &part(root, corner, [BAR, foot - BELOW - top]))?;
    }
    let upward = font(LABEL).transform(FontTransform::Rotate270);
    let upward = centered(upward.color(&BLACK));
    let rows = layout.corners.iter().step_by(layout.columns);
    for (title, [_, y]) in sheet.row_titles.iter().zip(rows) {
        let at = [MARGIN + 5.0, y + height / 2.0].map(units).into();
        root.draw_text(title, &upward, at)?;
    }
    Ok(())
}

/// Draws a panel's marks and axes. The given lengths are the space for numbers on the left, below and on the right.
fn draw_chart<DB: DrawingBackend>(
    panel: &Panel,
    area: &Area<DB>,
    space: [f64; 3],
    alike: u32,
) -> Drawn {
    let [left, below, right] = space.map(units);
    let mut builder = ChartBuilder::on(area);
    builder.x_label_area_size(below).y_label_area_size(left);
    builder.right_y_label_area_size(right);
    let (width, height) = area.dim_in_pixel();
    let [width, height] = [width as i32 - left - right, height as i32 - below];
    let (x, y) = (
        panel.x.with_ticks(width / units(32.0)),
        panel.y.with_ticks(height / units(24.0)),
    );
    let mut chart = builder.build_cartesian_2d(x, y)?;
    for mark in &panel.marks {
        marks::draw(mark, panel, &mut chart, alike)?;
    }
    let line = marks::stroke(super::BLACK, RIM);
    let mut axes = chart.configure_mesh();
    axes.disable_mesh().set_all_tick_mark_size(units(TICK));
    axes.axis_style(line);
    axes.label_style(font(NUMBER)).axis_desc_style(font(LABEL));
    axes.x_desc(&panel.x.label).y_desc(&panel.y.label).draw()?;
    let rim = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)];
    Ok(chart.plotting_area().draw(&PathElement::new(rim, line))?)
}

/// Draws a color bar: a chart of its colors with its axis on the right.
fn draw_bar<DB: DrawingBackend>(bar: &ColorBar, area: &Area<DB>) -> Drawn {
    let steps = bar.map.bands().unwrap_or(64);
    let [first, last] = bar.map.range().map(f64::from);
    let value = |step| first + (last - first) * (f64::from(step) + 0.5) / f64::from(steps);
    let panel = Panel {
        x: Axis::linear("", [0.0, 1.0]),
        y: Axis::linear(&bar.label, [first, last]),
        marks: vec![Mark::Cells(Cells {
            extent: [[0.0, first], [1.0, last]],
            columns: 1,
            values: (0..steps).map(value).map(Some).collect(),
            map: bar.map.clone(),
        })],
        ..Panel::default()
    };
    draw_chart(&panel, area, [0.0, 0.0, BAR - BAR_WIDTH], 1)
}

/// Draws the legend of a panel's labeled marks. It is a chart without axes, because plotters draws a chart's legend
/// only inside of it, and ours may be beside the panel.
fn draw_legend<DB: DrawingBackend>(panel: &Panel, corner: Corner, area: &Area<DB>) -> Drawn {
    let mut chart = ChartBuilder::on(area).build_cartesian_2d(0.0..1.0, 0.0..1.0)?;
    let mut empty = true;
    for mark in &panel.marks {
        let nothing = LineSeries::new([], BLACK);
        match mark {
            Mark::Line(_, style) if !style.label.is_empty() => {
                let ends = |(x, y)| vec![(x, y), (x + units(SAMPLE), y)];
                let entry = chart.draw_series(nothing)?.label(&style.label);
                entry.legend(move |at| marks::line(ends(at), style));
            }
            Mark::Points(_, style) if !style.label.is_empty() => {
                let middle = |(x, y)| (x + units(0.5 * SAMPLE), y);
                let entry = chart.draw_series(nothing)?.label(&style.label);
                entry.legend(move |at| marks::dot(middle(at), style));
            }
            _ => continue,
        }
        empty = false;
    }
    if empty {
        return Ok(());
    }
    let mut legend = chart.configure_series_labels();
    legend.position(match corner {
        Corner::UpperLeft | Corner::Beside => SeriesLabelPosition::UpperLeft,
        Corner::UpperRight => SeriesLabelPosition::UpperRight,
        Corner::LowerLeft => SeriesLabelPosition::LowerLeft,
        Corner::LowerRight => SeriesLabelPosition::LowerRight,
    });
    legend
        .legend_area_size(units(SAMPLE + 4.0))
        .margin(units(3.0));
    legend.label_font(font(NUMBER)).background_style(WHITE);
    Ok(legend.draw()?)
}
