//! Reads text: columns separated by blanks or tabs below comments, or CSV below a header.

use crate::input;
use crate::input::Lines;
use std::collections::BTreeMap;
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
    let missing = || head(unnamed(&names));
    let found = Columns::named(&names).map_err(head)?;
    let (columns, unit) = found.ok_or_else(missing)?;
    let mut contents = Contents {
        // The sandbox's own columns are in meters.
        unit: unit.or(names.contains(&"pos_x").then_some(Unit::Meter)),
        has_mass: columns.mass.is_some(),
        place: "line",
        ..Contents::default()
    };
    let mut times = Times::default();
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
        times.add(&cells, &columns, entry.frame);
        contents.entries.push(entry);
    }
    let rate = times.rate().map(|rate| options.own_rate(rate));
    let rate = rate
        .transpose()
        .map_err(|problem| ReadError::file(path, problem))?;
    contents.fps = rate.flatten();
    Tracks::new(path, contents, options)
}

/// What times say of the frame rate: the first time of each frame, seconds.
#[derive(Default)]
struct Times(BTreeMap<i64, f64>);

impl Times {
    fn add(&mut self, cells: &[&str], columns: &Columns, frame: i64) {
        let place = columns.time.and_then(|place| cells.get(place));
        // A time that is no finite number makes no frame rate, which `rate` says.
        if let Some(time) = place.and_then(|cell| cell.parse::<f64>().ok()) {
            self.0.entry(frame).or_insert(time * columns.seconds);
        }
    }

    /// The frame rate: the slope of the line through all times, or through frame 0 at 0 s if there is only one. Times
    /// are rounded: a whole number that fits them about as well is meant.
    fn rate(&self) -> Option<Result<f64, String>> {
        /// A whole rate may miss a time by this many times what the slope misses, and by rounding.
        const AS_WELL: f64 = 1.5;
        const ROUNDING: f64 = 1e-9;
        let (&last, &end) = self.0.last_key_value()?;
        let count = self.0.len() as f64;
        let times = || self.0.iter().map(|(&frame, &time)| (frame as f64, time));
        let [frame, time] = times().fold([0.0; 2], |[f, t], (frame, time)| {
            [f + frame / count, t + time / count]
        });
        let products = times().map(|(f, t)| [(f - frame) * (t - time), (f - frame).powi(2)]);
        let [both, square] = products.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
        let fps = match self.0.len() {
            1 if last <= 0 => return None,
            1 => last as f64 / end,
            _ => square / both,
        };
        if !FRAME_RATES.contains(&fps) {
            return Some(Err(format!(
                "frame {last} at {end:e} s makes {fps:e} frames per second: frame f is at f / fps; give --fps"
            )));
        }
        let misses = |fps: f64| {
            let miss = |(f, t): (f64, f64)| (t - time - (f - frame) / fps).abs();
            times().map(miss).fold(0.0, f64::max)
        };
        let whole = fps.round();
        if whole > 0.0 && misses(whole) <= AS_WELL * misses(fps) + ROUNDING {
            return Some(Ok(whole));
        }
        let unit = 10_f64.powi(8 - fps.log10().floor() as i32);
        Some(Ok((fps * unit).round() / unit))
    }
}

/// What the first line of a CSV lacks.
fn unnamed(names: &[&str]) -> String {
    let has = |known: &[&str]| names.iter().any(|name| known.contains(name));
    let why = match names[..] {
        [one] if one.contains(';') => {
            "; here columns are separated by semicolons: separate them by commas, and write numbers with points"
        }
        _ if has(&["t", "time"]) && !has(&["frame"]) => {
            "; here it names a time and no frame: add a column with the number of the frame"
        }
        _ => "",
    };
    format!("the first line must name the columns id, frame, x and y{why}")
}
