//! Parsers for the values of options.

use std::ops::RangeBounds;
use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::{PathBufValueParser, TypedValueParser};

use crate::analysis::crossing::Line;
use crate::engine::scene::Region;
use crate::scenario::trajectories::FRAME_RATES;

/// A number in a range; the error is `otherwise`.
fn within<T: FromStr + PartialOrd>(
    text: &str,
    range: impl RangeBounds<T>,
    otherwise: &'static str,
) -> Result<T, &'static str> {
    let number = text.parse().ok();
    number
        .filter(|number| range.contains(number))
        .ok_or(otherwise)
}

pub fn seconds(text: &str) -> Result<f64, &'static str> {
    within(text, 0.0..=1e9, "not a time in seconds, 0 or later")
}

pub fn positive_seconds(text: &str) -> Result<f64, &'static str> {
    let range = f64::MIN_POSITIVE..=1e9;
    within(text, range, "not a time in seconds above 0")
}

/// A time that may lie before the start, seconds.
pub fn moment(text: &str) -> Result<f64, &'static str> {
    within(text, -1e9..=1e9, "not a time in seconds")
}

pub fn length(text: &str) -> Result<f64, &'static str> {
    within(text, 1e-3..=1e3, "not a number between 0.001 and 1000")
}

pub fn frame_rate(text: &str) -> Result<f64, &'static str> {
    let otherwise = "not a number of frames per second above 0";
    within(text, FRAME_RATES, otherwise)
}

pub fn threads(text: &str) -> Result<usize, &'static str> {
    within(text, 1..=1024, "not a number of threads between 1 and 1024")
}

pub fn repeats(text: &str) -> Result<usize, &'static str> {
    within(text, 1..=1000, "not a number of repeats between 1 and 1000")
}

pub fn seed(text: &str) -> Result<u64, &'static str> {
    within(text, .., "not a whole number from 0 to 2^64 - 1")
}

pub fn id(text: &str) -> Result<u32, &'static str> {
    within(text, .., "not an agent's id, a whole number from 0")
}

pub fn every_frames(text: &str) -> Result<u64, &'static str> {
    within(text, 1.., "not a number of frames, 1 or more")
}

fn four(text: &str) -> Option<[f64; 4]> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let numbers: [f64; 4] = numbers.ok()?.try_into().ok()?;
    numbers.iter().all(|n| n.is_finite()).then_some(numbers)
}

pub fn region(text: &str) -> Result<Region, &'static str> {
    match four(text) {
        Some([x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Region {
            min: [x0, y0].into(),
            max: [x1, y1].into(),
        }),
        _ => Err("expected four numbers x0,y0,x1,y1 with x0 < x1 and y0 < y1"),
    }
}

pub fn line(text: &str) -> Result<Line, &'static str> {
    match four(text) {
        Some([x0, y0, x1, y1]) if (x0, y0) != (x1, y1) => Ok(Line {
            start: [x0, y0].into(),
            end: [x1, y1].into(),
        }),
        _ => Err("expected four numbers x0,y0,x1,y1, the ends of a line"),
    }
}

/// A path with the extension that the Rerun viewer expects of a recording.
pub fn recording() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("rrd") => Ok(path),
        _ => Err("a recording's name must end in .rrd"),
    })
}

/// A path with the extension of a picture.
pub fn picture() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| {
        let extension = path.extension().unwrap_or_default();
        let known = ["svg", "png"].iter();
        match known
            .into_iter()
            .any(|known| extension.eq_ignore_ascii_case(known))
        {
            true => Ok(path),
            false => Err("a picture's name must end in .svg or .png"),
        }
    })
}
