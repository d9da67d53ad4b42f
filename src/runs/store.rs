//! Results on disk: one file per job, written whole or not at all, with the failures of jobs and the claims of
//! processes beside them.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::error::StoreError;
use super::identity::Identity;
use super::outputs::{try_folder, write_whole};
use scenario::input::{self, LONGEST_TEXT};
use scenario::quote::shown_message;

/// The extensions of files that commands write beside the folder of results.
const RESULTS: [&str; 5] = ["md", "csv", "json", "svg", "png"];
/// The extension of a finished job's file.
const FINISHED: &str = "json";
/// The extension of a failed job's file.
const FAILED: &str = "failed";

/// A folder with the results of jobs in `cases/`, and the files made from them beside it.
#[derive(Debug, Clone)]
pub struct Store {
    folder: PathBuf,
}

/// Why a job has no result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// The error message.
    pub message: String,
    /// Number of attempts.
    pub attempts: u32,
}

/// The contents of a file.
#[derive(Serialize, Deserialize)]
struct Kept<T> {
    /// The job's identity, to recognize it.
    key: Identity,
    /// The name of the job.
    case: String,
    content: T,
}

/// The exclusive right to compute a job. It ends with the process.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    _file: File,
}

impl Drop for Claim {
    /// Removing the file is safe: a process that waits for it looks for the job's result or failure first.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

impl Store {
    /// Opens `folder`; creates it if it does not exist.
    ///
    /// # Errors
    /// It cannot be created or written to, or a folder in it has the name of a result.
    pub fn open(folder: &Path) -> Result<Self, StoreError> {
        let store = Self::at(folder);
        let cases = store.cases();
        // Check this now rather than when the first job is finished.
        let writable = fs::create_dir_all(&cases)
            .and_then(|()| try_folder(folder))
            .and_then(|()| try_folder(&cases));
        writable.map_err(|error| store.unwritable(folder, &error))?;
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if has_extension(&path, &RESULTS) && path.is_dir() {
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

    /// Whether results have been stored here before.
    pub fn is_begun(&self) -> bool {
        self.cases().is_dir()
    }

    /// Writes a file, whole or not at all, and returns its path.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, file: &str, contents: &[u8]) -> Result<PathBuf, StoreError> {
        let path = self.path(file);
        let written = write_whole(&path, |file| file.write_all(contents));
        written.map_err(|error| self.unwritable(&path, &error))?;
        Ok(path)
    }

    /// The result of a job, if it exists.
    ///
    /// # Errors
    /// Its file is damaged: the path and the reason.
    pub fn result<T: DeserializeOwned>(&self, key: &Identity) -> Result<Option<T>, String> {
        self.read(key, FINISHED)
    }

    /// All results of this type, in the order of their identities; those of other types and damaged files are left out.
    pub fn all<T: DeserializeOwned>(&self) -> Vec<T> {
        let entries = fs::read_dir(self.cases()).into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        let mut files: Vec<PathBuf> = paths
            .filter(|path| has_extension(path, &[FINISHED]))
            .collect();
        files.sort();
        let read = |path: &PathBuf| {
            let text = input::bytes(path, LONGEST_TEXT).ok()?;
            let kept: Kept<T> = serde_json::from_slice(&text).ok()?;
            Some(kept.content)
        };
        files.iter().filter_map(read).collect()
    }

    /// The failure of a job, if it failed; of a damaged file, what is wrong with it.
    pub fn failure(&self, key: &Identity) -> Option<Failure> {
        self.read(key, FAILED).unwrap_or_else(|message| {
            Some(Failure {
                message,
                attempts: 0,
            })
        })
    }

    /// Stores a result, or the failure of a job.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn keep(
        &self,
        key: &Identity,
        case: &str,
        result: &Result<Value, Failure>,
    ) -> Result<(), StoreError> {
        let failed = json!(result.as_ref().err());
        let (kind, content) = match result {
            Ok(result) => (FINISHED, result),
            Err(_) => (FAILED, &failed),
        };
        let path = self.file(key, kind);
        let kept = Kept {
            key: key.clone(),
            case: case.to_owned(),
            content,
        };
        let written = write_whole(&path, |file| {
            serde_json::to_writer(io::BufWriter::new(file), &kept).map_err(io::Error::from)
        });
        written.map_err(|error| self.unwritable(&path, &error))?;
        if result.is_ok() {
            let _ = fs::remove_file(self.file(key, FAILED));
        }
        Ok(())
    }

    /// Claims a job; `None` if another process has claimed it and `wait` is false.
    ///
    /// # Errors
    /// The file of the claim cannot be written.
    pub(super) fn claim(&self, key: &Identity, wait: bool) -> Result<Option<Claim>, StoreError> {
        let path = self.file(key, "lock");
        let opened = File::options().create(true).append(true).open(&path);
        let file = opened.map_err(|error| self.unwritable(&path, &error))?;
        // On file systems without locks several processes may compute the same job; their results are identical.
        if wait {
            let _ = file.lock();
        } else if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Ok(None);
        }
        Ok(Some(Claim { path, _file: file }))
    }

    fn read<T: DeserializeOwned>(&self, key: &Identity, kind: &str) -> Result<Option<T>, String> {
        let path = self.file(key, kind);
        let damaged = |reason: String| format!("{}: {}", path.display(), shown_message(&reason));
        let text = match input::bytes(&path, LONGEST_TEXT) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            read => read.map_err(|error| damaged(error.to_string()))?,
        };
        let kept: Kept<T> =
            serde_json::from_slice(&text).map_err(|error| damaged(error.to_string()))?;
        if kept.key == *key {
            Ok(Some(kept.content))
        } else {
            Err(damaged("it is about another case".to_owned()))
        }
    }

    fn file(&self, key: &Identity, kind: &str) -> PathBuf {
        self.cases().join(format!("{key}.{kind}"))
    }

    fn cases(&self) -> PathBuf {
        self.folder.join("cases")
    }

    /// The error that `path` cannot be written, with a count of the stored results.
    pub fn unwritable(&self, path: &Path, error: &io::Error) -> StoreError {
        let cases = self.cases();
        let files = fs::read_dir(&cases).into_iter().flatten().flatten();
        let finished = files.filter(|file| has_extension(&file.path(), &[FINISHED]));
        StoreError::Unwritable {
            path: path.display().to_string(),
            reason: error.to_string(),
            kept: match finished.count() {
                0 => String::new(),
                count => format!("; {count} finished case(s) are kept in {}", cases.display()),
            },
        }
    }
}

fn has_extension(path: &Path, known: &[&str]) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| known.contains(&extension))
}
