//! Reads text: columns separated by blanks or tabs below comments, or by commas or semicolons below a header.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::error::ReadError;
use super::level::Levels;
use super::line::{self, Columns, number, words};
use super::order::{self, Wide};
use super::times::{self, Times};
use super::tracks::{Contents, Tracks};
use super::{ReadOptions, Unit, frame_rate};
use crate::input::{Letters, Lines};

/// The first line of the files of Viswalk; their comments begin with `*`.
const VISWALK: &str = "$VISION";
/// The beginnings of comments.
const COMMENTS: [char; 3] = ['#', '%', '*'];

/// The bytes of a file in UTF-8, a line at a time.
type Text<R> = BufReader<Lines<Letters<R>>>;

/// The content of a file as far as it is read.
#[derive(Default)]
struct Rows {
    columns: Columns,
    contents: Contents,
    /// The times of rows that have frames, too.
    times: Times,
    /// The time of each row, seconds, if there are no frames.
    instants: Vec<f64>,
    wide: Wide,
    levels: Levels,
}

impl Rows {
    fn new(options: &ReadOptions) -> Self {
        Self {
            levels: Levels::new(&options.level),
            ..Self::default()
        }
    }

    fn add(&mut self, cells: &[&str], line: u64) -> Result<(), String> {
        let level = self.columns.level.and_then(|place| cells.get(place));
        if level.is_some_and(|name| !self.levels.includes(name)) {
            return Ok(());
        }
        let entry = self.columns.entry(cells, line)?;
        match (self.columns.time(cells)?, self.columns.frame) {
            (Some(time), Some(_)) => self.times.add(entry.frame, time),
            (Some(time), None) => self.instants.push(time),
            (None, _) => {}
        }
        self.wide.add(cells);
        self.contents.entries.push(entry);
        Ok(())
    }

    /// The tracks of all rows.
    fn tracks(self, path: &Path, options: &ReadOptions) -> Result<Tracks, ReadError> {
        self.levels.check(path)?;
        let mut contents = self.contents;
        let failed = |problem| ReadError::file(path, problem);
        contents.place = "line";
        contents.has_mass = self.columns.mass.is_some();
        let found = match self.columns.frame {
            Some(_) => self.times.rate(),
            None => times::number(&mut contents.entries, &self.instants).transpose(),
        };
        let rate = found.map(|rate| options.own_rate(rate)).transpose();
        contents.fps = contents.fps.or(rate.map_err(failed)?.flatten());
        if contents.is_unnamed {
            order::read_obsmat(&mut contents, &self.wide);
        }
        Tracks::new(path, contents, options)
    }
}

/// Reads text; `is_csv`: by the name of the file its columns are separated by commas.
pub fn read(
    path: &Path,
    file: impl Read,
    is_csv: bool,
    options: &ReadOptions,
) -> Result<Tracks, ReadError> {
    let unreadable = |error: std::io::Error| ReadError::line(path, 1, error.to_string());
    let mut text = text(file);
    match separator(text.fill_buf().map_err(unreadable)?, is_csv) {
        Some(separator) => Table::open(path, text, separator)?.tracks(options),
        None => read_columns(path, text, options),
    }
}

/// The lines of a file, whatever its encoding and the ends of its lines.
pub fn text<R: Read>(file: R) -> Text<R> {
    BufReader::with_capacity(1 << 20, Lines::new(Letters::new(file)))
}

/// What separates the columns, by the beginning of a file; `None`: blanks.
pub fn separator(start: &[u8], is_csv: bool) -> Option<u8> {
    let start = String::from_utf8_lossy(start);
    let mut lines = start.lines().map(str::trim);
    let first = lines
        .find(|line| !line.is_empty() && !line.starts_with(COMMENTS) && !line.starts_with(VISWALK))
        .unwrap_or_default();
    let separated = [';', ','].into_iter().find(|&one| first.contains(one));
    let is_number = |cell: Option<&str>| cell.is_some_and(|cell| number(cell).is_some());
    let begins = is_number(first.split_whitespace().next());
    let is_header = |by: char| !begins && !is_number(first.split(by).next());
    match separated {
        Some(by) if is_csv || is_header(by) => Some(by as u8),
        _ if is_csv && !matches!(Columns::named(&split(first)), Ok(Some(_))) => Some(b','),
        _ => None,
    }
}

