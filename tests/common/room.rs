//! A room that 12 people leave, and reports on it.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::program::{json, run_in, stderr};

/// 12 people leave a room by two exits.
pub fn scenario(folder: &Path) {
    let room = json!({
        "name": "room <&>", "description": "Twelve people & two doors", "duration_secs": 30,
        "profile": "steer+sph", "stop": {"when_empty": true},
        "walkable_area": [[[[0, 0], [8, 0], [8, 6], [0, 6]]]],
        "exits": [{"name": "east", "line": [[8, 2], [8, 4]]}, {"name": "west", "line": [[0, 2], [0, 4]]}],
        "journeys": [{"name": "out", "stages": [{"nearest": ["east", "west"]}]}],
        "crowds": [{"area": [[1, 1], [7, 1], [7, 5], [1, 5]], "number": 12, "journey": "out"}],
        "measurements": [{"line_flow": {"line": [[7.5, 2], [7.5, 4]]}}]
    });
    fs::write(folder.join("room.json"), room.to_string()).unwrap();
}

/// Runs a command in the folder and returns the JSON on stdout.
pub fn done(folder: &Path, arguments: &[&str]) -> Value {
    let output = run_in(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    json(&output)
}
