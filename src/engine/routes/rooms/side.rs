//! The two sides of openings.

use serde::{Deserialize, Serialize};

/// A side of an opening: agents come from the room on this side, and pass the opening to the room beyond it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Side(u32);

impl Side {
    /// Both sides of each of `openings` openings, in order.
    pub fn all(openings: usize) -> impl ExactSizeIterator<Item = Self> {
        (0..2 * openings as u32).map(Self)
    }

    /// Its number among the sides of all openings.
    pub fn index(self) -> usize {
        self.0 as usize
    }

    /// The number of its opening.
    pub fn opening(self) -> usize {
        self.index() / 2
    }

    /// Which of the two rooms of its opening lies beyond it, 0 or 1.
    pub fn beyond(self) -> usize {
        self.index() % 2
    }

    /// The other side of its opening: agents that turn back come from there.
    #[must_use]
    pub fn other(self) -> Self {
        Self(self.0 ^ 1)
    }
}
