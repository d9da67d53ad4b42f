//! A recording that has begun: the common part of recordings of runs and of measurements. A thread turns snapshots into
//! rows.

use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use rerun::RecordingStream;

use super::building::Building;
use super::debug::focus::Focus;
use super::debug::layers::Layer;
use super::error::{Cause, GONE, RecordingError};
use super::frame::crowd::{self, Crowd, Maps};
use super::frame::events;
use super::frame::{Snapshot, set_time, stats};
use super::layout::{Content, Opening, blueprint};
use super::options::RecordingOptions;
use super::scene::bars;
use super::stream::Output;
use super::text::{self, Document};
use crate::events::Line;

/// Maximum number of queued snapshots; the simulation waits when the queue is full.
const QUEUE: usize = 4;

/// What shows the debug agents, and the levels of a building.
#[derive(Default)]
pub struct Debug {
    /// The layers with all of them.
    pub layers: Vec<Layer>,
    /// The followed ones.
    pub focuses: Vec<Focus>,
    /// The building in three dimensions.
    pub building: Option<Building>,
}

/// The items that the thread writes.
enum Item {
    Frame(Box<Snapshot>),
    Lines(Vec<Line>),
}

pub struct Session {
    output: Output,
    /// `None` once the thread has been asked to end.
    items: Option<SyncSender<Item>>,
    thread: Option<JoinHandle<Result<(), Cause>>>,
    pub options: RecordingOptions,
    content: Content,
    document: Document,
}

impl Session {
    /// Logs the layout and the static data. `log_own` logs the static data of this kind of recording, and returns its
    /// text document and what shows its debug agents.
    pub fn begin(
        output: Output,
        options: RecordingOptions,
        content: Content,
        log_own: impl FnOnce(&RecordingStream) -> Result<(Document, Debug), Cause>,
    ) -> Result<Self, RecordingError> {
        let (items, queue) = sync_channel(QUEUE);
        let begin = |stream: &RecordingStream| -> Result<_, Cause> {
            let opening = match output.is_live() {
                true => Opening::Live,
                false => Opening::Empty,
            };
            blueprint::send(stream, &options, opening, &content)?;
            let (document, debug) = log_own(stream)?;
            document.log(stream, None)?;
            let maps = Maps::new(&options);
            bars::log(stream, &options.view, &maps)?;
            crowd::log_style(stream)?;
            stats::log_style(stream)?;
            stream.flush_blocking()?;
            let stream = stream.clone();
            let builder = std::thread::Builder::new().name("recording".to_owned());
            let thread = builder.spawn(move || write_all(&stream, queue, maps, debug))?;
            Ok((document, thread))
        };
        let (document, thread) = output.checked(begin(&output.stream))?;
        Ok(Self {
            output,
            items: Some(items),
            thread: Some(thread),
            options,
            content,
            document,
        })
    }

    /// Adds a frame. Errors of earlier frames are reported here or by [`finish`](Self::finish).
    pub fn write(&mut self, snapshot: Snapshot) -> Result<(), RecordingError> {
        self.send(Item::Frame(Box::new(snapshot)))
    }

    /// Checks that the viewer, if there is one, still takes data.
    pub fn check_viewer(&self) -> Result<(), RecordingError> {
        self.output.check_viewer()
    }

    /// Adds lines to the log of events.
    pub fn note(&mut self, lines: Vec<Line>) -> Result<(), RecordingError> {
        self.send(Item::Lines(lines))
    }

    fn send(&mut self, item: Item) -> Result<(), RecordingError> {
        let queue = self.items.as_ref();
        if queue.is_some_and(|queue| queue.send(item).is_ok()) {
            return Ok(());
        }
        let ended = self.end_thread().and(Err(GONE.into()));
        self.output.checked(ended)
    }

    /// Waits until all items are written.
    fn end_thread(&mut self) -> Result<(), Cause> {
        self.items = None;
        let joined = self.thread.take().map(JoinHandle::join);
        joined.map_or(Ok(()), |result| result.unwrap_or(Err(GONE.into())))
    }

    /// Logs more static data.
    pub fn log_static(
        &self,
        log: impl FnOnce(&RecordingStream) -> Result<(), Cause>,
    ) -> Result<(), RecordingError> {
        self.output.checked(log(&self.output.stream))
    }

    /// Sends the buffered data, then the final layout, closes the file and checks that it is complete. If the moment
    /// that the recording opens at was found during the run, `found` is its time; the view of the followed agent number
    /// `followed` is in front.
    pub fn finish(
        mut self,
        found: Option<f64>,
        followed: Option<usize>,
    ) -> Result<(), RecordingError> {
        self.options.opens_at = found.or(self.options.opens_at);
        let mut end = || {
            self.end_thread()?;
            let stream = &self.output.stream;
            if let Some(time) = found {
                self.document.log(stream, found)?;
                text::log_opening(stream, time)?;
            }
            // The viewer cannot go to a time that it has not read yet.
            stream.flush_blocking()?;
            let opening = Opening::Whole(followed);
            blueprint::send(stream, &self.options, opening, &self.content)
        };
        let ended = end();
        self.output.checked(ended)?;
        self.output.close()
    }
}

/// Writes all items of the queue.
fn write_all(
    stream: &RecordingStream,
    queue: Receiver<Item>,
    maps: Maps,
    mut debug: Debug,
) -> Result<(), Cause> {
    let mut crowd = Crowd::new(maps);
    for item in queue {
        let snapshot = match item {
            Item::Frame(snapshot) => snapshot,
            Item::Lines(lines) => {
                events::log(stream, &lines)?;
                continue;
            }
        };
        events::log(stream, &snapshot.events)?;
        set_time(stream, snapshot.frame, snapshot.time);
        crowd.log(stream, &snapshot)?;
        if let Some(building) = &mut debug.building {
            building.log(stream, &snapshot)?;
        }
        for (layer, parts) in &snapshot.lines {
            layer.log(stream, parts)?;
        }
        for layer in &mut debug.layers {
            layer.log(stream, &snapshot.open)?;
        }
        for (focus, place) in debug.focuses.iter_mut().zip(&snapshot.followed) {
            focus.log(stream, place.map(|k| &snapshot.open[k]))?;
        }
        stats::log(stream, &snapshot)?;
    }
    Ok(())
}
