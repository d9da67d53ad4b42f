//! The destination of a recording, and the rerun stream that goes there.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use rerun::log::ChunkBatcherConfig;
use rerun::sink::LogSink;
use rerun::{RecordingStream, RecordingStreamBuilder};

use super::error::{Cause, RecordingError};
use super::file::{Failure, FileSink};
use super::read;
use super::viewer::{Address, Viewer};

/// Application id; the viewer keeps its settings per application.
pub const APPLICATION: &str = "sandbox";
/// The most that a killed run loses, besides the chunk being written.
const FILE_TICK: Duration = Duration::from_secs(1);
/// Lag of a live viewer.
const VIEWER_TICK: Duration = Duration::from_millis(100);

/// Where a recording goes: to a file, to a viewer, or to both.
#[derive(Debug, Clone, Default)]
pub struct Destination {
    /// A file; an existing one is replaced.
    pub file: Option<PathBuf>,
    /// A viewer that shows the run live.
    pub viewer: Option<Viewer>,
    /// Set by a signal: a viewer that takes no data is then given up after 0.2 s instead of 2 s.
    pub interrupted: Arc<AtomicBool>,
}

impl From<&Path> for Destination {
    fn from(path: &Path) -> Self {
        Self {
            file: Some(path.to_owned()),
            viewer: None,
            interrupted: Arc::default(),
        }
    }
}

/// A rerun stream to a destination.
pub struct Output {
    file: Option<PathBuf>,
    /// The first error of the file.
    file_failure: Failure,
    /// The viewer's address and the first error of its connection.
    viewer: Option<(Address, Failure)>,
    /// The stream that takes the messages.
    pub stream: RecordingStream,
}

impl Output {
    /// Opens a recording called `name`. A viewer merges files with the same `id` into one recording; a live
    /// recording gets an id of its own.
    pub fn open(to: &Destination, name: &str, id: String) -> Result<Self, RecordingError> {
        check_enabled()?;
        let sink = to
            .viewer
            .as_ref()
            .map(|viewer| viewer.connect(&to.interrupted));
        let sink = sink.transpose()?;
        let viewer = sink
            .as_ref()
            .map(|sink| (sink.address().clone(), sink.failure()));
        let is_live = viewer.is_some();
        let mut file_failure = Failure::default();
        let open = || -> Result<RecordingStream, Cause> {
            let mut sinks: Vec<Box<dyn LogSink>> = Vec::new();
            if let Some(path) = &to.file {
                let file = FileSink::create(path)?;
                file_failure = file.failure();
                sinks.push(Box::new(file));
            }
            if let Some(sink) = sink {
                sinks.push(Box::new(sink));
            }
            let builder = RecordingStreamBuilder::new(APPLICATION).batcher_config(batches(is_live));
            // In a live viewer, a second run with the same id would become part of the first.
            let builder = if is_live {
                builder
            } else {
                builder.recording_id(id)
            };
            let stream = builder.set_sinks(sinks)?;
            stream.set_log_tick_enabled(false);
            stream.set_log_time_enabled(false);
            stream.send_recording_name(name)?;
            Ok(stream)
        };
        let stream =
            open().map_err(|cause| RecordingError::unwritten(to.file.as_deref(), &cause))?;
        Ok(Self {
            file: to.file.clone(),
            file_failure,
            viewer,
            stream,
        })
    }

    /// Whether a viewer shows the run live.
    pub fn is_live(&self) -> bool {
        self.viewer.is_some()
    }

    /// Adds the destination to an error.
    pub fn checked<T>(&self, result: Result<T, Cause>) -> Result<T, RecordingError> {
        result.map_err(|cause| RecordingError::unwritten(self.file.as_deref(), &cause))
    }

    /// Closes the file once everything has been sent, and checks that it is complete.
    ///
    /// # Errors
    /// The file is incomplete, or the viewer is gone or took no data for 2 s.
    pub fn close(self) -> Result<(), RecordingError> {
        self.checked(self.stream.flush_blocking().map_err(Cause::from))?;
        drop(self.stream); // Also drops the sinks; the file sink writes the index and waits for its thread.
        let file = self.file.as_deref();
        if let Some(reason) = self.file_failure.reason() {
            return Err(RecordingError::unwritten(file, &Cause::File(reason)));
        }
        file.map_or(Ok(()), read::check_footer)?;
        let gone = |(address, failure): (Address, Failure)| {
            let address = address.to_string();
            let gone = |reason| RecordingError::ViewerGone { address, reason };
            failure.reason().map(gone)
        };
        self.viewer.and_then(gone).map_or(Ok(()), Err)
    }
}

/// Checks that the environment variable `RERUN` does not switch recordings off. We could enable our stream in spite
/// of it, but not the stream that rerun creates for a layout.
///
/// # Errors
/// Recordings are switched off.
pub fn check_enabled() -> Result<(), RecordingError> {
    if rerun::decide_logging_enabled(true) {
        return Ok(());
    }
    let value = std::env::var("RERUN").unwrap_or_default();
    Err(RecordingError::SwitchedOff(value))
}

/// The crowd's rows fill a chunk by size; all other rows are flushed after a fixed time.
fn batches(is_live: bool) -> ChunkBatcherConfig {
    ChunkBatcherConfig {
        flush_tick: if is_live { VIEWER_TICK } else { FILE_TICK },
        ..ChunkBatcherConfig::DEFAULT
    }
}
