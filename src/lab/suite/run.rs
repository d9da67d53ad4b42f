//! The runs of a suite, judged.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::changed::Changed;
use super::check::{Judgment, Runs};
use super::file::Suite;
use super::finding::{Finding, Lacks, Skipped, THROUGH_WALLS};
use super::keys::{Case, Expected};
use super::known::label;
use super::report::Report;
use super::runs_check::check_runs;
use super::{data, deviations, diagrams, pictures, runner};
use crate::error::LabError;
use crate::gallery::distinct;
use crate::jobs::results;
use crate::sweep::{Cell, Changes, Study, StudyError};
use output::document::Names;
use runs::case::RunResult;
use runs::job::Listener;
use runs::store::Store;
use runs::summary::Summary;
use scenario::Setting;
use scenario::catalog::NAMES;

/// The part of a suite that is computed.
#[derive(Default)]
pub struct Chosen<'a> {
    /// The cases.
    pub cases: Vec<&'a Case>,
    /// The profiles; those of the study if there are none.
    pub profiles: &'a [String],
    /// The number of seeds; `None`: those of the study.
    pub seeds: Option<u64>,
    /// The first seed; `None`: that of the study.
    pub first_seed: Option<u64>,
    /// Settings of every run.
    pub settings: &'a [Setting],
    /// The folder with the data.
    pub data: Option<&'a Path>,
    /// The command of another simulator in place of ours; it stands where profiles do.
    pub runner: Option<&'a str>,
}

/// What is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Judged {
    /// Each seed: a case passes if it does with all of them.
    Seeds,
    /// Means over all seeds, with diagrams of all results.
    Means,
}

/// The runs of the chosen cases, after validation.
pub struct Planned<'a> {
    suite: &'a Suite,
    /// The cases whose data are there.
    cases: Vec<&'a Case>,
    /// The cases whose data are missing.
    pub skipped: Vec<Skipped<'a>>,
    /// What is not as in the suite.
    changed: Changed,
    /// The labels of the runs that begin from data.
    data: BTreeSet<String>,
    /// The command of another simulator.
    runner: Option<&'a str>,
    /// The study.
    pub study: Study,
}

impl Suite {
    /// The runs of the chosen cases. Cases whose data are missing are skipped.
    ///
    /// # Errors
    /// The study is invalid, or a check asks for a run or quantity that does not exist.
    pub fn planned<'a>(&'a self, chosen: &Chosen<'a>) -> Result<Planned<'a>, StudyError> {
        let (mut cases, mut skipped) = (Vec::new(), Vec::new());
        // Who and where people are does not depend on the profile.
        let any = [NAMES[0].to_owned()];
        let mut changes = Changes {
            profiles: if chosen.runner.is_some() {
                &any
            } else {
                chosen.profiles
            },
            seeds: chosen.seeds,
            first_seed: chosen.first_seed,
            settings: chosen.settings,
            data: BTreeMap::new(),
        };
        for &case in &chosen.cases {
            let files = self.files_of(case).map(|data| {
                let key = (data.run.clone(), data.setting.clone());
                let path = chosen.data.map(|folder| folder.join(&data.file));
                let found = path.filter(|path| path.is_file());
                found.map(|path| (key, path)).ok_or(data)
            });
            match files.collect::<Result<Vec<_>, _>>() {
                Ok(files) => {
                    changes.data.extend(files);
                    cases.push(case);
                }
                Err(data) => {
                    let place = match chosen.data {
                        Some(folder) => format!("{} has no {}", folder.display(), data.file),
                        None => format!("needs --data DIR with {}", data.file),
                    };
                    let why = format!("{place}, from {}", data.source);
                    skipped.push(Skipped {
                        case,
                        lacks: Lacks::Data,
                        why,
                    });
                }
            }
        }
        let study = match cases.is_empty() {
            true => Study::of_cells(&self.name, Vec::new(), None),
            false => self.study(&changes)?,
        };
        if !cases.is_empty() {
            check_runs(self, &study)?;
        }
        if chosen.runner.is_some() {
            for &case in &cases {
                if let Some(why) = runner_refuses(case, &study)? {
                    skipped.push(Skipped {
                        case,
                        lacks: Lacks::Scene,
                        why,
                    });
                }
            }
            cases.retain(|case| skipped.iter().all(|one| one.case.name != case.name));
        }
        let all = study.cells.iter().map(|cell| cell.case.seed);
        let seeds = all.filter(|_| chosen.first_seed.is_some());
        let changed = Changed {
            settings: chosen.settings.iter().map(Setting::brief).collect(),
            seeds: distinct(seeds),
        };
        Ok(Planned {
            suite: self,
            cases,
            skipped,
            changed,
            data: changes.data.into_keys().map(|(run, _)| run).collect(),
            runner: chosen.runner,
            study,
        })
    }
}

impl<'a> Planned<'a> {
    /// The names of the files with results; with means there are figures of all of them.
    pub fn names(&self, judged: Judged) -> Names {
        let figures: &[&str] = match judged {
            Judged::Means => &["fundamental", "passages", "deviations"],
            Judged::Seeds => &[],
        };
        Names::new(&self.suite.name, &[&self.suite.name], figures)
    }

