//! The thread that turns snapshots into rows.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

use rerun::RecordingStream;

use super::crowd::Crowd;
use super::error::Cause;
use super::layers::Layer;
use super::snapshot::Snapshot;
use super::{file, set_time, stats, wall_forces};

/// Maximum number of queued snapshots; the simulation waits when the queue is full.
const QUEUE: usize = 4;

/// The simulation's side of the queue.
pub struct Writer {
    /// `None` once the thread has been asked to end.
    snapshots: Option<SyncSender<Snapshot>>,
    thread: Option<JoinHandle<Result<(), Cause>>>,
}

impl Writer {
    /// Starts the thread.
    pub fn start(stream: RecordingStream, mut layers: Vec<Layer>) -> Result<Self, Cause> {
        let (snapshots, queue) = sync_channel::<Snapshot>(QUEUE);
        let write_all = move || {
            let mut crowd = Crowd::default();
            for snapshot in queue {
                stats::log_events(&stream, &snapshot.events)?;
                set_time(&stream, snapshot.frame, snapshot.time);
                crowd.log(&stream, &snapshot)?;
                if let Some(parts) = &snapshot.wall_forces {
                    wall_forces::log(&stream, parts)?;
                }
                for layer in &mut layers {
                    layer.log(&stream, &snapshot.open)?;
                }
                stats::log(&stream, &snapshot)?;
            }
            Ok(())
        };
        let thread = std::thread::Builder::new().name("recording".to_owned());
        Ok(Self {
            snapshots: Some(snapshots),
            thread: Some(thread.spawn(write_all)?),
        })
    }

    /// Queues a snapshot. Errors of earlier snapshots are reported here or by [`finish`](Self::finish).
    pub fn write(&mut self, snapshot: Snapshot) -> Result<(), Cause> {
        let queue = self.snapshots.as_ref();
        if queue.is_some_and(|queue| queue.send(snapshot).is_ok()) {
            return Ok(());
        }
        self.finish()?;
        Err(file::GONE.into())
    }

    /// Waits until everything is written.
    pub fn finish(&mut self) -> Result<(), Cause> {
        self.snapshots = None;
        let joined = self.thread.take().map(JoinHandle::join);
        joined.map_or(Ok(()), |result| result.unwrap_or(Err(file::GONE.into())))
    }
}
