//! A suite, from its file.

use std::path::Path;

use super::keys::{Case, File};
use super::known::check_cases;
use crate::sweep::{Changes, DataFile, FOLDER, PROFILE, Study, StudyError, Written, check_keys};
use scenario::{Problem, ScenarioError, in_plain_words};

/// A study with expected results.
pub struct Suite {
    /// The name of the study, of the files with the results, and of the table in documents.
    pub name: String,
    /// The cases, in the order of the report.
    pub cases: Vec<Case>,
    /// The profiles of the study's grid, whose misses are failures unless they are known. Without any, all misses are.
    pub profiles: Vec<String>,
    /// The data that runs need.
    pub(super) data: Vec<DataFile>,
    pub(super) from: Written,
}

impl Suite {
    /// A suite that is built into the program: a file under `scenarios/studies/`, without its extension.
    ///
    /// # Errors
    /// There is no such file, or it is invalid.
    pub fn built_in(name: &str) -> Result<Self, ScenarioError> {
        Self::of(Written::built_in(FOLDER, name)?)
    }

    /// Reads a suite from a file.
    ///
    /// # Errors
    /// The first problem, with its place in the file.
    pub fn read(path: &Path) -> Result<Self, ScenarioError> {
        Self::of(Written::read(path)?)
    }

    fn of(from: Written) -> Result<Self, ScenarioError> {
        check_keys(&from)?;
        let (_, mut keys) = from.parsed::<File>("`cases`")?;
        let mut grid = keys.grid.0.into_iter();
        let axis = grid.find(|(key, _)| key == PROFILE);
        let read = axis.map(|(_, names)| serde_json::from_value(names));
        let given = read.transpose().map_err(|error| {
            from.invalid(Problem::new(
                format!("grid.{PROFILE}"),
                in_plain_words(&error.to_string()),
            ))
        })?;
        let profiles: Vec<String> = given.unwrap_or_default();
        check_cases(&keys.cases, &profiles).map_err(|problem| from.invalid(problem))?;
        let cases = keys.cases.iter_mut();
        for why in cases.flat_map(|case| case.known_misses.values_mut()) {
            if let Some(shared) = keys.reasons.get(why) {
                why.clone_from(shared);
            }
        }
        Ok(Self {
            name: keys.name.unwrap_or_else(|| from.stem()),
            cases: keys.cases,
            profiles,
            data: keys.data,
            from,
        })
    }

    /// The cases with these names, in the order of the report; all without names. A name is that of a case, or a number
    /// that several names begin with: `12` means `12a` to `12d`.
    ///
    /// # Errors
    /// The first name that no case has.
    pub fn chosen(&self, names: &[String]) -> Result<Vec<&Case>, String> {
        let is_known = |name: &String| self.cases.iter().any(|case| case.is_named(name));
        if let Some(unknown) = names.iter().find(|name| !is_known(name)) {
            return Err(unknown.clone());
        }
        let is_chosen =
            |case: &&Case| names.is_empty() || names.iter().any(|name| case.is_named(name));
        Ok(self.cases.iter().filter(is_chosen).collect())
    }

    /// The study of these profiles and seeds, with these files of data by the labels of their runs.
    ///
    /// # Errors
    /// The study is invalid.
    pub fn study(&self, changes: &Changes) -> Result<Study, StudyError> {
        Study::changed(&self.from, changes, None)
    }

    /// The files that a case needs.
    pub(super) fn files_of(&self, case: &Case) -> impl Iterator<Item = &DataFile> {
        let files = self.data.iter();
        files.filter(|file| case.runs().any(|run| run == file.run))
    }

    /// The cases that need no data.
    pub fn without_data(&self) -> impl Iterator<Item = &Case> {
        let cases = self.cases.iter();
        cases.filter(|case| self.files_of(case).next().is_none())
    }
}
