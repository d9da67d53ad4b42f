//! The files in a zip archive.
//!
//! Only what programs write for small files is read: stored and deflated entries, at most 4 GiB, in one part.

use miniz_oxide::inflate::decompress_to_vec_with_limit;

/// Most bytes that the files of an archive have together.
const LARGEST: usize = 1 << 28;
/// The beginnings of archives: of one with files, and of an empty one.
const STARTS: [&[u8]; 2] = [b"PK\x03\x04", END];
/// The beginnings of the records: of an entry in the directory, and of the end of the directory.
const ENTRY: &[u8] = b"PK\x01\x02";
const END: &[u8] = b"PK\x05\x06";
/// The lengths of the records without names and comments, bytes.
const LOCAL_LENGTH: usize = 30;
const ENTRY_LENGTH: usize = 46;
const END_LENGTH: usize = 22;
/// The longest comment of an archive, bytes.
const LONGEST_COMMENT: usize = 0xffff;
/// The bit of encrypted entries.
const ENCRYPTED: usize = 1;

/// A file in an archive.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Its path in the archive.
    pub name: String,
    /// Its length, bytes.
    length: usize,
    packed: usize,
    method: usize,
    flags: usize,
    checksum: u32,
    /// Where its local record begins.
    at: usize,
}

/// Whether a file with this beginning is a zip archive.
pub fn is_archive(start: &[u8]) -> bool {
    STARTS.iter().any(|known| start.starts_with(known))
}

/// The files in an archive, without folders and what macOS adds.
///
/// # Errors
/// The archive is cut off or damaged, or its files are too large together.
pub fn entries(archive: &[u8]) -> Result<Vec<Entry>, String> {
    let damaged = || "the zip archive is cut off or damaged".to_owned();
    let from = archive.len().saturating_sub(END_LENGTH + LONGEST_COMMENT);
    let tail = &archive[from..];
    let in_tail = tail.windows(END.len()).rposition(|bytes| bytes == END);
    let end = from + in_tail.ok_or_else(damaged)?;
    let count = number(archive, end + 10, 2).ok_or_else(damaged)?;
    let mut at = number(archive, end + 16, 4).ok_or_else(damaged)?;
    let (mut entries, mut total) = (Vec::new(), 0_usize);
    for _ in 0..count {
        let (entry, next) = entry(archive, at).ok_or_else(damaged)?;
        at = next;
        total = total.saturating_add(entry.length);
        let is_hidden = entry.name.split('/').any(|part| part.starts_with('.'));
        if !entry.name.ends_with('/') && !entry.name.starts_with("__MACOSX/") && !is_hidden {
            entries.push(entry);
        }
    }
    match total > LARGEST {
        true => Err(too_large(total)),
        false => Ok(entries),
    }
}

fn too_large(total: usize) -> String {
    format!("its files have {total} bytes; at most {LARGEST} are unpacked")
}

/// The entry of the directory at a place, and where the next one begins.
fn entry(archive: &[u8], at: usize) -> Option<(Entry, usize)> {
    if archive.get(at..)?.get(..ENTRY.len())? != ENTRY {
        return None;
    }
    let field = |offset, length| number(archive, at + offset, length);
    let [name, extra, comment] = [field(28, 2)?, field(30, 2)?, field(32, 2)?];
    let first = at + ENTRY_LENGTH;
    let entry = Entry {
        name: String::from_utf8_lossy(archive.get(first..first + name)?).into_owned(),
        length: field(24, 4)?,
        packed: field(20, 4)?,
        method: field(10, 2)?,
        flags: field(8, 2)?,
        checksum: field(16, 4)? as u32,
        at: field(42, 4)?,
    };
    Some((entry, first + name + extra + comment))
}

/// The little-endian number of `length` bytes at a place.
fn number(bytes: &[u8], at: usize, length: usize) -> Option<usize> {
    let field = bytes.get(at..at.checked_add(length)?)?;
    let digits = field.iter().rev();
    Some(digits.fold(0, |sum, &byte| sum << 8 | usize::from(byte)))
}

impl Entry {
    /// Unpacks the file.
    ///
    /// # Errors
    /// It is encrypted, packed by another method, or damaged.
    pub fn content(&self, archive: &[u8]) -> Result<Vec<u8>, String> {
        let damaged = || "is cut off or damaged in the zip archive".to_owned();
        if self.flags & ENCRYPTED != 0 {
            return Err("is encrypted; save the archive without a password".to_owned());
        }
        let field = |offset| number(archive, self.at.checked_add(offset)?, 2);
        let [name, extra] = [26, 28].map(field);
        let first =
            self.at + LOCAL_LENGTH + name.ok_or_else(damaged)? + extra.ok_or_else(damaged)?;
        let end = first.checked_add(self.packed).ok_or_else(damaged)?;
        let packed = archive.get(first..end).ok_or_else(damaged)?;
        let content = match self.method {
            0 => packed.to_vec(),
            8 => decompress_to_vec_with_limit(packed, self.length).map_err(|_| damaged())?,
            other => {
                return Err(format!(
                    "is packed by method {other}; only stored and deflated files are read"
                ));
            }
        };
        match content.len() == self.length && checksum(&content) == self.checksum {
            true => Ok(content),
            false => Err(damaged()),
        }
    }
}

/// The CRC-32 of some bytes.
fn checksum(bytes: &[u8]) -> u32 {
    const POLYNOMIAL: u32 = 0xedb8_8320;
    let with_bit = |sum: u32, _| (sum >> 1) ^ (POLYNOMIAL & (sum & 1).wrapping_neg());
    let with_byte = |sum: u32, &byte: &u8| (0..8).fold(sum ^ u32::from(byte), with_bit);
    !bytes.iter().fold(!0, with_byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_zip() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
        assert_eq!(checksum(b""), 0);
    }

    #[test]
    fn no_beginning_of_an_archive_panics() {
        let mut archive = b"PK\x03\x04".to_vec();
        archive.extend([0xff; 60]);
        archive.extend(END);
        archive.extend([0xff; 18]);
        for length in 0..archive.len() {
            assert!(entries(&archive[..length]).is_err());
        }
        assert!(entries(&archive).is_err());
    }
}
