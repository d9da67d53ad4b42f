//! Reads the SQLite files of JuPedSim, versions 1 and 2, and of the sandbox.

use crate::error::quote::shown_message;
use std::path::Path;

use rusqlite::types::ValueRef;
use rusqlite::{Connection, OpenFlags, Row as Values};

use super::error::ReadError;
use super::level::{LEVEL, Levels, OnLevel, is_named};
use super::rows::{Key, Row};
use super::tracks::{Contents, Entry, Tracks};
use super::{ReadOptions, Unit, frame_rate};
use engine::math::Vector;

/// A row takes at least this many bytes of a file: its cell pointer, its length, its rowid and a type per column.
const LEAST_ROW: u64 = 8;

pub fn read(path: &Path, options: &ReadOptions) -> Result<Tracks, ReadError> {
    let failed = |error: rusqlite::Error| ReadError::file(path, shown_message(&error.to_string()));
    let connection =
        Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY).map_err(failed)?;
    let columns = columns(&connection, "trajectory_data").map_err(failed)?;
    let mut needed = ["frame", "id", "pos_x", "pos_y"].into_iter();
    if let Some(missing) = needed.find(|name| !columns.iter().any(|own| own == name)) {
        let problem = if columns.is_empty() {
            "it has no table trajectory_data: this is no trajectory of JuPedSim".to_owned()
        } else {
            format!("its table trajectory_data has no column {missing}")
        };
        return Err(ReadError::file(path, problem));
    }
    let has = |column: &str| columns.iter().any(|name| name == column);
    let (has_mass, has_levels) = (has("mass"), has(LEVEL));
    let mut levels = Levels::new(&options.level);
    let mut contents = Contents {
        unit: Some(Unit::Meter),
        has_mass,
        fps: frames_per_second(&connection, options).map_err(|what| ReadError::file(path, what))?,
        walkable: walkable(&connection, &options.level).map_err(failed)?,
        place: "row",
        ..Contents::default()
    };
    let mass = if has_mass { "mass" } else { "1.0" };
    let level = if has_levels { LEVEL } else { "NULL" };
    let text = format!("SELECT frame, id, pos_x, pos_y, {mass}, {level} FROM trajectory_data");
    let mut query = connection.prepare(&text).map_err(failed)?;
    let mut rows = query.query([]).map_err(failed)?;
    let mut line = 0;
    let about = path.metadata();
    let most = about.map_or(u64::MAX, |about| about.len() / LEAST_ROW);
    while let Some(row) = rows.next().map_err(failed)? {
        line += 1;
        if line > most {
            let problem =
                "trajectory_data has more rows than fit into the file: it is damaged, or a view";
            return Err(ReadError::file(path, problem));
        }
        if let Ok(ValueRef::Text(name)) = row.get_ref(5)
            && !levels.includes(&String::from_utf8_lossy(name))
        {
            continue;
        }
        let entry = entry(row, line).map_err(|what| {
            ReadError::file(path, format!("row {line} of trajectory_data: {what}"))
        })?;
        contents.entries.push(entry);
    }
    levels.check(path)?;
    Tracks::new(path, contents, options)
}

/// The names of the columns of trajectories.
pub fn names(path: &Path) -> rusqlite::Result<Vec<String>> {
    let connection = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY)?;
    columns(&connection, "trajectory_data")
}

/// The id and the frame, and the values of some columns of each row; NaN where a value is not a number.
pub fn values(path: &Path, names: &[&str]) -> Result<Vec<Row<Key>>, ReadError> {
    let read = || -> rusqlite::Result<Vec<Row<Key>>> {
        let connection = Connection::open_with_flags(path, OpenFlags::SQLITE_OPEN_READ_ONLY)?;
        let own = names.iter();
        let quoted = own.map(|name| format!("\"{}\"", name.replace('"', "\"\"")));
        let columns: Vec<String> = quoted.collect();
        let text = format!(
            "SELECT id, frame, {} FROM trajectory_data",
            columns.join(", ")
        );
        let mut query = connection.prepare(&text)?;
        let row = |row: &Values| {
            let values = (2..2 + names.len()).map(|column| {
                Ok(match row.get_ref(column)? {
                    ValueRef::Real(number) => number,
                    ValueRef::Integer(number) => number as f64,
                    _ => f64::NAN,
                })
            });
            // `read` has refused other ids and frames.
            let whole = |column: usize| -> rusqlite::Result<i64> {
                Ok(whole(row.get_ref(column)?).unwrap_or(i64::MIN))
            };
            let key = (whole(0)?, whole(1)?);
            Ok((key, values.collect::<rusqlite::Result<_>>()?))
        };
        query.query_map([], row)?.collect()
    };
    read().map_err(|error| ReadError::file(path, shown_message(&error.to_string())))
}

