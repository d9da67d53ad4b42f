//! The log of events.

use rerun::{RecordingStream, TextLog};

use super::set_time;
use crate::events::Line;
use crate::recording::error::Cause;

/// The entity of the log.
pub const ENTITY: &str = "log";

/// Logs lines, each at its own time.
pub fn log(stream: &RecordingStream, lines: &[Line]) -> Result<(), Cause> {
    for line in lines {
        set_time(stream, line.frame, line.time);
        let text = TextLog::new(line.text.as_str()).with_level(line.level);
        stream.log(ENTITY, &text)?;
    }
    Ok(())
}
