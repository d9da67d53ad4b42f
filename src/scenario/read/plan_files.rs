//! The files that a document names: their keys, how they are read, and their content as keys.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::error::Problem;
use crate::floor_plan::{FloorPlan, FloorPlanError, Label, Reading};
use crate::keys::shapes::{Outline, Ring};
use crate::read::parsed::parsed;
use crate::scene::surroundings::{OBSTACLES, WALKABLE_AREA};
use engine::geometry::Area;

/// The keys that may name a file.
pub const KEYS: [&str; 2] = [WALKABLE_AREA, OBSTACLES];
/// Words with which WKT begins.
const WKT: [&str; 3] = ["POLYGON", "MULTIPOLYGON", "GEOMETRYCOLLECTION"];
/// The key that says how they are read.
pub(super) const READING: &str = "plan";
/// The levels of a building: a file with all of them, or a list of levels, which may name files of their own.
pub const LEVELS: &str = "levels";
/// The key that gets the names in these files.
pub(super) const LABELS: &str = "labels";

/// The key that names a file, and the file: a floor plan or trajectories.
pub type PlanFile = (&'static str, PathBuf);

/// How files are read, as a key `plan` has it.
pub(super) fn reading_of(given: &Value) -> Result<Reading, Problem> {
    match given {
        Value::Null => Ok(Reading::default()),
        given => parsed(given).map_err(|problem| problem.under(READING)),
    }
}

/// Adds labels to a document.
pub(super) fn add_labels(document: &mut Value, added: Vec<Value>) {
    if added.is_empty() {
        return;
    }
    if document.get(LABELS).is_none() {
        document[LABELS] = json!([]);
    }
    // Anything else is rejected later.
    if let Value::Array(labels) = &mut document[LABELS] {
        labels.extend(added);
    }
}

/// A file that a document names.
pub(super) struct Named {
    pub(super) file: String,
    /// Whether the command line names it, in place of the plan of the scenario.
    pub(super) is_typed: bool,
}

impl Named {
    /// The problem with it. The command line is named in front of it already.
    pub(super) fn refused(&self, error: FloorPlanError) -> Problem {
        match error {
            FloorPlanError::File { error, .. } if self.is_typed => {
                Problem::new("", error.to_string())
            }
            error => error.into(),
        }
    }
}

/// The key of the file that the command line names.
pub(super) const TYPED: &str = "geometry";

/// The file that `document` has under a key.
pub(super) fn named(document: &Value, key: &str) -> Result<Option<Named>, Problem> {
    let reason = match document.get(key) {
        None | Some(Value::Null | Value::Array(_)) => return Ok(None),
        Some(Value::String(name)) if WKT.iter().any(|word| name.trim_start().starts_with(word)) => {
            "is WKT itself: save it as a file that ends in .wkt, and give its name here"
        }
        Some(Value::String(name)) => {
            return Ok(Some(Named {
                file: name.clone(),
                is_typed: false,
            }));
        }
        Some(Value::Object(plan)) if plan.contains_key("type") => {
            "is GeoJSON: save it as a file that ends in .geojson, and give its name here"
        }
        Some(Value::Object(plan)) if plan.get(TYPED).is_some_and(Value::is_string) => {
            return Ok(Some(Named {
                file: plan[TYPED].as_str().unwrap_or_default().to_owned(),
                is_typed: true,
            }));
        }
        Some(_) => "must be a list of polygons, or the name of a file",
    };
    Err(Problem::new(key, reason))
}

/// The names of a plan as labels.
pub(super) fn labels_of(plan: &FloorPlan) -> impl Iterator<Item = Value> {
    let names = plan.names.iter();
    names.map(|Label { text, at, width }| json!({"text": text, "at": [at.x, at.y], "width": width}))
}

/// Areas, each as its outline, then its holes.
pub(super) fn polygons(areas: &[Area]) -> Vec<Vec<Ring>> {
    let rings = |area: &Area| area.rings().map(Into::into).collect();
    areas.iter().map(rings).collect()
}

/// Areas, each as its outline, or as a list of rings if it has holes.
pub(super) fn outlines(areas: &[Area]) -> Vec<Outline> {
    let outline = |area: &Area| match area.holes.is_empty() {
        true => Outline::Ring((&area.exterior).into()),
        false => Outline::Rings(area.rings().map(Into::into).collect()),
    };
    areas.iter().map(outline).collect()
}
