//! Draws on pixels: plotters' own backend, with letters at their exact places, upright or turned.

use ab_glyph::{Font, PxScale, point};
use plotters::prelude::*;
use plotters_backend::{BackendColor, BackendCoord, BackendStyle, BackendTextStyle};
use plotters_backend::{DrawingBackend, DrawingErrorKind};

use super::font;

/// plotters' backend for pixels.
pub struct Pixels<'a>(pub BitMapBackend<'a>);

type Done<'a> = Result<(), DrawingErrorKind<<BitMapBackend<'a> as DrawingBackend>::ErrorType>>;

impl<'a> DrawingBackend for Pixels<'a> {
    type ErrorType = <BitMapBackend<'a> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.0.get_size()
    }

    fn ensure_prepared(&mut self) -> Done<'a> {
        self.0.ensure_prepared()
    }

    fn present(&mut self) -> Done<'a> {
        self.0.present()
    }

    fn draw_pixel(&mut self, at: BackendCoord, color: BackendColor) -> Done<'a> {
        self.0.draw_pixel(at, color)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Done<'a> {
        self.0.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Done<'a> {
        self.0.draw_rect(from, to, style, fill)
    }

    fn blit_bitmap(&mut self, at: BackendCoord, size: (u32, u32), source: &[u8]) -> Done<'a> {
        self.0.blit_bitmap(at, size, source)
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        at: BackendCoord,
    ) -> Done<'a> {
        let Some(face) = font::face() else {
            return self.0.draw_text(text, style, at);
        };
        let (start, em) = font::baseline(text, style, at);
        let units = face.height_unscaled() / face.units_per_em().unwrap_or(2048.0);
        let scale = PxScale::from(em as f32 * units);
        let color = style.color();
        let mut pixels = Vec::new();
        text.chars().for_each(|letter| {
            font::drawn(face, letter);
        });
        for (glyph, begins) in font::glyphs(face, text).0 {
            let place = point((begins * em) as f32, 0.0);
            let Some(outline) = face.outline_glyph(glyph.with_scale_and_position(scale, place))
            else {
                continue;
            };
            let corner = outline.px_bounds().min;
            outline.draw(|x, y, part| {
                let middle = [corner.x + x as f32 + 0.5, corner.y + y as f32 + 0.5];
                let [right, down] = font::turned(&style.transform(), middle.map(f64::from));
                let at = [start[0] + right, start[1] + down].map(|x| x.floor() as i32);
                pixels.push((at.into(), color.mix(f64::from(part.min(1.0)))));
            });
        }
        pixels
            .into_iter()
            .try_for_each(|(at, color)| self.0.draw_pixel(at, color))
    }
}
