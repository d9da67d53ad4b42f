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
use std::path::Path;

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
    let rest = std::io::Cursor::new(start).chain(file);
    let is_csv = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    if is_csv {
        text::read_csv(path, rest, options)
    } else {
        text::read_text(path, rest, options)
    }
}
