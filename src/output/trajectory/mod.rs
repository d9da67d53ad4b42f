//! Writes a run as trajectories for other programs. `scenario::trajectories` reads them.
//!
//! | file | read by | holds |
//! |---|---|---|
//! | `.sqlite`, `.db` | JuPedSim, PedPy | positions and orientations, the walkable area as WKT, and density, pressure, speed |
//! | `.txt` | PedPy, the Pedestrian Dynamics Data Archive's tools | positions, in text |
//! | `.csv` | everything | every quantity of every agent: [`COLUMNS`], and what forces keep |
//!
//! Positions in a building are those there, with the level and the height of each agent.
//!
//! Frames are numbered 0, 1, 2, … at the file's own rate. Numbers are the values of the evaluated frame, with all
//! digits. An interrupted run leaves whole frames: a text file has each frame as soon as it is logged, a SQLite file
//! all but those of the last second (a `-journal` file beside it belongs to it, and disappears when the file is
//! opened).

mod area;
mod error;
mod lines;
mod memory;
mod row;
mod sqlite;

pub use error::{Cause, TrajectoryError};
pub use memory::{Collected, Column, Columns, walkable_area};
pub use row::{COLUMNS, Row, Value};
pub use sqlite::journal;

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use area::WalkableArea;
use engine::clock::Clock;
use engine::scene::Region;
use engine::simulation::Simulation;
use lines::Lines;
use sqlite::Sqlite;

/// The format of a file, given by its extension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// JuPedSim's SQLite format, version 2, the only version that PedPy reads.
    Sqlite,
    /// The text format of the Pedestrian Dynamics Data Archive.
    Text,
    /// Every quantity, as comma-separated values.
    Csv,
}

impl Format {
    /// The format of a file with this name.
    ///
    /// # Errors
    /// No format has its extension.
    pub fn of(path: &Path) -> Result<Self, TrajectoryError> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("sqlite" | "db") => Ok(Self::Sqlite),
            Some("txt") => Ok(Self::Text),
            Some("csv") => Ok(Self::Csv),
            _ => Err(TrajectoryError::UnknownFormat(path.to_owned())),
        }
    }
}

/// The number of simulation frames per recorded frame at `fps` recorded frames per second.
///
/// # Errors
/// `fps` does not divide the clock's rate, to a relative accuracy of 1e-6.
pub fn frames_between(clock: &Clock, fps: f64) -> Result<u64, TrajectoryError> {
    let rate = |every: f64| 1.0 / (every * clock.time_step());
    let below = (rate(1.0) / fps).floor().max(1.0);
    let off = |every: f64| (rate(every) - fps).abs();
    let nearest = match off(below) <= off(below + 1.0) {
        true => below,
        false => below + 1.0,
    };
    if off(nearest) > 1e-6 * fps {
        return Err(TrajectoryError::FrameRate {
            fps,
            of: rate(1.0),
            nearest: rate(nearest),
        });
    }
    Ok(nearest as u64)
}

/// Writes trajectories, frame by frame.
pub struct Trajectory {
    path: PathBuf,
    every: u64,
    sink: Box<dyn Sink>,
}

/// A file in one of the formats.
trait Sink: Send {
    /// Adds a frame.
    fn write(&mut self, frame: u64, rows: &[Row<'_>]) -> Result<(), Cause>;

    /// Writes buffered data to the file.
    fn finish(&mut self) -> Result<(), Cause> {
        Ok(())
    }

    /// Number of frames in the file, even after an error.
    fn kept(&self) -> u64;
}

impl Trajectory {
    /// Begins the trajectories of `simulation` at `path`, replacing an existing file, with `fps` frames per second. The
    /// walkable area includes `view`. From now on every frame has densities.
    ///
    /// # Errors
    /// The format is unknown, `fps` does not divide the simulation's rate, or the file cannot be written.
    pub fn create(
        path: &Path,
        simulation: &mut Simulation,
        view: Region,
        fps: f64,
    ) -> Result<Self, TrajectoryError> {
        let format = Format::of(path)?;
        let levels = simulation.scene().levels.clone();
        let clock = *simulation.frame().clock;
        let every = frames_between(&clock, fps)?;
        let fps = 1.0 / clock.time_at(every);
        let open = || -> Result<Box<dyn Sink>, Cause> {
            let file = File::create(path)?;
            Ok(match format {
                Format::Sqlite => {
                    let area = WalkableArea::new(simulation, view);
                    Box::new(Sqlite::create(path, area, fps, levels.as_deref())?)
                }
                Format::Text => Box::new(Lines::text(file, fps, levels.is_some())?),
                Format::Csv => Box::new(Lines::csv(file)),
            })
        };
        let sink = open().map_err(|cause| TrajectoryError::unwritten(path, 0, cause))?;
        simulation.request_density_until(u64::MAX);
        Ok(Self {
            path: path.to_owned(),
            every,
            sink,
        })
    }

    /// Adds the current frame, which must be evaluated, if it is due at the file's rate.
    ///
    /// # Errors
    /// The file cannot be written, for example because the disk is full. Frames already written are kept.
    pub fn log(&mut self, simulation: &Simulation) -> Result<(), TrajectoryError> {
        let number = simulation.frame().clock.frame();
        if !number.is_multiple_of(self.every) {
            return Ok(());
        }
        let frame = number / self.every;
        let written = self.sink.write(frame, &row::rows(simulation, frame));
        self.checked(written)
    }

    /// Writes all buffered data to the file.
    ///
    /// # Errors
    /// Same as [`log`](Self::log).
    pub fn finish(mut self) -> Result<(), TrajectoryError> {
        let finished = self.sink.finish();
        // Writing to a removed file reports no error.
        let there = finished.and_then(|()| Ok(fs::metadata(&self.path).map(|_| ())?));
        self.checked(there)
    }

    fn checked(&self, result: Result<(), Cause>) -> Result<(), TrajectoryError> {
        let is_there = self.path.exists();
        let kept = if is_there { self.sink.kept() } else { 0 };
        result.map_err(|cause| TrajectoryError::unwritten(&self.path, kept, cause))
    }
}
