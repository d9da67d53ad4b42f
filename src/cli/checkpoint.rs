//! Checkpoints, as far as the command line is concerned.

use std::path::PathBuf;

use super::arguments::CheckpointOptions;
use super::{Failure, talk};
use crate::engine::simulation::Simulation;
use crate::runs::checkpoint::{Checkpoint, CheckpointError};
use crate::scenario::Scenario;
use crate::scenario::metrics::Metrics;

/// The checkpoints of a run.
pub struct Checkpoints {
    file: Option<PathBuf>,
    /// Frames between them.
    every: u64,
    /// The frame of the next.
    due: u64,
    /// The time of the last one that was written, seconds.
    kept: Option<f64>,
    /// Why the last one was not written, if it was not.
    failure: Option<CheckpointError>,
}

/// Where a frame is in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    /// Others follow.
    Underway,
    /// It is the last.
    Last,
    /// It is the last, because of a signal.
    Interrupted,
}

impl Checkpoints {
    /// Prepares to write them; the first comes a while after where `simulation` is.
    pub fn create(options: &CheckpointOptions, simulation: &mut Simulation) -> Self {
        if options.checkpoint.is_some() {
            // A resumed run may record densities that no force reads here.
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

    /// Writes one of an evaluated frame if its turn has come, and at the end of a run that has none. A failure
    /// does not end the run: the next one may succeed.
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

    /// Says what is kept if the last one was not written.
    pub fn finish(self) -> Result<(), Failure> {
        let (Some(path), Some(error)) = (&self.file, &self.failure) else {
            return Ok(());
        };
        let kept = match self.kept {
            _ if !path.is_file() => "no checkpoint is there".to_owned(),
            Some(time) => format!("the checkpoint of {time:.2} s is kept"),
            None => "what was there before the run is kept".to_owned(),
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
