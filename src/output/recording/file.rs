//! A file as rerun's messages go there.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use rerun::external::re_log_encoding::rrd::{CrateVersion, EncodeError, Encoder, EncodingOptions};
use rerun::log::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};

/// Messages under way to the file at most; with more, whoever sends waits.
const QUEUE: usize = 1024;

/// The first thing that went wrong, seen from both sides of a sink.
#[derive(Clone, Default)]
pub struct Failure(Arc<Mutex<Option<String>>>);

impl Failure {
    /// What went wrong first, if anything did.
    pub fn reason(&self) -> Option<String> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Notes what went wrong, unless something has before.
    pub fn is(&self, reason: &dyn ToString) {
        let mut first = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        first.get_or_insert_with(|| reason.to_string());
    }
}

/// A file that rerun's messages are written to by a thread of its own.
///
/// Rerun's own does not say why it failed, and when a disk becomes full its `flush` may wait without end
/// for a thread that has gone.
pub struct FileSink {
    /// `None` once the thread has been asked to end.
    commands: Option<SyncSender<Command>>,
    thread: Option<JoinHandle<()>>,
    failure: Failure,
}

enum Command {
    Write(LogMsg),
    /// To be answered when everything before it is in the file.
    Flush(SyncSender<()>),
}

impl FileSink {
    /// Begins the file at `path`, replacing any there.
    pub fn create(path: &Path) -> io::Result<Self> {
        let (version, options) = (CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED);
        let encoder = Encoder::new_eager(version, options, File::create(path)?);
        let encoder = encoder.map_err(|error| cause(&error))?;
        let (commands, queue) = sync_channel(QUEUE);
        let failure = Failure::default();
        let seen = failure.clone();
        let thread = std::thread::Builder::new()
            .name("recording file".to_owned())
            .spawn(move || write_all(&queue, encoder, &seen))?;
        Ok(Self {
            commands: Some(commands),
            thread: Some(thread),
            failure,
        })
    }

    /// What went wrong, to be looked at while the sink is used and when it is gone.
    pub fn failure(&self) -> Failure {
        self.failure.clone()
    }

    fn send(&self, command: Command) {
        // The thread ends only after this sink, or by a panic, which the missing footer shows.
        if let Some(commands) = &self.commands {
            commands.send(command).ok();
        }
    }
}

impl LogSink for FileSink {
    fn send(&self, message: LogMsg) {
        Self::send(self, Command::Write(message));
    }

    fn flush_blocking(&self, timeout: Duration) -> Result<(), SinkFlushError> {
        let (done, all_written) = sync_channel(1);
        Self::send(self, Command::Flush(done));
        match all_written.recv_timeout(timeout) {
            Err(RecvTimeoutError::Timeout) => return Err(SinkFlushError::Timeout),
            Err(RecvTimeoutError::Disconnected) => {
                self.failure.is(&"the thread that writes has failed")
            }
            Ok(()) => {}
        }
        self.failure
            .reason()
            .map_or(Ok(()), |reason| Err(SinkFlushError::failed(reason)))
    }

    fn defers_finalization_to_shutdown(&self) -> bool {
        true
    }
}

impl Drop for FileSink {
    /// Waits for the file's end.
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// Writes until nobody sends any more, then the index at the file's end; after a failure nothing more, so
/// that what is there opens.
fn write_all(queue: &Receiver<Command>, encoder: Encoder<File>, failure: &Failure) {
    let mut open = Some(encoder);
    for command in queue {
        match (command, &mut open) {
            (Command::Write(message), Some(encoder)) => {
                if let Err(error) = encoder.append(&message) {
                    failure.is(&cause(&error));
                    // Dropped as it is, it would write an index.
                    open.take().map(Encoder::into_inner);
                }
            }
            (Command::Write(_), None) => {}
            (Command::Flush(done), _) => {
                done.send(()).ok();
            }
        }
    }
    if let Some(Err(error)) = open.as_mut().map(Encoder::finish) {
        failure.is(&cause(&error));
    }
}

/// What the system said, where it was the system.
fn cause(error: &EncodeError) -> io::Error {
    match error {
        EncodeError::Write(error) => match error.raw_os_error() {
            Some(code) => io::Error::from_raw_os_error(code),
            None => io::Error::other(error.to_string()),
        },
        other => io::Error::other(other.to_string()),
    }
}
