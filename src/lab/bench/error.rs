//! Why something could not be measured.

use std::path::PathBuf;

use crate::engine::simulation::Fault;
use crate::scenario::{ScenarioError, SettingError};

/// Why something could not be measured.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// A crowd cannot go on.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// A scenario cannot be read.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// A scenario has no such setting.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// There is no such profile.
    #[error("there is no profile {0}; `sandbox list` names all")]
    Profile(String),
    /// The threads cannot be started.
    #[error("{threads} thread(s) cannot be started: {reason}")]
    Threads {
        /// How many.
        threads: usize,
        /// Why.
        reason: String,
    },
    /// Another program stopped in the middle of a comparison.
    #[error("{engine} stopped: {reason}")]
    Stopped {
        /// Which.
        engine: &'static str,
        /// What it said last.
        reason: String,
    },
    /// A result cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A picture cannot be made.
    #[error(transparent)]
    Picture(#[from] crate::output::plot::PlotError),
}
