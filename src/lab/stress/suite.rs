//! The whole suite.

use serde_json::Value;

use super::cell::Cell;
use super::fit::fit;
use super::map::Detail;
use super::report::{Finished, Report};
use crate::error::LabError;
use crate::jobs::{read, results};
use crate::sweep::{self, Study};
use runs::job::Listener;
use runs::store::Store;

/// Held-out crowds use the seeds after this one, which the maps do not use.
const OTHER_PEOPLE: u64 = 100;

/// Computes all results that are not in `store`.
///
/// # Errors
/// A run fails, or a result cannot be stored.
pub fn stress(detail: &Detail, store: &Store, listener: &dyn Listener) -> Result<Report, LabError> {
    let hard = Study::built_in("stress_hard", None, None)?;
    let jitter = Study::built_in("stress_jitter", None, None)?;
    let (crowds, held_out) = (detail.crowds(), &detail.held_out);
    let wanted = |cell: &sweep::Cell| cell.label() != Some(&detail.omitted_case);
    let mut jobs = hard.jobs(wanted);
    jobs.extend(jitter.jobs(|_| true));
    let seeded = crowds.iter().map(|crowd| (crowd, 0));
    let seeded = seeded.chain(held_out.iter().map(|crowd| (crowd, OTHER_PEOPLE)));
    jobs.extend(seeded.map(|(&crowd, seed)| Cell::job(crowd, detail.bisections, seed)));
    let results = &mut results(&jobs, store, listener)?.into_iter();
    let hard = runs(hard.cells.iter().filter(|cell| wanted(cell)), results)?;
    let jitter = runs(jitter.cells.iter(), results)?;
    let mut points = |count| -> Result<Vec<Cell>, LabError> {
        let points = results.take(count);
        points.map(|point| read(&point)).collect()
    };
    let cells = points(crowds.len())?;
    Ok(Report {
        hard,
        fitted: fit(&cells),
        cells,
        held_out: points(held_out.len())?,
        jitter,
    })
}

/// The runs of these cells, with the next results.
fn runs<'a>(
    cells: impl Iterator<Item = &'a sweep::Cell>,
    results: &mut impl Iterator<Item = Value>,
) -> Result<Vec<Finished>, LabError> {
    let run = |(cell, result): (&sweep::Cell, Value)| {
        let label = cell.label().unwrap_or_default().to_owned();
        let scenario = cell.case.scenario();
        let scenario = scenario.map_err(|error| LabError::of(label.clone(), error))?;
        Ok(Finished {
            label,
            description: scenario.description,
            result: read(&result)?,
        })
    };
    cells.zip(results).map(run).collect()
}
