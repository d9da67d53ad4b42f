//! Where a recording goes, and what rerun does on the way.

use std::path::{Path, PathBuf};
use std::time::Duration;

use rerun::log::ChunkBatcherConfig;
use rerun::sink::LogSink;
use rerun::{RecordingStream, RecordingStreamBuilder};

use super::error::{Cause, RecordingError};
use super::file::{Failure, FileSink};
use super::read;
use super::viewer::{Address, Viewer};

/// The viewer keeps its own settings per application.
pub const APPLICATION: &str = "sandbox";
/// What a run that is killed loses at most, besides the last chunk under way.
const FILE_TICK: Duration = Duration::from_secs(1);
/// What a viewer lags behind.
const VIEWER_TICK: Duration = Duration::from_millis(100);

/// Where a recording goes: to a file, to a viewer, or to both.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Destination {
    /// A file, which replaces any there.
    pub file: Option<PathBuf>,
    /// A viewer that shows the run while it goes on.
    pub viewer: Option<Viewer>,
}

impl From<&Path> for Destination {
    fn from(path: &Path) -> Self {
        Self {
            file: Some(path.to_owned()),
            viewer: None,
        }
    }
}

/// A stream to a destination.
pub struct Output {
    file: Option<PathBuf>,
    /// What went wrong with the file.
    file_failure: Failure,
    /// Where the viewer is, and what became of it.
    viewer: Option<(Address, Failure)>,
    /// Where messages enter.
    pub stream: RecordingStream,
}

impl Output {
    /// Opens a recording called `name`; two of the same name and `id` are one to a viewer that reads both
    /// files.
    pub fn open(to: &Destination, name: &str, id: String) -> Result<Self, RecordingError> {
        check_enabled()?;
        let sink = to.viewer.as_ref().map(Viewer::connect).transpose()?;
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
            // In a viewer a second run of the same name would become part of the first.
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

    /// Does somebody look on?
    pub fn is_live(&self) -> bool {
        self.viewer.is_some()
    }

    /// What went wrong, with where.
    pub fn checked<T>(&self, result: Result<T, Cause>) -> Result<T, RecordingError> {
        result.map_err(|cause| RecordingError::unwritten(self.file.as_deref(), &cause))
    }

    /// Closes the file, once everything has been sent, and checks that it is whole.
    ///
    /// # Errors
    /// It is not. Else, the viewer is gone or has taken no data for 2 s.
    pub fn close(self) -> Result<(), RecordingError> {
        self.checked(self.stream.flush_blocking().map_err(Cause::from))?;
        drop(self.stream); // And with it the sinks; that of the file adds the index and waits for it.
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

/// Checks that the environment variable `RERUN` does not switch recordings off. A stream could be enabled in
/// spite of it, but not the one that rerun makes for a layout.
///
/// # Errors
/// It does.
pub fn check_enabled() -> Result<(), RecordingError> {
    if rerun::decide_logging_enabled(true) {
        return Ok(());
    }
    let value = std::env::var("RERUN").unwrap_or_default();
    Err(RecordingError::SwitchedOff(value))
}

/// The crowd's rows fill a chunk by their size, all others by the passing of so much time.
fn batches(is_live: bool) -> ChunkBatcherConfig {
    ChunkBatcherConfig {
        flush_tick: if is_live { VIEWER_TICK } else { FILE_TICK },
        ..ChunkBatcherConfig::DEFAULT
    }
}
