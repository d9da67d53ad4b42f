//! The levels of a building that one file has.

use std::path::{Path, PathBuf};

use super::drawn_levels::{DrawnLevel, DrawnLevels};
pub use super::drawn_levels::{LevelForm, PlanJoin};
use super::error::FloorPlanError;
use super::reading::{Drawn, Reading};
use super::{FloorPlan, imdf, in_file, is_drawing, xml};
use crate::error::quote::shown;
use crate::input;
use crate::input::archive::{entries, is_archive};

/// A level of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanLevel {
    /// Its name, which no other level has.
    pub name: String,
    /// What it is.
    pub form: LevelForm,
    /// Its floor plan.
    pub plan: FloorPlan,
}

/// The levels of a file and their joins.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlanLevels {
    /// The levels.
    pub levels: Vec<PlanLevel>,
    /// Where they meet.
    pub joins: Vec<PlanJoin>,
    /// What readers of the results should know.
    pub notes: Vec<String>,
    /// The files that were read.
    pub files: Vec<PathBuf>,
}

/// Reads all levels of a file: GeoJSON in the words of IMDF, also as a folder or a zip archive of such files, or
/// JuPedSim's XML. `reading` has what the file does not say itself.
///
/// # Errors
/// The file cannot be read, has no levels, or they are wrong. The message has the file and the place.
pub fn read_levels(path: &Path, reading: &Reading) -> Result<PlanLevels, FloorPlanError> {
    if path.is_dir() {
        return in_folder(path, reading);
    }
    let mut found = in_file(path, |bytes| parse(bytes, path, reading))?;
    found.files = vec![path.to_owned()];
    Ok(found)
}

/// Reads the content of one file.
fn parse(bytes: &[u8], path: &Path, reading: &Reading) -> Result<PlanLevels, FloorPlanError> {
    let one_floor = |what: &str| {
        let reason = format!("{what} has one floor: name it under `walkable_area` of a level");
        Err(FloorPlanError::Levels(reason))
    };
    if is_archive(bytes) {
        return PlanLevels::of(imdf::levels(&unpacked(bytes)?, reading)?);
    }
    if is_drawing(bytes, Some(path)) {
        return one_floor("a drawing");
    }
    let whole = input::text_of(bytes.to_vec())
        .map_err(|error| FloorPlanError::Unreadable(error.to_string()))?;
    let text = whole.trim_start();
    match text.bytes().next() {
        Some(b'{') if imdf::is_imdf(text) => {
            PlanLevels::of(imdf::levels(&[(String::new(), text.to_owned())], reading)?)
        }
        Some(b'{') => {
            one_floor("GeoJSON whose features have no `feature_type` (level, unit, opening)")
        }
        Some(b'<') => PlanLevels::of(xml::levels(text, reading)?),
        _ => one_floor("WKT"),
    }
}

/// The GeoJSON files in an archive, each with its name without folders and ending.
fn unpacked(archive: &[u8]) -> Result<Vec<(String, String)>, FloorPlanError> {
    let unreadable = |reason: String| FloorPlanError::Unreadable(reason);
    let mut files = Vec::new();
    for entry in entries(archive).map_err(unreadable)? {
        let path = Path::new(&entry.name);
        if !is_collection(path) {
            continue;
        }
        let within = |reason: String| unreadable(format!("{}: {reason}", shown(&entry.name)));
        let content = entry.content(archive).map_err(within)?;
        let text = input::text_of(content).map_err(|error| within(error.to_string()))?;
        files.push((stem(path), text));
    }
    Ok(files)
}

/// Reads the GeoJSON files in a folder.
fn in_folder(folder: &Path, reading: &Reading) -> Result<PlanLevels, FloorPlanError> {
    let within = |error: FloorPlanError| FloorPlanError::File {
        path: folder.to_owned(),
        error: Box::new(error),
    };
    let read = folder.read_dir();
    let listed = read.map_err(|e| within(FloorPlanError::Unreadable(e.to_string())))?;
    let mut paths: Vec<PathBuf> = listed.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| is_collection(path));
    paths.sort();
    let mut files = Vec::new();
    for path in &paths {
        let text = in_file(path, |bytes| {
            let text = input::text_of(bytes.to_vec());
            text.map_err(|error| FloorPlanError::Unreadable(error.to_string()))
        })?;
        files.push((stem(path), text));
    }
    let read = imdf::levels(&files, reading).and_then(PlanLevels::of);
    let mut found = read.map_err(within)?;
    found.files = paths;
    Ok(found)
}

/// Whether a file is read as a part of a building: IMDF has one for each kind of features, and `manifest.json`.
fn is_collection(path: &Path) -> bool {
    super::has_ending(path, "geojson")
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or(String::new(), |stem| stem.to_string_lossy().to_lowercase())
}

impl PlanLevels {
    /// Unites the shapes of each level.
    ///
    /// # Errors
    /// There is one floor only, or a level is no valid floor plan.
    fn of(drawn: DrawnLevels) -> Result<Self, FloorPlanError> {
        let is_floor = |level: &&DrawnLevel| matches!(level.form, LevelForm::Floor(_));
        let mut floors = drawn.levels.iter().filter(is_floor);
        if let (Some(only), None) = (floors.next(), floors.next()) {
            let reason = format!(
                "it has one level only, `{}`: name it under `walkable_area` instead of `levels`",
                shown(&only.name)
            );
            return Err(FloorPlanError::Levels(reason));
        }
        let mut found = Self {
            joins: drawn.joins,
            notes: drawn.notes,
            ..Self::default()
        };
        for DrawnLevel { name, form, shapes } in drawn.levels {
            let shapes = Drawn {
                shapes,
                ..Drawn::default()
            };
            let of_level = format!("level `{}`", shown(&name));
            let plan = FloorPlan::noted(shapes).map_err(|error| error.of_level(&of_level))?;
            let notes = plan.notes.iter();
            found
                .notes
                .extend(notes.map(|note| format!("{of_level}: {note}")));
            found.levels.push(PlanLevel { name, form, plan });
        }
        let is_joined = |k: usize| found.joins.iter().any(|join| join.levels.contains(&k));
        for (k, level) in found.levels.iter().enumerate() {
            if !is_joined(k) {
                let name = shown(&level.name);
                found
                    .notes
                    .push(format!("level `{name}`: no stairs or ramp leads to it"));
            }
        }
        Ok(found)
    }
}
