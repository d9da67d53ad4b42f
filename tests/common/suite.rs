//! The suite of docs/guide/suites.md.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

/// The files of the example in docs/guide/suites.md: a scenario and a suite.
pub fn example() -> TempDir {
    let document = include_str!("../../docs/guide/suites.md");
    let folder = tempfile::tempdir().unwrap();
    for name in ["room.json", "my_suite.json"] {
        let (_, listing) = document.split_once(&format!("`{name}`, ")).unwrap();
        let listing = listing.split("```").nth(1).unwrap();
        let listing = listing.strip_prefix("json\n").unwrap();
        fs::write(folder.path().join(name), listing).unwrap();
    }
    folder
}

/// The suite of the example, with another value at `pointer`.
pub fn changed(folder: &Path, pointer: &str, value: Value) {
    let path = folder.join("my_suite.json");
    let mut suite: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    match suite.pointer_mut(pointer) {
        Some(old) => *old = value,
        None => {
            let (parent, key) = pointer.rsplit_once('/').unwrap();
            suite.pointer_mut(parent).unwrap()[key] = value;
        }
    }
    fs::write(path, suite.to_string()).unwrap();
}
