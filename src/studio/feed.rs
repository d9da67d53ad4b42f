//! The latest frames of a run, and its state, for pages that ask for them.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use output::page::{Coded, Live};
use serde_json::{Map, Value};

/// The most frames that are kept, and the most people in them: a page that asks less often misses frames.
const MOST_FRAMES: usize = 90;
const MOST_PEOPLE: usize = 600_000;

/// The latest frames of a run, and its state.
#[derive(Default)]
pub struct Feed {
    latest: Mutex<Latest>,
    changed: Condvar,
}

#[derive(Default)]
struct Latest {
    /// How often the run was set back.
    epoch: u64,
    /// Frames with their numbers, from 1 on.
    frames: VecDeque<(u64, Arc<Coded>)>,
    /// The number of the latest frame.
    last: u64,
    state: Value,
    /// How often frames or state have changed.
    changes: u64,
    /// Whether the run is closed.
    is_over: bool,
}

/// What a page knows.
#[derive(Debug, Clone, Copy)]
pub struct Known {
    /// The epoch of its latest frame.
    pub epoch: u64,
    /// The number of its latest frame.
    pub after: u64,
    /// The number of changes that it knows of; `None`: it asks for frames alone.
    pub changes: Option<u64>,
}

impl Feed {
    fn latest(&self) -> MutexGuard<'_, Latest> {
        self.latest.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a frame; `is_back`: the run was set back to it.
    pub fn add(&self, mut frame: Coded, is_back: bool) {
        let mut latest = self.latest();
        if is_back {
            latest.epoch += 1;
            latest.frames.clear();
        }
        let mut people = frame.people();
        people += latest
            .frames
            .iter()
            .map(|(_, one)| one.people())
            .sum::<usize>();
        while latest.frames.len() >= MOST_FRAMES
            || (people > MOST_PEOPLE && latest.frames.len() > 1)
        {
            let Some((_, first)) = latest.frames.pop_front() else {
                break;
            };
            people -= first.people();
            match latest.frames.front_mut() {
                // What happened is told in the next frame.
                Some((_, next)) => Arc::make_mut(next).take_events(&first),
                None => frame.take_events(&first),
            }
        }
        latest.last += 1;
        latest.changes += 1;
        let number = latest.last;
        latest.frames.push_back((number, Arc::new(frame)));
        self.changed.notify_all();
    }

    /// Sets the state of the run.
    pub fn set_state(&self, state: Value) {
        let mut latest = self.latest();
        if latest.state != state {
            latest.state = state;
            latest.changes += 1;
            self.changed.notify_all();
        }
    }

    /// The state of the run.
    pub fn state(&self) -> Value {
        self.latest().state.clone()
    }

    /// Tells pages that the run is closed.
    pub fn close(&self) {
        self.latest().is_over = true;
        self.changed.notify_all();
    }

    /// The frames after those that a page knows, once there are some, or something else has changed, or after `wait`:
    /// the lengths of three parts, then the parts. `None` once the run is closed.
    pub fn after(&self, live: &Live, known: Known, wait: Duration) -> Option<Vec<u8>> {
        let end = Instant::now() + wait;
        let mut latest = self.latest();
        let is_new = |latest: &Latest| {
            let has_frames = latest.epoch != known.epoch || latest.last > known.after;
            has_frames || known.changes.is_some_and(|known| known != latest.changes)
        };
        while !latest.is_over && !is_new(&latest) {
            let Some(left) = end.checked_duration_since(Instant::now()) else {
                break;
            };
            let waited = self.changed.wait_timeout(latest, left);
            latest = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
        if latest.is_over {
            return None;
        }
        let is_same = latest.epoch == known.epoch;
        let is_known = |number: u64| is_same && number <= known.after;
        let frames: Vec<_> = latest.frames.iter().cloned().collect();
        let before = frames
            .iter()
            .find(|(number, _)| is_same && *number == known.after);
        let new: Vec<&Coded> = frames
            .iter()
            .filter(|(number, _)| !is_known(*number))
            .map(|(_, frame)| &**frame)
            .collect();
        let more = Map::from_iter([
            ("epoch".to_owned(), latest.epoch.into()),
            ("joins".to_owned(), before.is_some().into()),
            ("last".to_owned(), latest.last.into()),
            ("changes".to_owned(), latest.changes.into()),
            ("state".to_owned(), latest.state.clone()),
        ]);
        drop(latest);
        let parts = live.part(before.map(|(_, frame)| &**frame), &new, more);
        let lengths = parts
            .each_ref()
            .map(|part| (part.len() as u32).to_le_bytes());
        Some(
            lengths
                .into_iter()
                .flatten()
                .chain(parts.concat())
                .collect(),
        )
    }
}
