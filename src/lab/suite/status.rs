//! How many cases of a suite each profile passes, as data that reports read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::passed::Passed;
use super::report::Report;
use crate::error::LabError;
use scenario::input;

/// The data of a file that ships with the program.
///
/// # Errors
/// They are invalid: the file, with the place in it.
pub fn shipped<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, LabError> {
    let invalid = |error| LabError::Data(format!("{file}: {error}"));
    serde_json::from_str(text).map_err(invalid)
}

/// The results of a suite by profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Status {
    /// The name of the suite.
    pub suite: String,
    /// The results of each profile.
    pub profiles: BTreeMap<String, Passed>,
}

impl Status {
    /// That of `sandbox validate` in this version, without the scenes that need data.
    ///
    /// # Errors
    /// The file is invalid.
    pub fn validated() -> Result<Self, LabError> {
        shipped(
            "docs/findings/validation.json",
            include_str!("../../../docs/findings/validation.json"),
        )
    }

    /// That of `sandbox verify` in this version.
    ///
    /// # Errors
    /// The file is invalid.
    pub fn verified() -> Result<Self, LabError> {
        shipped(
            "docs/findings/verification.json",
            include_str!("../../../docs/findings/verification.json"),
        )
    }

    /// The file that has the status beside a document, if there is one.
    pub fn beside(document: &Path) -> Option<PathBuf> {
        let file = document.with_extension("json");
        Self::read(&file).is_some().then_some(file)
    }

    fn read(file: &Path) -> Option<Self> {
        serde_json::from_str(&input::text(file).ok()?).ok()
    }

    /// The text of this status file with the results of a report in place of its own; `None` if it is of another suite.
    pub fn updated(file: &Path, report: &Report) -> Option<String> {
        let mut status = Self::read(file).filter(|status| status.suite == report.suite.name)?;
        let profiles = report.profiles.iter();
        let new = profiles.map(|profile| (profile.clone(), report.passed(profile)));
        status.profiles.extend(new);
        Some(serde_json::to_string_pretty(&status).ok()? + "\n")
    }
}
