//! Writes a sheet to a file. Both backends use integer coordinates, so each gets several units per point.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::imageops;
use image::{ColorType, ImageEncoder, RgbImage};
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;

use super::canvas::Canvas;
use super::{Sheet, layout};

/// Units per point in an SVG, which scales them back.
const SVG_SCALE: u32 = 3;
/// Pixels per point in a PNG.
const PNG_SCALE: u32 = 2;
/// A PNG is drawn larger by this factor and then scaled down, for smooth edges.
const OVERSAMPLING: u32 = 2;

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
        reason: String,
    },
}

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for PlotError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self::Drawing(error.to_string())
    }
}

/// Registers fonts with plotters, so that pictures are the same on every machine.
fn register_fonts() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        for (style, bytes) in [
            (FontStyle::Normal, dejavu::sans::regular()),
            (FontStyle::Bold, dejavu::sans::bold()),
        ] {
            // Drawing text reports an error if its font is missing.
            let _ = plotters::style::register_font("sans-serif", style, bytes);
        }
    });
}

/// Draws a sheet on a backend with `scale` units per point.
fn draw<DB: DrawingBackend>(sheet: &Sheet, backend: DB, scale: u32) -> Result<(), PlotError> {
    register_fonts();
    let root = backend.into_drawing_area();
    root.fill(&WHITE)?;
    layout::draw(sheet, &Canvas::new(&root, f64::from(scale)))?;
    Ok(root.present()?)
}

/// Width and height in units.
fn size(sheet: &Sheet, scale: u32) -> (u32, u32) {
    let [width, height] = layout::size(sheet).map(|points| points.ceil() as u32 * scale);
    (width, height)
}

fn unwritable(path: &Path) -> impl Fn(String) -> PlotError {
    let path = path.to_owned();
    move |reason| PlotError::Writing {
        path: path.clone(),
        reason,
    }
}

pub fn save_svg(sheet: &Sheet, path: &Path) -> Result<(), PlotError> {
    let (width, height) = size(sheet, SVG_SCALE);
    let mut text = String::new();
    draw(
        sheet,
        SVGBackend::with_string(&mut text, (width, height)),
        SVG_SCALE,
    )?;
    let units = format!(r#"width="{width}" height="{height}""#);
    let points = format!(
        r#"width="{}" height="{}""#,
        width / SVG_SCALE,
        height / SVG_SCALE
    );
    let text = text.replacen(&units, &points, 1);
    std::fs::write(path, text).map_err(|error| unwritable(path)(error.to_string()))
}

/// Reduces a channel to five bits, keeping white white. The difference is invisible and the file a third smaller.
fn coarse(value: u8) -> u8 {
    value & 0xF8 | value >> 5
}

pub fn save_png(sheet: &Sheet, path: &Path) -> Result<(), PlotError> {
    let (width, height) = size(sheet, PNG_SCALE * OVERSAMPLING);
    let mut rgb = vec![255; 3 * width as usize * height as usize];
    let backend = BitMapBackend::with_buffer(&mut rgb, (width, height));
    draw(sheet, backend, PNG_SCALE * OVERSAMPLING)?;
    let image = RgbImage::from_raw(width, height, rgb)
        .ok_or_else(|| PlotError::Drawing("a picture of the wrong size".to_owned()))?;
    let (width, height) = (width / OVERSAMPLING, height / OVERSAMPLING);
    let mut image = imageops::thumbnail(&image, width, height);
    image.iter_mut().for_each(|value| *value = coarse(*value));
    let unwritable = unwritable(path);
    let file = std::fs::File::create(path).map_err(|error| unwritable(error.to_string()))?;
    PngEncoder::new_with_quality(
        std::io::BufWriter::new(file),
        CompressionType::Best,
        FilterType::Adaptive,
    )
    .write_image(&image, width, height, ColorType::Rgb8)
    .map_err(|error| unwritable(error.to_string()))
}
