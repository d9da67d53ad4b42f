//! A PDF of several pages with texts and sheets on them. Places and sizes are in points; places are those of upper left
//! corners, from the upper left corner of the page.

use std::convert::Infallible;

use plotters::style::{Color, FontStyle, RGBColor, TextStyle};
use plotters_backend::{DrawingBackend, DrawingErrorKind};

use super::error::Drawn;
use super::ink::Ink;
use super::layout::Layout;
use super::output::FINER;
use super::pdf::Pdf;
use super::{PlotError, Print, Sheet, font};
use crate::colors::Rgb;

/// Pages while they are drawn, at first one.
pub struct Pages {
    pdf: Pdf,
    ink: Ink,
}

impl Pages {
    /// Pages of this size.
    pub fn new(size: [f64; 2]) -> Self {
        font::register();
        let scale = Print::paper(0.0).pixels_per_point() * f64::from(FINER);
        Self {
            pdf: Pdf::new(size, scale, FINER),
            ink: Ink { scale, alike: 1 },
        }
    }

    /// Adds a page, on which is drawn from now on.
    pub fn begin(&mut self) {
        self.pdf.begin_page();
    }

    /// The number of pages.
    pub fn count(&self) -> usize {
        self.pdf.count()
    }

    /// Draws on page `k`, from 0, from now on.
    pub fn go_to(&mut self, k: usize) {
        self.pdf.go_to(k);
    }

    /// A line of text.
    ///
    /// # Errors
    /// It cannot be drawn.
    pub fn text(&mut self, text: &str, at: [f64; 2], (size, color): (f64, Rgb)) -> Drawn {
        let style = self.ink.text(size, color, [1, -1]);
        self.draw(text, at, &style)
    }

    /// A line of bold text.
    ///
    /// # Errors
    /// It cannot be drawn.
    pub fn bold(&mut self, text: &str, at: [f64; 2], (size, color): (f64, Rgb)) -> Drawn {
        let mut style = self.ink.text(size, color, [1, -1]);
        style.font = style.font.style(FontStyle::Bold);
        self.draw(text, at, &style)
    }

    fn draw(&mut self, text: &str, at: [f64; 2], style: &TextStyle) -> Drawn {
        let at = self.ink.at(at);
        self.pdf
            .backend()
            .draw_text(text, style, at)
            .map_err(drawing)
    }

    /// A filled rectangle.
    ///
    /// # Errors
    /// It cannot be drawn.
    pub fn area(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], color: Rgb) -> Drawn {
        let [r, g, b] = color;
        let style = RGBColor(r, g, b).filled();
        let (upper, lower) = (self.ink.at([x, y]), self.ink.at([x + width, y + height]));
        self.pdf
            .backend()
            .draw_rect(upper, lower, &style, true)
            .map_err(drawing)
    }

    /// Width and height of a sheet on these pages.
    pub fn size_of(sheet: &Sheet, print: &Print) -> [f64; 2] {
        Layout::new(&sheet.for_print(print), print).size
    }

    /// A sheet, as it is drawn alone.
    ///
    /// # Errors
    /// It cannot be drawn.
    pub fn sheet(&mut self, sheet: &Sheet, print: &Print, at: [f64; 2]) -> Drawn {
        let sheet = sheet.for_print(print);
        let layout = Layout::new(&sheet, print);
        let ink = self.ink;
        self.pdf.within(at, layout.size, |pdf| {
            sheet.draw(&layout, print, pdf.backend(), ink)
        })
    }

    /// The file.
    ///
    /// # Errors
    /// The font cannot be embedded.
    pub fn finish(self) -> Result<Vec<u8>, PlotError> {
        self.pdf.finish().map_err(PlotError::Drawing)
    }
}

fn drawing(error: DrawingErrorKind<Infallible>) -> PlotError {
    PlotError::Drawing(error.to_string())
}
