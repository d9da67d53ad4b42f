//! The example of docs/guide/buildings.md, and the trajectories of its runs.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::program::{run, text};

/// The example of the page, in a folder.
pub fn house(folder: &TempDir) -> String {
    let page = include_str!("../../docs/guide/buildings.md");
    let example = page.split("```json\n").nth(1).unwrap();
    let path = folder.path().join("house.json");
    std::fs::write(&path, example.split("```").next().unwrap()).unwrap();
    text(&path).to_owned()
}

/// The trajectories of a scenario up to a time, in all formats that have levels.
pub fn in_all_formats(folder: &TempDir, scenario: &str, until: &str) -> [PathBuf; 3] {
    let files = ["a.csv", "a.sqlite", "a.txt"].map(|name| folder.path().join(name));
    for file in &files {
        let output = run(&[
            "run",
            scenario,
            "--until",
            until,
            "--trajectory",
            text(file),
        ]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
    files
}

/// The rows of a trajectory file: for each, its columns by name.
pub fn rows(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let rows = reader.deserialize();
    rows.map(Result::unwrap).collect()
}

/// The people of the example in the frame at a time: id, level, place and height.
pub type People = BTreeMap<u64, (String, [f64; 3])>;

/// The people of a CSV file in one of its frames.
pub fn people(file: &Path, frame: &str) -> People {
    let rows = rows(file).into_iter().filter(|row| row["frame"] == frame);
    let people = rows.map(|row| {
        let place = ["pos_x", "pos_y", "z"].map(|name| row[name].parse().unwrap());
        (row["id"].parse().unwrap(), (row["level"].clone(), place))
    });
    people.collect()
}
