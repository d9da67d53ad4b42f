//! Small studies for the tests of sweeps.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

/// Nine people in a room for half a second, and a density and arrivals to measure.
pub const ROOM: &str = r#"{"goal": [10, 1], "profile": "sph", "duration_secs": 0.4,
    "obstacles": [[[-1, -1], [4, -1], [4, -0.5], [-1, -0.5]]],
    "grids": [{"min": [0, 0], "max": [2, 2], "columns": 3, "rows": 3, "jitter": 0.1}],
    "measurements": [{"density": {"at_secs": 0.2}}, {"evacuated": {}}]}"#;

/// One person, 2 m away from or in the middle of a star that nobody is let out of: a run that cannot begin.
pub fn star() -> String {
    let corner = |k: u32| {
        let radius = if k.is_multiple_of(2) { 1.0 } else { 10.0 };
        let (sin, cos) = (std::f64::consts::PI * f64::from(k) / 8.0).sin_cos();
        vec![radius * cos, radius * sin]
    };
    let corners: Vec<Vec<f64>> = (0..16).map(corner).collect();
    format!(
        r#"{{"goal": [40, 0], "duration_secs": 0.1, "obstacles": [{corners:?}],
        "agents": [{{"position": [20, 0]}}]}}"#
    )
}

/// A folder with the scenarios `room.json` and `star.json`, and `study.json`.
pub fn folder(study: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.json"), ROOM).unwrap();
    fs::write(folder.path().join("star.json"), star()).unwrap();
    let path = put(folder.path(), study);
    (folder, path)
}

/// Writes another `study.json`.
pub fn put(folder: &Path, study: &str) -> PathBuf {
    let path = folder.join("study.json");
    fs::write(&path, study).unwrap();
    path
}

/// A CSV file as rows of named values, without how long runs took.
pub fn rows(path: &Path) -> Vec<Vec<(String, String)>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let head = reader.headers().unwrap().clone();
    let row = |record: csv::StringRecord| {
        let named = head.iter().zip(&record);
        let kept = named.filter(|(name, _)| *name != "wall_secs");
        kept.map(|(name, value)| (name.to_owned(), value.to_owned()))
            .collect()
    };
    reader
        .records()
        .map(|record| row(record.unwrap()))
        .collect()
}

/// A column of such rows.
pub fn column(rows: &[Vec<(String, String)>], name: &str) -> Vec<String> {
    let value = |row: &Vec<(String, String)>| {
        let found = row.iter().find(|(other, _)| other == name);
        found
            .unwrap_or_else(|| panic!("no column {name}"))
            .1
            .clone()
    };
    rows.iter().map(value).collect()
}

/// The files in `cases/` with an extension.
pub fn cases(out: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(out.join("cases")).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.to_str().unwrap().ends_with(extension))
        .collect()
}

/// A number of a JSON object.
pub fn number(value: &Value, key: &str) -> u64 {
    value[key]
        .as_u64()
        .unwrap_or_else(|| panic!("no {key} in {value}"))
}
