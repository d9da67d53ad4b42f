//! Writing checkpoints during a run.

use std::ops::ControlFlow;
use std::path::PathBuf;

use super::arguments::CheckpointOptions;
use super::failure::Failure;
use super::terminal::talk;
use runs::checkpoint::{Checkpoint, CheckpointError};
use runs::drive::{End, Observer, Run};
use scenario::Scenario;

/// The checkpoints of a run.
pub struct Checkpoints {
    file: PathBuf,
    /// The scenario to resume, if it is not that of the run.
    scenario: Option<Scenario>,
    /// Frames between checkpoints.
    every: u64,
    /// The frame of the next checkpoint.
    due: u64,
    /// The time of the last checkpoint written, seconds.
    kept: Option<f64>,
    /// Why the last attempt failed, if it did.
    failure: Option<CheckpointError>,
}

impl Checkpoints {
    /// Prepares the checkpoints, if requested; the first is due one interval after the current frame.
    pub fn create(
        options: &CheckpointOptions,
        scenario: Option<Scenario>,
        run: &mut Run,
    ) -> Option<Self> {
        let file = options.checkpoint.clone()?;
        // A resumed run may record densities even if this run does not need them.
        run.simulation.request_density_until(u64::MAX);
        let clock = run.simulation.frame().clock;
        let every = clock.frame_at(options.checkpoint_every).max(1);
        Some(Self {
            file,
            scenario,
            every,
            due: clock.frame() + every,
            kept: None,
            failure: None,
        })
    }
}

impl Observer<Failure> for Checkpoints {
    /// Writes a checkpoint if one is due, if a signal ends the run, or if the run ends before its first checkpoint. A
    /// failure does not end the run: the next attempt may succeed.
    fn observe(&mut self, run: &Run, _: f64, then: ControlFlow<End>) -> Result<(), Failure> {
        let clock = run.simulation.frame().clock;
        let is_due = clock.frame() >= self.due
            || then == ControlFlow::Break(End::Interrupted)
            || then.is_break() && self.kept.is_none();
        if !is_due {
            return Ok(());
        }
        self.due = clock.frame() + self.every;
        let scenario = self.scenario.as_ref().unwrap_or(&run.scenario);
        let written = Checkpoint::of(scenario, &run.simulation, &run.metrics).write(&self.file);
        match &written {
            Ok(()) => self.kept = Some(clock.time()),
            Err(error) if self.failure.is_none() => talk(&format!(
                "note: at {:.2} s: --checkpoint {error}",
                clock.time()
            )),
            Err(_) => {}
        }
        self.failure = written.err();
        Ok(())
    }

    /// Fails if the last attempt failed; the message says which checkpoint is kept.
    fn finish(self: Box<Self>) -> Result<(), Failure> {
        let Some(error) = &self.failure else {
            return Ok(());
        };
        let kept = match self.kept {
            _ if !self.file.is_file() => "there is no checkpoint".to_owned(),
            Some(time) => format!("the checkpoint of {time:.2} s is kept"),
            None => "the file from before the run is kept".to_owned(),
        };
        Err(Failure::Output(format!("--checkpoint {error}; {kept}")))
    }
}