fn split(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// Reads the text format of PeTrack and the Pedestrian Dynamics Data Archive.
fn read_columns<R: Read>(
    path: &Path,
    mut text: Text<R>,
    options: &ReadOptions,
) -> Result<Tracks, ReadError> {
    let mut rows = Rows::new(options);
    rows.contents.is_unnamed = true;
    let (mut bytes, mut number) = (Vec::new(), 0);
    let failed = |line, problem: String| ReadError::line(path, line, problem);
    loop {
        bytes.clear();
        let read = text.read_until(b'\n', &mut bytes);
        if read.map_err(|error| failed(number + 1, error.to_string()))? == 0 {
            break;
        }
        text.get_mut().next_line();
        number += 1;
        // Comments may be in another encoding; the numbers are still valid.
        let decoded = String::from_utf8_lossy(&bytes);
        let line = decoded.trim();
        if let Some(comment) = line.strip_prefix(['#', '%']) {
            heed(comment, &mut rows, options).map_err(|problem| failed(number, problem))?;
            continue;
        }
        let cells = split(line);
        if cells.is_empty() {
            continue;
        }
        let is_header = rows.contents.entries.is_empty() && line::number(cells[0]).is_none();
        if is_header && named(line, &mut rows).map_err(|p| failed(number, p))? {
            continue;
        }
        rows.add(&cells, number).map_err(|problem| {
            let hint = if line.contains([',', ';']) {
                "; columns are separated by blanks or tabs here, by commas in a .csv"
            } else {
                ""
            };
            failed(number, format!("{problem}{hint}"))
        })?;
    }
    rows.tracks(path, options)
}

/// Takes column names, frame rate and unit from a comment.
fn heed(comment: &str, rows: &mut Rows, options: &ReadOptions) -> Result<(), String> {
    if named(comment, rows)? {
        return Ok(());
    }
    let contents = &mut rows.contents;
    if contents.fps.is_none()
        && let Some(text) = line::frame_rate(comment)
    {
        contents.fps = options.own_rate(frame_rate(&text))?;
    }
    let words = words(&comment.to_lowercase());
    let unit = words
        .windows(2)
        .find_map(|pair| match (pair[0].as_str(), pair[1].as_str()) {
            ("in", "mm" | "millimeters" | "millimetres") => Some(Unit::Millimeter),
            ("in", "cm" | "centimeters" | "centimetres") => Some(Unit::Centimeter),
            ("in", "m" | "meters" | "metres") => Some(Unit::Meter),
            ("in", "ft" | "feet") => Some(Unit::Foot),
            _ => None,
        });
    contents.unit = contents.unit.or(unit);
    Ok(())
}

/// Takes the columns from a line of column names. Returns whether it was one.
fn named(line: &str, rows: &mut Rows) -> Result<bool, String> {
    let words = words(line);
    let names: Vec<&str> = words.iter().map(String::as_str).collect();
    let Some((found, unit)) = Columns::named(&names)? else {
        return Ok(false);
    };
    rows.columns = found;
    rows.contents.unit = unit.or(rows.contents.unit);
    rows.contents.is_unnamed = false;
    Ok(true)
}

/// Values separated by commas or semicolons below a line of column names, as the sandbox, Pathfinder and Viswalk write
/// them.
pub struct Table<'a, R> {
    path: &'a Path,
    reader: csv::Reader<Text<R>>,
    /// The number of lines before those that `reader` counts.
    before: u64,
    pub header: csv::StringRecord,
    pub columns: Columns,
    unit: Option<Unit>,
}

impl<'a, R: Read> Table<'a, R> {
    /// Reads the names of the columns.
    pub fn open(path: &'a Path, mut text: Text<R>, separator: u8) -> Result<Self, ReadError> {
        let unreadable = |error: std::io::Error| ReadError::line(path, 1, error.to_string());
        let is_viswalk = text
            .fill_buf()
            .map_err(unreadable)?
            .starts_with(VISWALK.as_bytes());
        if is_viswalk {
            text.read_until(b'\n', &mut Vec::new())
                .map_err(unreadable)?;
        }
        let before = u64::from(is_viswalk);
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(if is_viswalk { b'*' } else { b'#' }))
            .delimiter(separator)
            .trim(csv::Trim::All)
            .flexible(true)
            .buffer_capacity(1 << 20)
            .from_reader(text);
        let read = reader.headers();
        let header = read.map_err(|error| failed(path, &error, 1))?.clone();
        reader.get_mut().get_mut().next_line();
        let names: Vec<&str> = header.iter().collect();
        let line = before + header.position().map_or(1, csv::Position::line);
        let head = |problem: String| ReadError::line(path, line, problem);
        let missing =
            || head("the first line must name the columns id, frame or time, x and y".to_owned());
        let found = Columns::named(&names).map_err(head)?;
        let (columns, unit) = found.ok_or_else(missing)?;
        Ok(Self {
            path,
            reader,
            before,
            header,
            columns,
            unit,
        })
    }

    /// Passes on the cells of all rows with their line; a line of units is taken.
    pub fn each(
        &mut self,
        mut take: impl FnMut(&Columns, &[&str], u64) -> Result<(), String>,
    ) -> Result<(), ReadError> {
        let mut record = csv::StringRecord::new();
        let mut is_first = true;
        loop {
            let begun = self.before + self.reader.position().line();
            let read = self.reader.read_record(&mut record);
            if !read.map_err(|error| failed(self.path, &error, begun))? {
                return Ok(());
            }
            self.reader.get_mut().get_mut().next_line();
            let line = self.before + record.position().map_or(0, csv::Position::line);
            let problem = |problem| ReadError::line(self.path, line, problem);
            let cells: Vec<&str> = record.iter().collect();
            if std::mem::take(&mut is_first)
                && let Some(unit) = self.columns.units(&cells).map_err(problem)?
            {
                self.unit = unit.or(self.unit);
                continue;
            }
            take(&self.columns, &cells, line).map_err(problem)?;
        }
    }

    fn tracks(mut self, options: &ReadOptions) -> Result<Tracks, ReadError> {
        let mut rows = Rows::new(options);
        self.each(|&columns, cells, line| {
            rows.columns = columns;
            rows.add(cells, line)
        })?;
        rows.columns = self.columns;
        rows.contents.unit = self.unit;
        rows.tracks(self.path, options)
    }
}

/// The error of a table that cannot be read; it began in line `begun`.
fn failed(path: &Path, error: &csv::Error, begun: u64) -> ReadError {
    let line = error.position().map_or(begun, csv::Position::line);
    ReadError::line(path, line, error.to_string())
}
