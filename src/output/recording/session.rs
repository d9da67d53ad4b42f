//! A recording that has begun: the common part of recordings of runs and of measurements.

use rerun::RecordingStream;

use super::crowd::Maps;
use super::error::{Cause, RecordingError};
use super::events::Line;
use super::layout::{Content, Opening};
use super::output::Output;
use super::snapshot::Snapshot;
use super::text::Document;
use super::writer::{Debug, Writer};
use super::{RecordingOptions, bars, blueprint, crowd, stats, text};

pub struct Session {
    output: Output,
    writer: Writer,
    pub options: RecordingOptions,
    content: Content,
    document: Document,
}

impl Session {
    /// Logs the layout and the static data. `log_own` logs the static data of this kind of recording, and returns its
    /// text document and what shows its debug agents.
    pub fn begin(
        output: Output,
        options: RecordingOptions,
        content: Content,
        log_own: impl FnOnce(&RecordingStream) -> Result<(Document, Debug), Cause>,
    ) -> Result<Self, RecordingError> {
        let begin = |stream: &RecordingStream| -> Result<(Document, Writer), Cause> {
            let opening = match output.is_live() {
                true => Opening::Live,
                false => Opening::Empty,
            };
            blueprint::send(stream, &options, opening, &content)?;
            let (document, debug) = log_own(stream)?;
            document.log(stream, None)?;
            let maps = Maps::new(&options);
            bars::log(stream, &options.view, &maps)?;
            crowd::log_style(stream)?;
            stats::log_style(stream)?;
            stream.flush_blocking()?;
            Ok((document, Writer::start(stream.clone(), maps, debug)?))
        };
        let (document, writer) = output.checked(begin(&output.stream))?;
        Ok(Self {
            output,
            writer,
            options,
            content,
            document,
        })
    }

    /// Adds a frame.
    pub fn write(&mut self, snapshot: Snapshot) -> Result<(), RecordingError> {
        self.output.checked(self.writer.write(snapshot))
    }

    /// Logs more static data.
    pub fn log_static(
        &self,
        log: impl FnOnce(&RecordingStream) -> Result<(), Cause>,
    ) -> Result<(), RecordingError> {
        self.output.checked(log(&self.output.stream))
    }

    /// Adds lines to the log of events.
    pub fn note(&mut self, lines: Vec<Line>) -> Result<(), RecordingError> {
        self.output.checked(self.writer.note(lines))
    }

    /// Sends the buffered data, then the final layout, closes the file and checks that it is complete. If the moment
    /// that the recording opens at was found during the run, `found` is its time; the view of the followed agent number
    /// `followed` is in front.
    pub fn finish(
        mut self,
        found: Option<f64>,
        followed: Option<usize>,
    ) -> Result<(), RecordingError> {
        self.options.opens_at = found.or(self.options.opens_at);
        let mut end = || {
            self.writer.finish()?;
            let stream = &self.output.stream;
            if let Some(time) = found {
                self.document.log(stream, found)?;
                text::log_opening(stream, time)?;
            }
            // The viewer cannot go to a time that it has not read yet.
            stream.flush_blocking()?;
            let opening = Opening::Whole(followed);
            blueprint::send(stream, &self.options, opening, &self.content)
        };
        let ended = end();
        self.output.checked(ended)?;
        self.output.close()
    }
}
