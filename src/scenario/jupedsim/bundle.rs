//! The two files of a scenario of the web app, in a zip archive or beside each other.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::error::ScenarioError;
use crate::error::quote::shown;
use crate::input;
use crate::input::archive::{entries, is_archive};

/// The key that holds the geometry, as in the single files that JuPedSim's runner writes.
pub const GEOMETRY: &str = "walkable_area_wkt";
/// The key that holds the names of the two files.
pub const FILES: &str = "_files";
/// What a scenario consists of.
const PARTS: &str = "a scenario of JuPedSim's web app has one .json and one .wkt file";
/// Most files that a message names.
const MOST_NAMED: usize = 5;

/// The scenario in a zip archive, as one JSON text with the geometry; `None` for other files.
///
/// # Errors
/// The archive is damaged, or does not hold exactly one `.json` and one `.wkt` file. An error of `parse`.
pub fn text(
    path: &Path,
    parse: impl Fn(&str, &str) -> Result<Value, ScenarioError>,
) -> Result<Option<String>, ScenarioError> {
    if !path.is_file() || !starts_as_archive(path) {
        return Ok(None);
    }
    let unreadable = |reason| unreadable(path, reason);
    let [(config, text), (geometry, area)] = in_archive(path).map_err(unreadable)?;
    let mut document = parse(&text, &format!("{}: {config}", path.display()))?;
    if !super::is_web_app(&document) {
        return Err(unreadable(format!(
            "{config} is no scenario of JuPedSim's web app"
        )));
    }
    document[GEOMETRY] = area.trim().into();
    document[FILES] = json!([config, geometry]);
    Ok(Some(document.to_string()))
}

/// The geometry beside a scenario in a folder.
///
/// # Errors
/// The folder does not have exactly one `.wkt` file, or it cannot be read.
pub fn geometry_beside(file: &Path) -> Result<(PathBuf, String), String> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let names = names(folder)?;
    let name = only(&names, "wkt").map_err(|found| {
        format!("needs `{GEOMETRY}`, or one .wkt file beside it; there are {found}")
    })?;
    let path = folder.join(&name);
    let text = input::text(&path).map_err(|error| format!("{}: {error}", shown(&name)))?;
    Ok((path, text))
}

/// The `.json` file in a folder that has one, and one `.wkt` file.
pub fn config_in(folder: &Path) -> Option<PathBuf> {
    let names = names(folder).ok()?;
    only(&names, "wkt").ok()?;
    Some(folder.join(only(&names, "json").ok()?))
}

fn unreadable(path: &Path, reason: String) -> ScenarioError {
    ScenarioError::Unreadable {
        file: path.display().to_string(),
        reason,
    }
}

fn starts_as_archive(path: &Path) -> bool {
    let mut start = [0; 4];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut start));
    read.is_ok() && is_archive(&start)
}

/// The names and texts of a scenario and of its geometry.
type Files = [(String, String); 2];

fn in_archive(path: &Path) -> Result<Files, String> {
    let archive = input::bytes(path, input::LONGEST_TEXT).map_err(|error| error.to_string())?;
    let entries = entries(&archive)?;
    let names: Vec<String> = entries.iter().map(|entry| entry.name.clone()).collect();
    let read = |ending: &str| -> Result<(String, String), String> {
        let name =
            only(&names, ending).map_err(|found| format!("a zip archive with {found}; {PARTS}"))?;
        let entry = entries.iter().find(|entry| entry.name == name);
        let content = entry
            .map_or(Ok(Vec::new()), |entry| entry.content(&archive))
            .map_err(|reason| format!("{}: {reason}", shown(&name)))?;
        let text = input::text_of(content).map_err(|error| format!("{}: {error}", shown(&name)))?;
        Ok((name, text))
    };
    Ok([read("json")?, read("wkt")?])
}

/// The names of the files in a folder, sorted.
fn names(folder: &Path) -> Result<Vec<String>, String> {
    let folder = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let entries = folder.read_dir().map_err(|error| error.to_string())?;
    let files = entries.flatten().filter(|entry| entry.path().is_file());
    let all = files.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = all.filter(|name| !name.starts_with('.')).collect();
    names.sort();
    Ok(names)
}

/// The only name with this ending.
///
/// # Errors
/// There is none or several; what there is.
fn only(names: &[String], ending: &str) -> Result<String, String> {
    let has_ending = |name: &&String| {
        let found = Path::new(name).extension();
        found.is_some_and(|found| found.eq_ignore_ascii_case(ending))
    };
    let found: Vec<&String> = names.iter().filter(has_ending).collect();
    match found[..] {
        [name] => Ok(name.clone()),
        [] => Err(listed(names.iter().collect())),
        _ => Err(listed(found)),
    }
}

fn listed(names: Vec<&String>) -> String {
    let mut named: Vec<String> = names
        .iter()
        .take(MOST_NAMED)
        .map(|name| shown(name))
        .collect();
    match names.len().saturating_sub(MOST_NAMED) {
        0 if names.is_empty() => "no files".to_owned(),
        0 => named.join(", "),
        others => {
            named.push(format!("{others} others"));
            named.join(", ")
        }
    }
}
