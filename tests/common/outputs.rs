//! A folder of inputs, and checks of what commands do to it.

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Output;

use tempfile::TempDir;

use super::program::{run_in, stderr};

pub const SCENARIO: &str =
    r#"{"goal": [9, 0], "duration_secs": 1, "agents": [{"position": [0, 0]}]}"#;

/// A folder with inputs, links and a checkpoint of 1 s.
pub fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::write(at("s.json"), SCENARIO).unwrap();
    fs::write(at("area.csv"), "POLYGON ((-5 -5, 20 -5, 20 5, -5 5))").unwrap();
    let planned = SCENARIO.replacen('{', r#"{"walkable_area": "area.csv", "#, 1);
    fs::write(at("planned.json"), planned).unwrap();
    fs::create_dir(at("dir")).unwrap();
    symlink("dir", at("linked")).unwrap();
    symlink("s.json", at("link.csv")).unwrap();
    symlink("s.json", at("link.rrd")).unwrap();
    symlink("new", at("dangling.csv")).unwrap();
    fs::hard_link(at("s.json"), at("hard.csv")).unwrap();
    fs::write(at("tracks.txt"), "# framerate: 10\n1 0 0 0\n1 1 1 0\n").unwrap();
    let written = run(folder.path(), "run s.json --checkpoint c");
    assert_eq!(written.status.code(), Some(0), "{}", stderr(&written));
    folder
}

/// Runs the program in `folder` with the arguments in `typed`, separated by spaces.
pub fn run(folder: &Path, typed: &str) -> Output {
    run_in(folder, &typed.split(' ').collect::<Vec<_>>())
}

/// The names in a folder, with the contents of regular files.
pub fn contents(folder: &Path) -> BTreeMap<String, Option<Vec<u8>>> {
    let entries = fs::read_dir(folder).unwrap().flatten();
    let content = |path: &Path| path.is_file().then(|| fs::read(path).unwrap());
    entries
        .map(|entry| {
            let name = entry.file_name().into_string().unwrap();
            (name, content(&entry.path()))
        })
        .collect()
}

/// Expects exit code `code`, `words` on stderr, nothing on stdout, and an unchanged folder.
pub fn refused(folder: &Path, typed: &str, code: i32, words: &[&str]) {
    let before = contents(folder);
    let output = run(folder, typed);
    let stderr = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{typed}: {stderr}");
    for word in words {
        assert!(stderr.contains(word), "{typed}: no {word:?} in {stderr}");
    }
    assert!(output.stdout.is_empty(), "{typed}");
    assert_eq!(contents(folder), before, "{typed}");
    assert_eq!(contents(&folder.join("dir")), BTreeMap::new(), "{typed}");
}
