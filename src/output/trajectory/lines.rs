//! Text files with one line per agent and frame.

use std::fs::File;
use std::io::{self, Write};

use rayon::prelude::*;

use super::error::Cause;
use super::{Row, Sink};
use figures::table::csv_lines;
use scenario::trajectories::one_word;

/// Lines per parallel task.
const SOME: usize = 1024;

/// A file that grows by whole frames.
pub struct Lines {
    file: File,
    /// Length of the file, bytes.
    length: u64,
    frames: u64,
    format: fn(rows: &[Row<'_>], is_first: bool) -> Result<Vec<u8>, Cause>,
}

impl Lines {
    /// The text format of the Pedestrian Dynamics Data Archive. Readers take the first number after `framerate`, and
    /// the unit from `x/m`.
    ///
    /// The lines of a building end with the height and the level, in whose name blanks are underscores.
    pub fn text(mut file: File, fps: f64, has_levels: bool) -> io::Result<Self> {
        let two_decimals = Some(format!("{fps:.2}")).filter(|text| text.parse() == Ok(fps));
        let fps = two_decimals.unwrap_or_else(|| fps.to_string());
        let level = if has_levels { " level" } else { "" };
        let head = format!("# framerate: {fps}\n# id frame x/m y/m z/m{level}\n");
        file.write_all(head.as_bytes())?;
        Ok(Self {
            file,
            length: head.len() as u64,
            frames: 0,
            format: text,
        })
    }

    /// [`columns`](super::row::columns), below a header with their names.
    pub fn csv(file: File) -> Self {
        Self {
            file,
            length: 0,
            frames: 0,
            format: |rows, is_first| Ok(csv_lines(rows, is_first)?),
        }
    }
}

impl Sink for Lines {
    fn write(&mut self, _: u64, rows: &[Row<'_>]) -> Result<(), Cause> {
        let lines = (self.format)(rows, self.length == 0)?;
        if let Err(error) = self.file.write_all(&lines) {
            // Remove the partial frame. If truncating fails too, the file ends with it.
            self.file.set_len(self.length).ok();
            return Err(error.into());
        }
        self.length += lines.len() as u64;
        self.frames += 1;
        Ok(())
    }

    fn kept(&self) -> u64 {
        self.frames
    }
}

fn text(rows: &[Row<'_>], _: bool) -> Result<Vec<u8>, Cause> {
    let parts = rows.par_chunks(SOME).map(|rows| {
        let mut lines = Vec::new();
        for row in rows {
            let (id, frame, at, z) = (row.id(), row.number, row.place(), row.height());
            write!(lines, "{id}\t{frame}\t{}\t{}\t{z}", at.x, at.y)?;
            if let Some(level) = row.level() {
                write!(lines, "\t{}", one_word(level))?;
            }
            writeln!(lines)?;
        }
        Ok(lines)
    });
    Ok(parts.collect::<io::Result<Vec<_>>>()?.concat())
}
