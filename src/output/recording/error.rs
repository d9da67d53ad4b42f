//! Errors of recordings.

use std::path::{Path, PathBuf};

/// An error of rerun or the system.
pub type Cause = Box<dyn std::error::Error + Send + Sync>;

/// The error of a thread that has panicked.
pub const GONE: &str = "the thread that writes has failed";

/// A recording could not be written.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// Rerun is switched off by its environment variable.
    #[error("RERUN={0} in the environment switches recordings off: unset it, or set it to on")]
    SwitchedOff(String),
    /// The file cannot be written.
    #[error("cannot write {}: {cause}; {}", path.display(), kept(path))]
    Unwritten {
        /// The file.
        path: PathBuf,
        /// The reason.
        cause: String,
    },
    /// A recording for a viewer only cannot be created or sent.
    #[error("cannot show the run: {0}")]
    Unshown(String),
    /// No viewer answers.
    #[error(
        "no viewer answers at {address} ({reason}); start one with `rerun`, or let --spawn do it"
    )]
    NoViewer {
        /// The viewer's address.
        address: String,
        /// The system's message.
        reason: String,
    },
    /// No viewer can be started.
    #[error("cannot start a viewer: {0}")]
    NotSpawned(String),
    /// The viewer was closed or froze, or the connection broke. The recording's file, if any, is complete.
    #[error("the viewer at {address} went away before the run had ended: {reason}")]
    ViewerGone {
        /// The viewer's address.
        address: String,
        /// The reason.
        reason: String,
    },
    /// A recording cannot be read back.
    #[error("{}: cannot be read as a recording: {reason}", path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The file is incomplete.
    #[error("the recording {} is not complete: {reason}", path.display())]
    Incomplete {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}

impl RecordingError {
    /// A failure to write to `file`, or to the viewer if there is no file.
    pub(super) fn unwritten(file: Option<&Path>, cause: &impl ToString) -> Self {
        let cause = cause.to_string();
        match file {
            Some(path) => Self::Unwritten {
                path: path.to_owned(),
                cause,
            },
            None => Self::Unshown(cause),
        }
    }
}

fn kept(path: &Path) -> &'static str {
    match path.metadata() {
        Ok(about) if about.len() > 0 => "it opens, but ends early",
        _ => "nothing is in it",
    }
}
