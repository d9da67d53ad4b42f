//! The columns of a line of text.

use super::Unit;
use super::tracks::Entry;
use crate::engine::math::Vector;
use crate::scenario::quote::shown;

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
            mass: None,
        }
    }
}

impl Columns {
    /// The columns of a header with these names, and the unit if the header names it. `None` if the header lacks an
    /// id, a frame, x or y.
    pub fn named(names: &[&str]) -> Option<Result<(Self, Option<Unit>), String>> {
        let names: Vec<(String, String)> = names.iter().map(|name| base_and_unit(name)).collect();
        let find = |known: &[&str]| {
            names
                .iter()
                .position(|(base, _)| known.contains(&base.as_str()))
        };
        let columns = Self {
            id: find(&IDS)?,
            frame: find(&FRAMES)?,
            x: find(&XS)?,
            y: find(&YS)?,
            time: find(&["time"]),
            mass: find(&["mass"]),
        };
        let unit = match names[columns.x].1.as_str() {
            "" => None,
            name => match Unit::named(name) {
                Some(unit) => Some(unit),
                None => {
                    return Some(Err(format!(
                        "the unit \"{}\" is not known; m and cm are, or give --unit",
                        shown(name)
                    )));
                }
            },
        };
        Some(Ok((columns, unit)))
    }

    /// Parses one person in one frame.
    pub fn entry(&self, cells: &[&str], line: u64) -> Result<Entry, String> {
        let cell = |place: usize, what: &str| {
            let missing = || {
                format!(
                    "{what} belongs in column {}, and there are only {}",
                    place + 1,
                    cells.len()
                )
            };
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
    let exact = text.parse::<f64>().ok();
    let exact = exact.filter(|number| number.fract() == 0.0 && number.abs() <= EXACT);
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
    let is_part = |c: char| c.is_ascii_digit() || "+-.e".contains(c);
    let mut start: String = word.chars().take_while(|&c| is_part(c)).take(40).collect();
    while !start.is_empty() && start.parse::<f64>().is_err() {
        start.pop();
    }
    (!start.is_empty()).then_some(start)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_rates_are_found_as_they_are_written() {
        for (comment, fps) in [
            (" framerate: 10.00", 10.0),
            ("framerate: 16 fps", 16.0),
            (" Framerate = 25", 25.0),
            ("frame rate: 12.5 (camera 3)", 12.5),
            ("framerate=30fps, of 2 cameras", 30.0),
            ("framerate information: 1e1/s", 10.0),
            ("framerate: 1e-300", 1e-300),
            ("framerate: -5", -5.0),
            ("framerate: inf", f64::INFINITY),
        ] {
            let found = frame_rate(comment).map(|text| text.parse().unwrap());
            assert_eq!(found, Some(fps), "{comment}");
        }
        assert_eq!(frame_rate(" framerate: unknown"), None);
        assert_eq!(frame_rate(" 25 frames"), None);
    }

    #[test]
    fn columns_are_where_their_names_say() {
        let header = words("ID\tFR x/cm y/cm z/cm");
        let names: Vec<&str> = header.iter().map(String::as_str).collect();
        let (columns, unit) = Columns::named(&names).unwrap().unwrap();
        assert_eq!(
            (columns, unit),
            (Columns::default(), Some(Unit::Centimeter))
        );
        let (turned, unit) = Columns::named(&["y[m]", "x[m]", "frame", "id"])
            .unwrap()
            .unwrap();
        assert_eq!(unit, Some(Unit::Meter));
        let entry = turned.entry(&["2", "1", "7.0", "3"], 1).unwrap();
        assert_eq!((entry.id, entry.frame), (3, 7));
        assert_eq!(entry.position, Vector::new(1.0, 2.0));
        assert_eq!(words("x [m] y"), ["x[m]", "y"]);
        assert!(Columns::named(&["id:", "the", "agent"]).is_none());
    }
}
