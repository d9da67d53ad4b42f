//! The layout of a sheet. All lengths are in points.

use super::axis::NUMBER;
use super::font::{LINE, lines, width_of};
use super::{Axis, Cells, ColorBar, Corner, Mark, Panel, Print, Sheet, Style};

const MARGIN: f64 = 6.0; // around the sheet
const GAP: f64 = 9.0; // between panels, color bars and legends
const BETWEEN: f64 = 5.0; // between a color bar and the next panel
const ABOVE: f64 = 6.0; // between the titles of a row and the row above it, which has no numbers below it
pub const TITLE: f64 = 12.0; // size of the title of a sheet
pub const LABEL: f64 = 9.0; // size of titles of panels and labels of axes
pub const TICK: f64 = 2.5; // length of a tick
pub const PAD: f64 = 2.5; // between a tick, its number and the label of the axis
pub const BAR_WIDTH: f64 = 9.0; // of a color bar without its numbers
pub const SAMPLE: f64 = 18.0; // of a line in a legend
pub const NO_DATA: &str = "no data";
/// The narrowest panels in a row; narrower ones are put below each other.
const LEAST_PANEL: f64 = 90.0;
/// The narrowest panels of a grid.
pub const LEAST_CELL: f64 = 60.0;
/// Sheets are wider than this only if their panels do not fit otherwise.
const WIDEST: f64 = 1000.0;
/// The largest width of a legend beside panels, as a fraction of a sheet of given width; a wider legend is below them.
const BESIDE: f64 = 0.3;
/// The largest fraction of a panel that a legend may hide.
const HIDDEN: f64 = 0.2;
/// Panels of a sheet of given width are at most this many times as high as the sheet is wide.
const HIGHEST: f64 = 1.1;

/// The positions of the parts of a sheet.
#[derive(Debug, Clone)]
pub struct Layout {
    /// Panels per row.
    pub columns: usize,
    /// Width and height of the panels' axes.
    pub panel: [f64; 2],
    /// Upper left corners of the panels' axes.
    pub corners: Vec<[f64; 2]>,
    /// Width and height of the sheet.
    pub size: [f64; 2],
    /// The lines of the sheet's title.
    pub title: Vec<String>,
    /// The upper left corner of the sheet's color bar.
    pub bar: [f64; 2],
    /// The upper left corner of the legend that is beside the panels, and its width.
    pub legend: ([f64; 2], f64),
}

/// The space beside and below panels.
struct Space {
    left: f64,
    below: f64,
    bar: f64,
    sheet_bar: f64,
    rows: f64,
    /// The width and the number of the entries of the legend outside of panels.
    legend: f64,
    entries: usize,
}

/// The height of some lines of text of this size.
pub fn height_of(lines: usize, size: f64) -> f64 {
    lines as f64 * size * LINE
}

/// The space that the numbers and the label of a vertical axis need; `bar`: of a color bar with them.
pub fn beside(axis: &Axis, height: f64) -> f64 {
    let count = lines(&axis.label, LABEL, height).len();
    let label = height_of(count, LABEL) + if count > 0 { PAD } else { 0.0 };
    TICK + PAD + axis.fitted(height, false).widest() + label
}

/// The space that the numbers and the label of a horizontal axis need.
fn below(axis: &Axis, width: f64) -> f64 {
    let label = lines(&axis.label, LABEL, width).len();
    numbers_below(axis, width) + height_of(label, LABEL) + PAD
}

/// The space that the numbers of a horizontal axis need.
pub fn numbers_below(axis: &Axis, width: f64) -> f64 {
    let fitted = axis.fitted(width, true);
    let numbers = match fitted.is_crowded(width) {
        true => fitted.widest(),
        false => NUMBER * 1.05,
    };
    TICK + PAD + numbers + PAD
}

/// The vertical axis of a color bar.
pub fn bar_axis(bar: &ColorBar) -> Axis {
    Axis::linear(&bar.label, bar.map.range().map(f64::from))
}

fn bar_width(bar: &ColorBar, height: f64, has_gaps: bool) -> f64 {
    let no_data = if has_gaps {
        BAR_WIDTH + PAD + width_of(NO_DATA, NUMBER)
    } else {
        0.0
    };
    (BAR_WIDTH + beside(&bar_axis(bar), height)).max(no_data)
}

/// The styles with labels, and whether they are lines.
pub fn entries(panel: &Panel) -> Vec<(&Style, bool)> {
    let labeled = panel.marks.iter().filter_map(|mark| match mark {
        Mark::Line(_, style) => Some((style, true)),
        Mark::Points(_, style) => Some((style, false)),
        _ => None,
    });
    labeled
        .filter(|(style, _)| !style.label.is_empty())
        .collect()
}

