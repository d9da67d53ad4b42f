//! The runs of all pages, by number.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde_json::{Value, json};

use crate::answer::Refusal;
use crate::play::Play;

/// The most runs at a time.
const MOST: usize = 8;

/// The runs of all pages.
#[derive(Default)]
pub struct Plays(Mutex<Numbered>);

#[derive(Default)]
struct Numbered {
    last: u64,
    plays: BTreeMap<u64, Play>,
}

impl Plays {
    fn all(&self) -> MutexGuard<'_, Numbered> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a run, once there is room; returns its number.
    ///
    /// # Errors
    /// There are too many runs, or it cannot begin.
    pub fn add(&self, begin: impl FnOnce() -> Result<Play, Refusal>) -> Result<u64, Refusal> {
        let full = || {
            let message = format!("{MOST} runs are open, the most at a time; close one of them");
            Refusal::with(409, message)
        };
        if self.all().plays.len() >= MOST {
            return Err(full());
        }
        let play = begin()?;
        let mut all = self.all();
        if all.plays.len() >= MOST {
            return Err(full());
        }
        all.last += 1;
        let number = all.last;
        all.plays.insert(number, play);
        Ok(number)
    }

    /// A run.
    ///
    /// # Errors
    /// There is none of this number.
    pub fn get(&self, number: u64) -> Result<Play, Refusal> {
        let found = self.all().plays.get(&number).cloned();
        found.ok_or_else(|| {
            Refusal::with(
                404,
                format!("run {number}: it is closed, or the program was started again"),
            )
        })
    }

    /// Closes a run.
    ///
    /// # Errors
    /// There is none of this number.
    pub fn close(&self, number: u64) -> Result<(), Refusal> {
        let play = self.get(number)?;
        play.feed.close();
        self.all().plays.remove(&number);
        Ok(())
    }

    /// All runs: number, name, and state.
    pub fn list(&self) -> Value {
        let all = self.all();
        let one = |(number, play): (&u64, &Play)| json!({"id": number, "name": play.name, "state": play.feed.state()});
        all.plays.iter().map(one).collect()
    }
}
