//! The floor plans that a file names.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::error::Problem;
use crate::error::quote::shown;
use crate::file::File;
use crate::floor_plan;
use crate::floor_plan::{FloorPlan, Label};
use crate::keys::shapes::{Outline, Ring};
use crate::read::setting::Setting;
use crate::scene::surroundings::{OBSTACLES, WALKABLE_AREA};
use engine::geometry::Area;

/// The keys that may name a file.
pub const KEYS: [&str; 2] = [WALKABLE_AREA, OBSTACLES];
/// Words with which WKT begins.
const WKT: [&str; 3] = ["POLYGON", "MULTIPOLYGON", "GEOMETRYCOLLECTION"];
/// The key that gets the names in these files.
const LABELS: &str = "labels";

/// The key that names a file, and the file: a floor plan or trajectories.
pub type PlanFile = (&'static str, PathBuf);

/// The geometry of the floor plans that a scenario names, in the form of keys.
#[derive(Default)]
pub struct Plans {
    walkable: Option<Vec<Vec<Ring>>>,
    obstacles: Option<Vec<Outline>>,
}

impl Plans {
    /// Reads the files that `document` names, relative to `folder`, and takes their names out of it. Adds their labels
    /// to the document, and notes on them. Returns also the files, each with its key.
    pub fn take(
        document: &mut Value,
        folder: &Path,
        notes: &mut Vec<String>,
    ) -> Result<(Self, Vec<PlanFile>), Problem> {
        let (mut plans, mut files) = (Self::default(), Vec::new());
        for key in KEYS {
            let Some(name) = file_name(document, key)? else {
                continue;
            };
            let path = folder.join(&name);
            let read = match key {
                OBSTACLES => floor_plan::read_obstacles(&path),
                _ => floor_plan::read(&path),
            };
            let plan = read.map_err(|error| Problem::from(error).under(key))?;
            files.push((key, path));
            let name = shown(&name);
            if key == WALKABLE_AREA && plan.walkable.is_empty() {
                let reason = format!("{name}: contains only obstacles; name it under `obstacles`");
                return Err(Problem::new(key, reason));
            }
            for note in &plan.notes {
                notes.push(format!("{key}: {name}: {note}"));
            }
            if !plan.names.is_empty() {
                if document.get(LABELS).is_none() {
                    document[LABELS] = json!([]);
                }
                // Anything else is rejected later.
                if let Value::Array(labels) = &mut document[LABELS] {
                    labels.extend(labels_of(&plan));
                }
            }
            if key == OBSTACLES {
                document[key] = json!([]);
                plans.obstacles = Some(outlines(&plan.obstacles));
            } else {
                document[key] = Value::Null;
                plans.walkable = Some(polygons(&plan.walkable));
            }
        }
        Ok((plans, files))
    }

    /// Enters the geometry into the keys of a document that lacks it.
    pub fn enter(self, keys: &mut File) {
        keys.walkable_area = self.walkable.or(keys.walkable_area.take());
        if let Some(obstacles) = self.obstacles {
            keys.obstacles = obstacles;
        }
    }
}

/// Writes the geometry of `files`, which `keys` have, into a document that lacks it.
pub fn write(files: &[PlanFile], keys: &File, document: &mut Value) {
    for &(key, _) in files {
        match key {
            WALKABLE_AREA => document[key] = json!(keys.walkable_area),
            OBSTACLES => document[key] = json!(keys.obstacles),
            _ => {}
        }
    }
}

/// The name of the file that `document` has under a key.
fn file_name(document: &Value, key: &str) -> Result<Option<String>, Problem> {
    let reason = match document.get(key) {
        None | Some(Value::Null | Value::Array(_)) => return Ok(None),
        Some(Value::String(name)) if WKT.iter().any(|word| name.trim_start().starts_with(word)) => {
            "is WKT itself: save it as a file that ends in .wkt, and give its name here"
        }
        Some(Value::String(name)) => return Ok(Some(name.clone())),
        Some(Value::Object(plan)) if plan.contains_key("type") => {
            "is GeoJSON: save it as a file that ends in .geojson, and give its name here"
        }
        Some(_) => "must be a list of polygons, or the name of a file",
    };
    Err(Problem::new(key, reason))
}

impl Setting {
    /// Settings that replace a scenario's walkable area, obstacles and labels with those of `plan`; messages call them
    /// `text`.
    pub fn floor_plan(plan: &FloorPlan, text: &str) -> [Self; 3] {
        let walkable = Some(&plan.walkable).filter(|areas| !areas.is_empty());
        [
            Self::of(
                WALKABLE_AREA,
                json!(walkable.map(|areas| polygons(areas))),
                text,
            ),
            Self::of(OBSTACLES, json!(outlines(&plan.obstacles)), text),
            Self::of(LABELS, labels_of(plan).collect(), text),
        ]
    }
}

/// The names of a plan as labels.
fn labels_of(plan: &FloorPlan) -> impl Iterator<Item = Value> {
    let names = plan.names.iter();
    names.map(|Label { text, at, width }| json!({"text": text, "at": [at.x, at.y], "width": width}))
}

/// Areas, each as its outline, then its holes.
fn polygons(areas: &[Area]) -> Vec<Vec<Ring>> {
    let rings = |area: &Area| area.rings().map(Into::into).collect();
    areas.iter().map(rings).collect()
}

/// Areas, each as its outline, or as a list of rings if it has holes.
fn outlines(areas: &[Area]) -> Vec<Outline> {
    let outline = |area: &Area| match area.holes.is_empty() {
        true => Outline::Ring((&area.exterior).into()),
        false => Outline::Rings(area.rings().map(Into::into).collect()),
    };
    areas.iter().map(outline).collect()
}
