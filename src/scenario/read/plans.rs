//! The floor plans that a file names.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::error::Problem;
use crate::error::quote::shown;
use crate::file::File;
use crate::floor_plan;
use crate::floor_plan::{FloorPlan, FloorPlanError, Label, Place, Reading};
use crate::keys::shapes::{Outline, Ring};
use crate::read::parsed::parsed;
use crate::read::places;
use crate::read::setting::Setting;
use crate::scene::surroundings::{OBSTACLES, WALKABLE_AREA};
use engine::geometry::Area;

/// The keys that may name a file.
pub const KEYS: [&str; 2] = [WALKABLE_AREA, OBSTACLES];
/// Words with which WKT begins.
const WKT: [&str; 3] = ["POLYGON", "MULTIPOLYGON", "GEOMETRYCOLLECTION"];
/// The key that says how they are read.
const READING: &str = "plan";
/// The levels of a building, which may name files of their own.
const LEVELS: &str = "levels";
/// The key that gets the names in these files.
const LABELS: &str = "labels";

/// The key that names a file, and the file: a floor plan or trajectories.
pub type PlanFile = (&'static str, PathBuf);

/// The geometry of the floor plans that a scenario names, in the form of keys.
#[derive(Default)]
pub struct Plans {
    walkable: Option<Vec<Vec<Ring>>>,
    obstacles: Option<Vec<Outline>>,
    /// What they name.
    pub places: Vec<Place>,
}

impl Plans {
    /// Reads the files that `document` names, relative to `folder`, and takes their names out of it. Adds their labels
    /// to the document, and notes on them; replaces names of their places by their geometry. Returns also the files,
    /// each with its key.
    pub fn take(
        document: &mut Value,
        folder: &Path,
        notes: &mut Vec<String>,
    ) -> Result<(Self, Vec<PlanFile>), Problem> {
        let (mut plans, mut files) = (Self::default(), Vec::new());
        let reading = reading(document)?;
        let levels = document.get(LEVELS).and_then(Value::as_array);
        for k in 0..levels.map_or(0, Vec::len) {
            let place = format!("{LEVELS}[{k}]");
            let taken = take_level(document, k, (folder, &reading), notes);
            files.extend(taken.map_err(|problem| problem.under(&place))?);
        }
        let mut floor = Vec::new();
        for key in KEYS {
            let Some(named) = named(document, key)? else {
                continue;
            };
            let path = folder.join(&named.file);
            let read = match key {
                OBSTACLES => floor_plan::read_obstacles_as(&path, &reading),
                _ => floor_plan::read_as(&path, &reading),
            };
            let mut plan = read.map_err(|error| named.refused(error).under(key))?;
            files.push((key, path));
            let name = shown(&named.file);
            if key == WALKABLE_AREA && plan.walkable.is_empty() && !named.is_typed {
                let reason = format!("{name}: contains only obstacles; name it under `obstacles`");
                return Err(Problem::new(key, reason));
            }
            for note in &plan.notes {
                notes.push(match named.is_typed {
                    true => format!("{name}: {note}"),
                    false => format!("{key}: {name}: {note}"),
                });
            }
            add_labels(document, labels_of(&plan).collect());
            plans.places.append(&mut plan.places);
            plans.add(document, key, &plan);
            floor.append(&mut plan.walkable);
        }
        let entered = places::enter(document, &plans.places, &floor);
        entered.map_err(|problem| {
            // How the plan was read may explain a name that it lacks.
            let read = notes.iter().map(|note| format!("; note: {note}"));
            Problem::new(problem.path, problem.reason + &read.collect::<String>())
        })?;
        Ok((plans, files))
    }

    /// Takes the geometry of the plan that `document` names under a key.
    fn add(&mut self, document: &mut Value, key: &str, plan: &FloorPlan) {
        if key == WALKABLE_AREA {
            document[key] = Value::Null;
            self.walkable = Some(&plan.walkable)
                .filter(|areas| !areas.is_empty())
                .map(|areas| polygons(areas));
        }
        if key == OBSTACLES || plan.walkable.is_empty() {
            document[OBSTACLES] = json!([]);
            self.obstacles = Some(outlines(&plan.obstacles));
        }
    }

    /// Enters the geometry into the keys of a document that lacks it.
    pub fn enter(self, keys: &mut File) {
        keys.walkable_area = self.walkable.or(keys.walkable_area.take());
        if let Some(obstacles) = self.obstacles {
            keys.obstacles = obstacles;
        }
    }
}

/// Reads the files that level `k` of a building names, into the document. Returns them, each with its key.
fn take_level(
    document: &mut Value,
    k: usize,
    (folder, reading): (&Path, &Reading),
    notes: &mut Vec<String>,
) -> Result<Vec<PlanFile>, Problem> {
    let mut files = Vec::new();
    for key in KEYS {
        let level = &document[LEVELS][k];
        let Some(named) = named(level, key)? else {
            continue;
        };
        let (name, path) = (level["name"].clone(), folder.join(&named.file));
        let read = match key {
            OBSTACLES => floor_plan::read_obstacles_as(&path, reading),
            _ => floor_plan::read_as(&path, reading),
        };
        let plan = read.map_err(|error| named.refused(error).under(key))?;
        if key == WALKABLE_AREA && plan.walkable.is_empty() {
            let reason = format!("{}: contains only obstacles", shown(&named.file));
            return Err(Problem::new(key, reason));
        }
        let said = plan.notes.iter();
        notes.extend(
            said.map(|note| format!("{LEVELS}[{k}].{key}: {}: {note}", shown(&named.file))),
        );
        files.push((LEVELS, path));
        let own = &mut document[LEVELS][k];
        match key {
            OBSTACLES => own[key] = json!(outlines(&plan.obstacles)),
            _ => {
                own[key] = json!(polygons(&plan.walkable));
                if own[OBSTACLES].is_null() {
                    own[OBSTACLES] = json!(outlines(&plan.obstacles));
                }
            }
        }
        let labels = labels_of(&plan).map(|mut label| {
            label["level"] = name.clone();
            label
        });
        add_labels(document, labels.collect());
    }
    Ok(files)
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

/// How the files are read.
fn reading(document: &Value) -> Result<Reading, Problem> {
    match document.get(READING) {
        None | Some(Value::Null) => Ok(Reading::default()),
        Some(given) => parsed(given).map_err(|problem| problem.under(READING)),
    }
}

/// Adds labels to a document.
fn add_labels(document: &mut Value, added: Vec<Value>) {
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
struct Named {
    file: String,
    /// Whether the command line names it, in place of the plan of the scenario.
    is_typed: bool,
}

impl Named {
    /// The problem with it. The command line is named in front of it already.
    fn refused(&self, error: FloorPlanError) -> Problem {
        match error {
            FloorPlanError::File { error, .. } if self.is_typed => {
                Problem::new("", error.to_string())
            }
            error => error.into(),
        }
    }
}

/// The key of the file that the command line names.
const TYPED: &str = "geometry";

/// The file that `document` has under a key.
fn named(document: &Value, key: &str) -> Result<Option<Named>, Problem> {
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

    /// As [`floor_plan`](Self::floor_plan), with the plan at `path`, which is read as the key `plan` says, and whose
    /// places the scenario may name.
    pub fn plan_file(path: &Path, text: &str) -> [Self; 3] {
        let there = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        [
            Self::of(WALKABLE_AREA, json!({ TYPED: there }), text),
            Self::of(OBSTACLES, json!([]), text),
            Self::of(LABELS, json!([]), text),
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
