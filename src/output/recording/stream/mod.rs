//! The destination of a recording, and the rerun stream that goes there.

mod file;
mod relay;
pub mod viewer;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use rerun::external::re_log_encoding::{Decodable as _, StreamFooter};
use rerun::external::re_log_types::ApplicationId;
use rerun::log::ChunkBatcherConfig;
use rerun::sink::LogSink;
use rerun::{RecordingStream, RecordingStreamBuilder};

use super::error::{Cause, RecordingError};
use super::options::RecordingOptions;
use file::{Failure, FileSink};
use viewer::{Address, Viewer};

/// The longest time whose data a killed run loses, besides the chunk being written.
const FILE_TICK: Duration = Duration::from_secs(1);
/// Lag of a live viewer.
const VIEWER_TICK: Duration = Duration::from_millis(100);

/// The destination of a recording: a file, a viewer, or both.
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
            ..Self::default()
        }
    }
}

impl From<Viewer> for Destination {
    fn from(viewer: Viewer) -> Self {
        Self {
            viewer: Some(viewer),
            ..Self::default()
        }
    }
}

/// The application id of a recording: the viewer keeps one layout per application.
pub fn application(options: &RecordingOptions) -> Result<ApplicationId, Cause> {
    Ok(ApplicationId::try_new(options.application.as_str())?)
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
    /// Opens a recording. A viewer merges files with the same id into one recording; a live recording gets an id of
    /// its own.
    pub fn open(to: &Destination, options: &RecordingOptions) -> Result<Self, RecordingError> {
        check_enabled()?;
        let wanted = to.viewer.as_ref();
        let connected = wanted.map(|viewer| viewer.connect(&to.interrupted));
        let sink = connected.transpose()?;
        let live = sink.as_ref();
        let viewer = live.map(|sink| (sink.address.clone(), Arc::clone(&sink.failure)));
        let is_live = viewer.is_some();
        let mut file_failure = Failure::default();
        let open = || -> Result<RecordingStream, Cause> {
            let mut sinks: Vec<Box<dyn LogSink>> = Vec::new();
            if let Some(path) = &to.file {
                let file = FileSink::create(path)?;
                file_failure = Arc::clone(&file.failure);
                sinks.push(Box::new(file));
            }
            if let Some(sink) = sink {
                sinks.push(Box::new(sink));
            }
            // The crowd's rows fill a chunk by size; all other rows are flushed after a fixed time.
            let batches = ChunkBatcherConfig {
                flush_tick: if is_live { VIEWER_TICK } else { FILE_TICK },
                ..ChunkBatcherConfig::DEFAULT
            };
            let plain = RecordingStreamBuilder::new(application(options)?).batcher_config(batches);
            // In a live viewer, a second run with the same id would become part of the first.
            let builder = if is_live {
                plain
            } else {
                plain.recording_id(options.id.as_str())
            };
            let stream = builder.set_sinks(sinks)?;
            stream.set_log_tick_enabled(false);
            stream.set_log_time_enabled(false);
            stream.send_recording_name(options.title.as_str())?;
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

    /// Checks that the viewer, if there is one, still takes data.
    ///
    /// # Errors
    /// It is gone, or took no data for 2 s.
    pub fn check_viewer(&self) -> Result<(), RecordingError> {
        check_viewer(self.viewer.as_ref())
    }

    /// Adds the destination to an error.
    pub fn checked<T, C: ToString>(&self, result: Result<T, C>) -> Result<T, RecordingError> {
        result.map_err(|cause| RecordingError::unwritten(self.file.as_deref(), &cause))
    }

    /// Closes the file once everything has been sent, and checks that it is complete.
    ///
    /// # Errors
    /// The file is incomplete, or the viewer is gone or took no data for 2 s.
    pub fn close(self) -> Result<(), RecordingError> {
        self.checked(self.stream.flush_blocking())?;
        drop(self.stream); // Also drops the sinks; the file sink writes the index and waits for its thread.
        let file = self.file.as_deref();
        if let Some(reason) = self.file_failure.get() {
            return Err(RecordingError::unwritten(file, reason));
        }
        file.map_or(Ok(()), check_footer)?;
        check_viewer(self.viewer.as_ref())
    }
}

/// Checks that the viewer, if there is one, still takes data.
///
/// # Errors
/// It is gone, or took no data for 2 s.
fn check_viewer(viewer: Option<&(Address, Failure)>) -> Result<(), RecordingError> {
    if let Some((address, failure)) = viewer
        && let Some(reason) = failure.get()
    {
        return Err(RecordingError::ViewerGone {
            address: address.to_string(),
            reason: reason.clone(),
        });
    }
    Ok(())
}

/// Checks that the environment variable `RERUN` does not switch recordings off. We could override it for our stream,
/// but not for the stream that rerun creates for a layout.
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

/// Checks that the file ends like a recording that was closed. Reads only its last bytes.
fn check_footer(path: &Path) -> Result<(), RecordingError> {
    let incomplete = |reason: String| RecordingError::Incomplete {
        path: path.to_owned(),
        reason,
    };
    let last_bytes = || -> std::io::Result<(Vec<u8>, u64)> {
        let mut file = File::open(path)?;
        let size = StreamFooter::ENCODED_SIZE_BYTES as u64;
        let start = file.seek(SeekFrom::End(-i64::try_from(size).unwrap_or(0)))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok((bytes, start))
    };
    let (bytes, start) = last_bytes().map_err(|error| incomplete(error.to_string()))?;
    let footer =
        StreamFooter::from_rrd_bytes(&bytes).map_err(|error| incomplete(error.to_string()))?;
    let index_fits = footer.entries.iter().all(|entry| {
        let span = &entry.rrd_footer_byte_span_from_start_excluding_header;
        span.start + span.len <= start
    });
    if footer.entries.is_empty() || !index_fits {
        return Err(incomplete("its index is missing".to_owned()));
    }
    Ok(())
}
