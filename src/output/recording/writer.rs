//! The thread that turns snapshots into rows.

use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

use rerun::RecordingStream;

use super::crowd::{Crowd, Maps};
use super::error::Cause;
use super::events::Line;
use super::focus::Focus;
use super::layers::Layer;
use super::snapshot::Snapshot;
use super::{events, file, set_time, stats, wall_forces};

/// Maximum number of queued snapshots; the simulation waits when the queue is full.
const QUEUE: usize = 4;

/// The layers that show the debug agents.
#[derive(Default)]
pub struct Debug {
    /// The layers with all of them.
    pub layers: Vec<Layer>,
    /// The followed ones.
    pub focuses: Vec<Focus>,
}

/// The items that the thread writes.
enum Item {
    Frame(Box<Snapshot>),
    Lines(Vec<Line>),
}

/// The simulation's side of the queue.
pub struct Writer {
    /// `None` once the thread has been asked to end.
    items: Option<SyncSender<Item>>,
    thread: Option<JoinHandle<Result<(), Cause>>>,
}

impl Writer {
    /// Starts the thread.
    pub fn start(stream: RecordingStream, maps: Maps, mut debug: Debug) -> Result<Self, Cause> {
        let (items, queue) = sync_channel::<Item>(QUEUE);
        let write_all = move || {
            let mut crowd = Crowd::new(maps);
            for item in queue {
                let snapshot = match item {
                    Item::Frame(snapshot) => snapshot,
                    Item::Lines(lines) => {
                        events::log(&stream, &lines)?;
                        continue;
                    }
                };
                events::log(&stream, &snapshot.events)?;
                set_time(&stream, snapshot.frame, snapshot.time);
                crowd.log(&stream, &snapshot)?;
                if let Some(parts) = &snapshot.wall_forces {
                    wall_forces::log(&stream, parts)?;
                }
                for layer in &mut debug.layers {
                    layer.log(&stream, &snapshot.open)?;
                }
                for (focus, place) in debug.focuses.iter_mut().zip(&snapshot.followed) {
                    focus.log(&stream, place.map(|k| &snapshot.open[k]))?;
                }
                stats::log(&stream, &snapshot)?;
            }
            Ok(())
        };
        let thread = std::thread::Builder::new().name("recording".to_owned());
        Ok(Self {
            items: Some(items),
            thread: Some(thread.spawn(write_all)?),
        })
    }

    /// Queues a snapshot. Errors of earlier snapshots are reported here or by [`finish`](Self::finish).
    pub fn write(&mut self, snapshot: Snapshot) -> Result<(), Cause> {
        self.send(Item::Frame(Box::new(snapshot)))
    }

    /// Queues lines for the log of events.
    pub fn note(&mut self, lines: Vec<Line>) -> Result<(), Cause> {
        self.send(Item::Lines(lines))
    }

    fn send(&mut self, item: Item) -> Result<(), Cause> {
        let queue = self.items.as_ref();
        if queue.is_some_and(|queue| queue.send(item).is_ok()) {
            return Ok(());
        }
        self.finish()?;
        Err(file::GONE.into())
    }

    /// Waits until everything is written.
    pub fn finish(&mut self) -> Result<(), Cause> {
        self.items = None;
        let joined = self.thread.take().map(JoinHandle::join);
        joined.map_or(Ok(()), |result| result.unwrap_or(Err(file::GONE.into())))
    }
}
