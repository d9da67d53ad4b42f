//! Earlier frames of a run, to which it can be set back.

use output::events::Events;
use runs::drive::Run;

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
}

/// Snapshots, the oldest first. The first frame is always among them.
#[derive(Default)]
pub struct Snapshots(Vec<Snapshot>);

impl Snapshots {
    /// Adds a snapshot of the current frame if one is due; whether it was.
    ///
    /// # Errors
    /// The run cannot be copied.
    pub fn add(&mut self, run: &Run, events: &Events) -> Result<bool, String> {
        let clock = run.simulation.frame().clock;
        let (frame, time) = (clock.frame(), clock.time());
        let last = self.0.last().map(|one| clock.time_at(one.frame));
        if last.is_some_and(|last| time < last + EVERY) {
            return Ok(false);
        }
        self.0.push(Snapshot {
            frame,
            run: run.fork()?,
            events: events.clone(),
        });
        if self.0.len() > MOST {
            self.thin(frame);
        }
        Ok(true)
    }

    /// Removes the snapshot whose neighbors are nearest to each other, compared with its age.
    fn thin(&mut self, now: u64) {
        let gap = |k: usize| {
            let age = now - self.0[k].frame + 1;
            (self.0[k + 1].frame - self.0[k - 1].frame) as f64 / age as f64
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
        self.0.retain(|one| one.frame <= frame);
        let Some(last) = self.0.last() else {
            return Ok(None);
        };
        Ok(Some(Snapshot {
            frame: last.frame,
            run: last.run.fork()?,
            events: last.events.clone(),
        }))
    }
}