/// The size of the legend in a panel.
pub fn legend_size(entries: &[(&Style, bool)]) -> [f64; 2] {
    let height = height_of(entries.len(), NUMBER) + PAD;
    [entry_width(entries) + 2.0 * PAD, height]
}

/// Whether a panel's legend is in a corner of it: on sheets of given width, not if it would hide much of the panel.
pub fn has_own_legend(panel: &Panel, [width, height]: [f64; 2], print: &Print) -> bool {
    let [w, h] = legend_size(&entries(panel));
    let is_large = print.width.is_some() && w * h > HIDDEN * width * height;
    panel.legend.is_some_and(|corner| corner != Corner::Beside) && !is_large
}

/// The entries of the legend outside of panels, each once.
pub fn shared_entries<'a>(
    sheet: &'a Sheet,
    panel: [f64; 2],
    print: &Print,
) -> Vec<(&'a Style, bool)> {
    let mut shared: Vec<(&Style, bool)> = Vec::new();
    let outside = |one: &&Panel| one.legend.is_some() && !has_own_legend(one, panel, print);
    for entry in sheet.panels.iter().filter(outside).flat_map(entries) {
        if !shared.contains(&entry) {
            shared.push(entry);
        }
    }
    shared
}

/// The width of an entry of a legend.
pub fn entry_width(entries: &[(&Style, bool)]) -> f64 {
    let widths = entries
        .iter()
        .map(|(style, _)| width_of(&style.label, NUMBER));
    SAMPLE + 4.0 + widths.fold(0.0, f64::max)
}

/// Whether a panel shows cells without a value.
pub fn has_gaps(panel: &Panel) -> bool {
    fn lacks(mark: &Mark) -> bool {
        match mark {
            Mark::Cells(Cells { values, .. }) => values.iter().any(Option::is_none),
            Mark::Group(marks) => marks.iter().any(lacks),
            _ => false,
        }
    }
    panel.marks.iter().any(lacks)
}

/// The lines of a panel's title.
pub fn title_of(panel: &Panel, sheet: &Sheet, print: &Print, width: f64) -> Vec<String> {
    match print.titles || sheet.panels.len() > 1 {
        true => lines(&panel.title, LABEL, width),
        false => Vec::new(),
    }
}

impl Space {
    fn of(sheet: &Sheet, print: &Print, [width, height]: [f64; 2]) -> Self {
        let most = |of: &dyn Fn(&Panel) -> f64| sheet.panels.iter().map(of).fold(0.0, f64::max);
        let gaps = sheet.panels.iter().any(has_gaps);
        let legend = shared_entries(sheet, [width, height], print);
        let of_bar = |bar: &Option<ColorBar>, gaps: bool| match bar {
            Some(bar) => GAP + bar_width(bar, height, gaps),
            None => 0.0,
        };
        let all = sheet.row_titles.iter();
        let rows = all.map(|title| lines(title, LABEL, height).len()).max();
        Self {
            left: most(&|panel| beside(&panel.y, height)),
            below: most(&|panel| below(&panel.x, width)),
            bar: most(&|panel| of_bar(&panel.bar, has_gaps(panel))),
            sheet_bar: of_bar(&sheet.bar, gaps),
            rows: rows.map_or(0.0, |lines| height_of(lines, LABEL) + PAD),
            legend: entry_width(&legend),
            entries: legend.len(),
        }
    }
}

impl Layout {
    pub fn new(sheet: &Sheet, print: &Print) -> Self {
        let wanted = columns(sheet);
        let Some(width) = print.width else {
            return Self::with(sheet, print, wanted, sheet.panel_size);
        };
        let count = sheet.panels.len().max(1);
        let least = if sheet.row_titles.is_empty() {
            1
        } else {
            wanted
        };
        let whole = |c: &usize| *c == wanted || count.is_multiple_of(*c);
        let mut tried = (least..=wanted).rev().filter(whole).map(|columns| {
            let mut layout = Self::with(sheet, print, columns, sheet.panel_size);
            for _ in 0..4 {
                layout = layout.widened(sheet, print, width);
            }
            layout.centered(width)
        });
        let fits = |layout: &Self| layout.panel[0] >= LEAST_PANEL || layout.columns == least;
        let found = tried.find(fits);
        found.unwrap_or_else(|| Self::with(sheet, print, wanted, sheet.panel_size))
    }

    /// The layout with panels as wide as `width` allows.
    fn widened(&self, sheet: &Sheet, print: &Print, width: f64) -> Self {
        let [own, high] = sheet.panel_size;
        let others = self.size[0] - self.columns as f64 * self.panel[0];
        let most = (width - others) / self.columns as f64;
        let scale = (most / own).min(HIGHEST * width / high).max(0.05);
        Self::with(sheet, print, self.columns, [own * scale, high * scale])
    }

