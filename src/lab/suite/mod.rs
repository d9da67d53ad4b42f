//! Suites: cases with expected results, judged from runs of a study.
//!
//! A [`Case`] names runs of its suite's study and turns their results into [`Check`]s. A [`Report`] has the checks of
//! all cases, profiles and seeds.

mod case;
mod check;
mod data;
mod pictures;
mod report;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

pub use case::{Case, Runs};
pub use check::{Check, Expected};
pub use data::{DataFile, Skipped};
pub use report::{Finding, Report};

use data::Found;

use crate::lab::error::LabError;
use crate::lab::jobs::{read, results};
use crate::lab::sweep::{self, Study};
use crate::output::plot::Sheet;
use crate::runs::case::RunResult;
use crate::runs::job::Listener;
use crate::runs::store::Store;
use crate::runs::summary::Summary;

/// The name of the check of walls.
const THROUGH_WALLS: &str = "people through walls";

/// Cases whose runs are those of one study.
pub struct Suite {
    /// The name of the study, of the files with the results, and of the table in documents.
    pub name: &'static str,
    /// The cases, in the order of the report.
    pub cases: &'static [&'static [Case]],
    /// The data that cases need, whose runs are those of the study `NAME_data`.
    pub data: &'static [DataFile],
    /// The profiles of the study, for which known misses are listed.
    pub profiles: &'static [&'static str],
    /// Whether means over all seeds are judged, or each seed.
    pub judges_means: bool,
    /// Pictures of all results, by the names of their files, from the runs of each profile and seed.
    pub sheets: fn(&[Runs]) -> Vec<(&'static str, Sheet)>,
}

/// The part of a suite that is computed.
pub struct Chosen<'a> {
    /// The cases.
    pub cases: Vec<&'static Case>,
    /// The profiles; those of the study if there are none.
    pub profiles: &'a [String],
    /// The number of seeds.
    pub seeds: u64,
    /// The folder with the data.
    pub data: Option<&'a Path>,
}

/// The reason why crowds of the paper's profiles are too fast.
pub const NOTHING_SLOWS: &str = "nothing slows a crowd whose agents all walk at the same velocity: pressure, contact \
                                 and avoidance act on differences of velocity or on overlaps only";

impl Suite {
    /// All cases, in the order of the report.
    pub fn all(&self) -> impl Iterator<Item = &'static Case> + use<> {
        self.cases.iter().copied().flatten()
    }

    /// The cases with these names, in the order of the report; all without names. A name is an id, or a number that
    /// several ids begin with: `12` means `12a` to `12d`.
    ///
    /// # Errors
    /// The first name that no case has.
    pub fn chosen(&self, names: &[String]) -> Result<Vec<&'static Case>, String> {
        let is_known = |name: &String| self.all().any(|case| case.is_named(name));
        if let Some(unknown) = names.iter().find(|name| !is_known(name)) {
            return Err(unknown.clone());
        }
        let is_chosen =
            |case: &&Case| names.is_empty() || names.iter().any(|name| case.is_named(name));
        Ok(self.all().filter(is_chosen).collect())
    }

    /// Computes the chosen runs that are not in `store`, judges them, and writes tables and pictures. Cases whose data
    /// are missing are skipped.
    ///
    /// # Errors
    /// A profile is unknown, a run fails, or a file cannot be written.
    pub fn run(
        &'static self,
        chosen: &Chosen,
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<Report, LabError> {
        let Found {
            cases,
            files,
            skipped,
        } = self.found(&chosen.cases, chosen.data);
        let grid = (chosen.profiles, Some(chosen.seeds));
        let mut study = Study::built_in_for(self.name, grid.0, grid.1)?;
        if !files.is_empty() {
            let name = format!("{}_data", self.name);
            study
                .cells
                .extend(Study::built_in_with(&name, &files, grid)?.cells);
        }
        let labels: BTreeSet<&str> = cases.iter().flat_map(|case| case.runs).copied().collect();
        let wanted = |cell: &&sweep::Cell| cell.label().is_some_and(|label| labels.contains(label));
        let jobs = study.jobs(|cell| wanted(&cell));
        let results = results(&jobs, store, listener)?.into_iter();
        let results: Result<Vec<RunResult>, LabError> =
            results.map(|result| read(&result)).collect();
        let results = results?;
        let cells: Vec<&sweep::Cell> = study.cells.iter().filter(wanted).collect();
        let mut runs: BTreeMap<(usize, u64), Vec<(&str, &Summary)>> = BTreeMap::new();
        let mut profiles = Vec::new();
        for (cell, result) in cells.iter().zip(&results) {
            let profile = &result.summary.profile;
            let known = profiles.iter().position(|known| known == profile);
            let number = known.unwrap_or_else(|| {
                profiles.push(profile.clone());
                profiles.len() - 1
            });
            let own = runs.entry((number, cell.case.seed)).or_default();
            own.push((cell.label().unwrap_or_default(), &result.summary));
        }
        let mut measured = Vec::new();
        for label in files.keys() {
            if let Some(cell) = cells.iter().find(|cell| cell.label() == Some(label)) {
                measured.push((*label, data::measured(label, &cell.case)?));
            }
        }
        let runs = runs.into_values().map(|own| Runs {
            suite: self.name,
            own,
            measured: &measured,
        });
        let runs: Vec<Runs> = runs.collect();
        let mut findings = Vec::new();
        for &case in &cases {
            for runs in &runs {
                findings.push(Finding {
                    case,
                    profile: runs.profile().to_owned(),
                    seed: Some(runs.seed()),
                    checks: judged(case, runs)?,
                });
            }
        }
        if self.judges_means {
            findings = means(findings);
        }
        let report = Report {
            suite: self,
            profiles,
            findings,
            skipped,
        };
        report.write(store)?;
        for (stem, sheet) in (self.sheets)(&runs) {
            sheet.save(&store.path(stem))?;
        }
        pictures::save(&cases, &cells, store, listener)?;
        Ok(report)
    }
}

/// The checks of a case, and that no agent passed through a wall.
fn judged(case: &Case, runs: &Runs) -> Result<Vec<Check>, LabError> {
    let mut checks = (case.judge)(runs)?;
    let own = runs.own.iter();
    let own = own.filter(|(label, _)| case.runs.contains(label));
    let through: Vec<f64> = own
        .filter_map(|(_, summary)| summary.metric("agents_through_walls"))
        .collect();
    if !through.is_empty() {
        let sum = through.iter().sum();
        checks.push(Check::exactly(THROUGH_WALLS, Some(sum), 0.0));
    }
    Ok(checks)
}

/// One finding with the means over the seeds for each case and profile; a value that one seed lacks is missing.
fn means(findings: Vec<Finding>) -> Vec<Finding> {
    let mut means: Vec<(Finding, f64)> = Vec::new();
    for one in findings {
        let is_same =
            |(of, _): &&mut (Finding, f64)| of.case.id == one.case.id && of.profile == one.profile;
        let Some((mean, count)) = means.iter_mut().find(is_same) else {
            means.push((Finding { seed: None, ..one }, 1.0));
            continue;
        };
        *count += 1.0;
        for (mean, own) in mean.checks.iter_mut().zip(&one.checks) {
            let values = mean.value.zip(own.value);
            mean.value = values.map(|(mean, own)| mean + (own - mean) / *count);
        }
    }
    means.into_iter().map(|(mean, _)| mean).collect()
}
