//! The pairs of a group code and a value that a DXF file consists of, as text or in binary form.

use std::fmt;

use super::syntax;
use crate::floor_plan::error::FloorPlanError;

/// How binary files begin.
pub const SENTINEL: &[u8] = b"AutoCAD Binary DXF\r\n\x1a\0";
/// The largest group code.
const LARGEST_CODE: i64 = 1071;
/// Group codes of one byte are followed by the code proper if they have this value.
const EXTENDED: u8 = 255;

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Place {
    is_binary: bool,
    number: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let word = if self.is_binary { "byte" } else { "line" };
        write!(f, "{word} {}", self.number)
    }
}

/// A value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value<'a> {
    /// A text, or a number in a text file.
    Text(&'a [u8]),
    /// A number of a binary file.
    Real(f64),
    /// An integer of a binary file.
    Whole(i64),
}

/// A group code and its value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair<'a> {
    /// What the value means.
    pub code: i32,
    /// The value.
    pub value: Value<'a>,
    /// Where the value is.
    pub at: Place,
}

impl<'a> Pair<'a> {
    /// The bytes of a text, without spaces around it; none for numbers of a binary file.
    pub fn word(&self) -> &'a [u8] {
        match self.value {
            Value::Text(text) => text.trim_ascii(),
            Value::Real(_) | Value::Whole(_) => &[],
        }
    }

    /// Whether the value is this word.
    pub fn is(&self, code: i32, word: &str) -> bool {
        self.code == code && self.word() == word.as_bytes()
    }

    /// The value as a finite number.
    pub fn number(&self) -> Result<f64, FloorPlanError> {
        let number = match self.value {
            Value::Real(number) => Some(number),
            Value::Whole(number) => Some(number as f64),
            Value::Text(text) => parsed(text),
        };
        let finite = number.filter(|number| number.is_finite());
        finite.ok_or_else(|| self.wrong("a number"))
    }

    /// The value as an integer.
    pub fn whole(&self) -> Result<i64, FloorPlanError> {
        let number = self.number()?;
        let is_whole = number.fract() == 0.0 && number.abs() < 1e15;
        let whole = is_whole.then_some(number as i64);
        whole.ok_or_else(|| self.wrong("an integer"))
    }

    fn wrong(&self, expected: &str) -> FloorPlanError {
        let found = match self.value {
            Value::Text(text) => String::from_utf8_lossy(text).trim().to_owned(),
            Value::Real(number) => number.to_string(),
            Value::Whole(number) => number.to_string(),
        };
        syntax(format!(
            "{}: group code {} needs {expected}, found `{found}`; save the drawing again",
            self.at, self.code
        ))
    }
}

fn parsed(text: &[u8]) -> Option<f64> {
    std::str::from_utf8(text).ok()?.trim().parse().ok()
}

/// The pairs of a file, one after the other.
pub struct Pairs<'a> {
    rest: &'a [u8],
    at: Place,
    /// The length of group codes of binary files, bytes.
    code_length: usize,
}

impl<'a> Pairs<'a> {
    /// The pairs of a file.
    pub fn new(bytes: &'a [u8]) -> Self {
        let Some(rest) = bytes.strip_prefix(SENTINEL) else {
            let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            return Self {
                rest,
                at: Place::default(),
                code_length: 0,
            };
        };
        // The first code is 0. The first value begins with a letter.
        let code_length = if rest.get(1) == Some(&0) { 2 } else { 1 };
        let at = Place {
            is_binary: true,
            number: SENTINEL.len(),
        };
        Self {
            rest,
            at,
            code_length,
        }
    }

