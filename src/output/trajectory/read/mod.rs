//! Trajectories of other programs, of cameras and of our own: read, checked and put in order.
//!
//! | file | from | what is read |
//! |---|---|---|
//! | SQLite | JuPedSim 1 and 2, the sandbox | `trajectory_data`, `fps`, the walkable area, `mass` if there |
//! | `.csv` | the sandbox, anybody | by their names: `id`, `frame`, `x` and `y` or `pos_x` and `pos_y`; `time`, `mass` |
//! | other text | PeTrack, Pedestrian Dynamics Data Archive | `id frame x y`, or as the header names them |
//!
//! Metres and seconds from then on. Frame f is at the time f / fps.

mod error;
mod line;
mod sqlite;
mod text;
mod tracks;

pub use error::ReadError;
pub use tracks::Tracks;

use std::fs::File;
use std::io::Read;
use std::ops::RangeInclusive;
use std::path::Path;

use crate::scenario::quote::shown;

/// Frames per second that a trajectory may have.
pub const FRAME_RATES: RangeInclusive<f64> = 1e-6..=1e6;

/// What coordinates in a file count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Metres.
    Metre,
    /// Centimetres.
    Centimetre,
}

impl Unit {
    /// Its length in metres.
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
        }
    }

    /// The unit of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "m" => Some(Self::Metre),
            "cm" => Some(Self::Centimetre),
            _ => None,
        }
    }
}

/// What a file may not say itself; it wins over what the file says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReadOptions {
    /// The unit of the coordinates.
    pub unit: Option<Unit>,
    /// Frames per second, above 0.
    pub fps: Option<f64>,
}

impl ReadOptions {
    /// A file's own frame rate; a bad one does not matter where another one is given.
    fn own_rate(&self, rate: Result<f64, String>) -> Result<Option<f64>, String> {
        match rate {
            Err(_) if self.fps.is_some() => Ok(None),
            rate => rate.map(Some),
        }
    }
}

/// Reads the trajectories in a file, whatever its format.
///
/// # Errors
/// The file cannot be read, or something in it makes no sense: the error names the line and the fix.
pub fn read(path: &Path, options: &ReadOptions) -> Result<Tracks, ReadError> {
    let unopened =
        |error: std::io::Error| ReadError::file(path, format!("cannot be read: {error}"));
    let mut file = File::open(path).map_err(unopened)?;
    let mut start = Vec::new();
    let magic = b"SQLite format 3\0";
    let head = file.by_ref().take(magic.len() as u64);
    { head }.read_to_end(&mut start).map_err(unopened)?;
    if start == magic {
        return sqlite::read(path, options);
    }
    read_text(path, Read::chain(start.as_slice(), file), options)
}

/// Reads the trajectories in a text; `path` is what messages call it, and its extension tells the format.
///
/// # Errors
/// As [`read`].
pub fn read_text(path: &Path, text: impl Read, options: &ReadOptions) -> Result<Tracks, ReadError> {
    let is_csv = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    if is_csv {
        text::read_csv(path, text, options)
    } else {
        text::read_text(path, text, options)
    }
}

/// A frame rate that a file gives, as it stands there, if one can be.
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
