//! Reads text: columns separated by blanks or tabs below comments, or CSV below a header.

use crate::input;
use crate::input::Lines;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::error::ReadError;
use super::line::{self, Columns, words};
use super::tracks::{Contents, Tracks};
use super::{FRAME_RATES, ReadOptions, Unit, frame_rate};

/// Reads the text format of PeTrack and the Pedestrian Dynamics Data Archive.
pub fn read_text(path: &Path, file: impl Read, options: &ReadOptions) -> Result<Tracks, ReadError> {
    let mut contents = Contents {
        place: "line",
        ..Contents::default()
    };
    let mut reader = BufReader::with_capacity(1 << 20, Lines::new(file));
    let mut columns = Columns::default();
    let (mut bytes, mut number) = (Vec::new(), 0);
    let failed = |line, problem: String| ReadError::line(path, line, problem);
    loop {
        bytes.clear();
        let read = reader.read_until(b'\n', &mut bytes);
        if read.map_err(|error| failed(number + 1, error.to_string()))? == 0 {
            break;
        }
        reader.get_mut().next_line();
        number += 1;
        // Comments may be in another encoding; the numbers are still valid.
        let text = String::from_utf8_lossy(&bytes);
        let line = input::without_mark(&text).trim();
        if let Some(comment) = line.strip_prefix(['#', '%']) {
            heed(comment, &mut columns, &mut contents, options)
                .map_err(|problem| failed(number, problem))?;
            continue;
        }
        let cells: Vec<&str> = line.split_whitespace().collect();
        if cells.is_empty() {
            continue;
        }
        let is_header = contents.entries.is_empty() && cells[0].parse::<f64>().is_err();
        if is_header && named(line, &mut columns, &mut contents).map_err(|p| failed(number, p))? {
            continue;
        }
        let entry = columns.entry(&cells, number).map_err(|problem| {
            let hint = if line.contains([',', ';']) {
                "; columns are separated by blanks or tabs here, by commas in a .csv"
            } else {
                ""
            };
            failed(number, format!("{problem}{hint}"))
        })?;
        contents.entries.push(entry);
    }
    contents.has_mass = columns.mass.is_some();
    Tracks::new(path, contents, options)
}

/// Takes column names, frame rate and unit from a comment.
fn heed(
    comment: &str,
    columns: &mut Columns,
    contents: &mut Contents,
    options: &ReadOptions,
) -> Result<(), String> {
    if named(comment, columns, contents)? {
        return Ok(());
    }
    if contents.fps.is_none()
        && let Some(text) = line::frame_rate(comment)
    {
        contents.fps = options.own_rate(frame_rate(&text))?;
    }
    let words = words(&comment.to_lowercase());
    let unit = words
        .windows(2)
        .find_map(|pair| match (pair[0].as_str(), pair[1].as_str()) {
            ("in", "cm" | "centimeters" | "centimetres") => Some(Unit::Centimeter),
            ("in", "m" | "meters" | "metres") => Some(Unit::Meter),
            _ => None,
        });
    contents.unit = contents.unit.or(unit);
    Ok(())
}

/// Takes the columns from a line of column names. Returns whether it was one.
fn named(line: &str, columns: &mut Columns, contents: &mut Contents) -> Result<bool, String> {
    let words = words(line);
    let names: Vec<&str> = words.iter().map(String::as_str).collect();
    let Some((found, unit)) = Columns::named(&names)? else {
        return Ok(false);
    };
    *columns = found;
    contents.unit = unit.or(contents.unit);
    Ok(true)
}

/// Reads comma-separated values below a line of column names, as the sandbox writes them.
pub fn read_csv(path: &Path, file: impl Read, options: &ReadOptions) -> Result<Tracks, ReadError> {
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true)
        .buffer_capacity(1 << 20)
        .from_reader(Lines::new(file));
    let unreadable = |error: csv::Error, begun: u64| {
        let line = error.position().map_or(begun, csv::Position::line);
        ReadError::line(path, line, error.to_string())
    };
    let read = reader.headers();
    let header = read.map_err(|error| unreadable(error, 1))?.clone();
    reader.get_mut().next_line();
    let names: Vec<&str> = header.iter().collect();
    let head = |problem: String| ReadError::line(path, 1, problem);
    let missing = || head("the first line must name the columns id, frame, x and y".to_owned());
    let found = Columns::named(&names).map_err(head)?;
    let (columns, unit) = found.ok_or_else(missing)?;
    let mut contents = Contents {
        // The sandbox's own columns are in meters.
        unit: unit.or(names.contains(&"pos_x").then_some(Unit::Meter)),
        has_mass: columns.mass.is_some(),
        place: "line",
        ..Contents::default()
    };
    let mut record = csv::StringRecord::new();
    loop {
        let begun = reader.position().line();
        let read = reader.read_record(&mut record);
        if !read.map_err(|error| unreadable(error, begun))? {
            break;
        }
        reader.get_mut().next_line();
        let line = record.position().map_or(0, csv::Position::line);
        let cells: Vec<&str> = record.iter().collect();
        let failed = |problem| ReadError::line(path, line, problem);
        let entry = columns.entry(&cells, line).map_err(failed)?;
        if contents.fps.is_none() && entry.frame > 0 {
            let rate = rate(&cells, &columns, entry.frame).map(|rate| options.own_rate(rate));
            contents.fps = rate.transpose().map_err(failed)?.flatten();
        }
        contents.entries.push(entry);
    }
    Tracks::new(path, contents, options)
}

/// The frame rate, if there are times. Rounded to nine significant digits, because times are rounded.
fn rate(cells: &[&str], columns: &Columns, frame: i64) -> Option<Result<f64, String>> {
    let time: f64 = cells.get(columns.time?)?.parse().ok()?;
    let fps = frame as f64 / time;
    if !FRAME_RATES.contains(&fps) {
        let reason = format!(
            "frame {frame} at {time:e} s makes {fps:e} frames per second: frame f is at f / fps; give --fps"
        );
        return Some(Err(reason));
    }
    let unit = 10_f64.powi(8 - fps.log10().floor() as i32);
    Some(Ok((fps * unit).round() / unit))
}
