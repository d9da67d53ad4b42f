//! Other columns of a trajectory file than positions, for pictures.

use std::collections::HashMap;
use std::fs::File;
use std::path::Path;

use super::error::ReadError;
use super::line::Columns;
use super::{Format, Tracks, open};

/// Columns that are not values of people.
const OTHERS: [&str; 8] = ["id", "frame", "time", "x", "y", "pos_x", "pos_y", "z"];

/// A column of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name in the file.
    pub name: String,
    /// The value of each row of the tracks, NaN where there is no number; empty if it was not read.
    pub values: Vec<f64>,
}

/// A row's person and frame, and its values.
type Row = (i64, i64, Vec<f64>);

/// The columns with values of people of a CSV or SQLite file; the values of `wanted` and of the radius are read. Of
/// files in HDF5 and text only positions are read.
///
/// # Errors
/// The file cannot be read.
pub fn columns(path: &Path, wanted: &[&str], tracks: &Tracks) -> Result<Vec<Column>, ReadError> {
    let (_, start) = open(path)?;
    let format = Format::of(path, &start);
    let mut names = match format {
        Format::Csv => csv_names(path)?,
        Format::Sqlite => sqlite_names(path),
        Format::Hdf5 | Format::Text => Vec::new(),
    };
    names.retain(|name| !OTHERS.contains(&name.as_str()));
    let read = |name: &&String| wanted.contains(&name.as_str()) || *name == "radius";
    let needed: Vec<&str> = names.iter().filter(read).map(String::as_str).collect();
    let values = match needed.is_empty() {
        true => Vec::new(),
        false => {
            let rows = match format {
                Format::Csv => csv_rows(path, &needed)?,
                Format::Sqlite => sqlite_rows(path, &needed)?,
                Format::Hdf5 | Format::Text => Vec::new(),
            };
            in_order(rows, needed.len(), tracks)
        }
    };
    let mut values: HashMap<String, Vec<f64>> =
        needed.into_iter().map(str::to_owned).zip(values).collect();
    let column = names.into_iter().map(|name| Column {
        values: values.remove(&name).unwrap_or_default(),
        name,
    });
    Ok(column.collect())
}

/// The values of some columns in the order of the tracks' rows.
fn in_order(rows: Vec<Row>, count: usize, tracks: &Tracks) -> Vec<Vec<f64>> {
    let mut values = vec![vec![f64::NAN; tracks.len()]; count];
    let keyed = rows.into_iter().map(|(id, frame, own)| ((id, frame), own));
    let rows: HashMap<(i64, i64), Vec<f64>> = keyed.collect();
    for (k, &frame) in tracks.frames.iter().enumerate() {
        for row in tracks.rows(k) {
            let id = tracks.ids[tracks.person[row] as usize];
            let own = rows.get(&(id, frame)).into_iter().flatten();
            for (column, value) in values.iter_mut().zip(own) {
                column[row] = *value;
            }
        }
    }
    // A column of text has no numbers at all.
    for column in &mut values {
        if column.iter().all(|value| value.is_nan()) {
            column.clear();
        }
    }
    values
}

fn reader(path: &Path) -> Result<csv::Reader<File>, ReadError> {
    let opened = File::open(path);
    let file = opened.map_err(|error| ReadError::file(path, format!("cannot be read: {error}")))?;
    let mut builder = csv::ReaderBuilder::new();
    builder
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true);
    Ok(builder.from_reader(file))
}

fn csv_names(path: &Path) -> Result<Vec<String>, ReadError> {
    let mut reader = reader(path)?;
    let read = reader.headers();
    let header = read.map_err(|error| ReadError::file(path, error.to_string()))?;
    Ok(header.iter().map(str::to_owned).collect())
}

fn csv_rows(path: &Path, names: &[&str]) -> Result<Vec<Row>, ReadError> {
    let mut reader = reader(path)?;
    let failed = |error: csv::Error| ReadError::file(path, error.to_string());
    let headers = reader.headers().map_err(failed)?.clone();
    let header: Vec<&str> = headers.iter().collect();
    let found = Columns::named(&header).map_err(|problem| ReadError::file(path, problem))?;
    let Some((columns, _)) = found else {
        return Ok(Vec::new());
    };
    let place = |name: &&str| header.iter().position(|own| own == name);
    let places: Vec<usize> = names.iter().filter_map(place).collect();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(failed)?;
        let cells: Vec<&str> = record.iter().collect();
        let line = record.position().map_or(0, csv::Position::line);
        let read_entry = columns.entry(&cells, line);
        let entry = read_entry.map_err(|problem| ReadError::line(path, line, problem))?;
        let values = places.iter().map(|&place| {
            let value = cells.get(place).and_then(|cell| cell.parse().ok());
            value.unwrap_or(f64::NAN)
        });
        rows.push((entry.id, entry.frame, values.collect()));
    }
    Ok(rows)
}

#[cfg(feature = "program")]
fn sqlite_names(path: &Path) -> Vec<String> {
    super::sqlite::names(path).unwrap_or_default()
}

#[cfg(feature = "program")]
fn sqlite_rows(path: &Path, names: &[&str]) -> Result<Vec<Row>, ReadError> {
    super::sqlite::values(path, names)
}

#[cfg(not(feature = "program"))]
fn sqlite_names(_: &Path) -> Vec<String> {
    Vec::new()
}

#[cfg(not(feature = "program"))]
fn sqlite_rows(_: &Path, _: &[&str]) -> Result<Vec<Row>, ReadError> {
    Ok(Vec::new())
}
