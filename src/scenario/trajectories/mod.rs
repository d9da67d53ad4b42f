//! Reads, checks and sorts trajectories from other programs, from video tracking and from the sandbox.
//!
//! | file | from | what is read |
//! |---|---|---|
//! | SQLite | JuPedSim 1 and 2, the sandbox | `trajectory_data`, `fps`, the walkable area, `mass` if present |
//! | HDF5 | Pedestrian Dynamics Data Archive, PedPy | dataset `trajectory`, its `fps`, `wkt_geometry` |
//! | text with `,` or `;` | the sandbox, Pathfinder, Viswalk, others | by name: `id`, `frame` or `time`, `x`, `y`, `mass` |
//! | text with blanks | PeTrack, Pedestrian Dynamics Data Archive | `id frame x y`, or by the names in a header |
//! | text with eight columns | ETH and UCY, `obsmat.txt` | frame, id, x, z, y, velocities |
//!
//! Results are in meters and seconds. Frame f is at the time f / fps. A person's rows are a number of frames apart, and
//! people may have frames of their own: [`Tracks::together`] has all people in the same frames. Of a building, the
//! people on one level are read.

mod columns;
mod error;
#[cfg(feature = "program")]
mod hdf5;
mod jumps;
mod level;
mod line;
mod order;
mod places;
mod rows;
#[cfg(feature = "program")]
mod sqlite;
mod steps;
mod text;
mod times;
mod together;
mod tracks;
mod unit;

pub use columns::{Column, columns};
pub use error::ReadError;
pub use level::{OnLevel, one_word};
pub use tracks::{TOO_FAST, Tracks};
pub use unit::{UNITS, Unit};

use std::fs::File;
use std::io::Read;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::error::quote::shown;
use crate::input::other_than_text;

/// The endings of trajectory files. A command that reads scenarios, too, tells both apart by them; others read files
/// of any name.
pub const ENDINGS: [&str; 7] = ["sqlite", "db", "h5", "hdf5", "csv", "txt", "pp"];

/// The first bytes of an SQLite file.
const SQLITE_MAGIC: &[u8] = b"SQLite format 3\0";
/// The first bytes of an HDF5 file.
const HDF5_MAGIC: &[u8] = b"\x89HDF\r\n\x1a\n";
/// The first bytes of a Rerun recording.
const RECORDING_MAGIC: &[u8] = b"RRF";

/// Valid frame rates, frames per second.
pub const FRAME_RATES: RangeInclusive<f64> = 1e-6..=1e6;

/// Information that a file may lack; it takes precedence over the file's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReadOptions {
    /// The unit of the coordinates.
    pub unit: Option<Unit>,
    /// Frames per second, above 0.
    pub fps: Option<f64>,
    /// The level of a building.
    pub level: OnLevel,
}

impl ReadOptions {
    /// Filters the file's own frame rate: an invalid rate is ignored if `fps` is given.
    fn own_rate(&self, rate: Result<f64, String>) -> Result<Option<f64>, String> {
        match rate {
            Err(_) if self.fps.is_some() => Ok(None),
            rate => rate.map(Some),
        }
    }
}

/// The formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Sqlite,
    Hdf5,
    Csv,
    Text,
}

impl Format {
    /// The format of a file, by the bytes with which it starts; that of a text by its ending.
    fn of(path: &Path, start: &[u8]) -> Self {
        let extension = path.extension().unwrap_or_default();
        if start.starts_with(SQLITE_MAGIC) {
            Self::Sqlite
        } else if start.starts_with(HDF5_MAGIC) {
            Self::Hdf5
        } else if extension.eq_ignore_ascii_case("csv") {
            Self::Csv
        } else {
            Self::Text
        }
    }
}

/// Whether the name of a file has one of [`ENDINGS`].
pub fn has_ending(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    let mut endings = ENDINGS.iter();
    endings.any(|ending| extension.eq_ignore_ascii_case(ending))
}

/// [`ENDINGS`] for a sentence.
pub fn endings() -> String {
    ENDINGS.map(|ending| format!(".{ending}")).join(", ")
}

/// Opens a file and reads the bytes with which it starts.
fn open(path: &Path) -> Result<(File, Vec<u8>), ReadError> {
    let begun = || -> std::io::Result<(File, Vec<u8>)> {
        let (mut file, mut start) = (File::open(path)?, Vec::new());
        let head = file.by_ref().take(SQLITE_MAGIC.len() as u64);
        { head }.read_to_end(&mut start)?;
        Ok((file, start))
    };
    begun().map_err(|error| ReadError::file(path, format!("cannot be read: {error}")))
}

/// Reads the trajectories in a file, whatever its format.
///
/// # Errors
/// The file cannot be read, or its content is invalid. The error names the line and a fix.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Tracks, ReadError> {
    let (file, start) = open(path)?;
    if start.starts_with(b"{") {
        return Err(ReadError::file(
            path,
            "JSON, which has no trajectories: run a scenario with --trajectory FILE, and give that file",
        ));
    }
    if start.starts_with(RECORDING_MAGIC) {
        return Err(ReadError::file(
            path,
            "a recording has no trajectories to read; run its scenario again with --trajectory FILE",
        ));
    }
    if let Some(other) = other_than_text(&start) {
        return Err(ReadError::file(path, other));
    }
    match Format::of(path, &start) {
        #[cfg(feature = "program")]
        Format::Sqlite => sqlite::read(path, options),
        #[cfg(feature = "program")]
        Format::Hdf5 => hdf5::read(path, options),
        #[cfg(not(feature = "program"))]
        Format::Sqlite => Err(ReadError::file(
            path,
            "a SQLite file, which is read with the feature `program` only; convert it to CSV",
        )),
        #[cfg(not(feature = "program"))]
        Format::Hdf5 => Err(ReadError::file(
            path,
            "an HDF5 file, which is read with the feature `program` only; convert it to CSV",
        )),
        Format::Csv | Format::Text => read_text(path, Read::chain(start.as_slice(), file), options),
    }
}

/// Reads the trajectories in a text. Messages name `path`, whose ending says what separates columns if the text does
/// not.
///
/// # Errors
/// Same as [`read`].
pub fn read_text(path: &Path, text: impl Read, options: &ReadOptions) -> Result<Tracks, ReadError> {
    text::read(path, text, Format::of(path, b"") == Format::Csv, options)
}

/// A whole number that some programs write as a floating-point number, which is exact up to 2^53.
fn whole(number: f64) -> Option<i64> {
    let is_whole = number.fract() == 0.0 && number.abs() <= tracks::LAST_FRAME as f64;
    is_whole.then_some(number as i64)
}

/// Parses the frame rate of a file and checks its range.
fn frame_rate(text: &str) -> Result<f64, String> {
    let fps = text.parse().ok().filter(|fps| FRAME_RATES.contains(fps));
    fps.ok_or_else(|| {
        let (least, most) = (FRAME_RATES.start(), FRAME_RATES.end());
        format!(
            "the frame rate \"{}\" is not a number between {least:e} and {most:e}; give --fps",
            shown(text)
        )
    })
}
