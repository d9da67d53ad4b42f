//! Walkable areas and obstacles, given in a scenario or in files that it names.

use std::fmt;
use std::path::Path;

use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};
use serde_json::{Value, json};

use super::PlanFile;
use super::error::{Problem, Under};
use super::file::File;
use super::range::point;
use super::setting::Setting;
use crate::engine::geometry::{Area, Polygon, Ring};
use crate::scenario::floor_plan::{self, FloorPlan, FloorPlanError};
use crate::scenario::quote::shown;

/// The keys that may name a file.
const WALKABLE_AREA: &str = "walkable_area";
const OBSTACLES: &str = "obstacles";

/// Most corners of one ring: the search for crossing edges compares all nearby pairs.
const MOST_CORNERS: usize = 20_000;
/// Most walls of a scenario.
const MOST_WALLS: u64 = 1_000_000;

/// Nested lists of numbers: a point, a ring of points or a list of rings.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Nested {
    Number(f64),
    List(Vec<Nested>),
}

impl<'de> Deserialize<'de> for Nested {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NestedVisitor)
    }
}

struct NestedVisitor;

impl<'de> Visitor<'de> for NestedVisitor {
    type Value = Nested;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or a list")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Nested, E> {
        Ok(Nested::Number(number))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Nested, E> {
        Ok(Nested::Number(number as f64))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Nested, E> {
        Ok(Nested::Number(number as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Nested, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            list.push(item);
        }
        Ok(Nested::List(list))
    }
}

/// Replaces the names of floor plan files, relative to `folder`, with their contents. Returns the files, each with
/// its key.
pub(super) fn fill(document: &mut Value, folder: &Path) -> Result<Vec<PlanFile>, Problem> {
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
            Some(_) => {
                let reason = "must be a list of polygons, or the name of a file";
                return Err(Problem::new(key, reason));
            }
        };
        let path = folder.join(name);
        let plan: FloorPlan = read(&path).map_err(|error| problem(error).under(key))?;
        files.push((key, path));
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
    }
    Ok(files)
}

impl Setting {
    /// Settings that replace a scenario's walkable area and obstacles with `plan`; messages call them `text`.
    pub fn floor_plan(plan: &FloorPlan, text: &str) -> [Self; 2] {
        let walkable = match plan.walkable.is_empty() {
            true => Value::Null,
            false => walkable_value(plan),
        };
        [
            Self::of(WALKABLE_AREA, walkable, text),
            Self::of(OBSTACLES, obstacles_value(plan), text),
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

fn rings_value(area: &Area) -> Value {
    area.rings().map(ring_value).collect()
}

fn ring_value(ring: &Ring) -> Value {
    ring.points().iter().map(|p| json!([p.x, p.y])).collect()
}

/// The number of walls in a file: one per corner.
pub(super) fn walls(file: &File) -> u64 {
    let obstacles = file.obstacles.iter().flatten().map(corners).sum::<u64>();
    let areas = file.walkable_area.iter().flatten().flatten();
    obstacles + areas.map(|ring| ring.len() as u64).sum::<u64>()
}

/// The number of corners in an element of an obstacle: one for a corner, all of them for a ring.
fn corners(item: &Nested) -> u64 {
    match item {
        Nested::List(inner) if matches!(inner.first(), Some(Nested::List(_))) => inner.len() as u64,
        Nested::List(_) | Nested::Number(_) => 1,
    }
}

/// Rejects a ring with too many corners.
fn check_length(count: usize) -> Result<(), Problem> {
    if count <= MOST_CORNERS {
        return Ok(());
    }
    let reason =
        format!("{count} corners; at most {MOST_CORNERS} are allowed: split it into several");
    Err(Problem::new("", reason))
}

/// The obstacles in order, then the solid around the walkable area.
pub(super) fn solids(file: &File) -> Result<Vec<Polygon>, Problem> {
    let walls = walls(file);
    if walls > MOST_WALLS {
        let reason = format!(
            "{walls} corners in total; at most {MOST_WALLS} are allowed: leave out unimportant corners"
        );
        return Err(Problem::new(OBSTACLES, reason));
    }
    let mut solids = Vec::with_capacity(file.obstacles.len() + 1);
    for (k, given) in file.obstacles.iter().enumerate() {
        solids.push(obstacle(given).under(&format!("{OBSTACLES}[{k}]"))?);
    }
    if let Some(polygons) = &file.walkable_area {
        solids.extend(walls_round(polygons).under(WALKABLE_AREA)?);
    }
    Ok(solids)
}

fn walls_round(polygons: &[Vec<Vec<[f64; 2]>>]) -> Result<Vec<Polygon>, Problem> {
    for (k, rings) in polygons.iter().enumerate() {
        for (r, ring) in rings.iter().enumerate() {
            check_length(ring.len()).under(&format!("[{k}][{r}]"))?;
            for (c, &corner) in ring.iter().enumerate() {
                point(&format!("[{k}][{r}][{c}]"), corner)?;
            }
        }
    }
    let plan = FloorPlan::walkable(polygons).map_err(problem)?;
    plan.solids()
        .map_err(|error| Problem::new("", error.to_string()))
}

/// Reads an obstacle: a ring, or a list of rings (the outline, then the holes).
fn obstacle(given: &[Nested]) -> Result<Polygon, Problem> {
    let is_corner = |item: &Nested| match item {
        Nested::List(inner) => matches!(inner.first(), None | Some(Nested::Number(_))),
        Nested::Number(_) => true,
    };
    if given.iter().all(is_corner) {
        let corners = ring(given)?;
        let points = corners.into_iter().map(Into::into).collect();
        return Polygon::new(points).map_err(|error| Problem::new("", error.to_string()));
    }
    let mut rings = Vec::with_capacity(given.len());
    for (k, item) in given.iter().enumerate() {
        let place = format!("[{k}]");
        let Nested::List(corners) = item else {
            return Err(Problem::new(place, "must be a ring, a list of points"));
        };
        rings.push(ring(corners).under(&place)?);
    }
    let area = FloorPlan::obstacle(&rings).map_err(problem)?;
    Polygon::filling(area).map_err(|error| Problem::new("", error.to_string()))
}

fn ring(given: &[Nested]) -> Result<Vec<[f64; 2]>, Problem> {
    let corner = |(k, item): (usize, &Nested)| match item {
        Nested::List(xy) => match xy[..] {
            [Nested::Number(x), Nested::Number(y)] => {
                point(&format!("[{k}]"), [x, y])?;
                Ok([x, y])
            }
            _ => Err(Problem::new(format!("[{k}]"), "must be a point, [x, y]")),
        },
        Nested::Number(_) => Err(Problem::new(format!("[{k}]"), "must be a point, [x, y]")),
    };
    check_length(given.len())?;
    given.iter().enumerate().map(corner).collect()
}

/// Converts an error; its place becomes the path if it is an index.
fn problem(error: FloorPlanError) -> Problem {
    match error {
        FloorPlanError::Ring { place, reason } => Problem::new(place, reason),
        FloorPlanError::EmptyGeometry(place) => Problem::new(place, "has no rings"),
        other => Problem::new("", other.to_string()),
    }
}
