//! Pictures: sheets of panels with shared or separate axes, as SVG, PDF and PNG from the same drawing code, and
//! animations of such sheets. This is the only module that names plotters.
//!
//! A [`Sheet`] is plain data: panels in rows, each with two axes and marks in axis units. The caller decides what a
//! sheet shows; this module decides the layout; [`Print`] says how wide it is, with how many pixels, and whether with
//! titles. Sizes are in points, 1/72 of an inch.

mod animation;
mod axis;
mod draw;
mod error;
mod font;
mod ink;
mod layout;
mod marks;
mod narrow;
mod output;
mod pages;
mod pdf;
mod pixels;
mod print;

pub use animation::{Animation, has_extension};
pub use axis::Axis;
pub use draw::{label_lines, label_width};
pub use error::PlotError;
pub use font::{LINE, lines as text_lines, take_lacked, width_of as text_width};
pub use pages::Pages;
pub use print::{PAPER_DPI, Print};

use crate::colors::{ColorMap, Rgb};

/// Black, for text and axes.
pub const BLACK: Rgb = [0, 0, 0];
/// Gray, for secondary lines.
pub const GRAY: Rgb = [140, 140, 140];
/// Line colors that color-blind readers can distinguish (Okabe and Ito 2008).
pub const LINES: [Rgb; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [90, 90, 90],
];

/// The color of line `k`: after seven colors, they repeat.
pub fn line_color(k: usize) -> Rgb {
    LINES[k % LINES.len()]
}

/// A picture: panels in rows.
#[derive(Debug, Clone, Default)]
pub struct Sheet {
    /// Title above the panels; may be empty.
    pub title: String,
    /// Panels per row. The layout changes this number if it leaves fewer places empty or if the sheet must be narrow.
    pub columns: usize,
    /// Width and height of each panel's axes, points; with a given width of the sheet only their ratio counts.
    pub panel_size: [f64; 2],
    /// All panels have the same axes, so only the outer axes are labeled.
    pub shared_axes: bool,
    /// Titles left of the rows; may be empty.
    pub row_titles: Vec<String>,
    /// Color bar shared by all panels.
    pub bar: Option<ColorBar>,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
}

impl Sheet {
    /// A sheet of panels, each with its own axes and color bar.
    pub fn new(title: &str, columns: usize, panel_size: [f64; 2], panels: Vec<Panel>) -> Self {
        Self {
            title: title.to_owned(),
            columns,
            panel_size,
            panels,
            ..Self::default()
        }
    }
}

/// A pair of axes and the marks on them. Later marks cover earlier ones.
#[derive(Debug, Clone, Default)]
pub struct Panel {
    /// Title above the panel; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis, upward.
    pub y: Axis,
    /// The marks.
    pub marks: Vec<Mark>,
    /// Color bar of this panel.
    pub bar: Option<ColorBar>,
    /// Position of the legend of labeled marks.
    pub legend: Option<Corner>,
}

impl Panel {
    /// A panel without a color bar and a legend.
    pub fn new(title: &str, x: Axis, y: Axis, marks: Vec<Mark>) -> Self {
        Self {
            title: title.to_owned(),
            x,
            y,
            marks,
            ..Self::default()
        }
    }

    /// The panel with a legend.
    pub fn with_legend(mut self, corner: Corner) -> Self {
        self.legend = Some(corner);
        self
    }

    /// The panel with a color bar.
    pub fn with_bar(mut self, bar: ColorBar) -> Self {
        self.bar = Some(bar);
        self
    }
}

/// A position in or beside a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Upper left.
    UpperLeft,
    /// Upper right.
    UpperRight,
    /// Lower left.
    LowerLeft,
    /// Lower right.
    LowerRight,
    /// Outside, to the right of the panel.
    Beside,
}

/// The meaning of colors.
#[derive(Debug, Clone)]
pub struct ColorBar {
    /// Quantity and unit.
    pub label: String,
    /// The color map.
    pub map: ColorMap,
}

impl ColorBar {
    /// The bar of a color map.
    pub fn new(label: &str, map: &ColorMap) -> Self {
        let (label, map) = (label.to_owned(), map.clone());
        Self { label, map }
    }
}

