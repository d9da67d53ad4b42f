//! Errors of benchmarks.

use std::path::PathBuf;

use crate::engine::simulation::Fault;
use crate::scenario::{ScenarioError, SettingError};

/// Why a benchmark failed.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A simulation failed.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// A scenario cannot be read.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A setting is invalid.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// The profile does not exist.
    #[error("there is no profile {0}; `sandbox list` names all")]
    Profile(String),
    /// The threads cannot be started.
    #[error("{threads} thread(s) cannot be started: {reason}")]
    Threads {
        /// Number of threads.
        threads: usize,
        /// The reason.
        reason: String,
    },
    /// Another program stopped in the middle of a comparison.
    #[error("{engine} stopped: {reason}")]
    Stopped {
        /// The program.
        engine: &'static str,
        /// Why it stopped.
        reason: String,
    },
    /// A result cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] crate::output::plot::PlotError),
}
