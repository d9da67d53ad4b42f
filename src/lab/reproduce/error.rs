//! Why something could not be reproduced.

use crate::engine::simulation::Fault;
use crate::scenario::ScenarioError;

/// Why something could not be reproduced.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// A case is no scenario.
    #[error("{case}: {error}")]
    Scenario {
        /// The case.
        case: String,
        /// What is wrong with it.
        error: ScenarioError,
    },
    /// A run could not go on.
    #[error("{case}: {fault}")]
    Fault {
        /// The case.
        case: String,
        /// What happened.
        fault: Fault,
    },
    /// A file or folder cannot be written.
    #[error("cannot write {path}: {reason}{kept}")]
    Unwritable {
        /// The file or folder.
        path: String,
        /// What the system said.
        reason: String,
        /// What is there all the same.
        kept: String,
    },
    /// A result that was asked for is not there, or not of the expected form.
    #[error("{case}: there is no {what}")]
    Missing {
        /// The case.
        case: String,
        /// What was asked for.
        what: String,
    },
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] crate::output::plot::PlotError),
    /// Data that comes with the program makes no sense.
    #[error("{0}")]
    Data(String),
}

impl From<csv::Error> for ReproduceError {
    fn from(error: csv::Error) -> Self {
        Self::Data(format!("CSV: {error}"))
    }
}
