//! Errors of experiments.

use std::io;
use std::path::PathBuf;

use output::plot::PlotError;
use runs::error::{RunError, StoreError};

/// Why an experiment cannot be finished.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// A run failed.
    #[error("{case}: {error}")]
    Run {
        /// The run.
        case: String,
        /// The reason.
        error: RunError,
    },
    /// Some jobs failed: their names and error messages, one line each.
    #[error("{0}")]
    Failed(String),
    /// Results cannot be stored.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A requested result is missing, or has another form.
    #[error("{case}: there is no {what}")]
    Missing {
        /// The run.
        case: String,
        /// The requested result.
        what: String,
    },
    /// A file of a run can no longer be read.
    #[error("{}: {error}", .file.display())]
    Unread {
        /// The file.
        file: PathBuf,
        /// The reason.
        error: io::Error,
    },
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] PlotError),
    /// Data or a study that ship with the program are invalid, or a table cannot be written.
    #[error("{0}")]
    Data(String),
}

impl LabError {
    /// The run `case` has no result called `what`.
    pub fn missing(case: impl Into<String>, what: impl Into<String>) -> Self {
        Self::Missing {
            case: case.into(),
            what: what.into(),
        }
    }

    /// The error of the run `case`.
    pub fn of(case: impl Into<String>, error: impl Into<RunError>) -> Self {
        Self::Run {
            case: case.into(),
            error: error.into(),
        }
    }
}

impl From<csv::Error> for LabError {
    fn from(error: csv::Error) -> Self {
        Self::Data(format!("CSV: {error}"))
    }
}
