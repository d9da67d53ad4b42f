//! The floor plans that a file names.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::error::Problem;
use crate::error::quote::shown;
use crate::floor_plan;
use crate::floor_plan::{FloorPlan, Label};
use crate::read::setting::Setting;
use crate::scene::surroundings::{OBSTACLES, WALKABLE_AREA};
use engine::geometry::{Area, Ring};

/// The keys that may name a file.
pub const KEYS: [&str; 2] = [WALKABLE_AREA, OBSTACLES];
/// Words with which WKT begins.
const WKT: [&str; 3] = ["POLYGON", "MULTIPOLYGON", "GEOMETRYCOLLECTION"];
/// The key that gets the names in these files.
const LABELS: &str = "labels";

/// The key that names a file, and the file: a floor plan or trajectories.
pub type PlanFile = (&'static str, PathBuf);

/// Replaces the names of floor plan files, relative to `folder`, with their contents, and adds notes on them. Returns
/// the files, each with its key.
pub fn fill(
    document: &mut Value,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<Vec<PlanFile>, Problem> {
    let mut files = Vec::new();
    let Value::Object(document) = document else {
        return Ok(files);
    };
    for (key, read) in [
        (WALKABLE_AREA, floor_plan::read as fn(&Path) -> _),
        (OBSTACLES, floor_plan::read_obstacles),
    ] {
        let name = match document.get(key) {
            Some(Value::String(name)) => name,
            None | Some(Value::Null | Value::Array(_)) => continue,
            Some(Value::Object(plan)) if plan.contains_key("type") => {
                let reason =
                    "is GeoJSON: save it as a file that ends in .geojson, and give its name here";
                return Err(Problem::new(key, reason));
            }
            Some(_) => {
                let reason = "must be a list of polygons, or the name of a file";
                return Err(Problem::new(key, reason));
            }
        };
        if WKT.iter().any(|word| name.trim_start().starts_with(word)) {
            let reason =
                "is WKT itself: save it as a file that ends in .wkt, and give its name here";
            return Err(Problem::new(key, reason));
        }
        let path = folder.join(name);
        let plan: FloorPlan = read(&path).map_err(|error| Problem::from(error).under(key))?;
        files.push((key, path));
        let read = plan.notes.iter();
        notes.extend(read.map(|note| format!("{key}: {}: {note}", shown(name))));
        let value = match key {
            OBSTACLES => obstacles_value(&plan),
            _ if plan.walkable.is_empty() => {
                let reason = format!(
                    "{}: contains only obstacles; name it under `obstacles`",
                    shown(name)
                );
                return Err(Problem::new(key, reason));
            }
            _ => walkable_value(&plan),
        };
        document.insert(key.to_owned(), value);
        if !plan.names.is_empty() {
            let labels = document.entry(LABELS).or_insert_with(|| json!([]));
            // Anything else is rejected later.
            if let Value::Array(labels) = labels {
                labels.extend(labels_of(&plan));
            }
        }
    }
    Ok(files)
}

impl Setting {
    /// Settings that replace a scenario's walkable area, obstacles and labels with those of `plan`; messages call them
    /// `text`.
    pub fn floor_plan(plan: &FloorPlan, text: &str) -> [Self; 3] {
        let walkable = match plan.walkable.is_empty() {
            true => Value::Null,
            false => walkable_value(plan),
        };
        [
            Self::of(WALKABLE_AREA, walkable, text),
            Self::of(OBSTACLES, obstacles_value(plan), text),
            Self::of(LABELS, labels_of(plan).collect(), text),
        ]
    }
}

fn walkable_value(plan: &FloorPlan) -> Value {
    plan.walkable.iter().map(rings_value).collect()
}

fn obstacles_value(plan: &FloorPlan) -> Value {
    let obstacle = |area: &Area| match area.holes.is_empty() {
        true => ring_value(&area.exterior),
        false => rings_value(area),
    };
    plan.obstacles.iter().map(obstacle).collect()
}

/// The names of a plan as labels.
fn labels_of(plan: &FloorPlan) -> impl Iterator<Item = Value> {
    let names = plan.names.iter();
    names.map(|Label { text, at, width }| json!({"text": text, "at": [at.x, at.y], "width": width}))
}

fn rings_value(area: &Area) -> Value {
    area.rings().map(ring_value).collect()
}

fn ring_value(ring: &Ring) -> Value {
    ring.points().iter().map(|p| json!([p.x, p.y])).collect()
}
