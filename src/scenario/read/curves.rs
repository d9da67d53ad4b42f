//! The curves over time that a file names.

use std::path::Path;

use serde_json::{Value, json};

use crate::error::quote::shown;
use crate::error::{Problem, Under};
use crate::input;
use crate::read::plans::PlanFile;

/// The key of events that may name a file.
const KEY: &str = "acceleration";

/// Replaces the names of files with the forces of pushes, relative to `folder`, with their contents. Returns the files.
pub fn fill(document: &mut Value, folder: &Path) -> Result<Vec<PlanFile>, Problem> {
    let mut files = Vec::new();
    let events = document.get_mut("events").and_then(Value::as_array_mut);
    for (k, event) in events.into_iter().flatten().enumerate() {
        if let Some(curve) = event.get_mut(KEY)
            && let Some(name) = curve.as_str()
        {
            let path = folder.join(name);
            let points = read(&path).under(&format!("events[{k}].{KEY}"))?;
            *curve = json!(points);
            files.push((KEY, path));
        }
    }
    Ok(files)
}

/// The points in a text file: two numbers per line. A first line without numbers is a header.
fn read(path: &Path) -> Result<Vec<[f64; 2]>, Problem> {
    let file = shown(&path.display().to_string());
    let text = input::text(path)
        .map_err(|error| Problem::new("", format!("{file} cannot be read: {error}")))?;
    let mut points = Vec::new();
    for (k, line) in text.lines().enumerate() {
        let numbers = line.split_whitespace().map(|word| word.parse().ok());
        match numbers.collect::<Option<Vec<f64>>>().as_deref() {
            Some(&[secs, value]) => points.push([secs, value]),
            Some([]) => {}
            None if k == 0 => {}
            _ => {
                let line = k + 1;
                let reason = format!("{file}, line {line}: must be two numbers, seconds and m/s²");
                return Err(Problem::new("", reason));
            }
        }
    }
    Ok(points)
}
