//! Writes a sheet to files.

use std::path::Path;

use image::{RgbImage, imageops};
use plotters::prelude::*;

use super::error::{Drawn, PlotError};
use super::ink::Ink;
use super::layout::Layout;
use super::pdf::Pdf;
use super::pixels::Pixels;
use super::{Print, Sheet, draw, font};
use common::outputs::write_file;

/// Units per point in an SVG.
const SVG_SCALE: u32 = 4;
/// Pixels are drawn this many times larger and then scaled down, for smooth edges.
pub(super) const FINER: u32 = 2;
/// The most pixels of a picture, before it is scaled down.
const MOST_PIXELS: f64 = 400e6;

impl Sheet {
    /// Writes `stem`.svg and `stem`.png; for a paper, also `stem`.pdf. They are printed as [`Print::of_program`] says.
    ///
    /// # Errors
    /// The sheet cannot be drawn or a file cannot be written.
    pub fn save(&self, stem: &Path) -> Result<(), PlotError> {
        let print = Print::of_program();
        let mut files = print.extensions().map(|e| stem.with_added_extension(e));
        files.try_for_each(|file| self.save_as(&file, &print))
    }

    /// Writes one file: a PNG if its name ends in .png, a PDF if it ends in .pdf, else an SVG.
    ///
    /// # Errors
    /// The sheet cannot be drawn or the file cannot be written.
    pub fn save_as(&self, path: &Path, print: &Print) -> Result<(), PlotError> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let bytes = match extension.to_str() {
            Some("png") => png(&self.image(print)?, print)?,
            Some("pdf") => self.pdf(print)?,
            _ => self.svg(print)?,
        };
        write_file(path, &bytes).map_err(|reason| PlotError::writing(path, reason))
    }

    /// The size of a panel's axes when the sheet is printed, points.
    pub fn printed_panel(&self, print: &Print) -> [f64; 2] {
        Layout::new(&self.for_print(print), print).panel
    }

    /// The sheet as an SVG.
    ///
    /// # Errors
    /// It cannot be drawn.
    pub fn svg(&self, print: &Print) -> Result<Vec<u8>, PlotError> {
        let sheet = self.for_print(print);
        let layout = Layout::new(&sheet, print);
        let size = layout
            .size
            .map(|length| (length * f64::from(SVG_SCALE)).round() as u32);
        let [width, height] = size;
        let ink = Ink {
            scale: f64::from(SVG_SCALE),
            // The encoder of images in an SVG only finds repetitions of the row above: pairs of rows halve its size.
            alike: 2,
        };
        let mut drawn = String::new();
        let backend = SVGBackend::with_string(&mut drawn, (width, height));
        sheet.draw(&layout, print, backend, ink)?;
        let points = size.map(|units| f64::from(units) / f64::from(SVG_SCALE));
        let text = drawn
            .replacen(
                &format!(r#"width="{width}" height="{height}""#),
                &format!(r#"width="{}pt" height="{}pt""#, points[0], points[1]),
                1,
            )
            // plotters' own type of images is unknown to some programs.
            .replace("data:png;base64,", "data:image/png;base64,")
            // XML has no control characters; names may.
            .replace(|c: char| c.is_control() && c != '\n' && c != '\t', " ");
        Ok(text.into_bytes())
    }

    /// The sheet as pixels.
    ///
    /// # Errors
    /// The sheet cannot be drawn.
    pub fn image(&self, print: &Print) -> Result<RgbImage, PlotError> {
        let sheet = self.for_print(print);
        let layout = Layout::new(&sheet, print);
        let scale = print.pixels_per_point();
        let size = layout
            .size
            .map(|length| (length * scale).round().max(1.0) as u32);
        let [width, height] = size.map(|length| length * FINER);
        if f64::from(width) * f64::from(height) > MOST_PIXELS {
            return Err(PlotError::Large(size[0], size[1]));
        }
        let mut image = RgbImage::new(width, height);
        let ink = Ink {
            scale: scale * f64::from(FINER),
            alike: 1,
        };
        let backend = BitMapBackend::with_buffer(&mut image, (width, height));
        sheet.draw(&layout, print, Pixels(backend), ink)?;
        Ok(imageops::thumbnail(&image, size[0], size[1]))
    }

    fn pdf(&self, print: &Print) -> Result<Vec<u8>, PlotError> {
        let sheet = self.for_print(print);
        let layout = Layout::new(&sheet, print);
        let ink = Ink {
            scale: print.pixels_per_point() * f64::from(FINER),
            alike: 1,
        };
        let mut pdf = Pdf::new(layout.size, ink.scale, FINER);
        sheet.draw(&layout, print, pdf.backend(), ink)?;
        pdf.finish().map_err(PlotError::Drawing)
    }

    pub(super) fn draw<DB: DrawingBackend>(
        &self,
        layout: &Layout,
        print: &Print,
        backend: DB,
        ink: Ink,
    ) -> Drawn {
        font::register();
        let root = backend.into_drawing_area();
        root.fill(&WHITE)?;
        draw::draw((self, layout), print, &root, ink)?;
        Ok(root.present()?)
    }
}

/// A PNG that says its resolution.
fn png(image: &RgbImage, print: &Print) -> Result<Vec<u8>, PlotError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Best);
    encoder.set_filter(png::FilterType::Paeth);
    encoder.set_adaptive_filter(png::AdaptiveFilterType::Adaptive);
    encoder.set_pixel_dims(Some(resolution(print)));
    let failed = |error: png::EncodingError| PlotError::Drawing(error.to_string());
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(image).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

/// The resolution as a PNG says it, in pixels per meter.
pub(super) fn resolution(print: &Print) -> png::PixelDimensions {
    let per_meter = (print.dpi / 0.0254).round() as u32;
    png::PixelDimensions {
        xppu: per_meter,
        yppu: per_meter,
        unit: png::Unit::Meter,
    }
}
