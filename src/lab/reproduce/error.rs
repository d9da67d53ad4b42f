//! Errors of reproductions.

use crate::engine::simulation::Fault;
use crate::scenario::ScenarioError;

/// Why something could not be reproduced.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// The scenario of a case is invalid.
    #[error("{case}: {error}")]
    Scenario {
        /// The case.
        case: String,
        /// What is invalid.
        error: ScenarioError,
    },
    /// A run failed.
    #[error("{case}: {fault}")]
    Fault {
        /// The case.
        case: String,
        /// The reason.
        fault: Fault,
    },
    /// A file or folder cannot be written.
    #[error("cannot write {path}: {reason}{kept}")]
    Unwritable {
        /// The file or folder.
        path: String,
        /// The system's error message.
        reason: String,
        /// The results that are stored nevertheless.
        kept: String,
    },
    /// A requested result is missing, or has another form.
    #[error("{case}: there is no {what}")]
    Missing {
        /// The case.
        case: String,
        /// The requested result.
        what: String,
    },
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] crate::output::plot::PlotError),
    /// Data that ship with the program are invalid.
    #[error("{0}")]
    Data(String),
}

impl From<csv::Error> for ReproduceError {
    fn from(error: csv::Error) -> Self {
        Self::Data(format!("CSV: {error}"))
    }
}
