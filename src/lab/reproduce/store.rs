//! Finished cases on disk: one file each, whole or not there.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::case::{Case, CaseResult, Key};
use super::error::ReproduceError;
use crate::runs::outputs::{try_folder, write_whole};
use crate::scenario::input::{self, LONGEST_TEXT};
use crate::scenario::quote::shown_message;

/// A folder with finished cases in `cases/`, and beside it what was made of them.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
}

/// What a case's file says.
#[derive(Serialize, Deserialize)]
struct Kept {
    /// The engine and the whole document, to be sure of what this is.
    identity: String,
    result: CaseResult,
}

/// What the store knows of a case.
#[derive(Debug, Clone, PartialEq)]
pub enum Found {
    /// Everything.
    Whole(CaseResult),
    /// The run, but not all that is to be kept of it.
    Part(CaseResult),
    /// Nothing.
    Nothing,
    /// A file that cannot be read: why.
    Damaged(String),
}

impl Store {
    /// Opens `folder`, and makes it if there is none.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn open(folder: &Path) -> Result<Self, ReproduceError> {
        let store = Self::at(folder);
        let cases = store.cases();
        // Better known now than when the first case is finished.
        let writable = fs::create_dir_all(&cases).and_then(|()| try_folder(&cases));
        writable.map_err(|error| store.unwritable(folder, &error))?;
        Ok(store)
    }

    /// What may be in `folder`; makes nothing.
    pub fn at(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
        }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Where a file of this name belongs.
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

    /// The failure to write `path`, and what is there all the same.
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

    /// What is known of a case.
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

    /// Keeps a finished case.
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
