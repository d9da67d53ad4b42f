//! The columns of a line of text.

use super::Unit;
use super::tracks::Entry;
use crate::error::quote::shown;
use engine::math::Vector;

/// Known names of the columns, in lower case; the first is ours.
const IDS: [&str; 5] = ["id", "persid", "personid", "ped_id", "pid"];
const FRAMES: [&str; 4] = ["frame", "fr", "frame_id", "framenr"];
const XS: [&str; 2] = ["x", "pos_x"];
const YS: [&str; 2] = ["y", "pos_y"];

/// The indices of the columns that are read, from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Columns {
    id: usize,
    frame: usize,
    x: usize,
    y: usize,
    pub time: Option<usize>,
    /// The unit of times, seconds.
    pub seconds: f64,
    pub mass: Option<usize>,
}

impl Default for Columns {
    /// id, frame, x, y: the usual order.
    fn default() -> Self {
        Self {
            id: 0,
            frame: 1,
            x: 2,
            y: 3,
            time: None,
            seconds: 1.0,
            mass: None,
        }
    }
}

impl Columns {
    /// The columns of a header with these names, and the unit if the header names it. `None` if the header lacks an
    /// id, a frame, x or y.
    pub fn named(names: &[&str]) -> Result<Option<(Self, Option<Unit>)>, String> {
        let names: Vec<(String, String)> = names.iter().map(|name| base_and_unit(name)).collect();
        let find = |known: &[&str]| {
            names
                .iter()
                .position(|(base, _)| known.contains(&base.as_str()))
        };
        let [Some(id), Some(frame), Some(x), Some(y)] = [&IDS[..], &FRAMES, &XS, &YS].map(find)
        else {
            return Ok(None);
        };
        let time = find(&["time"]);
        let seconds = match time.map_or("", |time| names[time].1.as_str()) {
            "" | "s" | "sec" | "secs" | "seconds" => 1.0,
            "ms" | "milliseconds" => 1e-3,
            other => {
                return Err(format!(
                    "the unit \"{}\" of the time is not known; s and ms are",
                    shown(other)
                ));
            }
        };
        let columns = Self {
            id,
            frame,
            x,
            y,
            time,
            seconds,
            mass: find(&["mass"]),
        };
        let name = names[x].1.as_str();
        let unit = Unit::named(name);
        if unit.is_none() && !name.is_empty() {
            return Err(format!(
                "the unit \"{}\" is not known; m and cm are, or give --unit",
                shown(name)
            ));
        }
        Ok(Some((columns, unit)))
    }

    /// Parses one person in one frame.
    pub fn entry(&self, cells: &[&str], line: u64) -> Result<Entry, String> {
        let cell = |place: usize, what: &str| {
            let (column, count) = (place + 1, cells.len());
            let missing =
                || format!("{what} belongs in column {column}, and there are only {count}");
            cells.get(place).copied().ok_or_else(missing)
        };
        let whole = |place: usize, what: &str| {
            let text = cell(place, what)?;
            whole(text)
                .ok_or_else(|| format!("the {what} \"{}\" is not a whole number", shown(text)))
        };
        let finite = |place: usize, what: &str| {
            let text = cell(place, what)?;
            let number = text.parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| format!("{what} is \"{}\", not a finite number", shown(text)))
        };
        let mass = self.mass.map_or(Ok(1.0), |place| finite(place, "mass"))?;
        Ok(Entry {
            id: whole(self.id, "id")?,
            frame: whole(self.frame, "frame")?,
            position: Vector::new(finite(self.x, "x")?, finite(self.y, "y")?),
            mass,
            line,
        })
    }
}

/// Splits a column name into its base and its unit: `x/cm`, `x[cm]`, `x(cm)`.
fn base_and_unit(name: &str) -> (String, String) {
    let name = name.trim().to_lowercase();
    let (base, unit) = name.split_once(['/', '[', '(']).unwrap_or((&name, ""));
    let unit = unit.trim_end_matches([']', ')']).trim();
    (base.trim().to_owned(), unit.to_owned())
}

/// A whole number: 17, but also 17.0, because some programs write all numbers as floats.
fn whole(text: &str) -> Option<i64> {
    const EXACT: f64 = (1_i64 << 53) as f64;
    let number = text.parse::<f64>().ok();
    let exact = number.filter(|number| number.fract() == 0.0 && number.abs() <= EXACT);
    text.parse().ok().or(exact.map(|number| number as i64))
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
    words.find_map(number)
}

/// The text of the number with which a word begins.
fn number(word: &str) -> Option<String> {
    if word.parse::<f64>().is_ok() {
        return Some(word.to_owned()); // also `nan` and `inf`
    }
    let is_other = |c: char| !c.is_ascii_digit() && !"+-.e".contains(c);
    let most = word.find(is_other).unwrap_or(word.len()).min(40);
    let mut starts = (1..=most).rev().map(|end| &word[..end]);
    let start = starts.find(|start| start.parse::<f64>().is_ok());
    start.map(str::to_owned)
}
