//! Pictures: sheets of panels on shared or own axes, as SVG and PNG from the same drawing code. The
//! only place that names plotters.
//!
//! A [`Sheet`] is data: panels in rows, each with two axes and marks in the axes' units. What is drawn
//! where is decided here, what a picture shows by whoever makes the sheet. Sizes are in points; an SVG
//! has one unit a point, a PNG two pixels.

mod axis;
mod canvas;
mod clip;
mod layout;
mod marks;
mod output;
mod raster;

pub use axis::{Axis, Scale};
pub use output::PlotError;

use std::path::Path;

use crate::output::colors::{ColorMap, Rgb};

/// Black, for text and axes.
pub const BLACK: Rgb = [0, 0, 0];
/// For obstacles and lines of little weight.
pub const GRAY: Rgb = [140, 140, 140];
/// Colours for lines that colour-blind readers can tell apart (Okabe and Ito 2008).
pub const LINES: [Rgb; 7] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [90, 90, 90],
];

/// A picture: panels in rows.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// Above everything; may be empty.
    pub title: String,
    /// Panels per row.
    pub columns: usize,
    /// Width and height of each panel's axes, points.
    pub panel_size: [f64; 2],
    /// Do all panels have the same axes? Then only the outer ones are labelled.
    pub shared_axes: bool,
    /// Left of the rows; may be empty.
    pub row_titles: Vec<String>,
    /// What the colours of all panels mean.
    pub bar: Option<ColorBar>,
    /// Row by row.
    pub panels: Vec<Panel>,
}

/// One pair of axes and what is on them, later marks over earlier ones.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Above it; may be empty.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// What is shown.
    pub marks: Vec<Mark>,
    /// What this panel's colours mean.
    pub bar: Option<ColorBar>,
    /// Where marks with labels are explained.
    pub legend: Option<Corner>,
}

/// A place in or at a panel.
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
    /// Not inside, but beside the panel on the right.
    Beside,
}

/// What colours mean.
#[derive(Debug, Clone)]
pub struct ColorBar {
    /// Quantity and unit.
    pub label: String,
    /// The colours.
    pub map: ColorMap,
}

/// A disc, in axis units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Its centre.
    pub center: [f64; 2],
    /// Its radius.
    pub radius: f64,
    /// Its colour.
    pub color: Rgb,
}

/// A value with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Where on the x axis.
    pub x: f64,
    /// Where on the y axis.
    pub y: f64,
    /// Half the length of its error bar; 0 for none.
    pub error: f64,
}

/// How a line or a set of points looks, and what it is called in the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// The colour.
    pub color: Rgb,
    /// Line width or radius of the points, points.
    pub width: f64,
    /// Broken lines; hollow points.
    pub broken: bool,
    /// Its name in the legend; empty for none.
    pub label: String,
}

impl Style {
    /// A full line or full points.
    pub fn full(color: Rgb, width: f64, label: &str) -> Self {
        Self {
            color,
            width,
            broken: false,
            label: label.to_owned(),
        }
    }

    /// A broken line or hollow points.
    pub fn broken(color: Rgb, width: f64, label: &str) -> Self {
        Self {
            broken: true,
            ..Self::full(color, width, label)
        }
    }
}

/// A rectangular field of values, in rows from the lower end of the y axis.
#[derive(Debug, Clone)]
pub struct Cells {
    /// Lower left and upper right corner, axis units.
    pub extent: [[f64; 2]; 2],
    /// Cells per row.
    pub columns: usize,
    /// Row by row; `None` is left empty.
    pub values: Vec<Option<f64>>,
    /// Colours for the values.
    pub map: ColorMap,
}

impl Cells {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.values.len() / self.columns.max(1)
    }
}

/// Something in a panel, in axis units.
#[derive(Debug, Clone)]
pub enum Mark {
    /// People.
    Discs(Vec<Disc>),
    /// A filled polygon, for example an obstacle.
    Area(Vec<[f64; 2]>, Rgb),
    /// A line through points.
    Line(Vec<[f64; 2]>, Style),
    /// Values with error bars.
    Points(Vec<Point>, Style),
    /// A heat map.
    Cells(Cells),
    /// Words, centred at a place.
    Text([f64; 2], String, Rgb),
}

impl Sheet {
    /// Writes `stem`.svg and `stem`.png.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn save(&self, stem: &Path) -> Result<(), PlotError> {
        output::save_svg(self, &stem.with_extension("svg"))?;
        output::save_png(self, &stem.with_extension("png"))
    }
}
