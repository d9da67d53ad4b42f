//! The columns of a line of text.

use super::level::LEVEL;
use super::tracks::Entry;
use super::{UNITS, Unit};
use crate::error::quote::shown;
use engine::math::Vector;

/// Known names of the columns, in lower case; the first is ours. `no`, `simsec` and `coordcentx` are Viswalk's, `t` is
/// Pathfinder's.
const IDS: [&str; 7] = [
    "id",
    "persid",
    "personid",
    "ped_id",
    "pid",
    "pedestrianid",
    "no",
];
const FRAMES: [&str; 4] = ["frame", "fr", "frame_id", "framenr"];
const TIMES: [&str; 3] = ["time", "t", "simsec"];
const XS: [&str; 3] = ["x", "pos_x", "coordcentx"];
const YS: [&str; 3] = ["y", "pos_y", "coordcenty"];
/// Columns of coordinates that are always in meters: those of the sandbox and of Viswalk.
const IN_METERS: [&str; 2] = ["pos_x", "coordcentx"];
/// How Viswalk begins the name of a column.
const VISWALK: &str = "$pedestrian:";

/// The indices of the columns that are read, from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Columns {
    id: usize,
    /// `None`: times number the frames.
    pub frame: Option<usize>,
    x: usize,
    y: usize,
    pub time: Option<usize>,
    /// The unit of times, seconds.
    pub seconds: f64,
    pub mass: Option<usize>,
    pub level: Option<usize>,
}

impl Default for Columns {
    /// id, frame, x, y: the usual order.
    fn default() -> Self {
        Self {
            id: 0,
            frame: Some(1),
            x: 2,
            y: 3,
            time: None,
            seconds: 1.0,
            mass: None,
            level: None,
        }
    }
}

impl Columns {
    /// The columns of a header with these names, and the unit if the header names it. `None` if the header lacks an
    /// id, x, y, or both a frame and a time.
    pub fn named(names: &[&str]) -> Result<Option<(Self, Option<Unit>)>, String> {
        let names: Vec<(String, String)> = names.iter().map(|name| base_and_unit(name)).collect();
        let find = |known: &[&str]| {
            names
                .iter()
                .position(|(base, _)| known.contains(&base.as_str()))
        };
        let ([Some(id), Some(x), Some(y)], frame, time) =
            ([&IDS[..], &XS, &YS].map(find), find(&FRAMES), find(&TIMES))
        else {
            return Ok(None);
        };
        if frame.or(time).is_none() {
            return Ok(None);
        }
        let columns = Self {
            id,
            frame,
            x,
            y,
            time,
            seconds: time.map_or(Ok(1.0), |time| seconds(&names[time].1))?,
            mass: find(&["mass"]),
            level: find(&[LEVEL]),
        };
        let (base, unit) = &names[x];
        let by_name = IN_METERS.contains(&base.as_str()).then_some(Unit::Meter);
        Ok(Some((columns, length(unit)?.or(by_name))))
    }

    /// The unit of the coordinates if these cells are units, as in the second line of Pathfinder's files. Takes that
    /// of the time.
    pub fn units(&mut self, cells: &[&str]) -> Result<Option<Option<Unit>>, String> {
        let cell = |place: usize| cells.get(place).map_or("", |cell| cell.trim());
        let instant = self.frame.or(self.time).unwrap_or(self.x);
        let numbers = [self.x, self.y, instant].map(|place| number(cell(place)));
        if numbers.iter().any(Option::is_some) {
            return Ok(None);
        }
        let Ok(unit) = length(&cell(self.x).to_lowercase()) else {
            return Ok(None); // an invalid number, which `entry` reports
        };
        if let Some(time) = self.time {
            self.seconds = seconds(&cell(time).to_lowercase())?;
        }
        Ok(Some(unit))
    }

    /// Parses one person in one frame, in frame 0 without a column of frames.
    pub fn entry(&self, cells: &[&str], line: u64) -> Result<Entry, String> {
        let whole = |place: usize, what: &str| {
            let text = cell(cells, place, what)?;
            whole(text)
                .ok_or_else(|| format!("the {what} \"{}\" is not a whole number", shown(text)))
        };
        let finite = |place: usize, what: &str| finite(cells, place, what);
        let mass = self.mass.map_or(Ok(1.0), |place| finite(place, "mass"))?;
        Ok(Entry {
            id: whole(self.id, "id")?,
            frame: self.frame.map_or(Ok(0), |place| whole(place, "frame"))?,
            position: Vector::new(finite(self.x, "x")?, finite(self.y, "y")?),
            mass,
            line,
        })
    }

