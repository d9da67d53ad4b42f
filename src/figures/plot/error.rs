//! Why a picture cannot be made.

use std::path::{Path, PathBuf};

use plotters::drawing::DrawingAreaErrorKind;

/// A picture cannot be drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// It cannot be drawn.
    #[error("cannot draw: {0}")]
    Drawing(String),
    /// It would have too many pixels.
    #[error("the picture would have {0} × {1} pixels; give a lower resolution or a smaller width")]
    Large(u32, u32),
    /// It cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    Writing {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: std::io::Error,
    },
    /// The results have no table.
    #[error("{}: these results have no table; give a file in .html, .pdf, .md or .json", .0.display())]
    NoTable(PathBuf),
    /// There is no program that writes videos.
    #[error(
        "cannot write {}: videos need the program ffmpeg, which is not installed or not in PATH ({reason}); install \
         it, or write an animation as .gif or .png",
        path.display()
    )]
    NoFfmpeg {
        /// The file.
        path: PathBuf,
        /// The system's message.
        reason: String,
    },
}

impl PlotError {
    /// A file that cannot be written.
    pub(super) fn writing(path: &Path, reason: impl Into<std::io::Error>) -> Self {
        Self::Writing {
            path: path.to_owned(),
            reason: reason.into(),
        }
    }
}

/// The result of drawing.
pub type Drawn = Result<(), PlotError>;

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for PlotError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self::Drawing(error.to_string())
    }
}
