//! Errors of writing trajectories.

use std::path::{Path, PathBuf};

/// An error of the file system or of a format's library.
pub type Cause = Box<dyn std::error::Error + Send + Sync>;

/// Trajectories cannot be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// No format has this extension.
    #[error(
        "{}: no format has this extension; .sqlite and .db (JuPedSim), .txt and .csv are known",
        .0.display()
    )]
    UnknownFormat(PathBuf),
    /// The frame rate does not divide the simulation's frame rate.
    #[error(
        "{fps} frames per second do not divide the simulation's {}; the nearest that do are {}",
        decimals(*of), decimals(*nearest)
    )]
    FrameRate {
        /// The requested rate.
        fps: f64,
        /// The simulation's rate.
        of: f64,
        /// The nearest valid rate.
        nearest: f64,
    },
    /// The file cannot be written.
    #[error("cannot write {}: {cause}; {}", path.display(), kept(*frames))]
    Unwritten {
        /// The file.
        path: PathBuf,
        /// Number of frames in the file.
        frames: u64,
        /// The system's message.
        cause: String,
    },
}

impl TrajectoryError {
    /// `path` has `frames` frames, and no more can be written.
    pub(super) fn unwritten(path: &Path, frames: u64, cause: Cause) -> Self {
        Self::Unwritten {
            path: path.to_owned(),
            frames,
            cause: cause.to_string(),
        }
    }
}

/// Rounds to six decimals.
fn decimals(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

fn kept(frames: u64) -> String {
    match frames {
        0 => "nothing is in it".to_owned(),
        frames => format!("its first {frames} frames are kept"),
    }
}
