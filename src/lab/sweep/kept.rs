//! The finished and failed cells of a study on disk: one file per cell, written whole or not at all.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::cell::Cell;
use crate::lab::reproduce::{ReproduceError, Store};
use crate::runs::summary::Summary;
use crate::scenario::input::{self, LONGEST_TEXT};
use crate::scenario::quote::shown_message;

/// The result of a cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellResult {
    /// As `sandbox run --json` reports it.
    #[serde(flatten)]
    pub summary: Summary,
    /// Number of counted arrivals.
    pub evacuated: usize,
    /// Number of agents at the end.
    pub remaining: usize,
    /// Computing time on one thread, seconds.
    pub wall_secs: f64,
}

/// Why a cell has no result.
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
    /// The cell's key, to recognize the cell.
    key: String,
    /// The name of the cell in the study that it was computed for.
    cell: String,
    #[serde(flatten)]
    content: T,
}

/// A folder with finished cells in `cases/`.
#[derive(Debug, Clone)]
pub struct Shelf(Store);

/// The exclusive right to compute a cell. It ends with the process.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    _file: File,
}

impl Drop for Claim {
    /// Removing the file is safe: a process that waits for it looks for the cell's result or failure first.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

impl Shelf {
    /// Opens `folder`; creates it if it does not exist.
    ///
    /// # Errors
    /// It cannot be created or written to.
    pub fn open(folder: &Path) -> Result<Self, ReproduceError> {
        Store::open(folder).map(Self)
    }

    /// A shelf in `folder`, without creating anything.
    pub fn at(folder: &Path) -> Self {
        Self(Store::at(folder))
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.0.folder()
    }

    /// Have cells been stored here before?
    pub fn is_begun(&self) -> bool {
        self.0.path("cases").is_dir()
    }

    /// Writes a file into the folder, whole or not at all.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, file: &str, contents: &[u8]) -> Result<PathBuf, ReproduceError> {
        self.0.write(file, contents)
    }

    /// The result of a cell, if it exists.
    ///
    /// # Errors
    /// Its file is damaged: the path and the reason.
    pub fn result(&self, cell: &Cell) -> Result<Option<CellResult>, String> {
        self.read(cell, FINISHED)
    }

    /// The failure of a cell, if it failed; `None` if the file is damaged.
    pub fn failure(&self, cell: &Cell) -> Option<Failure> {
        self.read(cell, FAILED).unwrap_or_default()
    }

    /// Stores a result.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn keep(&self, cell: &Cell, result: &CellResult) -> Result<(), ReproduceError> {
        self.put(cell, FINISHED, result)?;
        let _ = fs::remove_file(self.path(cell, FAILED));
        Ok(())
    }

    /// Stores a failure.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn keep_failure(
        &self,
        cell: &Cell,
        failure: &Failure,
    ) -> Result<(), ReproduceError> {
        self.put(cell, FAILED, failure)
    }

    /// Claims a cell; `None` if another process has claimed it and `wait` is false.
    ///
    /// # Errors
    /// The file of the claim cannot be written.
    pub(super) fn claim(&self, cell: &Cell, wait: bool) -> Result<Option<Claim>, ReproduceError> {
        let path = self.path(cell, "lock");
        let opened = File::options().create(true).append(true).open(&path);
        let file = opened.map_err(|error| self.0.unwritable(&path, &error))?;
        // On file systems without locks several processes may compute the same cell; their results are identical.
        if wait {
            let _ = file.lock();
        } else if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Ok(None);
        }
        Ok(Some(Claim { path, _file: file }))
    }

    fn path(&self, cell: &Cell, kind: &str) -> PathBuf {
        self.0.path(&format!("cases/{}.{kind}", cell.key()))
    }

    fn put<T: Serialize>(&self, cell: &Cell, kind: &str, content: T) -> Result<(), ReproduceError> {
        let kept = Kept {
            key: cell.key().to_owned(),
            cell: cell.to_string(),
            content,
        };
        let text = serde_json::to_vec(&kept)
            .map_err(|error| ReproduceError::Data(format!("{cell}: {error}")))?;
        let file = format!("cases/{}.{kind}", cell.key());
        self.0.write(&file, &text).map(|_| ())
    }

    fn read<T: DeserializeOwned>(&self, cell: &Cell, kind: &str) -> Result<Option<T>, String> {
        let path = self.path(cell, kind);
        let damaged = |reason: String| format!("{}: {}", path.display(), shown_message(&reason));
        let text = match input::bytes(&path, LONGEST_TEXT) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            read => read.map_err(|error| damaged(error.to_string()))?,
        };
        let kept: Kept<T> =
            serde_json::from_slice(&text).map_err(|error| damaged(error.to_string()))?;
        if kept.key == cell.key() {
            Ok(Some(kept.content))
        } else {
            Err(damaged("it is about another cell".to_owned()))
        }
    }
}

/// Extensions of the files.
const FINISHED: &str = "json";
const FAILED: &str = "failed";
