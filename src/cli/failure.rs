//! Why a command failed, and its exit code.

use std::fmt::Display;

use engine::breakdown::Breakdown;
use engine::simulation::{Fault, Simulation};
use lab::error::LabError;
use lab::estimate::QuestionError;
use lab::measure::MeasureError;
use lab::sweep::{DrawingError, StudyError};
use output::page::PageError;
use output::plot::PlotError;
use output::recording::RecordingError;
use output::trajectory::TrajectoryError;
use runs::checkpoint::CheckpointError;
use runs::error::StoreError;
use runs::outputs::OutputsError;
use scenario::ScenarioError;
use scenario::trajectories::ReadError;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A scenario or a setting is invalid: exit code 2.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// Another input is invalid: exit code 2.
    #[error("{0}")]
    Input(String),
    /// Trajectories cannot be read: exit code 2.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Trajectories cannot be measured as asked for: exit code 2.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// A study is invalid: exit code 2.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A study cannot be drawn as asked for: exit code 2.
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    /// The simulation failed: exit code 1.
    #[error(transparent)]
    Fault(#[from] Fault),
    /// A file cannot be written, or a result is not as required: exit code 1.
    #[error("{0}")]
    Output(String),
    /// `reproduce`, `accuracy` or `stress` failed: exit code 1.
    #[error(transparent)]
    Reproduce(#[from] LabError),
    /// A signal ended a run without files: exit code 130 or 143.
    #[error("interrupted at {time:.2} s; nothing is written")]
    Stopped {
        /// The time of the last frame, seconds.
        time: f64,
        /// The exit code, 128 + the signal's number.
        exit_code: u8,
    },
    /// A signal ended the run: exit code 130 or 143.
    #[error("interrupted at {time:.2} s; results and files end there")]
    Interrupted {
        /// The time of the last frame, seconds.
        time: f64,
        /// The exit code, 128 + the signal's number.
        exit_code: u8,
    },
}

impl Failure {
    /// An invalid input, or else a file that cannot be written.
    fn of(error: &dyn Display, is_input: bool) -> Self {
        match is_input {
            true => Self::Input(error.to_string()),
            false => Self::Output(error.to_string()),
        }
    }

    /// The exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Fault(_) | Self::Output(_) | Self::Reproduce(_) => 1,
            Self::Interrupted { exit_code, .. } | Self::Stopped { exit_code, .. } => *exit_code,
            Self::Scenario(_) | Self::Input(_) => 2,
            Self::Read(_) | Self::Measure(_) | Self::Study(_) | Self::Drawing(_) => 2,
        }
    }

    /// Adds the forces on the agent that caused a fault.
    pub(super) fn with_forces(self, simulation: &mut Simulation) -> Self {
        let Self::Fault(fault) = self else {
            return self;
        };
        match Breakdown::of_fault(simulation, &fault) {
            Some(agent) => Self::Output(format!("{fault}\n{agent}")),
            None => Self::Fault(fault),
        }
    }
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        LabError::from(error).into()
    }
}

impl From<QuestionError> for Failure {
    fn from(error: QuestionError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<OutputsError> for Failure {
    fn from(error: OutputsError) -> Self {
        Self::of(&error, !matches!(error, OutputsError::Unwritable(..)))
    }
}

impl From<CheckpointError> for Failure {
    fn from(error: CheckpointError) -> Self {
        Self::of(&error, !matches!(error, CheckpointError::Unwritable { .. }))
    }
}

impl From<RecordingError> for Failure {
    fn from(error: RecordingError) -> Self {
        Self::of(&error, matches!(error, RecordingError::SwitchedOff(_)))
    }
}

impl From<PageError> for Failure {
    fn from(error: PageError) -> Self {
        Self::of(&error, matches!(error, PageError::NoViewer { .. }))
    }
}

impl From<PlotError> for Failure {
    fn from(error: PlotError) -> Self {
        let is_input = matches!(error, PlotError::Large(..) | PlotError::NoFfmpeg { .. });
        Self::of(&error, is_input)
    }
}

impl From<TrajectoryError> for Failure {
    fn from(error: TrajectoryError) -> Self {
        match error {
            TrajectoryError::Unwritten { .. } => Self::Output(error.to_string()),
            TrajectoryError::FrameRate { .. } => Self::Input(format!("--trajectory-fps: {error}")),
            TrajectoryError::UnknownFormat(_) => Self::Input(format!("--trajectory {error}")),
        }
    }
}
