//! Why a recording failed.

use std::path::{Path, PathBuf};

use rerun::RecordingStreamError;
use rerun::sink::SinkFlushError;

/// What rerun or the system has to say.
#[derive(Debug, thiserror::Error)]
pub enum Cause {
    /// The file cannot be made, or a thread not started.
    #[error(transparent)]
    System(#[from] std::io::Error),
    /// The stream refused something.
    #[error(transparent)]
    Stream(#[from] RecordingStreamError),
    /// Something did not reach the file.
    #[error(transparent)]
    Flush(#[from] SinkFlushError),
    /// The same, found when it was closed.
    #[error("{0}")]
    File(String),
    /// The thread that writes has ended before its time.
    #[error("the thread that writes has failed")]
    WriterGone,
}

/// A recording could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// Rerun is switched off by its environment variable.
    #[error("RERUN={0} in the environment switches recordings off: unset it, or set it to on")]
    SwitchedOff(String),
    /// It cannot be written.
    #[error("cannot write {}: {cause}; {}", path.display(), kept(path))]
    Unwritten {
        /// Which file.
        path: PathBuf,
        /// Why.
        cause: String,
    },
    /// Where it goes to a viewer alone: it cannot be made.
    #[error("cannot show the run: {0}")]
    Unshown(String),
    /// Nobody is at the other end.
    #[error(
        "no viewer answers at {address} ({reason}); start one with `rerun`, or let --spawn do it"
    )]
    NoViewer {
        /// Where.
        address: String,
        /// What the system says.
        reason: String,
    },
    /// No viewer can be started.
    #[error("cannot start a viewer: {reason}")]
    NotSpawned {
        /// Why.
        reason: String,
    },
    /// The viewer was closed, froze, or the connection broke; a file beside it is whole.
    #[error("the viewer at {address} went away before the run had ended: {reason}")]
    ViewerGone {
        /// Where.
        address: String,
        /// What rerun says.
        reason: String,
    },
    /// The file is not whole.
    #[error("the recording {} is not complete: {reason}", path.display())]
    Incomplete {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// The file is no recording.
    #[error("cannot read the recording {}: {reason}", path.display())]
    Unreadable {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
}

impl RecordingError {
    /// The file takes no more; without one, the viewer.
    pub(super) fn unwritten(file: Option<&Path>, cause: &Cause) -> Self {
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
