//! A recording of measured frames.

use rerun::RecordingStream;

use super::debug::DebugAgents;
use super::draw::xy;
use super::error::RecordingError;
use super::frame::Snapshot;
use super::layout::{Content, Kind};
use super::options::RecordingOptions;
use super::scene::markers::Marked;
use super::scene::names::Names;
use super::scene::{self, obstacles};
use super::session::{Debug, Session};
use super::stream::{Destination, Output};
use super::text;
use engine::geometry::Walls;
use engine::math::Vector;

/// One person in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPerson {
    /// The same in every frame in which the person appears.
    pub id: u32,
    /// Meters.
    pub position: Vector,
    /// m/s; `None` if unknown.
    pub velocity: Option<Vector>,
    /// P/m².
    pub density: f64,
}

/// Writes a recording of measured frames: the crowd by density and by speed, walls, time series.
pub struct MeasuredRecorder {
    session: Session,
    radius: f64,
}

impl MeasuredRecorder {
    /// Begins a recording. Every person is a disc of `radius` meters; `marked` regions and lines are drawn. There are
    /// no debug agents, whatever the options say.
    ///
    /// # Errors
    /// The file cannot be written, or no viewer answers.
    pub fn create(
        to: impl Into<Destination>,
        (walls, marked): (&Walls, Marked),
        radius: f64,
        options: &RecordingOptions,
    ) -> Result<Self, RecordingError> {
        let options = RecordingOptions {
            debug: DebugAgents::None,
            ..options.clone()
        };
        let output = Output::open(&to.into(), &options)?;
        let log_own = |stream: &RecordingStream| {
            scene::log_walls(stream, walls.obstacles())?;
            let mut names = Names::of_walls(&options.view, walls);
            marked.log(stream, &mut names)?;
            names.log(stream)?;
            Ok((text::of_measurement(stream, &options)?, Debug::default()))
        };
        let content = Content::new(Kind::Measurement, obstacles::has_outside(walls.obstacles()));
        let session = Session::begin(output, options.clone(), content, log_own)?;
        Ok(Self { session, radius })
    }

    /// Adds a frame, which may be empty.
    ///
    /// # Errors
    /// An earlier frame could not be written.
    pub fn log(
        &mut self,
        frame: i64,
        time: f64,
        people: impl Iterator<Item = MeasuredPerson>,
    ) -> Result<(), RecordingError> {
        let mut snapshot = Snapshot {
            frame,
            time,
            ..Snapshot::default()
        };
        for person in people {
            let velocity = person.velocity.unwrap_or(Vector::repeat(f64::NAN));
            snapshot.ids.push(person.id);
            snapshot.positions.push(xy(person.position));
            snapshot.velocities.push(xy(velocity));
            snapshot.radii.push(self.radius as f32);
            snapshot.densities.push(person.density as f32);
        }
        self.session.write(snapshot)
    }

    /// Sends the buffered data, closes the file and checks that it is complete.
    ///
    /// # Errors
    /// Data could not be written, for example because the disk is full; or the viewer is gone or took no data for 2 s.
    pub fn finish(self) -> Result<(), RecordingError> {
        self.session.finish(None, None)
    }
}
