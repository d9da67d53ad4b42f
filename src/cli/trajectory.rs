//! Trajectory files: options and checks.

use super::Failure;
use super::arguments::TrajectoryOptions;
use crate::engine::simulation::Simulation;
use crate::output::trajectory::{Format, Trajectory, TrajectoryError, frames_between, journal};
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

/// The trajectory files of a run.
pub struct Trajectories(Vec<Trajectory>);

impl Trajectories {
    /// Opens the requested files.
    pub fn create(
        options: &TrajectoryOptions,
        scenario: &Scenario,
        simulation: &mut Simulation,
    ) -> Result<Self, Failure> {
        let (view, fps) = (scenario.view.region, options.fps);
        let files = options.files.iter();
        let opened = files.map(|path| Trajectory::create(path, simulation, view, fps));
        Ok(Self(opened.collect::<Result<_, _>>()?))
    }

    /// Adds an evaluated frame to the files in which it is due.
    pub fn log(&mut self, simulation: &Simulation) -> Result<(), Failure> {
        for trajectory in &mut self.0 {
            trajectory.log(simulation)?;
        }
        Ok(())
    }

    /// Closes all files, even if one fails.
    pub fn finish(self) -> Result<(), Failure> {
        let finished: Vec<_> = self.0.into_iter().map(Trajectory::finish).collect();
        Ok(finished.into_iter().collect::<Result<(), _>>()?)
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
