//! What is finished of a study, and what failed: one file per cell, whole or not there.

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

/// What a cell gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellResult {
    /// As `sandbox run --json` reports it.
    #[serde(flatten)]
    pub summary: Summary,
    /// Counted arrivals.
    pub evacuated: usize,
    /// Who was still there at the end.
    pub remaining: usize,
    /// How long it took to compute on one thread, seconds.
    pub wall_secs: f64,
}

/// Why a cell has no result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// What happened.
    pub message: String,
    /// How often it was tried.
    pub attempts: u32,
}

/// What a file says.
#[derive(Serialize, Deserialize)]
struct Kept<T> {
    /// The cell's key, to be sure of what this is.
    key: String,
    /// What the cell was called in the study that it was run for.
    cell: String,
    #[serde(flatten)]
    content: T,
}

/// A folder with finished cells in `cases/`.
#[derive(Debug, Clone)]
pub struct Shelf(Store);

/// The right to compute a cell, which only one process has at a time; it ends with the process.
#[derive(Debug)]
pub(super) struct Claim {
    path: PathBuf,
    _file: File,
}

impl Drop for Claim {
    /// Whoever waits for this very file finds the cell's result, or its failure, before anything else.
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

impl Shelf {
    /// Opens `folder`, and makes it if there is none.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn open(folder: &Path) -> Result<Self, ReproduceError> {
        Store::open(folder).map(Self)
    }

    /// What may be in `folder`; makes nothing.
    pub fn at(folder: &Path) -> Self {
        Self(Store::at(folder))
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.0.folder()
    }

    /// Were cells ever kept here?
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

    /// The result of a cell, if it is there.
    ///
    /// # Errors
    /// Its file is damaged: its name, and what shows it.
    pub fn result(&self, cell: &Cell) -> Result<Option<CellResult>, String> {
        self.read(cell, FINISHED)
    }

    /// How a cell failed, if it has; a damaged file says nothing.
    pub fn failure(&self, cell: &Cell) -> Option<Failure> {
        self.read(cell, FAILED).unwrap_or_default()
    }

    /// Keeps a result.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn keep(&self, cell: &Cell, result: &CellResult) -> Result<(), ReproduceError> {
        self.put(cell, FINISHED, result)?;
        let _ = fs::remove_file(self.path(cell, FAILED));
        Ok(())
    }

    /// Keeps why there is none.
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

    /// Claims a cell; `None` if it is another process's and this one will not wait.
    ///
    /// # Errors
    /// The claim cannot be written.
    pub(super) fn claim(&self, cell: &Cell, wait: bool) -> Result<Option<Claim>, ReproduceError> {
        let path = self.path(cell, "lock");
        let opened = File::options().create(true).append(true).open(&path);
        let file = opened.map_err(|error| self.0.unwritable(&path, &error))?;
        // A file system without locks lets everybody in: two may compute the same, to the same bits.
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

/// Kinds of files.
const FINISHED: &str = "json";
const FAILED: &str = "failed";