fn entry(row: &Values, line: u64) -> Result<Entry, String> {
    let whole = |column: usize, what: &str| {
        let value = row.get_ref(column).ok().and_then(whole);
        value.ok_or_else(|| format!("{what} is not a whole number"))
    };
    let finite = |column: usize, what: &str| match row.get_ref(column) {
        Ok(ValueRef::Real(number)) if number.is_finite() => Ok(number),
        Ok(ValueRef::Integer(number)) => Ok(number as f64),
        _ => Err(format!("{what} is not a finite number")),
    };
    Ok(Entry {
        frame: whole(0, "frame")?,
        id: whole(1, "id")?,
        position: Vector::new(finite(2, "pos_x")?, finite(3, "pos_y")?),
        mass: finite(4, "mass")?,
        line,
    })
}

/// A whole number, also as the floating-point number as which pandas may write it.
fn whole(value: ValueRef) -> Option<i64> {
    match value {
        ValueRef::Integer(number) => Some(number),
        ValueRef::Real(number) => super::whole(number),
        _ => None,
    }
}

/// The names of a table's columns; empty if there is no such table.
fn columns(connection: &Connection, table: &str) -> rusqlite::Result<Vec<String>> {
    let mut query = connection.prepare("SELECT name FROM pragma_table_info(?)")?;
    let names = query.query_map([table], |row| row.get(0))?;
    names.collect()
}

/// The frame rate in the metadata, if there is one.
fn frames_per_second(
    connection: &Connection,
    options: &ReadOptions,
) -> Result<Option<f64>, String> {
    let query = "SELECT CAST(value AS TEXT) FROM metadata WHERE key = 'fps'";
    let text = connection.query_row(query, [], |row| row.get::<_, String>(0));
    let Ok(text) = text else {
        return Ok(None);
    };
    let rate = options.own_rate(frame_rate(text.trim()));
    rate.map_err(|problem| format!("metadata: {problem}"))
}

/// The distinct walkable areas as text, in no particular order. There are several if doors open or close. Values that
/// are not text are converted to text, so that the floor-plan reader rejects them if they are used. The level of a
/// building has its own in a table `levels`.
fn walkable(connection: &Connection, level: &OnLevel) -> rusqlite::Result<Vec<String>> {
    let of_level = match level {
        OnLevel::Named(wanted) => connection
            .prepare("SELECT name, wkt FROM levels")
            .and_then(|mut query| {
                let rows = query.query_map([], |row| Ok((row.get(0)?, row.get(1)?)))?;
                let mut named = rows.filter_map(Result::ok);
                let own = named.find(|(name, _): &(String, String)| is_named(wanted, name));
                Ok(own.map(|(_, wkt)| wkt))
            })
            .ok()
            .flatten(),
        OnLevel::Only | OnLevel::Any => None,
    };
    if let Some(wkt) = of_level {
        return Ok(vec![wkt]);
    }
    let Ok(mut query) = connection.prepare("SELECT DISTINCT wkt FROM geometry") else {
        return Ok(Vec::new());
    };
    let text = |row: &Values| {
        Ok(match row.get_ref(0)? {
            ValueRef::Text(text) | ValueRef::Blob(text) => {
                String::from_utf8_lossy(text).into_owned()
            }
            ValueRef::Null => String::new(),
            ValueRef::Integer(number) => number.to_string(),
            ValueRef::Real(number) => number.to_string(),
        })
    };
    query.query_map([], text)?.collect()
}
