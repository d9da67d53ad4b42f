//! Lines, areas, text and pixels, with positions in points, on any plotters backend.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::output::PlotError;
use crate::output::colors::Rgb;

/// A position on the sheet in points: right and down.
pub type Place = [f64; 2];

/// Which part of a text is at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    Left,
    Center,
    Right,
    /// Centered and rotated to read upward.
    Upwards,
}

/// The font of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Font {
    /// Points.
    pub size: f64,
    pub bold: bool,
    pub color: Rgb,
}

/// Pixels in rows from the top.
pub struct Pixels {
    pub width: u32,
    pub height: u32,
    pub rgb: Vec<u8>,
}

/// A sheet on a backend with `scale` units per point.
pub struct Canvas<'a, DB: DrawingBackend> {
    area: &'a DrawingArea<DB, Shift>,
    pub scale: f64,
}

fn color([r, g, b]: Rgb) -> RGBColor {
    RGBColor(r, g, b)
}

impl<'a, DB: DrawingBackend> Canvas<'a, DB> {
    pub fn new(area: &'a DrawingArea<DB, Shift>, scale: f64) -> Self {
        Self { area, scale }
    }

    fn at(&self, [x, y]: Place) -> (i32, i32) {
        let unit = |value: f64| (value * self.scale).round() as i32;
        (unit(x), unit(y))
    }

    /// A line `width` points wide.
    pub fn line(&self, points: &[Place], width: f64, rgb: Rgb) -> Result<(), PlotError> {
        let points: Vec<_> = points.iter().map(|&p| self.at(p)).collect();
        let width = (width * self.scale).round().max(1.0) as u32;
        let style = color(rgb).stroke_width(width);
        Ok(self.area.draw(&PathElement::new(points, style))?)
    }

    /// A filled polygon.
    pub fn area(&self, corners: &[Place], rgb: Rgb) -> Result<(), PlotError> {
        let corners: Vec<_> = corners.iter().map(|&p| self.at(p)).collect();
        Ok(self
            .area
            .draw(&Polygon::new(corners, color(rgb).filled()))?)
    }

    /// A filled rectangle.
    pub fn rectangle(&self, corners: [Place; 2], rgb: Rgb) -> Result<(), PlotError> {
        let corners = corners.map(|p| self.at(p));
        Ok(self
            .area
            .draw(&Rectangle::new(corners, color(rgb).filled()))?)
    }

    /// A filled disc.
    pub fn disc(&self, center: Place, radius: f64, rgb: Rgb) -> Result<(), PlotError> {
        let radius = (radius * self.scale).round().max(1.0) as i32;
        let disc = Circle::new(self.at(center), radius, color(rgb).filled());
        Ok(self.area.draw(&disc)?)
    }

    /// A line of text, centered vertically.
    pub fn text(&self, at: Place, text: &str, anchor: Anchor, font: Font) -> Result<(), PlotError> {
        if text.is_empty() {
            return Ok(());
        }
        let style = if font.bold {
            FontStyle::Bold
        } else {
            FontStyle::Normal
        };
        let (horizontal, turn) = match anchor {
            Anchor::Left => (HPos::Left, FontTransform::None),
            Anchor::Center => (HPos::Center, FontTransform::None),
            Anchor::Right => (HPos::Right, FontTransform::None),
            Anchor::Upwards => (HPos::Center, FontTransform::Rotate270),
        };
        let style = FontDesc::new(FontFamily::SansSerif, font.size * self.scale, style)
            .transform(turn)
            .color(&color(font.color))
            .pos(Pos::new(horizontal, VPos::Center));
        Ok(self.area.draw(&Text::new(text, self.at(at), style))?)
    }

    /// An image in backend pixels, with its upper left corner at `at`.
    pub fn pixels(&self, at: Place, pixels: &Pixels) -> Result<(), PlotError> {
        let size = (pixels.width, pixels.height);
        let picture = BitMapElement::with_ref(self.at(at), size, &pixels.rgb);
        picture.map_or(Ok(()), |picture| Ok(self.area.draw(&picture)?))
    }
}
