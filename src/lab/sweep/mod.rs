//! Studies: a scenario with a grid or list of settings and with several seeds, from one file.
//!
//! A [`Study`] is a list of [`Cell`]s, numbered from 1. Each cell is one run: a scenario with its settings and seed.
//! [`run`] computes the cells of a [`Shard`] that are not in the store yet, in parallel, each on a single thread.
//! [`Gathered`] is the state of all cells, as tables and pictures. A failed cell is recorded, and the others continue;
//! the next call tries it again. Any number of processes may work on the same folder at the same time.
//!
//! The file is a JSON object; an unknown key is an error:
//!
//! | key | meaning |
//! |---|---|
//! | `scenario` | the name of a shipped scenario, or the path of a file, relative to the study's folder |
//! | `settings` | an object of settings for every cell: keys as for `--set`, values in JSON |
//! | `measurements` | measurements in addition to those of the scenario |
//! | `list` | a list of objects of settings, one for each cell; each may have a `label` for tables |
//! | `grid` | an object of settings, each with a list of values; all combinations are run |
//! | `seeds` | the number of seeds (1, 2, …), or a list of seeds |
//! | `cases`, `reasons`, `data` | what a [suite](crate::suite) expects of the runs |
//! | `name` | the name of the results; by default the file's name |
//! | `description` | a description, in one line |
//!
//! The cells are all combinations of `list`, `grid` and `seeds`; `list` changes slowest, `seeds` fastest. `scenario`
//! may also be a key of `grid` and `list`. A setting of the `list` overrides one of `settings`.

mod cell;
mod choice;
mod curves;
mod entries;
mod gathered;
mod pictures;
mod plan;
mod readable;
mod seeds;
mod shard;
mod study;
mod tables;
mod written;

pub use cell::Cell;
pub(crate) use cell::plain;
pub(crate) use choice::source;
pub(crate) use entries::Entries;
pub(crate) use gathered::number;
pub use gathered::{Combination, Gathered, State};
pub use pictures::{Drawing, DrawingError};
pub(crate) use plan::{Changes, DataFile, PROFILE, check_keys};
pub(crate) use readable::readable;
pub(crate) use seeds::Seeds;
pub use shard::Shard;
pub(crate) use study::{FOLDER, check_name};
pub use study::{Study, StudyError};
pub(crate) use written::Written;

use runs::error::StoreError;
use runs::job::{self, Listener, Tally};
use runs::store::Store;

/// Computes the cells of a shard that are not in `store`, as [`job::run`] does, within the study's memory.
///
/// # Errors
/// Results cannot be stored. A failed cell is not an error: it is in the tally, and the next call tries it again.
pub fn run(
    study: &Study,
    shard: Shard,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Tally, StoreError> {
    let jobs = study.jobs(|cell| shard.has(cell.number));
    job::run(&jobs, store, study.memory, listener)
}
