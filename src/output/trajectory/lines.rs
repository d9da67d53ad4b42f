//! Text files with one line per agent and frame.

use std::fs::File;
use std::io::{self, Write};

use rayon::prelude::*;

use super::error::Cause;
use super::{Row, Sink};

/// Lines per parallel task.
const SOME: usize = 1024;

/// A file that grows by whole frames.
pub struct Lines {
    file: File,
    /// Length of the file, bytes.
    length: u64,
    frames: u64,
    format: fn(rows: &[Row<'_>], is_first: bool) -> io::Result<Vec<u8>>,
}

impl Lines {
    /// The text format of the Pedestrian Dynamics Data Archive. Readers take the first number after `framerate`, and
    /// the unit from `x/m`.
    pub fn text(mut file: File, fps: f64) -> io::Result<Self> {
        let two_decimals = format!("{fps:.2}");
        let is_exact = two_decimals.parse() == Ok(fps);
        let fps = if is_exact {
            two_decimals
        } else {
            fps.to_string()
        };
        let head = format!("# framerate: {fps}\n# id frame x/m y/m z/m\n");
        file.write_all(head.as_bytes())?;
        Ok(Self {
            file,
            length: head.len() as u64,
            frames: 0,
            format: text,
        })
    }

    /// Every field of a [`Row`], below a header with their names.
    pub fn csv(file: File) -> Self {
        Self {
            file,
            length: 0,
            frames: 0,
            format: csv,
        }
    }
}

impl Sink for Lines {
    fn write(&mut self, _: u64, rows: &[Row<'_>]) -> Result<(), Cause> {
        let (format, is_first) = (self.format, self.length == 0);
        let parts = rows.par_chunks(SOME).enumerate();
        let parts = parts.map(|(k, rows)| format(rows, is_first && k == 0));
        let lines = parts.collect::<io::Result<Vec<_>>>()?.concat();
        if let Err(error) = self.file.write_all(&lines) {
            // Remove the partial frame. If truncating fails too, the file ends with it.
            self.file.set_len(self.length).ok();
            return Err(error.into());
        }
        self.length += lines.len() as u64;
        self.frames += 1;
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Cause> {
        Ok(())
    }

    fn kept(&self) -> u64 {
        self.frames
    }
}

fn text(rows: &[Row<'_>], _: bool) -> io::Result<Vec<u8>> {
    let mut lines = Vec::new();
    for row in rows {
        let Row { id, frame, .. } = row;
        writeln!(lines, "{id}\t{frame}\t{}\t{}\t0", row.pos_x, row.pos_y)?;
    }
    Ok(lines)
}

fn csv(rows: &[Row<'_>], is_first: bool) -> io::Result<Vec<u8>> {
    let mut lines = Vec::new();
    let mut writer = csv::WriterBuilder::new()
        .has_headers(is_first)
        .from_writer(&mut lines);
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush()?;
    drop(writer);
    Ok(lines)
}
