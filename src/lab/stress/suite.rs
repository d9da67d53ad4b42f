//! The whole suite.

use super::cell::Cell;
use super::fit::fit;
use super::map::Detail;
use super::report::{Finished, Report};
use super::rest::Rest;
use crate::error::LabError;
use crate::jobs::{Results, results};
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
    let shown = crowds.iter().map(|crowd| (crowd, 0));
    let seeded = shown.chain(held_out.iter().map(|crowd| (crowd, OTHER_PEOPLE)));
    jobs.extend(seeded.map(|(&crowd, seed)| Cell::job(crowd, detail.bisections, seed)));
    let results = results(&jobs, store, listener)?;
    let points = |crowds: &[Rest], seed| -> Result<Vec<Cell>, LabError> {
        let point = |&crowd: &Rest| {
            let job = Cell::job(crowd, detail.bisections, seed);
            results.of(&job.name, &job.key)
        };
        crowds.iter().map(point).collect()
    };
    let cells = points(&crowds, 0)?;
    Ok(Report {
        hard: runs(hard.cells.iter().filter(|cell| wanted(cell)), results)?,
        fitted: fit(&cells),
        cells,
        held_out: points(held_out, OTHER_PEOPLE)?,
        jitter: runs(jitter.cells.iter(), results)?,
    })
}

/// The runs of these cells.
fn runs<'a>(
    cells: impl Iterator<Item = &'a sweep::Cell>,
    results: Results,
) -> Result<Vec<Finished>, LabError> {
    let run = |cell: &sweep::Cell| {
        let label = cell.label().unwrap_or_default().to_owned();
        let scenario = cell.case.scenario();
        let scenario = scenario.map_err(|error| LabError::of(label.clone(), error))?;
        Ok(Finished {
            label,
            description: scenario.description,
            result: results.of(&cell.to_string(), &cell.case.key)?,
        })
    };
    cells.map(run).collect()
}