    /// The names of the pictures of single cases.
    pub fn pictures(&self) -> impl Iterator<Item = String> {
        let own = self.cases.iter().filter(|_| self.runner.is_none());
        let drawn = own.filter(|case| case.picture.is_some());
        drawn.map(|case| format!("{}.png", case.name))
    }

    /// Computes the runs that are not in `store`, judges them, and draws the pictures of cases into its folder.
    ///
    /// # Errors
    /// A run fails, or a file cannot be written.
    pub fn run(
        self,
        judged: Judged,
        store: &Store,
        listener: &dyn Listener,
    ) -> Result<Report<'a>, LabError> {
        let labels: BTreeSet<&str> = self.cases.iter().flat_map(|case| case.runs()).collect();
        let wanted = |cell: &&Cell| labels.contains(label(cell));
        let cells: Vec<&Cell> = self.study.cells.iter().filter(wanted).collect();
        let results = match self.runner {
            Some(command) => runner::summaries(command, &cells, store, listener)?,
            None => {
                let jobs = self.study.jobs(|cell| wanted(&cell));
                let computed = results(&jobs, store, listener)?;
                let result = |cell: &&Cell| {
                    let result: RunResult = computed.of(&cell.to_string(), &cell.case.key)?;
                    Ok(result.summary)
                };
                cells.iter().map(result).collect::<Result<_, LabError>>()?
            }
        };
        let profiles = distinct(
            results
                .iter()
                .map(|summary: &Summary| summary.profile.clone()),
        );
        let measured = of_data(self.data, &cells)?;
        let own = cells.iter().copied().zip(&results);
        let runs = by_seed(own, &profiles, &measured);
        let mut findings = Vec::new();
        for &case in &self.cases {
            for runs in &runs {
                findings.push(Finding {
                    case,
                    profile: runs.profile().to_owned(),
                    seed: Some(runs.seed()),
                    checks: judgments(case, runs)?,
                });
            }
        }
        if judged == Judged::Means {
            findings = means(findings);
        }
        let mut report = Report {
            suite: self.suite,
            profiles,
            findings,
            skipped: self.skipped,
            changed: self.changed,
            figures: Vec::new(),
        };
        if judged == Judged::Means {
            report.figures = diagrams::sheets(&self.suite.cases, &runs);
            report.figures.extend(deviations::sheet(&report));
        }
        if self.runner.is_none() {
            pictures::save(&self.cases, &cells, store, listener)?;
        }
        Ok(report)
    }
}

/// Why another simulator cannot be judged by a case.
fn runner_refuses(case: &Case, study: &Study) -> Result<Option<String>, StudyError> {
    let mut scenarios = Vec::new();
    for run in case.runs() {
        if let Some(cell) = study.cells.iter().find(|cell| label(cell) == run) {
            scenarios.push(cell.case.scenario()?);
        }
    }
    Ok(runner::refused(case, &scenarios))
}

/// The measurements in the data from which runs begin, by the labels of the runs.
fn of_data(labels: BTreeSet<String>, cells: &[&Cell]) -> Result<Vec<(String, Summary)>, LabError> {
    let of = |run: String| {
        let cell = cells.iter().find(|cell| label(cell) == run)?;
        let data = data::measured(&run, &cell.case);
        Some(data.map(|data| (run, data)))
    };
    labels.into_iter().filter_map(of).collect()
}

/// The results of each profile and seed, by the places of the profiles.
fn by_seed<'r>(
    results: impl Iterator<Item = (&'r Cell, &'r Summary)>,
    profiles: &[String],
    measured: &'r [(String, Summary)],
) -> Vec<Runs<'r>> {
    let mut runs: BTreeMap<_, Vec<(&str, &Summary)>> = BTreeMap::new();
    for (cell, summary) in results {
        let profile = profiles.iter().position(|name| *name == summary.profile);
        let own = runs.entry((profile, cell.case.seed)).or_default();
        own.push((label(cell), summary));
    }
    let of_seed = |own| Runs { own, measured };
    runs.into_values().map(of_seed).collect()
}

/// The judgments of a case, and that no agent passed through a wall.
fn judgments(case: &Case, runs: &Runs) -> Result<Vec<Judgment>, LabError> {
    let judged = case.checks.iter().map(|check| check.judged(runs));
    let mut checks: Vec<Judgment> = judged.collect::<Result<_, _>>()?;
    let own = runs
        .own
        .iter()
        .filter(|(label, _)| case.runs().any(|run| run == *label));
    let through = own.filter_map(|(_, run)| run.metric("agents_through_walls"));
    if let Some(sum) = through.reduce(|sum, one| sum + one) {
        checks.push(Judgment {
            quantity: THROUGH_WALLS.to_owned(),
            value: Some(sum),
            expected: Expected::Between([0.0; 2]),
            run: None,
        });
    }
    Ok(checks)
}

/// One finding with the means over the seeds for each case and profile; a value that one seed lacks is missing.
fn means(findings: Vec<Finding>) -> Vec<Finding> {
    let mut means: Vec<(Finding, f64)> = Vec::new();
    for one in findings {
        let is_same = |(of, _): &&mut (Finding, f64)| {
            of.case.name == one.case.name && of.profile == one.profile
        };
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
