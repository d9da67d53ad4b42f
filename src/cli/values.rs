//! Parsers for the values of options.

use std::path::PathBuf;

use crate::output::trajectory::read::FRAME_RATES;
use clap::builder::{PathBufValueParser, TypedValueParser};

pub fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=1e9).contains(&value) => Ok(value),
        _ => Err("not a time in seconds, 0 or later".to_owned()),
    }
}

pub fn frame_rate(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(fps) if FRAME_RATES.contains(&fps) => Ok(fps),
        _ => Err("not a number of frames per second above 0".to_owned()),
    }
}

pub fn positive_seconds(text: &str) -> Result<f64, String> {
    match seconds(text) {
        Ok(value) if value > 0.0 => Ok(value),
        _ => Err("not a time in seconds above 0".to_owned()),
    }
}

pub fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=1024) => Ok(count),
        _ => Err("not a number of threads between 1 and 1024".to_owned()),
    }
}

pub fn repeats(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=1000) => Ok(count),
        _ => Err("not a number of repeats between 1 and 1000".to_owned()),
    }
}

pub fn seed(text: &str) -> Result<u64, &'static str> {
    text.parse()
        .map_err(|_| "not a whole number from 0 to 2^64 - 1")
}

pub fn id(text: &str) -> Result<u32, &'static str> {
    text.parse()
        .map_err(|_| "not an agent's id, a whole number from 0")
}

pub fn every_frames(text: &str) -> Result<u64, &'static str> {
    match text.parse() {
        Ok(frames @ 1..) => Ok(frames),
        _ => Err("not a number of frames, 1 or more"),
    }
}

/// A path with the extension that the Rerun viewer expects of a recording.
pub fn recording() -> impl TypedValueParser<Value = PathBuf> {
    PathBufValueParser::new().try_map(|path| match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("rrd") => Ok(path),
        _ => Err("a recording's name must end in .rrd"),
    })
}
