//! Small studies for the tests of sweeps.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;

/// Nine people in a room for 0.4 s, with measurements of density and arrivals.
pub const ROOM: &str = r#"{"goal": [10, 1], "profile": "sph", "duration_secs": 0.4,
    "obstacles": [[[-1, -1], [4, -1], [4, -0.5], [-1, -0.5]]],
    "grids": [{"min": [0, 0], "max": [2, 2], "columns": 3, "rows": 3, "jitter": 0.1}],
    "measurements": [{"density": {"at_secs": 0.2}}, {"evacuated": {}}]}"#;

/// One person in a crack between two obstacles that fill the rest of the floor. If jitter puts the person beside
/// the crack, there is no free point nearby and the run fails at its start.
pub const CRACK: &str = r#"{"goal": [2, 40], "duration_secs": 0.1, "navigation": "straight",
    "walkable_area": [[[[0, 0], [4, 0], [4, 4], [0, 4]]]],
    "obstacles": [[[-1, -1], [2, -1], [2, 5], [-1, 5]],
                  [[2.0000005, -1], [5, -1], [5, 5], [2.0000005, 5]]],
    "sources": [{"min": [2.00000025, 2], "max": [2.00000025, 2], "columns": 1, "rows": 1,
                 "every_secs": 1, "times": 1}]}"#;

/// A folder with the scenarios `room.json` and `crack.json`, and `study.json`.
pub fn folder(study: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("room.json"), ROOM).unwrap();
    fs::write(folder.path().join("crack.json"), CRACK).unwrap();
    let path = put(folder.path(), study);
    (folder, path)
}

/// Writes another `study.json`.
pub fn put(folder: &Path, study: &str) -> PathBuf {
    let path = folder.join("study.json");
    fs::write(&path, study).unwrap();
    path
}

/// The rows of a CSV file as named values, without `wall_secs`.
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

/// One column of the rows of a CSV file.
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

/// The files in `cases/` with this extension, without those that are being written.
pub fn cases(out: &Path, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(out.join("cases")).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.to_str().unwrap().ends_with(extension))
        .filter(|path| !path.file_name().unwrap().to_str().unwrap().starts_with('.'))
        .collect()
}

/// An integer in a JSON object.
pub fn number(value: &Value, key: &str) -> u64 {
    value[key]
        .as_u64()
        .unwrap_or_else(|| panic!("no {key} in {value}"))
}
