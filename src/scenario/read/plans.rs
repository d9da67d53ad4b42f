//! The floor plans that a file names.

use std::path::Path;

use serde_json::{Value, json};

use crate::error::Problem;
use crate::error::quote::shown;
use crate::file::File;
use crate::floor_plan;
use crate::floor_plan::{FloorPlan, Place};
use crate::keys::shapes::{Outline, Ring};
use crate::read::places::{self, Site};
pub use crate::read::plan_files::{KEYS, LEVELS, PlanFile};
use crate::read::plan_files::{
    LABELS, READING, TYPED, add_labels, labels_of, named, outlines, polygons, reading_of,
};
use crate::read::plan_levels;
use crate::read::setting::Setting;
use crate::scene::surroundings::{OBSTACLES, WALKABLE_AREA};

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
        let reading = reading_of(&document[READING])?;
        let mut sites = Vec::new();
        if document.get(LEVELS).is_some() {
            (files, sites) = plan_levels::take(document, folder, notes)?;
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
        sites.push(Site {
            level: None,
            places: plans.places.clone(),
            floor,
        });
        let entered = places::enter(document, &sites);
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
