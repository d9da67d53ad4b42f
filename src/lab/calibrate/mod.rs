//! Calibration: parameters for which runs come close to measured values.
//!
//! A [`Calibration`] is one file: parameters with bounds, scenes with measured values and tolerances, seeds. [`run`]
//! computes the starting point, a screening ([`morris`](analysis::morris)), the generations of a search
//! ([`cma_es`](analysis::cma_es)), slopes around the best point
//! ([`identifiability`](analysis::identifiability)), and the errors of the fitted values and of the held-out
//! values. The points of each stage are the cells of a sweep; finished cells are kept in the store, and everything else
//! is computed from them. An interrupted calibration therefore continues from its finished cells, any number of
//! processes can share one folder, and the results are identical to the last byte after any number of interruptions.

mod evaluate;
mod file;
mod parameter;
mod pictures;
mod reader;
mod report;
mod residual;
mod scene;
mod search;
mod study;
mod text;

pub use evaluate::{Evaluated, Sample};
pub use parameter::Parameter;
pub use report::Report;
pub use scene::{Scene, Set, Target};
pub use search::{Calibrated, Stage};
pub use study::{Calibration, MOST_GENERATIONS};
pub use text::names;

use crate::error::LabError;
use crate::sweep::Shard;
use runs::job::Listener;
use runs::store::Store;

/// Computes all stages. `shard` is the part of each stage's cells that
/// this process computes first; then it computes those that no other process has claimed, and waits for the others.
///
/// # Errors
/// Results cannot be stored, or the screening drops all parameters.
pub fn run<'a>(
    calibration: &'a Calibration,
    shard: Shard,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Report<'a>, LabError> {
    let found = search::search(&evaluate::Evaluator {
        calibration,
        shard,
        store,
        listener,
    })?;
    Ok(Report { calibration, found })
}