    /// The layout in the middle of a sheet of this width.
    fn centered(mut self, width: f64) -> Self {
        let aside = (0.5 * (width - self.size[0])).max(0.0);
        for corner in self
            .corners
            .iter_mut()
            .chain([&mut self.bar, &mut self.legend.0])
        {
            corner[0] += aside;
        }
        self.size[0] = width;
        self
    }

    fn with(sheet: &Sheet, print: &Print, columns: usize, panel: [f64; 2]) -> Self {
        let ([width, height], count) = (panel, sheet.panels.len().max(1));
        let space = Space::of(sheet, print, panel);
        let [step, below] = match sheet.shared_axes {
            true => [width + GAP, 0.0],
            false => [
                space.left + width + (space.bar + BETWEEN).max(GAP),
                space.below,
            ],
        };
        let title = match print.titles {
            true => {
                let whole = columns as f64 * step + space.sheet_bar;
                lines(
                    &sheet.title,
                    TITLE,
                    print.width.unwrap_or(whole) - 2.0 * MARGIN,
                )
            }
            false => Vec::new(),
        };
        let left = MARGIN + space.rows + space.left;
        let heading = height_of(title.len(), TITLE) + if title.is_empty() { 0.0 } else { 2.0 };
        let begin = MARGIN + heading - if heading > 0.0 { 0.0 } else { 2.0 };
        let rows = tops(sheet, print, columns, [width, height, below], begin);
        let top = rows[0];
        let at = |column, row: usize| [left + column as f64 * step, rows[row]];
        let [right, foot] = at(columns - 1, (count - 1) / columns);
        let mut size = [
            right + width + space.bar.max(space.sheet_bar).max(10.0) + MARGIN,
            foot + height + space.below + MARGIN,
        ];
        let bar = [right + width + GAP, top];
        let empty = !count.is_multiple_of(columns);
        let is_narrow = |most: f64| space.legend + GAP > BESIDE * most;
        let legend = if space.entries == 0 {
            ([0.0; 2], 0.0)
        } else if empty {
            (at(count % columns, count / columns), width)
        } else if print.width.is_some_and(is_narrow) {
            let place = [MARGIN + space.left, size[1]];
            let room = size[0] - place[0] - MARGIN;
            let rows = space.entries.div_ceil(per_row(space.legend, room));
            size[1] += height_of(rows, NUMBER) + MARGIN;
            (place, room)
        } else {
            let place = [right + width + space.bar.max(GAP), top];
            size[0] = size[0].max(place[0] + space.legend + MARGIN);
            (place, space.legend)
        };
        Self {
            columns,
            panel,
            corners: (0..count).map(|k| at(k % columns, k / columns)).collect(),
            size,
            title,
            bar,
            legend,
        }
    }
}

/// The upper ends of the rows of panels, from `begin` on, and of one row more. `below` is the space below a row.
fn tops(
    sheet: &Sheet,
    print: &Print,
    columns: usize,
    [width, height, below]: [f64; 3],
    begin: f64,
) -> Vec<f64> {
    let count = sheet.panels.len().max(1);
    let (mut y, mut tops) = (begin, Vec::new());
    for row in 0..=(count / columns) {
        let panels = sheet.panels.iter().skip(row * columns).take(columns);
        let counts = panels.map(|panel| title_of(panel, sheet, print, width).len());
        let titles = counts.max().unwrap_or(0);
        let is_close = sheet.shared_axes && row > 0 && titles > 0;
        y += (height_of(titles, LABEL) + 3.0).max(GAP) + if is_close { ABOVE } else { 0.0 };
        tops.push(y);
        y += height + below;
    }
    tops
}

/// The number of entries of a legend that fit beside each other into this width.
pub fn per_row(entry: f64, width: f64) -> usize {
    ((width / (entry + GAP)) as usize).max(1)
}

/// The number of panels per row, such that at most the last place is empty. Three panels are all in one row or all
/// below each other.
fn columns(sheet: &Sheet) -> usize {
    let count = sheet.panels.len().max(1);
    let wanted = sheet.columns.clamp(1, count);
    let keeps = !sheet.row_titles.is_empty() || count.is_multiple_of(wanted);
    let legend = |panel: &Panel| panel.legend == Some(Corner::Beside);
    if keeps || sheet.panels.iter().any(legend) {
        return wanted;
    }
    let width = |columns: usize| columns as f64 * (sheet.panel_size[0] + 100.0);
    let whole = |columns: &usize| count.is_multiple_of(*columns) && width(*columns) <= WIDEST;
    let mut others = (wanted + 1..=count.min(wanted + 1)).chain((1..wanted).rev());
    others.find(whole).unwrap_or(wanted)
}