    /// Parses the time, seconds; an error only without a column of frames.
    pub fn time(&self, cells: &[&str]) -> Result<Option<f64>, String> {
        let Some(place) = self.time else {
            return Ok(None);
        };
        let time = match self.frame {
            Some(_) => cells.get(place).and_then(|cell| parsed(cell)),
            None => Some(finite(cells, place, "time")?),
        };
        Ok(time.map(|time| time * self.seconds))
    }
}

fn cell<'a>(cells: &[&'a str], place: usize, what: &str) -> Result<&'a str, String> {
    let (column, count) = (place + 1, cells.len());
    let missing = || format!("{what} belongs in column {column}, and there are only {count}");
    cells.get(place).copied().ok_or_else(missing)
}

fn finite(cells: &[&str], place: usize, what: &str) -> Result<f64, String> {
    let text = cell(cells, place, what)?;
    number(text).ok_or_else(|| format!("{what} is \"{}\", not a finite number", shown(text)))
}

/// The unit of lengths with this name; `None` without a name.
fn length(name: &str) -> Result<Option<Unit>, String> {
    let unit = Unit::named(name);
    match unit.is_none() && !name.is_empty() {
        true => Err(format!(
            "the unit \"{}\" is not known; {} are, or give --unit",
            shown(name),
            UNITS.join(", ")
        )),
        false => Ok(unit),
    }
}

/// The unit of times with this name, seconds.
fn seconds(name: &str) -> Result<f64, String> {
    match name {
        "" | "s" | "sec" | "secs" | "seconds" => Ok(1.0),
        "ms" | "milliseconds" => Ok(1e-3),
        other => Err(format!(
            "the unit \"{}\" of the time is not known; s and ms are",
            shown(other)
        )),
    }
}

/// Splits a column name into its base and its unit: `x/cm`, `x[cm]`, `x(cm)`.
fn base_and_unit(name: &str) -> (String, String) {
    let lower = name.trim_start_matches('\u{feff}').trim().to_lowercase();
    let name = lower.strip_prefix(VISWALK).unwrap_or(&lower);
    let (base, unit) = name.split_once(['/', '[', '(']).unwrap_or((name, ""));
    let unit = unit.trim_end_matches([']', ')']).trim();
    (base.trim().to_owned(), unit.to_owned())
}

/// A number with a decimal point, or with a decimal comma between digits.
fn parsed(text: &str) -> Option<f64> {
    let own = text.parse().ok();
    own.or_else(|| {
        let (whole, rest) = text.split_once(',')?;
        let is_digit = |c: char| c.is_ascii_digit();
        let are_digits = whole.ends_with(is_digit) && rest.starts_with(is_digit);
        let is_comma = are_digits && !whole.contains('.') && !rest.contains(['.', ',']);
        is_comma.then(|| format!("{whole}.{rest}").parse().ok())?
    })
}

/// A finite number.
pub fn number(text: &str) -> Option<f64> {
    parsed(text).filter(|number: &f64| number.is_finite())
}

/// A whole number: 17, but also 17.0, because some programs write all numbers as floats.
fn whole(text: &str) -> Option<i64> {
    text.parse().ok().or_else(|| super::whole(number(text)?))
}

/// The words of a header. A unit in brackets belongs to the word before it.
pub fn words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match words.last_mut() {
            Some(last) if word.starts_with(['[', '(']) => last.push_str(word),
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// The text of the first number after the word framerate.
pub fn frame_rate(comment: &str) -> Option<String> {
    let lower = comment.to_lowercase();
    let after = ["framerate", "frame rate"];
    let rest = after.iter().find_map(|word| lower.split_once(word))?.1;
    let mut words = rest.split(|c: char| c.is_whitespace() || ":=,;()[]".contains(c));
    words.find_map(first_number)
}

/// The text of the number with which a word begins.
fn first_number(word: &str) -> Option<String> {
    if word.parse::<f64>().is_ok() {
        return Some(word.to_owned()); // also `nan` and `inf`
    }
    let is_other = |c: char| !c.is_ascii_digit() && !"+-.e".contains(c);
    let most = word.find(is_other).unwrap_or(word.len()).min(40);
    let mut starts = (1..=most).rev().map(|end| &word[..end]);
    let start = starts.find(|start| start.parse::<f64>().is_ok());
    start.map(str::to_owned)
}
