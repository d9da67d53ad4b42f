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
    /// It cannot be written.
    #[error("cannot write {}: {cause}; {}", path.display(), kept(path))]
    Unwritten {
        /// Which file.
        path: PathBuf,
        /// Why.
        cause: String,
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
    /// `path` takes no more.
    pub(super) fn unwritten(path: &Path, cause: &Cause) -> Self {
        Self::Unwritten {
            path: path.to_owned(),
            cause: cause.to_string(),
        }
    }
}

fn kept(path: &Path) -> &'static str {
    match path.metadata() {
        Ok(about) if about.len() > 0 => "it opens, but ends early",
        _ => "nothing is in it",
    }
}
