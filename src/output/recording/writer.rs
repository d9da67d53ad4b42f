//! The thread that turns snapshots into rows.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::JoinHandle;

use rerun::RecordingStream;

use super::error::Cause;
use super::snapshot::Snapshot;
use super::{crowd, layers, set_time, stats};

/// Maximum number of queued snapshots; the simulation waits when the queue is full.
const QUEUE: usize = 4;

/// The simulation's side of the queue.
pub struct Writer {
    /// `None` once the thread has been asked to end.
    snapshots: Option<SyncSender<Snapshot>>,
    /// Written snapshots, returned so that their memory can be reused.
    used: Receiver<Snapshot>,
    thread: Option<JoinHandle<Result<(), Cause>>>,
}

/// The thread's side of the queue.
struct Rows {
    stream: RecordingStream,
    crowd: crowd::Crowd,
    layers: layers::Layers,
}

impl Writer {
    /// Starts the thread.
    pub fn start(stream: RecordingStream, layers: layers::Layers) -> Result<Self, Cause> {
        let (snapshots, queue) = sync_channel(QUEUE);
        let (give_back, used) = channel();
        let rows = Rows {
            stream,
            crowd: crowd::Crowd::default(),
            layers,
        };
        let thread = std::thread::Builder::new()
            .name("recording".to_owned())
            .spawn(move || rows.write_all(&queue, &give_back))?;
        Ok(Self {
            snapshots: Some(snapshots),
            used,
            thread: Some(thread),
        })
    }

    /// A snapshot to fill, reused if possible.
    pub fn empty(&self) -> Snapshot {
        self.used.try_recv().unwrap_or_default()
    }

    /// Queues a snapshot. Errors of earlier snapshots are reported here or by [`finish`](Self::finish).
    pub fn write(&mut self, snapshot: Snapshot) -> Result<(), Cause> {
        let queue = self.snapshots.as_ref();
        if queue.is_some_and(|queue| queue.send(snapshot).is_ok()) {
            return Ok(());
        }
        self.finish()?;
        Err(Cause::WriterGone)
    }

    /// Waits until everything is written.
    pub fn finish(&mut self) -> Result<(), Cause> {
        self.snapshots = None;
        let result = self.thread.take().map(JoinHandle::join);
        result.map_or(Ok(()), |joined| joined.unwrap_or(Err(Cause::WriterGone)))
    }
}

impl Rows {
    fn write_all(
        mut self,
        queue: &Receiver<Snapshot>,
        give_back: &Sender<Snapshot>,
    ) -> Result<(), Cause> {
        while let Ok(snapshot) = queue.recv() {
            self.write(&snapshot)?;
            // The receiver may be gone; then the memory is not reused.
            give_back.send(snapshot).ok();
        }
        Ok(())
    }

    fn write(&mut self, snapshot: &Snapshot) -> Result<(), Cause> {
        stats::log_events(&self.stream, &snapshot.events)?;
        set_time(&self.stream, snapshot.frame, snapshot.time);
        self.crowd.log(&self.stream, snapshot)?;
        self.layers.log(&self.stream, &snapshot.open)?;
        stats::log(&self.stream, snapshot)?;
        if snapshot.opens_here {
            stats::log_bookmark(&self.stream)?;
        }
        Ok(())
    }
}
