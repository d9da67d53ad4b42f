//! Reading whole files and lines, with limits on their length.

pub mod archive;
mod letters;

pub use letters::Letters;

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result};
use std::path::Path;
use std::sync::OnceLock;

use serde::Deserialize;

/// Longest text that is read, bytes. A scenario with ten million corners takes 200 MB.
pub const LONGEST_TEXT: u64 = 1 << 28;
/// Approximate limit on the length of a line, bytes.
pub const LONGEST_LINE: u64 = 1 << 20;

/// Reads a whole file.
///
/// # Errors
/// The file cannot be read, or has more than `most` bytes.
pub fn bytes(path: &Path, most: u64) -> Result<Vec<u8>> {
    rest(File::open(path)?, most)
}

/// The value of a JSON file that is built into the program.
///
/// # Panics
/// The file is not valid; tests read all of them.
pub fn embedded<T: Deserialize<'static>>(file: &str, text: &'static str) -> T {
    serde_json::from_str(text)
        .unwrap_or_else(|error| panic!("{file}, which is built into the program: {error}"))
}

/// Reads a whole text file in UTF-8 or UTF-16, without a byte-order mark.
///
/// # Errors
/// The file cannot be read, has more than [`LONGEST_TEXT`] bytes, or is not text.
pub fn text(path: &Path) -> Result<String> {
    text_of(bytes(path, LONGEST_TEXT)?)
}

/// The path that stands for the standard input.
const STANDARD_INPUT: &str = "-";

/// Whether a path stands for the standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path.as_os_str() == STANDARD_INPUT
}

/// The text of the standard input, which is read once, without a byte-order mark.
///
/// # Errors
/// As [`text`].
pub fn standard_input() -> Result<String> {
    static READ: OnceLock<std::result::Result<String, (ErrorKind, String)>> = OnceLock::new();
    let read = READ.get_or_init(|| {
        let read = rest(std::io::stdin(), LONGEST_TEXT).and_then(text_of);
        read.map_err(|error| (error.kind(), error.to_string()))
    });
    read.clone().map_err(|(kind, said)| Error::new(kind, said))
}

/// The text of a file's content, without a byte-order mark; UTF-16 becomes UTF-8.
///
/// # Errors
/// It is neither UTF-8 nor UTF-16.
pub fn text_of(bytes: Vec<u8>) -> Result<String> {
    if let Some(other) = other_than_text(&bytes) {
        return Err(Error::new(ErrorKind::InvalidData, other));
    }
    let letters = rest(Letters::new(bytes.as_slice()), u64::MAX - 1)?;
    let not_text = |_| Error::new(ErrorKind::InvalidData, "not UTF-8 text; save it as UTF-8");
    String::from_utf8(letters).map_err(not_text)
}

/// What a file is that is neither UTF-8 nor UTF-16 text, if its beginning says so.
pub fn other_than_text(start: &[u8]) -> Option<&'static str> {
    match start {
        [0x1f, 0x8b, ..] => Some("a file compressed by gzip, not text; unpack it"),
        [b'P', b'K', 3, 4, ..] => Some("a zip archive, not text; unpack it"),
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => Some("UTF-32 text; save it as UTF-8"),
        _ => None,
    }
}

/// Reads the rest of a file.
///
/// # Errors
/// The file cannot be read, or the rest has more than `most` bytes.
pub fn rest(file: impl Read, most: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let reason = format!("longer than {most} bytes");
        return Err(Error::new(ErrorKind::FileTooLarge, reason));
    }
    Ok(bytes)
}

/// A reader that fails after about [`LONGEST_LINE`] bytes unless [`next_line`](Self::next_line) is called in
/// between. Under a buffered line reader it bounds the memory that an endless line can take. Lines that end with a
/// carriage return alone, as the first ones show, end with a line feed instead.
pub struct Lines<R> {
    file: R,
    left: u64,
    /// Whether lines end with carriage returns alone; `None` before the end of a line.
    returns: Option<bool>,
}

impl<R: Read> Lines<R> {
    /// Wraps a file.
    pub fn new(file: R) -> Self {
        Self {
            file,
            left: LONGEST_LINE,
            returns: None,
        }
    }

    /// Restarts the count: a line was complete.
    pub fn next_line(&mut self) {
        self.left = LONGEST_LINE;
    }
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        if self.left == 0 {
            let reason = format!("the line is longer than {LONGEST_LINE} bytes");
            return Err(Error::new(ErrorKind::FileTooLarge, reason));
        }
        let most = buffer.len().min(self.left as usize);
        let read = self.file.read(&mut buffer[..most])?;
        self.left -= read as u64;
        let bytes = &mut buffer[..read];
        let [has_return, has_feed] = [b'\r', b'\n'].map(|end| bytes.contains(&end));
        if self.returns.is_none() && (has_return || has_feed) {
            self.returns = Some(!has_feed);
        }
        if self.returns == Some(true) {
            let ends = bytes.iter_mut().filter(|byte| **byte == b'\r');
            ends.for_each(|byte| *byte = b'\n');
        }
        Ok(read)
    }
}
