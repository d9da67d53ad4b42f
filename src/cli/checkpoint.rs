//! Writing checkpoints during a run.

use std::path::PathBuf;

use super::arguments::CheckpointOptions;
use super::{Failure, talk};
use crate::engine::simulation::Simulation;
use crate::runs::checkpoint::{Checkpoint, CheckpointError};
use crate::scenario::Scenario;
use crate::scenario::measurements::Metrics;

/// The checkpoints of a run.
pub struct Checkpoints {
    file: Option<PathBuf>,
    /// Frames between checkpoints.
    every: u64,
    /// The frame of the next checkpoint.
    due: u64,
    /// The time of the last checkpoint written, seconds.
    kept: Option<f64>,
    /// Why the last attempt failed, if it did.
    failure: Option<CheckpointError>,
}

/// The position of a frame in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    /// More frames follow.
    Underway,
    /// The last frame.
    Last,
    /// The last frame, because of a signal.
    Interrupted,
}

impl Checkpoints {
    /// Prepares the checkpoints; the first is due one interval after the current frame.
    pub fn create(options: &CheckpointOptions, simulation: &mut Simulation) -> Self {
        if options.checkpoint.is_some() {
            // The resumed run may record densities, which this run might not need.
            simulation.request_density_until(u64::MAX);
        }
        let clock = simulation.frame().clock;
        let every = clock.frame_at(options.checkpoint_every).max(1);
        Self {
            file: options.checkpoint.clone(),
            every,
            due: clock.frame() + every,
            kept: None,
            failure: None,
        }
    }

    /// Writes a checkpoint of an evaluated frame if one is due, if a signal ends the run, or if the run ends without
    /// any. A failure does not end the run: the next attempt may succeed.
    pub fn write(
        &mut self,
        scenario: &Scenario,
        simulation: &Simulation,
        metrics: &Metrics,
        moment: Moment,
    ) {
        let Some(path) = &self.file else {
            return;
        };
        let clock = simulation.frame().clock;
        let is_due = clock.frame() >= self.due
            || moment == Moment::Interrupted
            || moment == Moment::Last && self.kept.is_none();
        if !is_due {
            return;
        }
        self.due = clock.frame() + self.every;
        match Checkpoint::of(scenario, simulation, metrics).write(path) {
            Ok(()) => {
                self.kept = Some(clock.time());
                self.failure = None;
            }
            Err(error) => {
                if self.failure.is_none() {
                    let time = clock.time();
                    talk(&format!("note: at {time:.2} s: --checkpoint {error}"));
                }
                self.failure = Some(error);
            }
        }
    }

    /// Fails if the last attempt failed; the message says which checkpoint is kept.
    pub fn finish(self) -> Result<(), Failure> {
        let (Some(path), Some(error)) = (&self.file, &self.failure) else {
            return Ok(());
        };
        let kept = match self.kept {
            _ if !path.is_file() => "there is no checkpoint".to_owned(),
            Some(time) => format!("the checkpoint of {time:.2} s is kept"),
            None => "the file from before the run is kept".to_owned(),
        };
        Err(Failure::Output(format!("--checkpoint {error}; {kept}")))
    }
}

impl From<CheckpointError> for Failure {
    fn from(error: CheckpointError) -> Self {
        match error {
            CheckpointError::Unwritable { .. } => Self::Output(error.to_string()),
            CheckpointError::Scenario(error) => Self::Scenario(error),
            error => Self::Input(error.to_string()),
        }
    }
}
