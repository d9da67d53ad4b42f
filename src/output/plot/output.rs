//! Writes a sheet to files.

use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ColorType, ImageEncoder, RgbImage, imageops};
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;

use super::Sheet;
use super::layout::{self, Layout, SCALE};

/// Pixels per point in a PNG. It is drawn larger and then scaled down, for smooth edges.
const PNG_SCALE: u32 = 2;

/// A picture cannot be drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// It cannot be drawn.
    #[error("cannot draw: {0}")]
    Drawing(String),
    /// It cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    Writing {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: std::io::Error,
    },
}

pub type Drawn = Result<(), PlotError>;

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for PlotError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self::Drawing(error.to_string())
    }
}

impl Sheet {
    /// Writes `stem`.svg and `stem`.png.
    ///
    /// # Errors
    /// The sheet cannot be drawn or a file cannot be written.
    pub fn save(&self, stem: &Path) -> Result<(), PlotError> {
        self.save_as(&stem.with_extension("svg"))?;
        self.save_as(&stem.with_extension("png"))
    }

    /// Writes one file: a PNG if its name ends in .png, else an SVG.
    ///
    /// # Errors
    /// The sheet cannot be drawn or the file cannot be written.
    pub fn save_as(&self, path: &Path) -> Result<(), PlotError> {
        // A font of our own makes pictures the same on every machine. Without it, drawing text is an error.
        let regular = dejavu::sans::regular();
        let _ = plotters::style::register_font("sans-serif", FontStyle::Normal, regular);
        let is_png = path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("png"));
        let bytes = if is_png { self.png()? } else { self.svg()? };
        std::fs::write(path, bytes).map_err(|reason| PlotError::Writing {
            path: path.to_owned(),
            reason,
        })
    }

    fn svg(&self) -> Result<Vec<u8>, PlotError> {
        let points = Layout::new(self).size;
        let size @ [width, height] = points.map(|length| length * SCALE);
        let mut text = String::new();
        // The encoder of images in an SVG only finds repetitions of the row above: pairs of rows halve its size.
        self.draw(SVGBackend::with_string(&mut text, (width, height)), 2)?;
        let attributes = |[x, y]: [u32; 2]| format!(r#"width="{x}" height="{y}""#);
        Ok(text
            .replacen(&attributes(size), &attributes(points), 1)
            .into_bytes())
    }

    fn png(&self) -> Result<Vec<u8>, PlotError> {
        let points = Layout::new(self).size;
        let [width, height] = points.map(|length| length * SCALE);
        let mut image = RgbImage::new(width, height);
        self.draw(BitMapBackend::with_buffer(&mut image, (width, height)), 1)?;
        let [width, height] = points.map(|length| length * PNG_SCALE);
        let mut image = imageops::thumbnail(&image, width, height);
        // Five bits per channel, and white stays white: the difference is invisible and the file a third smaller.
        let values = image.iter_mut();
        values.for_each(|value| *value = *value & 0xF8 | *value >> 5);
        let mut bytes = Vec::new();
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive)
            .write_image(&image, width, height, ColorType::Rgb8)
            .map_err(|error| PlotError::Drawing(error.to_string()))?;
        Ok(bytes)
    }

    fn draw<DB: DrawingBackend>(&self, backend: DB, alike: u32) -> Drawn {
        let root = backend.into_drawing_area();
        root.fill(&WHITE)?;
        layout::draw(self, &root, alike)?;
        Ok(root.present()?)
    }
}
