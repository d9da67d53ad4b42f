//! Why there is no trajectory.

use std::path::{Path, PathBuf};

/// What a file system or a format's own library has to say.
pub type Cause = Box<dyn std::error::Error + Send + Sync>;

/// Trajectories could not be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// No format has this extension.
    #[error(
        "{}: no format has this extension; .sqlite and .db (JuPedSim), .txt and .csv are known",
        .0.display()
    )]
    UnknownFormat(PathBuf),
    /// Not every so many frames.
    #[error(
        "{fps} frames per second do not divide the simulation's {}; the nearest that do are {}",
        decimals(*of), decimals(*nearest)
    )]
    FrameRate {
        /// What was asked for.
        fps: f64,
        /// What it must divide.
        of: f64,
        /// What does.
        nearest: f64,
    },
    /// The file cannot be written.
    #[error("cannot write {}: {cause}; {}", path.display(), kept(*frames))]
    Unwritten {
        /// Which file.
        path: PathBuf,
        /// How many frames are in it.
        frames: u64,
        /// What the system says.
        cause: String,
    },
}

impl TrajectoryError {
    /// `path` has so many frames and takes no more.
    pub(super) fn unwritten(path: &Path, frames: u64, cause: Cause) -> Self {
        Self::Unwritten {
            path: path.to_owned(),
            frames,
            cause: cause.to_string(),
        }
    }
}

/// As few as needed, six at most.
fn decimals(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

fn kept(frames: u64) -> String {
    match frames {
        0 => "nothing is in it".to_owned(),
        frames => format!("its first {frames} frames are kept"),
    }
}