/// A disc, in axis units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Its center.
    pub center: [f64; 2],
    /// Its radius.
    pub radius: f64,
    /// Its color.
    pub color: Rgb,
}

/// A value with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Position on the x axis.
    pub x: f64,
    /// Position on the y axis.
    pub y: f64,
    /// Half the length of its error bar; 0 for none.
    pub error: f64,
}

/// Without an error bar.
impl From<[f64; 2]> for Point {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y, error: 0.0 }
    }
}

/// The look of a line or a set of points, and its label in the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// The color.
    pub color: Rgb,
    /// Line width or point radius, points.
    pub width: f64,
    /// Dashed line or hollow points.
    pub broken: bool,
    /// Label in the legend; empty for none.
    pub label: String,
}

impl Style {
    /// A solid line or filled points.
    pub fn full(color: Rgb, width: f64, label: &str) -> Self {
        Self {
            color,
            width,
            broken: false,
            label: label.to_owned(),
        }
    }

    /// A dashed line or hollow points.
    pub fn broken(color: Rgb, width: f64, label: &str) -> Self {
        Self {
            broken: true,
            ..Self::full(color, width, label)
        }
    }

    /// The style of line `k`: after seven colors, the same follow, broken.
    pub fn nth(k: usize, width: f64, label: &str) -> Self {
        Self {
            broken: k >= LINES.len(),
            ..Self::full(line_color(k), width, label)
        }
    }
}

/// A rectangular grid of values, in rows from the lower end of the y axis.
#[derive(Debug, Clone)]
pub struct Cells {
    /// Lower left and upper right corner, axis units.
    pub extent: [[f64; 2]; 2],
    /// Cells per row.
    pub columns: usize,
    /// Values row by row; `None`: no data.
    pub values: Vec<Option<f64>>,
    /// Colors for the values.
    pub map: ColorMap,
}

/// Text with a white rim, readable on any background.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The point that it belongs to, axis units.
    pub at: [f64; 2],
    /// Its side: −1, 0 or 1 for left of the point, centered, right of it; and for below, centered, above.
    pub side: [i8; 2],
    /// The text.
    pub text: String,
    /// Its color.
    pub color: Rgb,
}

/// The size of labels, points.
pub const LABEL_SIZE: f64 = 8.0;

/// The color of cells without a value.
pub const NO_DATA: Rgb = [214, 214, 218];

/// A mark in a panel, in axis units.
#[derive(Debug, Clone)]
pub enum Mark {
    /// Discs.
    Discs(Vec<Disc>),
    /// A filled polygon.
    Area(Vec<[f64; 2]>, Rgb),
    /// A line through points.
    Line(Vec<[f64; 2]>, Style),
    /// Values with error bars.
    Points(Vec<Point>, Style),
    /// A heat map; cells without a value are gray.
    Cells(Cells),
    /// A heat map; earlier marks of its group are seen through cells without a value.
    Overlay(Cells),
    /// Text, centered at a position.
    Text([f64; 2], String, Rgb),
    /// Text beside a point.
    Label(Label),
    /// Marks that become one image if they have many shapes.
    Group(Vec<Mark>),
}

impl Mark {
    /// Points without error bars.
    pub fn dots(points: impl IntoIterator<Item = [f64; 2]>, style: Style) -> Self {
        Self::Points(points.into_iter().map(Point::from).collect(), style)
    }

    /// A line through points.
    pub fn line(points: impl IntoIterator<Item = [f64; 2]>, style: Style) -> Self {
        Self::Line(points.into_iter().collect(), style)
    }

    /// A filled rectangle.
    pub fn rectangle([left, right]: [f64; 2], [low, high]: [f64; 2], color: Rgb) -> Self {
        let corners = vec![[left, low], [right, low], [right, high], [left, high]];
        Self::Area(corners, color)
    }

    /// Black text beside a point; `side` as in [`Label`].
    pub fn label(at: [f64; 2], side: [i8; 2], text: String) -> Self {
        let color = BLACK;
        Self::Label(Label {
            at,
            side,
            text,
            color,
        })
    }
}