    /// The next pair that is not a comment; `None` at the end.
    pub fn next(&mut self) -> Result<Option<Pair<'a>>, FloorPlanError> {
        loop {
            let pair = match self.at.is_binary {
                true => self.next_binary()?,
                false => self.next_text()?,
            };
            if pair.is_none_or(|pair| pair.code != 999) {
                return Ok(pair);
            }
        }
    }

    fn next_text(&mut self) -> Result<Option<Pair<'a>>, FloorPlanError> {
        let Some(line) = self.line() else {
            return Ok(None);
        };
        let whole = parsed(line).filter(|code| code.fract() == 0.0);
        let code = whole.map(|code| code as i64);
        let Some(code) = code.filter(|code| (-5..=LARGEST_CODE).contains(code)) else {
            // Spaces and line feeds may follow the last pair.
            let is_end = line.trim_ascii().is_empty() && self.rest.trim_ascii().is_empty();
            if is_end {
                return Ok(None);
            }
            let found = String::from_utf8_lossy(line);
            return Err(syntax(format!(
                "{}: expected a group code (an integer up to {LARGEST_CODE}), found `{}`; the file is damaged: save \
                 the drawing again",
                self.at,
                found.trim()
            )));
        };
        let Some(value) = self.line() else {
            return Err(self.truncated());
        };
        Ok(Some(Pair {
            code: code as i32,
            value: Value::Text(value),
            at: self.at,
        }))
    }

    /// The error of a file that ends too early.
    pub fn truncated(&self) -> FloorPlanError {
        syntax(format!(
            "{}: the file ends before the drawing does; copy or save it again",
            self.at
        ))
    }

    /// The next line without its end, which may be a carriage return alone.
    fn line(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.at.number += 1;
        let mut bytes = self.rest.iter();
        let end = bytes.position(|&byte| byte == b'\n' || byte == b'\r');
        let (line, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        let ends: [&[u8]; 3] = [b"\r\n", b"\n", b"\r"];
        let after = ends.iter().find_map(|end| rest.strip_prefix(*end));
        self.rest = after.unwrap_or_default();
        Some(line)
    }

    fn next_binary(&mut self) -> Result<Option<Pair<'a>>, FloorPlanError> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        let short = match self.code_length {
            1 => i32::from(self.bytes::<1>()?[0]),
            _ => i32::from(i16::from_le_bytes(self.bytes()?)),
        };
        let code = match self.code_length {
            1 if short == i32::from(EXTENDED) => i32::from(i16::from_le_bytes(self.bytes()?)),
            _ => short,
        };
        let at = self.at;
        let value = match code {
            -5..=9
            | 100..=109
            | 300..=309
            | 320..=369
            | 390..=399
            | 410..=419
            | 430..=439
            | 470..=481
            | 999..=1003
            | 1005..=1009 => Value::Text(self.string()?),
            10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => {
                Value::Real(f64::from_le_bytes(self.bytes()?))
            }
            60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => {
                Value::Whole(i64::from(i16::from_le_bytes(self.bytes()?)))
            }
            90..=99 | 420..=429 | 440..=459 | 1071 => {
                Value::Whole(i64::from(i32::from_le_bytes(self.bytes()?)))
            }
            160..=169 => Value::Whole(i64::from_le_bytes(self.bytes()?)),
            290..=299 => Value::Whole(i64::from(self.bytes::<1>()?[0])),
            310..=319 | 1004 => {
                let length = usize::from(self.bytes::<1>()?[0]);
                Value::Text(self.take(length)?)
            }
            _ => {
                return Err(syntax(format!(
                    "{at}: group code {code} is unknown; the file is damaged: save the drawing again"
                )));
            }
        };
        Ok(Some(Pair { code, value, at }))
    }

    fn take(&mut self, length: usize) -> Result<&'a [u8], FloorPlanError> {
        let Some((taken, rest)) = self.rest.split_at_checked(length) else {
            return Err(self.truncated());
        };
        self.rest = rest;
        self.at.number += length;
        Ok(taken)
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], FloorPlanError> {
        let taken = self.take(N)?;
        taken.try_into().map_err(|_| self.truncated())
    }

    /// A text that ends with a zero byte.
    fn string(&mut self) -> Result<&'a [u8], FloorPlanError> {
        let end = self.rest.iter().position(|&byte| byte == 0);
        let text = self.take(end.unwrap_or(self.rest.len()))?;
        self.take(1)?;
        Ok(text)
    }
}
