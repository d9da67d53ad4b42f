//! Data that some cases need and that are not part of the program: trajectory files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::{Case, Suite};
use crate::lab::error::LabError;
use crate::runs::case;
use crate::runs::summary::Summary;
use crate::scenario::measurements::Measurement;

/// A file from which the scene of a run begins.
pub struct DataFile {
    /// The label of the run in the suite's study of scenes with data.
    pub run: &'static str,
    /// Its name in the folder with the data.
    pub name: &'static str,
    /// Its source.
    pub source: &'static str,
}

/// A case whose data are missing.
pub struct Skipped {
    /// The case.
    pub case: &'static Case,
    /// The reason, and the source of the data.
    pub why: String,
}

/// Cases with data, with their files by the labels of their runs, and cases whose data are missing.
pub(super) struct Found {
    pub cases: Vec<&'static Case>,
    pub files: BTreeMap<&'static str, PathBuf>,
    pub skipped: Vec<Skipped>,
}

impl Suite {
    /// The files that a case needs.
    fn files_of(&self, case: &Case) -> impl Iterator<Item = &'static DataFile> {
        let files = self.data.iter();
        files.filter(|file| case.runs.contains(&file.run))
    }

    /// The cases that need no data.
    pub fn without_data(&self) -> impl Iterator<Item = &'static Case> {
        self.all()
            .filter(|case| self.files_of(case).next().is_none())
    }

    /// Looks for the data of these cases in `folder`.
    pub(super) fn found(&self, cases: &[&'static Case], folder: Option<&Path>) -> Found {
        let mut found = Found {
            cases: Vec::new(),
            files: BTreeMap::new(),
            skipped: Vec::new(),
        };
        for &case in cases {
            let path = |file: &DataFile| folder.map(|folder| folder.join(file.name));
            let is_there = |file: &&DataFile| path(file).is_some_and(|path| path.is_file());
            match self.files_of(case).find(|file| !is_there(file)) {
                Some(DataFile { name, source, .. }) => {
                    let place = match folder {
                        Some(folder) => format!("{} has no {name}", folder.display()),
                        None => format!("needs --data DIR with {name}"),
                    };
                    let why = format!("{place}, from {source}");
                    found.skipped.push(Skipped { case, why });
                }
                None => {
                    let files = self.files_of(case);
                    let files = files.filter_map(|file| Some((file.run, path(file)?)));
                    found.files.extend(files);
                    found.cases.push(case);
                }
            }
        }
        found
    }
}

/// The measurements of a scenario's lines for the people of the data from which it begins, from its start on. People
/// are measured as in a run, at their positions in its frames.
pub(super) fn measured(label: &str, case: &case::Case) -> Result<Summary, LabError> {
    let failed = |error| LabError::of(label, error);
    let draft = case.draft().map_err(failed)?;
    let data = draft.trajectories().map_err(failed)?;
    let scenario = draft.scenario().map_err(failed)?;
    let mut summary = Summary {
        scenario: scenario.name,
        ..Summary::default()
    };
    let Some((tracks, at)) = data else {
        return Ok(summary);
    };
    for measurement in &scenario.measurements {
        if let Measurement::LineFlow(line) = measurement {
            let (values, passages) = line.of_tracks(&tracks, at, &scenario.scene);
            let number = |(name, value): (String, Option<f64>)| (name, value.into());
            summary.metrics.extend(values.into_iter().map(number));
            summary.data.extend([passages]);
        }
    }
    Ok(summary)
}
