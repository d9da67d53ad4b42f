//! Finished cases on disk: one file each, written whole or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::case::{Case, CaseResult, Key};
use super::error::ReproduceError;
use crate::runs::outputs::{try_folder, write_whole};
use crate::scenario::input::{self, LONGEST_TEXT};
use crate::scenario::quote::shown_message;

/// The extensions of results.
const RESULTS: [&str; 5] = ["md", "csv", "json", "svg", "png"];

/// A folder with the finished cases in `cases/`, and the products made from them beside it.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
}

/// The contents of a case's file.
#[derive(Serialize, Deserialize)]
struct Kept {
    /// The engine and the whole document, to recognize the case.
    identity: String,
    result: CaseResult,
}

/// The state of a case in the store.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Complete.
    Whole(CaseResult),
    /// The result of the run, which lacks some of the data to keep.
    Part(CaseResult),
    /// Not in the store.
    Nothing,
    /// The file cannot be read, with the reason.
    Damaged(String),
}

impl Store {
    /// Opens `folder`; creates it if it does not exist.
    ///
    /// # Errors
    /// It cannot be created or written to, or a folder in it has the name of a result.
    pub fn open(folder: &Path) -> Result<Self, ReproduceError> {
        let store = Self::at(folder);
        let cases = store.cases();
        // Check this now rather than when the first case is finished.
        let writable = fs::create_dir_all(&cases)
            .and_then(|()| try_folder(folder))
            .and_then(|()| try_folder(&cases));
        writable.map_err(|error| store.unwritable(folder, &error))?;
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let extension = path.extension().and_then(|extension| extension.to_str());
            if extension.is_some_and(|extension| RESULTS.contains(&extension)) && path.is_dir() {
                return Err(store.unwritable(&path, &io::Error::other("it is a folder")));
            }
        }
        Ok(store)
    }

    /// A store in `folder`, without creating anything.
    pub fn at(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
        }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The path of a file with this name.
    pub fn path(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    /// Writes a file, whole or not at all, and returns its path.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, file: &str, contents: &[u8]) -> Result<PathBuf, ReproduceError> {
        let path = self.path(file);
        let written = write_whole(&path, |file| file.write_all(contents));
        written.map_err(|error| self.unwritable(&path, &error))?;
        Ok(path)
    }

    /// The error that `path` cannot be written, with a count of the stored results.
    pub(crate) fn unwritable(&self, path: &Path, error: &io::Error) -> ReproduceError {
        let cases = self.cases();
        let finished =
            fs::read_dir(&cases).map_or(0, |files| files.flatten().filter(is_case).count());
        ReproduceError::Unwritable {
            path: path.display().to_string(),
            reason: error.to_string(),
            kept: match finished {
                0 => String::new(),
                count => format!("; {count} finished case(s) are kept in {}", cases.display()),
            },
        }
    }

    /// Looks up a case.
    pub fn find(&self, case: &Case, key: &Key) -> Found {
        let text = match input::bytes(&self.case_path(key), LONGEST_TEXT) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Found::Nothing,
            Err(error) => return Found::Damaged(error.to_string()),
        };
        match serde_json::from_slice::<Kept>(&text) {
            Err(error) => Found::Damaged(shown_message(&error.to_string())),
            Ok(kept) if kept.identity != key.identity => {
                Found::Damaged("it is about another case".to_owned())
            }
            Ok(Kept { result, .. }) => {
                let mut names = case.probes().iter().map(|probe| probe.name());
                if names.all(|name| result.kept.contains_key(&name)) {
                    Found::Whole(result)
                } else {
                    Found::Part(result)
                }
            }
        }
    }

    /// Stores a finished case.
    ///
    /// # Errors
    /// Its file cannot be written.
    pub fn keep(&self, key: &Key, result: &CaseResult) -> Result<(), ReproduceError> {
        let kept = Kept {
            identity: key.identity.clone(),
            result: result.clone(),
        };
        let text = serde_json::to_vec(&kept)
            .map_err(|error| ReproduceError::Data(format!("{key}: {error}")))?;
        self.write(&format!("cases/{key}.json"), &text).map(|_| ())
    }

    /// The file of a case.
    pub fn case_path(&self, key: &Key) -> PathBuf {
        self.cases().join(format!("{key}.json"))
    }

    fn cases(&self) -> PathBuf {
        self.folder.join("cases")
    }
}

fn is_case(file: &fs::DirEntry) -> bool {
    file.path()
        .extension()
        .is_some_and(|extension| extension == "json")
}
