//! Draws in a PDF: lines, areas, text in an embedded font, images, on pages of the same size.

mod embedded;

use std::collections::BTreeMap;
use std::convert::Infallible;

use ab_glyph::{Font, GlyphId};
use image::{RgbImage, imageops};
use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::types::{LineCapStyle, LineJoinStyle, TextRenderingMode};
use pdf_writer::{Content, Filter, Finish, Name, Rect, Ref, Str};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontStyle,
};
use subsetter::GlyphRemapper;

use super::font;

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const FONT: Ref = Ref::new(3);
/// The first page; its content and then the other pages with theirs follow, then the images.
const FIRST_PAGE: i32 = 8;
const FONT_NAME: Name = Name(b"F");
/// The compression level of streams, from 0 to 10.
const LEVEL: u8 = 8;
/// The control points of a quarter of a circle.
const ARC: f32 = 0.552_285;
/// The width of the rim of bold letters, ems.
const RIM: f32 = 0.03;

/// A PDF while it is drawn.
pub struct Pdf {
    /// Width and height of a page, points.
    size: [f64; 2],
    /// Width and height of what is drawn now, points.
    area: [f64; 2],
    /// Units per point.
    scale: f64,
    /// Images are enlarged by this factor in both directions.
    finer: u32,
    pages: Vec<Content>,
    /// The page on which is drawn.
    page: usize,
    images: Vec<RgbImage>,
    remapper: GlyphRemapper,
    /// The letter and the width, in thousandths of an em, of each glyph by its number in the file.
    letters: BTreeMap<u16, (char, f32)>,
}

/// The backend that draws in a PDF.
pub struct Backend<'a>(&'a mut Pdf);

type Done = Result<(), DrawingErrorKind<Infallible>>;

impl Pdf {
    pub fn new(size: [f64; 2], scale: f64, finer: u32) -> Self {
        let mut pdf = Self {
            size,
            area: size,
            scale,
            finer,
            pages: Vec::new(),
            page: 0,
            images: Vec::new(),
            remapper: GlyphRemapper::new(),
            letters: BTreeMap::new(),
        };
        pdf.begin_page();
        pdf
    }

    /// Adds a page, on which is drawn from now on.
    pub fn begin_page(&mut self) {
        let mut content = Content::new();
        let unit = (1.0 / self.scale) as f32;
        // Units with y down, as of all backends.
        content.transform([unit, 0.0, 0.0, -unit, 0.0, self.size[1] as f32]);
        content.set_line_join(LineJoinStyle::RoundJoin);
        content.set_line_cap(LineCapStyle::ButtCap);
        self.page = self.pages.len();
        self.pages.push(content);
    }

    /// The number of pages.
    pub fn count(&self) -> usize {
        self.pages.len()
    }

    /// Draws on page `k`, from 0, from now on.
    pub fn go_to(&mut self, k: usize) {
        self.page = k.min(self.pages.len() - 1);
    }

    /// Draws something of this size with its upper left corner at a place, points.
    pub fn within<R>(
        &mut self,
        [x, y]: [f64; 2],
        size: [f64; 2],
        draw: impl FnOnce(&mut Self) -> R,
    ) -> R {
        let [right, down] = [x, y].map(|shift| (shift * self.scale) as f32);
        self.content().save_state();
        self.content().transform([1.0, 0.0, 0.0, 1.0, right, down]);
        self.area = size;
        let result = draw(self);
        self.area = self.size;
        self.content().restore_state();
        result
    }

    /// What is on the page on which is drawn.
    fn content(&mut self) -> &mut Content {
        &mut self.pages[self.page]
    }

    pub fn backend(&mut self) -> Backend<'_> {
        Backend(self)
    }

    /// The file.
    pub fn finish(self) -> Result<Vec<u8>, String> {
        let mut pdf = pdf_writer::Pdf::new();
        pdf.catalog(CATALOG).pages(PAGES);
        let count = self.pages.len() as i32;
        let place = |k: i32| Ref::new(FIRST_PAGE + 2 * k);
        pdf.pages(PAGES).kids((0..count).map(place)).count(count);
        let numbered = (0..).zip(&self.images);
        let images: Vec<_> = numbered
            .map(|(k, image)| (format!("I{k}"), Ref::new(FIRST_PAGE + 2 * count + k), image))
            .collect();
        let [width, height] = self.size.map(|length| length as f32);
        for k in 0..count {
            let mut page = pdf.page(place(k));
            page.media_box(Rect::new(0.0, 0.0, width, height));
            page.parent(PAGES).contents(place(k).next());
            let mut resources = page.resources();
            resources.fonts().pair(FONT_NAME, FONT);
            let mut objects = resources.x_objects();
            for (name, place, _) in &images {
                objects.pair(Name(name.as_bytes()), *place);
            }
            objects.finish();
            resources.finish();
            page.finish();
        }
        for (_, place, image) in images {
            let data = compress_to_vec_zlib(image, LEVEL);
            let mut object = pdf.image_xobject(place, &data);
            object.filter(Filter::FlateDecode);
            object
                .width(image.width() as i32)
                .height(image.height() as i32);
            object.bits_per_component(8);
            object.color_space().device_rgb();
        }
        self.write_font(&mut pdf)?;
        for (k, content) in (0..).zip(self.pages) {
            let content = compress_to_vec_zlib(&content.finish(), LEVEL);
            pdf.stream(place(k).next(), &content)
                .filter(Filter::FlateDecode);
        }
        Ok(pdf.finish())
    }

    fn fill_color(&mut self, color: BackendColor) {
        let [r, g, b] = parts(color);
        self.content().set_fill_rgb(r, g, b);
    }

    fn stroke_style<S: BackendStyle>(&mut self, style: &S) {
        let [r, g, b] = parts(style.color());
        self.content().set_stroke_rgb(r, g, b);
        self.content().set_line_width(style.stroke_width() as f32);
    }

    /// Begins a path through points; false if there are fewer than two.
    fn path(&mut self, path: impl IntoIterator<Item = BackendCoord>) -> bool {
        let mut count = 0;
        for (x, y) in path {
            let (x, y) = (x as f32, y as f32);
            match count {
                0 => self.content().move_to(x, y),
                _ => self.content().line_to(x, y),
            };
            count += 1;
        }
        if count == 1 {
            self.content().end_path();
        }
        count > 1
    }

    /// The number of a glyph in the file.
    fn glyph(&mut self, glyph: GlyphId, letter: char) -> u16 {
        let number = self.remapper.remap(glyph.0);
        // One box stands for all letters that the font lacks.
        let letter = match glyph {
            font::LACKING => char::REPLACEMENT_CHARACTER,
            _ => letter,
        };
        if let Some(face) = font::face() {
            let em = face.units_per_em().unwrap_or(2048.0);
            let width = 1000.0 * face.h_advance_unscaled(glyph) / em;
            self.letters.entry(number).or_insert((letter, width));
        }
        number
    }
}

