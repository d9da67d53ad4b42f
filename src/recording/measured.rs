//! A recording of frames that nobody simulated: a crowd that was measured.

use std::path::{Path, PathBuf};

use rerun::{RecordingStream, RecordingStreamBuilder};

use super::blueprint::{Content, Opening};
use super::error::RecordingError;
use super::layers::Layers;
use super::writer::Writer;
use super::{
    APPLICATION, RecordingOptions, batches, blueprint, crowd, geometry, read, stats, text,
};
use crate::geometry::Walls;
use crate::math::Vector;

/// One person in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPerson {
    /// Whoever is there twice has the same.
    pub id: u32,
    /// Metres.
    pub position: Vector,
    /// m/s; `None` where it is not known.
    pub velocity: Option<Vector>,
    /// P/m².
    pub density: f64,
}

/// Writes a recording of measured frames: the crowd by density and by speed, walls, time series.
pub struct MeasuredRecorder {
    path: PathBuf,
    stream: RecordingStream,
    writer: Writer,
    options: RecordingOptions,
    radius: f64,
}

impl MeasuredRecorder {
    /// Begins a recording at `path`, replacing any file there; everybody is a disc of `radius` metres. Nobody
    /// is laid open, whatever the options say.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(
        path: &Path,
        walls: &Walls,
        radius: f64,
        options: &RecordingOptions,
    ) -> Result<Self, RecordingError> {
        let options = RecordingOptions {
            debug: super::DebugAgents::None,
            ..options.clone()
        };
        let stream = RecordingStreamBuilder::new(APPLICATION)
            .recording_id(options.title.clone())
            .batcher_config(batches())
            .save(path)?;
        stream.set_log_tick_enabled(false);
        stream.set_log_time_enabled(false);
        stream.send_recording_name(options.title.clone())?;
        blueprint::send(&stream, &options, Opening::Empty, Content::Measurement)?;
        text::log_measurement(&stream, &options)?;
        geometry::log_still(&stream, walls.obstacles())?;
        crowd::log_style(&stream)?;
        stats::log_style(&stream)?;
        stream.flush_blocking()?;
        Ok(Self {
            path: path.to_owned(),
            writer: Writer::start(stream.clone(), Layers::none())?,
            stream,
            options,
            radius,
        })
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
        let mut snapshot = self.writer.empty();
        snapshot.clear(frame, time);
        for person in people {
            let velocity = person.velocity.unwrap_or(Vector::repeat(f64::NAN));
            snapshot.ids.push(person.id);
            snapshot.positions.push(geometry::xy(person.position));
            snapshot.velocities.push(geometry::xy(velocity));
            snapshot.radii.push(self.radius as f32);
            snapshot.densities.push(person.density as f32);
        }
        self.writer.write(snapshot)
    }

    /// Writes what is still in memory, closes the file and checks that it is whole.
    ///
    /// # Errors
    /// Something could not be written: the disk is full, for example.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        self.writer.finish()?;
        self.stream.flush_blocking()?;
        let opening = Opening::Whole(None);
        blueprint::send(&self.stream, &self.options, opening, Content::Measurement)?;
        self.stream.flush_blocking()?;
        drop(self.stream); // As for a run.
        read::check_footer(&self.path)
    }
}
