//! Studies: a scenario over a grid or list of settings and over seeds, from one file.
//!
//! A [`Study`] is a list of [`Cell`]s, numbered from 1: one scenario with its settings and seed each. [`run`]
//! computes those of a [`Shard`] that the [`Shelf`] does not have yet, side by side, each on one thread;
//! [`Gathered`] is what is there of all of them, as tables. A cell that fails is written down and the others
//! go on; it is tried again by the next call. Any number of processes may work on one folder at once.
//!
//! The file is a JSON object; an unknown key is an error:
//!
//! | key | what it says |
//! |---|---|
//! | `scenario` | a scenario that comes with the program by name, or a file, seen from the study's folder |
//! | `settings` | an object of settings that hold in every cell: keys as `--set` takes them, values JSON |
//! | `list` | a list of such objects: one cell each |
//! | `grid` | an object of settings with a list of values each: every combination of them |
//! | `seeds` | how many (1, 2, …), or a list of them |
//! | `name` | what the results are called; else the file's name |
//! | `description` | a line about it |
//!
//! `list`, `grid` and `seeds` multiply; the first changes slowest. `scenario` may also be a key of `grid` and
//! `list`. A setting of the `list` goes before one of `settings`.

mod cell;
mod choice;
mod entries;
mod gathered;
mod kept;
mod memory;
mod runner;
mod seeds;
mod shard;
mod study;
mod tables;

pub use cell::Cell;
pub use gathered::{Gathered, State};
pub use kept::{CellResult, Failure, Shelf};
pub use runner::{Listener, Tally, run};
pub use shard::Shard;
pub use study::Study;

use crate::lab::reproduce::ReproduceError;
use crate::scenario::{Problem, ScenarioError, TooLarge};

/// Why a study makes no sense.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study's file.
    #[error(transparent)]
    File(#[from] ScenarioError),
    /// One of its cells.
    #[error("{file}: cell {cell}: {error}")]
    Cell {
        /// The study's file.
        file: String,
        /// The cell's number.
        cell: usize,
        /// What is wrong with its scenario.
        error: CellError,
    },
    /// The cells cannot be checked side by side.
    #[error(transparent)]
    Machine(#[from] ReproduceError),
}

/// Why a cell cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum CellError {
    /// Its scenario or its settings make no sense.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// It needs more memory than there is.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
}

/// Something wrong at a place of the study's file.
fn problem(path: impl Into<String>, reason: impl Into<String>) -> Problem {
    Problem {
        path: path.into(),
        reason: reason.into(),
    }
}