fn parts(color: BackendColor) -> [f32; 3] {
    let (r, g, b) = color.rgb;
    [r, g, b].map(|value| f32::from(value) / 255.0)
}

fn is_clear(color: BackendColor) -> bool {
    color.alpha == 0.0
}

impl DrawingBackend for Backend<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        let units = |points: f64| (points * self.0.scale).round() as u32;
        self.0.area.map(units).into()
    }

    fn ensure_prepared(&mut self) -> Done {
        Ok(())
    }

    fn present(&mut self) -> Done {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Done {
        self.0.fill_color(color);
        self.0
            .content()
            .rect(x as f32, y as f32, 1.0, 1.0)
            .fill_nonzero();
        Ok(())
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Done {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, foot): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Done {
        let corners = [(left, top), (right, top), (right, foot), (left, foot)];
        match fill {
            true => self.fill_polygon(corners, style),
            false => self.draw_path(corners.into_iter().chain([corners[0]]), style),
        }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Done {
        if !is_clear(style.color()) {
            self.0.stroke_style(style);
            if self.0.path(path) {
                self.0.content().stroke();
            }
        }
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        (x, y): BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Done {
        if is_clear(style.color()) {
            return Ok(());
        }
        match fill {
            true => self.0.fill_color(style.color()),
            false => self.0.stroke_style(style),
        }
        let (x, y, r) = (x as f32, y as f32, radius as f32);
        let content = self.0.content();
        content.move_to(x + r, y);
        let mut end = [1.0, 0.0];
        for _ in 0..4 {
            let [a, b] = end;
            let next = [-b, a];
            let first = [a + ARC * next[0], b + ARC * next[1]];
            let second = [next[0] + ARC * a, next[1] + ARC * b];
            let [p, q, to] = [first, second, next].map(|[a, b]| [x + r * a, y + r * b]);
            content.cubic_to(p[0], p[1], q[0], q[1], to[0], to[1]);
            end = next;
        }
        match fill {
            true => content.fill_nonzero(),
            false => content.close_and_stroke(),
        };
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Done {
        if !is_clear(style.color()) {
            self.0.fill_color(style.color());
            if self.0.path(corners) {
                self.0.content().fill_even_odd();
            }
        }
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Done {
        let (Some(face), false) = (font::face(), is_clear(style.color())) else {
            return Ok(());
        };
        let ([x, y], em) = font::baseline(text, style, at);
        let glyphs = text
            .chars()
            .map(|letter| (font::drawn(face, letter), letter));
        let bytes = glyphs.flat_map(|(glyph, letter)| self.0.glyph(glyph, letter).to_be_bytes());
        let numbers: Vec<u8> = bytes.collect();
        let transform = style.transform();
        let [right, up] = [[1.0, 0.0], [0.0, -1.0]].map(|way| font::turned(&transform, way));
        let matrix = [right[0], right[1], up[0], up[1], x, y].map(|number| number as f32);
        self.0.fill_color(style.color());
        let is_bold = matches!(style.style(), FontStyle::Bold);
        let [r, g, b] = parts(style.color());
        let content = self.0.content();
        if is_bold {
            // The font has no bold face: letters get a rim.
            content.save_state().set_stroke_rgb(r, g, b);
            content.set_line_width(RIM * em as f32);
            content.set_text_rendering_mode(TextRenderingMode::FillStroke);
        }
        content.begin_text().set_font(FONT_NAME, em as f32);
        content
            .set_text_matrix(matrix)
            .show(Str(&numbers))
            .end_text();
        if is_bold {
            content.restore_state();
        }
        Ok(())
    }

    fn blit_bitmap(
        &mut self,
        (x, y): BackendCoord,
        (width, height): (u32, u32),
        source: &[u8],
    ) -> Done {
        let Some(image) = RgbImage::from_raw(width, height, source.to_vec()) else {
            return Ok(());
        };
        let [w, h] = [width, height].map(|side| side.div_ceil(self.0.finer));
        let name = format!("I{}", self.0.images.len());
        self.0.images.push(imageops::thumbnail(&image, w, h));
        let content = self.0.content();
        let [x, y, width, height] = [x, y, width as i32, height as i32].map(|k| k as f32);
        content.save_state();
        content.transform([width, 0.0, 0.0, -height, x, y + height]);
        content.x_object(Name(name.as_bytes())).restore_state();
        Ok(())
    }
}
