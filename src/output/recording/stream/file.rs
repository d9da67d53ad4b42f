//! Writes rerun's messages to a file.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;
use std::time::Duration;

use rerun::external::re_log_encoding::rrd::{CrateVersion, EncodeError, Encoder, EncodingOptions};
use rerun::log::LogMsg;
use rerun::sink::{LogSink, SinkFlushError};

use crate::recording::error::GONE;

/// Maximum number of queued messages; senders wait when the queue is full.
const QUEUE: usize = 1024;

/// The first error of a sink, shared by both of its sides; readable after the sink is dropped.
pub type Failure = Arc<OnceLock<String>>;

/// A sink that writes rerun's messages to a file on its own thread.
///
/// Rerun's own file sink does not say why it failed, and when the disk is full its `flush` may wait forever for a
/// thread that has ended.
pub struct FileSink {
    /// `None` once the thread has been asked to end.
    commands: Option<SyncSender<Command>>,
    thread: Option<JoinHandle<()>>,
    pub failure: Failure,
}

enum Command {
    Write(LogMsg),
    /// Answered when all earlier messages are in the file.
    Flush(SyncSender<()>),
}

impl FileSink {
    /// Creates the file at `path`, replacing an existing one.
    pub fn create(path: &Path) -> io::Result<Self> {
        let (version, options) = (CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED);
        let begun = Encoder::new_eager(version, options, File::create(path)?);
        let encoder = begun.map_err(|error| io::Error::other(cause(&error)))?;
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

    fn send(&self, command: Command) {
        // The thread ends only after this sink, or by a panic, which the missing footer reveals.
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
                self.failure.set(GONE.to_owned()).ok();
            }
            Ok(()) => {}
        }
        let reason = self.failure.get();
        reason.map_or(Ok(()), |reason| Err(SinkFlushError::failed(reason)))
    }

    fn defers_finalization_to_shutdown(&self) -> bool {
        true
    }
}

impl Drop for FileSink {
    /// Waits until the file is complete.
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

/// Writes messages until the sender is gone, then the index at the end of the file. After an error it writes nothing
/// more, so that the file can still be opened.
fn write_all(queue: &Receiver<Command>, encoder: Encoder<File>, failure: &Failure) {
    let mut open = Some(encoder);
    for command in queue {
        match (command, &mut open) {
            (Command::Write(message), Some(encoder)) => {
                if let Err(error) = encoder.append(&message) {
                    failure.set(cause(&error)).ok();
                    // Dropping the encoder would write an index.
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
        failure.set(cause(&error)).ok();
    }
}

/// The operating system's error, if there is one.
fn cause(error: &EncodeError) -> String {
    match error {
        EncodeError::Write(error) => error.to_string(),
        other => other.to_string(),
    }
}
