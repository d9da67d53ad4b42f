//! Errors of reading trajectories.

use std::path::{Path, PathBuf};

/// Trajectories cannot be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{}: {problem}", path.display(), line.map_or(String::new(), |line| format!(":{line}")))]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// The line number, from 1, if a line of a text file is invalid.
    pub line: Option<u64>,
    /// The problem and its fix.
    pub problem: String,
}

impl ReadError {
    /// The same error for a command whose option for the frame rate has another name than `--fps`.
    #[must_use]
    pub fn with_rate_option(self, option: &str) -> Self {
        Self {
            problem: self.problem.replace("--fps", option),
            ..self
        }
    }

    /// An error about the whole file.
    pub(super) fn file(path: &Path, problem: impl Into<String>) -> Self {
        Self {
            path: path.to_owned(),
            line: None,
            problem: problem.into(),
        }
    }

    /// An error about a line of the file.
    pub(super) fn line(path: &Path, line: u64, problem: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::file(path, problem)
        }
    }
}
