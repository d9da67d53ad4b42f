//! Trajectory files: options and checks.

use std::ops::ControlFlow;

use super::arguments::TrajectoryOptions;
use super::failure::Failure;
use crate::output::trajectory::{Format, Trajectory, frames_between, journal};
use crate::runs::drive::{End, Observer, Run};
use crate::runs::outputs::{Manner, Outputs};
use crate::scenario::Scenario;

/// Adds the trajectories to `outputs`.
pub fn add(
    outputs: &mut Outputs,
    options: &TrajectoryOptions,
    scenario: &Scenario,
) -> Result<(), Failure> {
    let option = "--trajectory";
    for path in &options.files {
        let format = Format::of(path)?;
        outputs.writes(option, path, Manner::InPlace);
        if format == Format::Sqlite {
            // SQLite's journal, which exists during every transaction.
            let journal = journal(path).map_err(|error| Failure::Output(error.to_string()))?;
            outputs.writes(option, &journal, Manner::Beside);
        }
    }
    if !options.files.is_empty() {
        frames_between(&scenario.scene.clock, options.fps)?;
    }
    Ok(())
}

/// Opens the requested files.
pub fn create(options: &TrajectoryOptions, run: &mut Run) -> Result<Vec<Trajectory>, Failure> {
    let (view, fps) = (run.scenario.view.region, options.fps);
    let files = options.files.iter();
    let opened = files.map(|path| Trajectory::create(path, &mut run.simulation, view, fps));
    Ok(opened.collect::<Result<_, _>>()?)
}

impl Observer<Failure> for Trajectory {
    fn observe(&mut self, run: &Run, _: f64, _: ControlFlow<End>) -> Result<(), Failure> {
        Ok(self.log(&run.simulation)?)
    }

    fn finish(self: Box<Self>) -> Result<(), Failure> {
        Ok(Self::finish(*self)?)
    }
}
