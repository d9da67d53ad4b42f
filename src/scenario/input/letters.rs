//! Texts in UTF-16, and texts that begin with a byte-order mark.

use std::io::{Error, ErrorKind, Read, Result};

/// Bytes that are converted at a time.
const CHUNK: usize = 1 << 16;

/// The encoding of a text, by its byte-order mark.
#[derive(Clone, Copy)]
enum Encoding {
    Utf8,
    Utf16LittleEndian,
    Utf16BigEndian,
}

/// A reader of text in UTF-8 or UTF-16, which gives UTF-8 without a byte-order mark. UTF-16 is known by its mark.
pub struct Letters<R> {
    file: R,
    /// `None` before the first byte.
    encoding: Option<Encoding>,
    /// Text in UTF-8, read and converted, but not yet taken.
    ready: Vec<u8>,
    /// The part of `ready` that is taken.
    taken: usize,
    /// Bytes of an incomplete letter of UTF-16.
    rest: Vec<u8>,
}

impl<R: Read> Letters<R> {
    /// Wraps a file at its beginning.
    pub fn new(file: R) -> Self {
        Self {
            file,
            encoding: None,
            ready: Vec::new(),
            taken: 0,
            rest: Vec::new(),
        }
    }

    /// Reads the byte-order mark, if there is one.
    fn begin(&mut self) -> Result<Encoding> {
        let mut start = Vec::new();
        Read::take(&mut self.file, 3).read_to_end(&mut start)?;
        let (encoding, mark) = match start[..] {
            [0xef, 0xbb, 0xbf] => (Encoding::Utf8, 3),
            [0xff, 0xfe, ..] => (Encoding::Utf16LittleEndian, 2),
            [0xfe, 0xff, ..] => (Encoding::Utf16BigEndian, 2),
            _ => (Encoding::Utf8, 0),
        };
        let bytes = start.split_off(mark);
        match encoding {
            Encoding::Utf8 => self.ready = bytes,
            _ => self.rest = bytes,
        }
        self.encoding = Some(encoding);
        Ok(encoding)
    }

    /// Fills a buffer, or reads to the end: a first read has the beginning of the text, not a few bytes.
    fn fill(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let mut read = 0;
        while read < buffer.len() {
            match self.file.read(&mut buffer[read..]) {
                Ok(0) => break,
                Ok(more) => read += more,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(read)
    }

    /// Converts the next chunk of UTF-16. Returns whether there was one.
    fn convert(&mut self, number: fn([u8; 2]) -> u16) -> Result<bool> {
        let broken = |what: &str| Error::new(ErrorKind::InvalidData, format!("UTF-16 text {what}"));
        let read = Read::take(&mut self.file, CHUNK as u64).read_to_end(&mut self.rest)?;
        if read == 0 && self.rest.is_empty() {
            return Ok(false);
        }
        let pairs = self.rest.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let mut numbers: Vec<u16> = pairs.map(number).collect();
        // The second half of a letter may be in the next chunk.
        let is_half = read > 0 && matches!(numbers.last(), Some(0xd800..=0xdbff));
        numbers.truncate(numbers.len() - usize::from(is_half));
        self.rest.drain(..2 * numbers.len());
        if read == 0 && !self.rest.is_empty() {
            return Err(broken("ends within a letter"));
        }
        let text = String::from_utf16(&numbers).map_err(|_| broken("with a broken letter"))?;
        (self.ready, self.taken) = (text.into_bytes(), 0);
        Ok(true)
    }
}

impl<R: Read> Read for Letters<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let encoding = match self.encoding {
            Some(encoding) => encoding,
            None => self.begin()?,
        };
        while self.taken == self.ready.len() {
            let more = match encoding {
                Encoding::Utf8 => return self.fill(buffer),
                Encoding::Utf16LittleEndian => self.convert(u16::from_le_bytes)?,
                Encoding::Utf16BigEndian => self.convert(u16::from_be_bytes)?,
            };
            if !more {
                return Ok(0);
            }
        }
        let mut read = (&self.ready[self.taken..]).read(buffer)?;
        self.taken += read;
        if matches!(encoding, Encoding::Utf8) {
            read += self.fill(&mut buffer[read..])?;
        }
        Ok(read)
    }
}
