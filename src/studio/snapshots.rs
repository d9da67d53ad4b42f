//! Earlier frames of a run, to which it can be set back.

use std::sync::{Arc, Mutex, PoisonError};

use output::events::Events;
use runs::drive::Run;

use crate::doors::Doors;

/// The time between two snapshots at first, seconds.
const EVERY: f64 = 1.0;
/// The most snapshots: the older they are, the farther apart.
const MOST: usize = 32;

/// A run in an earlier frame.
pub struct Snapshot {
    /// The number of the frame.
    pub frame: u64,
    /// The run, evaluated.
    pub run: Run,
    /// Its log of events.
    pub events: Events,
    /// The counts at its doors.
    pub doors: Doors,
}

/// Snapshots with the numbers of their frames, the oldest first. The first frame is always among them. Forks of a run
/// share them.
#[derive(Clone, Default)]
pub struct Snapshots(Vec<(u64, Arc<Mutex<Snapshot>>)>);

impl Snapshots {
    /// Adds a snapshot of the current frame if one is due; whether it was.
    ///
    /// # Errors
    /// The run cannot be copied.
    pub fn add(&mut self, run: &Run, events: &Events, doors: &Doors) -> Result<bool, String> {
        let clock = run.simulation.frame().clock;
        let (frame, time) = (clock.frame(), clock.time());
        let last = self.0.last().map(|one| clock.time_at(one.0));
        if last.is_some_and(|last| time < last + EVERY) {
            return Ok(false);
        }
        let snapshot = Snapshot {
            frame,
            run: run.fork()?,
            events: events.clone(),
            doors: doors.clone(),
        };
        self.0.push((frame, Arc::new(Mutex::new(snapshot))));
        if self.0.len() > MOST {
            self.thin(frame);
        }
        Ok(true)
    }

    /// Removes the snapshot whose neighbors are nearest to each other, compared with its age.
    fn thin(&mut self, now: u64) {
        let gap = |k: usize| {
            let age = now - self.0[k].0 + 1;
            (self.0[k + 1].0 - self.0[k - 1].0) as f64 / age as f64
        };
        let inner = 1..self.0.len() - 1;
        if let Some(k) = inner.min_by(|&a, &b| gap(a).total_cmp(&gap(b))) {
            self.0.remove(k);
        }
    }

    /// A copy of the last snapshot at or before a frame; later ones are forgotten.
    ///
    /// # Errors
    /// The run cannot be copied.
    pub fn back_to(&mut self, frame: u64) -> Result<Option<Snapshot>, String> {
        self.0.retain(|one| one.0 <= frame);
        let Some((_, last)) = self.0.last() else {
            return Ok(None);
        };
        let last = last.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(Some(Snapshot {
            frame: last.frame,
            run: last.run.fork()?,
            events: last.events.clone(),
            doors: last.doors.clone(),
        }))
    }
}
