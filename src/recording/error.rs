//! Why a recording failed.

use std::path::PathBuf;

use rerun::RecordingStreamError;
use rerun::sink::SinkFlushError;

/// A recording could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The stream refused something.
    #[error("cannot record: {0}")]
    Stream(#[from] RecordingStreamError),
    /// Something did not reach the file.
    #[error("cannot write the recording (is the disk full?): {0}")]
    Flush(#[from] SinkFlushError),
    /// The thread that writes cannot start.
    #[error("cannot start to record: {0}")]
    Thread(#[from] std::io::Error),
    /// The thread that writes has ended before its time.
    #[error("the thread that writes the recording has failed")]
    WriterGone,
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
