//! The plan files of a building: one with all levels, or one for each.

use std::path::Path;

use serde_json::{Value, json};

use super::plan_files::{
    KEYS, LEVELS, PlanFile, READING, add_labels, labels_of, named, outlines, polygons, reading_of,
};
use crate::error::quote::shown;
use crate::error::{Problem, Under};
use crate::floor_plan;
use crate::floor_plan::{FloorPlan, LevelForm, PlanLevel, PlanLevels, Reading};
use crate::read::places::Site;
use crate::scene::surroundings::{OBSTACLES, WALKABLE_AREA};

/// The edges at which levels meet.
const JOINS: &str = "joins";

/// Reads the files of the levels of a document into it. Returns them, and what the levels name.
pub fn take(
    document: &mut Value,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<(Vec<PlanFile>, Vec<Site>), Problem> {
    match &document[LEVELS] {
        Value::String(name) => {
            let name = name.clone();
            take_all(document, &name, folder, notes).under(LEVELS)
        }
        Value::Array(levels) => {
            let (mut files, mut sites) = (Vec::new(), Vec::new());
            for k in 0..levels.len() {
                let place = format!("{LEVELS}[{k}]");
                let (own, site) = take_one(document, k, folder, notes).under(&place)?;
                files.extend(own);
                sites.extend(site);
            }
            Ok((files, sites))
        }
        _ => Ok((Vec::new(), Vec::new())),
    }
}

/// Reads the file `name`, which has all levels and their joins, into a document.
fn take_all(
    document: &mut Value,
    name: &str,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<(Vec<PlanFile>, Vec<Site>), Problem> {
    let reading = reading_of(&document[READING])?;
    let read = floor_plan::read_levels(&folder.join(name), &reading)?;
    let PlanLevels {
        levels,
        joins,
        notes: said,
        files,
    } = read;
    notes.extend(
        said.iter()
            .map(|note| format!("{LEVELS}: {}: {note}", shown(name))),
    );
    let names: Vec<&str> = levels.iter().map(|level| level.name.as_str()).collect();
    let of_file = joins.iter().map(|join| {
        let names = join.levels.map(|number| names[number]);
        json!({"levels": names, "line": join.line})
    });
    // Anything else than a list is rejected later.
    if let Value::Null | Value::Array(_) = document[JOINS] {
        let given = document[JOINS].as_array().cloned().unwrap_or_default();
        document[JOINS] = of_file.chain(given).collect();
    }
    let mut listed = Vec::with_capacity(levels.len());
    let mut sites = Vec::with_capacity(levels.len());
    for level in levels {
        listed.push(written(&level));
        add_labels(document, labels_on(&level.plan, &json!(level.name)));
        sites.push(Site {
            level: Some(level.name),
            places: level.plan.places,
            floor: level.plan.walkable,
        });
    }
    document[LEVELS] = listed.into();
    let files = files.into_iter().map(|file| (LEVELS, file));
    Ok((files.collect(), sites))
}

/// A level of a file as an element of `levels`.
fn written(level: &PlanLevel) -> Value {
    let mut written = json!({
        "name": level.name,
        WALKABLE_AREA: polygons(&level.plan.walkable),
        OBSTACLES: outlines(&level.plan.obstacles),
    });
    match level.form {
        LevelForm::Floor(elevation) => written["elevation"] = json!(elevation),
        LevelForm::Stairs => written["kind"] = json!("stairs"),
        LevelForm::Ramp => written["kind"] = json!("ramp"),
    }
    written
}

/// Reads the files that level `k` of a building names, into the document. Returns them, each with its key, and what
/// they name.
fn take_one(
    document: &mut Value,
    k: usize,
    folder: &Path,
    notes: &mut Vec<String>,
) -> Result<(Vec<PlanFile>, Option<Site>), Problem> {
    let reading = reading_of_level(document, k)?;
    let name = document[LEVELS][k]["name"].clone();
    let mut files = Vec::new();
    let mut site = Site {
        level: name.as_str().map(str::to_owned),
        ..Site::default()
    };
    for key in KEYS {
        let Some(named) = named(&document[LEVELS][k], key)? else {
            continue;
        };
        let path = folder.join(&named.file);
        let read = match key {
            OBSTACLES => floor_plan::read_obstacles_as(&path, &reading),
            _ => floor_plan::read_as(&path, &reading),
        };
        let plan = read.map_err(|error| named.refused(error).under(key))?;
        if key == WALKABLE_AREA && plan.walkable.is_empty() {
            let reason = format!(
                "{}: contains only obstacles; name it under `obstacles`, and give the level a `walkable_area`",
                shown(&named.file)
            );
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
        add_labels(document, labels_on(&plan, &name));
        site.places.extend(plan.places);
        site.floor.extend(plan.walkable);
    }
    if files.is_empty() && !document[LEVELS][k][READING].is_null() {
        let note = "has no effect: the level names no file";
        notes.push(format!("{LEVELS}[{k}].{READING}: {note}"));
    }
    let read = Some(site).filter(|_| !files.is_empty());
    Ok((files, read))
}

/// How the files of level `k` are read: as its own key `plan` says, else as that of the scenario. All levels have the
/// coordinates of the building, so no file is moved unless `origin` says so.
fn reading_of_level(document: &Value, k: usize) -> Result<Reading, Problem> {
    let own = &document[LEVELS][k][READING];
    reading_of(own)?;
    let mut all = document[READING].clone();
    match (&mut all, own) {
        (Value::Object(all), Value::Object(own)) => all.extend(own.clone()),
        (all, own) if !own.is_null() => *all = own.clone(),
        _ => {}
    }
    let mut reading = reading_of(&all)?;
    reading.origin = reading.origin.or(Some([0.0, 0.0]));
    Ok(reading)
}

/// The names of a plan as labels on a level.
fn labels_on(plan: &FloorPlan, level: &Value) -> Vec<Value> {
    let labels = labels_of(plan).map(|mut label| {
        label["level"] = level.clone();
        label
    });
    labels.collect()
}
