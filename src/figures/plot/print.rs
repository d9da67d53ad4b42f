//! The print of sheets: width, resolution, titles.

use std::sync::OnceLock;

/// Points per millimeter.
const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// The resolution of pictures in papers, pixels per inch.
pub const PAPER_DPI: f64 = 300.0;
/// The resolution of pictures for screens, which are as wide as their panels need, pixels per inch.
const SCREEN_DPI: f64 = 150.0;

/// The print of a sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Print {
    /// The width of the sheet, points; `None`: as wide as its panels need.
    pub width: Option<f64>,
    /// The resolution of pixels, in files of pixels and of those in other files, pixels per inch.
    pub dpi: f64,
    /// Whether titles are drawn. Figures of papers have captions instead. Panels keep theirs if there are several.
    pub titles: bool,
}

impl Default for Print {
    fn default() -> Self {
        Self {
            width: None,
            dpi: SCREEN_DPI,
            titles: true,
        }
    }
}

static OF_PROGRAM: OnceLock<Print> = OnceLock::new();

impl Print {
    /// For a column of a paper that is this wide, millimeters.
    pub fn paper(width_mm: f64) -> Self {
        Self {
            width: Some(width_mm * POINTS_PER_MM),
            dpi: PAPER_DPI,
            titles: false,
        }
    }

    /// Prints all sheets that are saved without a print of their own like this. The first call counts.
    pub fn for_all_sheets(self) {
        let _ = OF_PROGRAM.set(self);
    }

    /// The extensions of the files that a sheet of results is written to: PDF, too, if a width is given.
    pub fn extensions(&self) -> impl Iterator<Item = &'static str> + use<> {
        ["svg", "png"].into_iter().chain(self.width.map(|_| "pdf"))
    }

    /// The print of sheets without a print of their own.
    pub fn of_program() -> Self {
        OF_PROGRAM.get().copied().unwrap_or_default()
    }

    /// Pixels per point.
    pub(super) fn pixels_per_point(&self) -> f64 {
        self.dpi / 72.0
    }
}
