//! Checkpoints, as far as the command line is concerned.

use std::path::PathBuf;

use super::Failure;
use super::arguments::CheckpointOptions;
use super::output::check_free;
use crate::checkpoint::{Checkpoint, CheckpointError};
use crate::metrics::Metrics;
use crate::scenario::Scenario;
use crate::simulation::Simulation;

/// The checkpoints of a run.
pub struct Checkpoints {
    file: Option<PathBuf>,
    /// Frames between them.
    every: u64,
    /// The frame of the next.
    due: u64,
}

impl Checkpoints {
    /// Prepares to write them; the first comes a while after where `simulation` is.
    pub fn create(
        options: &CheckpointOptions,
        force: bool,
        simulation: &mut Simulation,
    ) -> Result<Self, Failure> {
        if let Some(path) = &options.checkpoint {
            check_free("--checkpoint", path, force)?;
            // A resumed run may record densities that no force reads here.
            simulation.request_density_until(u64::MAX);
        }
        let clock = simulation.frame().clock;
        let every = clock.frame_at(options.checkpoint_every).max(1);
        Ok(Self {
            file: options.checkpoint.clone(),
            every,
            due: clock.frame() + every,
        })
    }

    /// Writes one of an evaluated frame if its turn has come, or `now`.
    pub fn write(
        &mut self,
        scenario: &Scenario,
        simulation: &Simulation,
        metrics: &Metrics,
        now: bool,
    ) -> Result<(), Failure> {
        let Some(path) = &self.file else {
            return Ok(());
        };
        if now || simulation.frame().clock.frame() >= self.due {
            self.due += self.every;
            Checkpoint::of(scenario, simulation, metrics).write(path)?;
        }
        Ok(())
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
