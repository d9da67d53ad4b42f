//! The drawings of pages, so that a closed tab loses none.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde_json::{Value, json};

use crate::answer::Refusal;

/// The most drawings: beyond them, the one that was changed the longest ago is forgotten.
const MOST: usize = 20;
/// The longest name of a drawing's key.
const LONGEST: usize = 64;

/// The drawings of all pages, the latest first.
#[derive(Default)]
pub struct Drawings(Mutex<VecDeque<Kept>>);

/// A drawing as it was at its last change.
struct Kept {
    /// The key that its page has chosen.
    key: String,
    changed: Instant,
    document: Value,
}

impl Drawings {
    fn all(&self) -> MutexGuard<'_, VecDeque<Kept>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps a drawing as it is now.
    ///
    /// # Errors
    /// The key is empty or long.
    pub fn keep(&self, key: &str, document: Value) -> Result<(), Refusal> {
        if key.is_empty() || key.len() > LONGEST {
            return Err(Refusal::wrong(format!(
                "drawing: give a key of 1 to {LONGEST} bytes"
            )));
        }
        let mut all = self.all();
        all.retain(|kept| kept.key != key);
        all.push_front(Kept {
            key: key.to_owned(),
            changed: Instant::now(),
            document,
        });
        all.truncate(MOST);
        Ok(())
    }

    /// A drawing.
    ///
    /// # Errors
    /// There is none of this key.
    pub fn get(&self, key: &str) -> Result<Value, Refusal> {
        let all = self.all();
        let found = all.iter().find(|kept| kept.key == key);
        found
            .map(|kept| kept.document.clone())
            .ok_or_else(|| nothing(key))
    }

    /// Forgets a drawing.
    ///
    /// # Errors
    /// There is none of this key.
    pub fn forget(&self, key: &str) -> Result<(), Refusal> {
        let mut all = self.all();
        let before = all.len();
        all.retain(|kept| kept.key != key);
        match all.len() < before {
            true => Ok(()),
            false => Err(nothing(key)),
        }
    }

    /// All drawings, the latest first: key, name, number of elements, and the seconds since their last change.
    pub fn list(&self) -> Value {
        let one = |kept: &Kept| {
            let age = kept.changed.elapsed().as_secs();
            let keys = kept.document.as_object().into_iter().flatten();
            let lists = keys.filter_map(|(_, value)| value.as_array());
            json!({
                "key": kept.key, "name": kept.document["name"], "elements": lists.map(Vec::len).sum::<usize>(),
                "age_secs": age,
            })
        };
        self.all().iter().map(one).collect()
    }
}

fn nothing(key: &str) -> Refusal {
    Refusal::with(
        404,
        format!("drawing {key}: it is forgotten, or the program was started again"),
    )
}
