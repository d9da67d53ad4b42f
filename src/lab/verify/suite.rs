//! Runs the cases.

use std::collections::{BTreeMap, BTreeSet};

use super::case::{CASES, Case, Runs};
use super::check::Check;
use super::pictures;
use super::report::{Finding, Report};
use crate::lab::error::LabError;
use crate::lab::jobs::{read, results};
use crate::lab::sweep::{self, Study};
use crate::runs::case::RunResult;
use crate::runs::job::Listener;
use crate::runs::store::Store;

/// The name of the check of walls.
pub(super) const THROUGH_WALLS: &str = "people through walls";

/// The cases with these names, in the order of the report; all without names. A name is an id, or a number that several
/// ids begin with: `12` means `12a` to `12d`.
///
/// # Errors
/// The first name that no case has.
pub fn chosen(names: &[String]) -> Result<Vec<&'static Case>, String> {
    let all = || CASES.iter().copied().flatten();
    let is_known = |name: &String| all().any(|case| case.is_named(name));
    if let Some(unknown) = names.iter().find(|name| !is_known(name)) {
        return Err(unknown.clone());
    }
    let is_chosen = |case: &&Case| names.is_empty() || names.iter().any(|name| case.is_named(name));
    Ok(all().filter(is_chosen).collect())
}

/// Computes the runs of these cases that are not in `store`, for these profiles (without any: [`PROFILES`](super::PROFILES)) and with
/// `seeds` seeds each; judges them, and writes tables and pictures.
///
/// # Errors
/// A profile is unknown, a run fails, or a file cannot be written.
pub fn verify(
    cases: &[&'static Case],
    profiles: &[String],
    seeds: u64,
    store: &Store,
    listener: &dyn Listener,
) -> Result<Report, LabError> {
    let study = Study::built_in_for("verification", profiles, Some(seeds))?;
    let labels: BTreeSet<&str> = cases.iter().flat_map(|case| case.runs).copied().collect();
    let wanted = |cell: &&sweep::Cell| cell.label().is_some_and(|label| labels.contains(label));
    let jobs = study.jobs(|cell| wanted(&cell));
    let results = results(&jobs, store, listener)?.into_iter();
    let results: Result<Vec<RunResult>, LabError> = results.map(|result| read(&result)).collect();
    let results = results?;
    let cells: Vec<&sweep::Cell> = study.cells.iter().filter(wanted).collect();
    let mut runs: BTreeMap<(usize, u64), Vec<(&str, &RunResult)>> = BTreeMap::new();
    let mut profiles = Vec::new();
    for (cell, result) in cells.iter().zip(&results) {
        let profile = &result.summary.profile;
        let known = profiles.iter().position(|known| known == profile);
        let number = known.unwrap_or_else(|| {
            profiles.push(profile.clone());
            profiles.len() - 1
        });
        let own = runs.entry((number, cell.case.seed)).or_default();
        own.push((cell.label().unwrap_or_default(), result));
    }
    let mut findings = Vec::new();
    for case in cases {
        for ((profile, seed), runs) in &runs {
            findings.push(Finding {
                case,
                profile: profiles[*profile].clone(),
                seed: *seed,
                checks: judged(case, runs)?,
            });
        }
    }
    let report = Report { profiles, findings };
    report.write(store)?;
    pictures::save(cases, &cells, store, listener)?;
    Ok(report)
}

/// The checks of a case, and that no agent passed through a wall.
fn judged(case: &Case, runs: &[(&str, &RunResult)]) -> Result<Vec<Check>, LabError> {
    let own = runs.iter().filter(|(label, _)| case.runs.contains(label));
    let own = own.map(|(label, result)| (*label, &result.summary));
    let runs = Runs(own.collect());
    let mut checks = (case.judge)(&runs)?;
    let through = runs.0.iter();
    let through: Vec<f64> = through
        .filter_map(|(_, summary)| summary.metric("agents_through_walls"))
        .collect();
    if !through.is_empty() {
        let sum = through.iter().sum();
        checks.push(Check::exactly(THROUGH_WALLS, Some(sum), 0.0));
    }
    Ok(checks)
}
