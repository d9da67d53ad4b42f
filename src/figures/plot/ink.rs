//! Points as units of a backend.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::font::SIZE_PER_EM;
use crate::colors::Rgb;

/// The units of a backend, which draws in whole units.
#[derive(Debug, Clone, Copy)]
pub struct Ink {
    /// Units per point.
    pub scale: f64,
    /// Pixels of images are drawn in groups of this number of identical rows.
    pub alike: u32,
}

impl Ink {
    /// A length in units.
    pub fn units(&self, points: f64) -> i32 {
        (points * self.scale).round() as i32
    }

    /// A place in units.
    pub fn at(&self, place: [f64; 2]) -> (i32, i32) {
        place.map(|points| self.units(points)).into()
    }

    /// The style of a text whose em square has this size, points.
    pub fn text(&self, size: f64, [r, g, b]: Rgb, side: [i8; 2]) -> TextStyle<'static> {
        let size = size * SIZE_PER_EM * self.scale;
        let font = FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal);
        let mut style = TextStyle::from(font).pos(anchor(side));
        style.color.rgb = (r, g, b);
        style
    }

    /// The style of a line of this width, points.
    pub fn stroke(&self, [r, g, b]: Rgb, width: f64) -> ShapeStyle {
        let width = self.units(width).max(1) as u32;
        RGBColor(r, g, b).stroke_width(width)
    }
}

/// The anchor of a text that is left of, centered at or right of its point; and below, centered, above.
fn anchor([h, v]: [i8; 2]) -> Pos {
    Pos::new(
        match h {
            -1 => HPos::Right,
            0 => HPos::Center,
            _ => HPos::Left,
        },
        match v {
            -1 => VPos::Top,
            0 => VPos::Center,
            _ => VPos::Bottom,
        },
    )
}

pub fn fill([r, g, b]: Rgb) -> ShapeStyle {
    RGBColor(r, g, b).filled()
}
