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

/// The geometry of the floor plans that a scenario names.
#[derive(Debug, Clone, Default)]
pub struct Plans {
    walkable: Option<Vec<Area>>,
    obstacles: Option<Vec<Area>>,
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
                plans.obstacles = Some(plan.obstacles);
            } else {
                document[key] = Value::Null;
                plans.walkable = Some(plan.walkable);
            }
        }
        Ok((plans, files))
    }

    /// Enters the geometry into the keys of a document that lacks it.
    pub fn enter(&self, keys: &mut File) {
        if let Some(walkable) = &self.walkable {
            keys.walkable_area = Some(walkable.iter().map(rings).collect());
        }
        if let Some(obstacles) = &self.obstacles {
            keys.obstacles = obstacles.iter().map(outline).collect();
        }
    }

    /// Writes the geometry in `keys` into a document that lacks it.
    pub fn write(&self, keys: &File, document: &mut Value) {
        if self.walkable.is_some() {
            document[WALKABLE_AREA] = json!(keys.walkable_area);
        }
        if self.obstacles.is_some() {
            document[OBSTACLES] = json!(keys.obstacles);
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
        let walkable: Vec<_> = plan.walkable.iter().map(rings).collect();
        let obstacles: Vec<_> = plan.obstacles.iter().map(outline).collect();
        let walkable = Some(walkable).filter(|areas| !areas.is_empty());
        [
            Self::of(WALKABLE_AREA, json!(walkable), text),
            Self::of(OBSTACLES, json!(obstacles), text),
            Self::of(LABELS, labels_of(plan).collect(), text),
        ]
    }
}

/// The names of a plan as labels.
fn labels_of(plan: &FloorPlan) -> impl Iterator<Item = Value> {
    let names = plan.names.iter();
    names.map(|Label { text, at, width }| json!({"text": text, "at": [at.x, at.y], "width": width}))
}

/// The outline of an area, then its holes.
fn rings(area: &Area) -> Vec<Ring> {
    area.rings().map(Into::into).collect()
}

fn outline(area: &Area) -> Outline {
    match area.holes.is_empty() {
        true => Outline::Ring((&area.exterior).into()),
        false => Outline::Rings(rings(area)),
    }
}
