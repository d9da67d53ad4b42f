//! The unit of a drawing, and the shift that brings it near the origin.

use super::map::Point;
use super::syntax;
use crate::error::quote::to_centimeters;
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::units::{UNITS, Unit};

/// What a drawing may be in, likely units first.
const GUESSES: [&str; 3] = ["m", "mm", "cm"];
/// Sizes that a plan may have, meters.
const PLAUSIBLE: [f64; 2] = [1.0, 5000.0];
/// Sizes that most plans have, meters.
const TYPICAL: [f64; 2] = [5.0, 500.0];
/// Plans with larger coordinates are moved, meters.
const FAR: f64 = 2000.0;

/// The corners of a rectangle around points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// The smallest coordinates.
    pub low: Point,
    /// The largest coordinates.
    pub high: Point,
}

impl Extent {
    /// The rectangle around points; `None` without points.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Point>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = *points.next()?;
        let start = Self {
            low: first,
            high: first,
        };
        Some(points.fold(start, |extent, p| Self {
            low: [0, 1].map(|k| extent.low[k].min(p[k])),
            high: [0, 1].map(|k| extent.high[k].max(p[k])),
        }))
    }

    fn size(&self) -> Point {
        [0, 1].map(|k| self.high[k] - self.low[k])
    }

    fn length(&self) -> f64 {
        let [width, height] = self.size();
        width.max(height)
    }
}

fn is_within(range: [f64; 2], length: f64) -> bool {
    range[0] <= length && length <= range[1]
}

/// The unit of a drawing of this extent, and a note on it unless the header says meters: the unit that is asked for,
/// else the one of the header, if the size is plausible, else the likeliest one.
///
/// # Errors
/// The unit that is asked for is unknown, or no unit gives a plausible size.
pub fn unit(
    asked: Option<&str>,
    number: i64,
    extent: &Extent,
) -> Result<(Unit, Option<String>), FloorPlanError> {
    if let Some(name) = asked {
        return Ok((Unit::named(name)?, None));
    }
    let length = extent.length();
    let of_header = UNITS.into_iter().find(|unit| unit.number == number);
    if let Some(unit) = of_header.filter(|unit| is_within(PLAUSIBLE, length * unit.length)) {
        let note = format!(
            "{}, as the header says: {}",
            unit.plural,
            size(extent, unit)
        );
        return Ok((unit, (unit.name != "m").then_some(note)));
    }
    let guesses = GUESSES
        .into_iter()
        .filter_map(|name| Unit::named(name).ok());
    let likely = guesses
        .clone()
        .find(|unit| is_within(TYPICAL, length * unit.length));
    let guess = likely.or_else(|| {
        let mut guesses = guesses;
        guesses.find(|unit| is_within(PLAUSIBLE, length * unit.length))
    });
    let why = match of_header {
        Some(unit) => format!(
            "the header says {}, which would be {}",
            unit.plural,
            size(extent, unit)
        ),
        None => "the header names no unit".to_owned(),
    };
    let Some(unit) = guess else {
        let [width, height] = extent.size();
        return Err(syntax(format!(
            "{why}, and the plan is {width} by {height} units in size: neither meters, centimeters nor millimeters \
             are plausible; give `plan.unit`"
        )));
    };
    let note = format!(
        "taken as {}, {}: {why}; `plan.unit` says otherwise",
        unit.plural,
        size(extent, unit)
    );
    Ok((unit, Some(note)))
}

fn size(extent: &Extent, unit: Unit) -> String {
    let [width, height] = extent.size().map(|length| rounded(length * unit.length));
    format!("{width} by {height} m")
}

/// A length in messages: to centimeters, or with three digits if it is shorter.
fn rounded(length: f64) -> f64 {
    if length >= 0.1 {
        return to_centimeters(length);
    }
    (1e5 * length).round() / 1e5
}

/// From the coordinates of a drawing to meters near the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The length of the unit, meters.
    pub unit: f64,
    /// What is subtracted then, meters.
    pub origin: Point,
}

impl Frame {
    /// The frame of a plan whose built shapes have one extent and all shapes another one. Its origin is the one that is
    /// `asked` for.
    pub fn new(unit: Unit, built: &Extent, all: &Extent, asked: Option<Point>) -> Self {
        let coordinates = all.low.iter().chain(&all.high);
        let farthest = coordinates.fold(0.0, |far: f64, x| far.max((x * unit.length).abs()));
        let near = match farthest > FAR {
            true => built.low.map(|x| (x * unit.length).floor()),
            false => [0.0, 0.0],
        };
        let origin = asked.unwrap_or(near);
        Self {
            unit: unit.length,
            origin,
        }
    }

    /// A point in meters.
    pub fn at(&self, p: Point) -> Point {
        [0, 1].map(|k| p[k] * self.unit - self.origin[k])
    }

    /// A note on the shift, if there is one.
    pub fn note(&self) -> Option<String> {
        let [x, y] = self.origin.map(|x| 0.0 - x);
        (self.origin != [0.0, 0.0])
            .then(|| format!("moved by ({x}, {y}) m, so that it begins near the origin"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn extent(width: f64, height: f64) -> Extent {
        Extent {
            low: [0.0, 0.0],
            high: [width, height],
        }
    }

    fn found(asked: Option<&str>, number: i64, width: f64) -> (f64, String) {
        let (unit, note) = unit(asked, number, &extent(width, 0.5 * width)).unwrap();
        (unit.length, note.unwrap_or_default())
    }

    #[test]
    fn the_unit_of_the_header_counts_if_the_size_is_plausible() {
        assert_eq!(found(None, 6, 30.0), (1.0, String::new()));
        let (length, note) = found(None, 4, 24_300.0);
        assert_eq!(length, 0.001);
        assert_eq!(note, "millimeters, as the header says: 24.3 by 12.15 m");
        assert_eq!(found(Some("cm"), 4, 24_300.0), (0.01, String::new()));
    }

    #[test]
    fn an_implausible_or_missing_unit_is_guessed_with_a_note() {
        let (length, note) = found(None, 4, 30.0);
        assert_eq!(length, 1.0);
        assert_eq!(
            note,
            "taken as meters, 30 by 15 m: the header says millimeters, which would be 0.03 by 0.015 m; `plan.unit` \
             says otherwise"
        );
        assert_eq!(found(None, 0, 30_000.0).0, 0.001);
        assert_eq!(found(None, 0, 1_000.0).0, 0.01);
        let wrong = unit(None, 0, &extent(1e9, 1.0)).unwrap_err();
        assert!(wrong.to_string().contains("give `plan.unit`"), "{wrong}");
    }

    #[test]
    fn far_plans_are_moved_by_whole_meters() {
        let far = Extent {
            low: [345_000.4, 5_268_000.9],
            high: [345_020.0, 5_268_030.0],
        };
        let frame = Frame::new(UNITS[4], &far, &far, None);
        assert_eq!(
            frame.note().unwrap(),
            "moved by (-345000, -5268000) m, so that it begins near the origin"
        );
        let [x, y] = frame.at(far.low);
        assert!((x - 0.4).abs() < 1e-6 && (y - 0.9).abs() < 1e-6);
    }
}
