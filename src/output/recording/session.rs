//! A recording that has begun: what recordings of runs and of measurements share.

use rerun::RecordingStream;

use super::blueprint::{self, Content, Opening};
use super::error::{Cause, RecordingError};
use super::layers::Layer;
use super::output::Output;
use super::snapshot::Snapshot;
use super::writer::Writer;
use super::{RecordingOptions, crowd, stats};
use crate::engine::scene::Region;

pub struct Session {
    output: Output,
    writer: Writer,
    pub options: RecordingOptions,
    content: Content,
}

impl Session {
    /// Logs the layout and the static data. `log_own` logs the static data of this kind of recording, and returns its
    /// layers.
    pub fn begin(
        output: Output,
        options: RecordingOptions,
        content: Content,
        log_own: impl FnOnce(&RecordingStream) -> Result<Vec<Layer>, Cause>,
    ) -> Result<Self, RecordingError> {
        let begin = |stream: &RecordingStream| -> Result<Writer, Cause> {
            let opening = match output.is_live() {
                true => Opening::Live,
                false => Opening::Empty,
            };
            blueprint::send(stream, &options, opening, &content)?;
            let layers = log_own(stream)?;
            crowd::log_style(stream)?;
            stats::log_style(stream)?;
            stream.flush_blocking()?;
            Writer::start(stream.clone(), layers)
        };
        Ok(Self {
            writer: output.checked(begin(&output.stream))?,
            output,
            options,
            content,
        })
    }

    /// Adds a frame.
    pub fn write(&mut self, snapshot: Snapshot) -> Result<(), RecordingError> {
        self.output.checked(self.writer.write(snapshot))
    }

    /// Sends the buffered data, then the final layout, closes the file and checks that it is complete.
    pub fn finish(mut self, focus: Option<Region>) -> Result<(), RecordingError> {
        let mut end = || {
            self.writer.finish()?;
            // The viewer cannot go to a time that it has not read yet.
            self.output.stream.flush_blocking()?;
            let (stream, opening) = (&self.output.stream, Opening::Whole(focus));
            blueprint::send(stream, &self.options, opening, &self.content)
        };
        let ended = end();
        self.output.checked(ended)?;
        self.output.close()
    }
}
