//! Other columns of a trajectory file than positions, for pictures.

use std::collections::HashMap;
use std::fs::File;
use std::hash::Hash;
use std::io::BufRead;
use std::path::Path;

use super::error::ReadError;
use super::line::number;
use super::rows::{Key, Row};
use super::text::{Table, separator, text};
use super::{Format, Tracks, open};

/// Columns that are not values of people.
const OTHERS: [&str; 9] = ["id", "frame", "time", "t", "x", "y", "pos_x", "pos_y", "z"];

/// A column of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name in the file.
    pub name: String,
    /// The value of each row of the tracks, NaN where there is no number; empty if it was not read.
    pub values: Vec<f64>,
}

/// The columns with values of people of a CSV or SQLite file; the values of `wanted` and of the radius are read. Of
/// files in HDF5 and text with blanks only positions are read.
///
/// # Errors
/// The file cannot be read.
pub fn columns(path: &Path, wanted: &[&str], tracks: &Tracks) -> Result<Vec<Column>, ReadError> {
    let (_, start) = open(path)?;
    let format = Format::of(path, &start);
    let mut table = match format {
        Format::Csv | Format::Text => table(path, format == Format::Csv)?,
        Format::Sqlite | Format::Hdf5 => None,
    };
    let mut names: Vec<String> = match (&table, format) {
        (Some(table), _) => table.header.iter().map(str::to_owned).collect(),
        (None, Format::Sqlite) => sqlite_names(path),
        (None, _) => Vec::new(),
    };
    names.retain(|name| !OTHERS.contains(&name.as_str()));
    let read = |name: &&String| wanted.contains(&name.as_str()) || *name == "radius";
    let needed: Vec<&str> = names.iter().filter(read).map(String::as_str).collect();
    let values = match (needed.is_empty(), &mut table) {
        (true, _) => Vec::new(),
        (false, Some(table)) => {
            let rows = text_rows(table, &needed)?;
            in_order(rows, needed.len(), tracks, |row| tracks.lines[row])
        }
        (false, None) => {
            let rows = sqlite_rows(path, &needed)?;
            let key = |row| (tracks.own_id(row), tracks.frame_of(row));
            in_order(rows, needed.len(), tracks, key)
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
fn in_order<K: Eq + Hash>(
    rows: Vec<Row<K>>,
    count: usize,
    tracks: &Tracks,
    key: impl Fn(usize) -> K,
) -> Vec<Vec<f64>> {
    let mut values = vec![vec![f64::NAN; tracks.len()]; count];
    let rows: HashMap<K, Vec<f64>> = rows.into_iter().collect();
    for row in 0..tracks.len() {
        let own = rows.get(&key(row)).into_iter().flatten();
        for (column, value) in values.iter_mut().zip(own) {
            column[row] = *value;
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

/// The table in a text; `None` if its columns are separated by blanks.
fn table(path: &Path, is_csv: bool) -> Result<Option<Table<'_, File>>, ReadError> {
    let unreadable = |error| ReadError::file(path, format!("cannot be read: {error}"));
    let mut text = text(File::open(path).map_err(unreadable)?);
    let separator = separator(text.fill_buf().map_err(unreadable)?, is_csv);
    let open = |separator| Table::open(path, text, separator);
    separator.map(open).transpose()
}

fn text_rows(table: &mut Table<File>, names: &[&str]) -> Result<Vec<Row<u64>>, ReadError> {
    let place = |name: &&str| table.header.iter().position(|own| own == *name);
    let places: Vec<usize> = names.iter().filter_map(place).collect();
    let mut rows = Vec::new();
    table.each(|_, cells, line| {
        let values = places.iter().map(|&place| {
            let value = cells.get(place).and_then(|cell| number(cell));
            value.unwrap_or(f64::NAN)
        });
        rows.push((line, values.collect()));
        Ok(())
    })?;
    Ok(rows)
}

#[cfg(feature = "program")]
fn sqlite_names(path: &Path) -> Vec<String> {
    super::sqlite::names(path).unwrap_or_default()
}

#[cfg(feature = "program")]
fn sqlite_rows(path: &Path, names: &[&str]) -> Result<Vec<Row<Key>>, ReadError> {
    super::sqlite::values(path, names)
}

#[cfg(not(feature = "program"))]
fn sqlite_names(_: &Path) -> Vec<String> {
    Vec::new()
}

#[cfg(not(feature = "program"))]
fn sqlite_rows(_: &Path, _: &[&str]) -> Result<Vec<Row<Key>>, ReadError> {
    Ok(Vec::new())
}
