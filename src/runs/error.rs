//! Why runs cannot be computed or their results stored.

use engine::simulation::Fault;
use scenario::ScenarioError;

/// Why a run cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// Its scenario or a setting is invalid, or needs more memory than there is.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The simulation failed.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// The file of its scenario is not the one that was checked.
    #[error("{0} has changed since it was read")]
    Changed(String),
}

/// Why jobs cannot go on: no further job would succeed.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
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
    /// The system cannot start a thread.
    #[error("no thread can be started: {0}")]
    Threads(String),
}
