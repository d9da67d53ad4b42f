//! The whole suite.

use super::cell::Cell;
use super::fit::fit;
use super::hard::{HARD, Hard, Survival};
use super::jitter::{Jitter, VARIANTS};
use super::map::Detail;
use super::report::Report;
use crate::lab::error::LabError;
use crate::lab::jobs::{read, results};
use crate::runs::identity::Identity;
use crate::runs::job::{Job, Listener, Progress};
use crate::runs::store::Store;

/// Held-out crowds use the seeds after this one, which the maps do not use.
const OTHER_PEOPLE: u64 = 100;

/// Does all jobs whose results are not in `store`, and writes tables and pictures.
///
/// # Errors
/// A run or a file fails.
pub fn stress(detail: Detail, store: &Store, listener: &dyn Listener) -> Result<Report, LabError> {
    let (crowds, held_out) = (detail.crowds(), detail.held_out());
    let mut jobs = Vec::new();
    for hard in HARD {
        jobs.push(hard.job(detail.quick)?);
    }
    jobs.extend(crowds.iter().map(|&crowd| Cell::job(crowd, detail, 0)));
    let others = held_out.iter();
    jobs.extend(others.map(|&crowd| Cell::job(crowd, detail, OTHER_PEOPLE)));
    jobs.extend(VARIANTS.map(|variant| variant.job()));
    let results = results(&jobs, store, listener)?;
    let (hard, rest) = results.split_at(HARD.len());
    let (cells, rest) = rest.split_at(crowds.len());
    let (held_out, jitter) = rest.split_at(held_out.len());
    let hard: Result<Vec<Survival>, _> = hard.iter().map(read).collect();
    let cells: Result<Vec<Cell>, _> = cells.iter().map(read).collect();
    let held_out: Result<Vec<Cell>, _> = held_out.iter().map(read).collect();
    let jitter: Result<Vec<Jitter>, _> = jitter.iter().map(read).collect();
    let cells = cells?;
    let report = Report {
        hard: HARD.iter().map(|hard| hard.name).zip(hard?).collect(),
        fitted: fit(&cells),
        cells,
        held_out: held_out?,
        jitter: VARIANTS.into_iter().zip(jitter?).collect(),
    };
    report.write(store)?;
    super::pictures::save(&report, detail, store)?;
    Ok(report)
}

impl Hard {
    /// The job that runs it.
    fn job(&self, quick: bool) -> Result<Job<'static>, LabError> {
        let invalid = |error| LabError::of(self.name.to_owned(), error);
        let shortened = self.quick_secs.filter(|_| quick);
        let settings: Result<Vec<_>, _> = shortened
            .iter()
            .map(|secs| format!("duration_secs={secs}").parse())
            .collect();
        let settings =
            settings.map_err(|error| LabError::Data(format!("{}: {error}", self.name)))?;
        let scenario = self.scenario(&settings).map_err(invalid)?;
        let frames = scenario.duration_secs / scenario.scene.clock.time_step();
        let name = format!("hard {}, {frames} frames", self.name);
        let work = move |_: Progress| Ok::<Survival, LabError>(Self::survive(&scenario));
        let key = Identity::of(&name, self.text);
        Ok(Job::new(name, key, 0.3 + 1.5e-5 * frames, work))
    }
}
