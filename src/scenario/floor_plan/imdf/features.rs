//! The features of files → levels, units, openings and fixtures in meters.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::categories::Category;
use super::degrees::Plane;
use crate::error::numbers::brief;
use crate::error::quote::shown;
use crate::error::suggestion;
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::geojson::{Collection, Described, collection};
use crate::floor_plan::kind::Kind;
use crate::floor_plan::reading::{Drawn, Reading};
use crate::floor_plan::shape::{Form, Shape};

/// Coordinates within this extent cannot be meters, but degrees.
const MOST_DEGREES: f64 = 0.5;

/// A storey.
#[derive(Debug)]
pub struct Storey {
    pub id: String,
    pub name: String,
    pub elevation: f64,
}

/// An area of a level.
#[derive(Debug)]
pub struct Unit {
    /// The number of its level.
    pub level: usize,
    pub category: Category,
    /// Its category in the file.
    pub word: String,
    pub shape: Shape,
}

/// A line at which people pass from one unit to another.
#[derive(Debug)]
pub struct Opening {
    /// The number of its level.
    pub level: usize,
    pub shape: Shape,
}

/// What the files have, from the lowest level up.
#[derive(Debug, Default)]
pub struct Site {
    pub storeys: Vec<Storey>,
    pub units: Vec<Unit>,
    pub openings: Vec<Opening>,
    /// Solid bodies, each with the number of its level.
    pub fixtures: Vec<(usize, Shape)>,
    pub notes: Vec<String>,
}

/// What a feature is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Level,
    Unit,
    Opening,
    Fixture,
}

/// The roles by the words of `feature_type`; the other features of IMDF are left out.
const ROLES: [(&str, Role); 5] = [
    ("level", Role::Level),
    ("unit", Role::Unit),
    ("opening", Role::Opening),
    ("fixture", Role::Fixture),
    ("kiosk", Role::Fixture),
];

/// A feature of a role.
struct Feature {
    role: Role,
    /// Its name in messages.
    place: String,
    id: Option<String>,
    name: Option<String>,
    properties: Map<String, Value>,
    shapes: Vec<Shape>,
}

/// Reads `files`, each with its name, which says what its features are that do not say it themselves.
pub fn read(files: &[(String, String)], reading: &Reading) -> Result<Site, FloorPlanError> {
    let mut site = Site::default();
    let mut all: Vec<Feature> = Vec::new();
    let mut others: BTreeMap<String, usize> = BTreeMap::new();
    let mut declared = Drawn::default();
    let mut is_in_degrees = false;
    for (file, text) in files {
        let Collection {
            features,
            is_in_degrees: are_degrees,
            drawn,
        } = collection(text).map_err(|error| match file.is_empty() {
            true => error,
            false => error.of_level(&format!("{file}.geojson")),
        })?;
        is_in_degrees |= are_degrees;
        declared.unit = declared.unit.or(drawn.unit);
        declared.notes.extend(drawn.notes);
        for one in features {
            let word = kind_of(&one).unwrap_or_else(|| file.clone());
            match ROLES.iter().find(|(known, _)| *known == word) {
                Some((_, role)) => all.push(feature(*role, &word, one)?),
                None => *others.entry(word).or_default() += 1,
            }
        }
    }
    declared.notes.dedup();
    place(&mut all, (&mut declared, is_in_degrees), reading)?;
    site.notes = declared.notes;
    let listed: Vec<String> = others
        .iter()
        .map(|(word, count)| match word.is_empty() {
            true => format!("{count} without `feature_type`"),
            false => format!("{count} {}", shown(word)),
        })
        .collect();
    if !listed.is_empty() {
        let listed = listed.join(", ");
        site.notes.push(format!("features left out: {listed}"));
    }
    site.storeys = storeys(&all, reading)?;
    for feature in all {
        site.take(feature)?;
    }
    Ok(site)
}

/// What a feature says that it is.
pub fn kind_of(feature: &Described) -> Option<String> {
    let word = |keys: &Map<String, Value>| keys.get("feature_type")?.as_str().map(str::to_owned);
    let found = word(&feature.members).or_else(|| word(&feature.properties))?;
    Some(found.trim().to_lowercase())
}

/// A text, also in one of several languages.
fn text(value: &Value) -> Option<String> {
    let given = match value {
        Value::Object(languages) => {
            let mut all = languages.values();
            let first = languages.get("en").or_else(|| all.next());
            first?.as_str()?
        }
        other => other.as_str()?,
    };
    let text = given.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

fn feature(role: Role, word: &str, one: Described) -> Result<Feature, FloorPlanError> {
    let own = |key: &str| one.properties.get(key);
    let names = ["name", "short_name"];
    let name = names.iter().find_map(|key| text(own(key)?));
    let id = one.id.clone().or_else(|| id_of(own("id")?));
    let called = name.as_ref().or(id.as_ref());
    let place = match called {
        Some(called) => format!("{word} {} ({called})", one.number),
        None => format!("{word} {}", one.number),
    };
    let kind = match role {
        Role::Level | Role::Unit => Kind::Floor,
        Role::Opening => Kind::Door,
        Role::Fixture => Kind::Obstacle,
    };
    let (shapes, needed) = match role {
        Role::Level => (Vec::new(), None),
        Role::Opening => (one.shapes(&place, kind)?, Some(Form::Line)),
        _ => (one.shapes(&place, kind)?, Some(Form::Area)),
    };
    if let Some(form) = needed
        && shapes.iter().any(|shape| shape.form != form)
    {
        let form = if form == Form::Line {
            "LineString"
        } else {
            "Polygon"
        };
        return Err(wrong(&place, format!("its geometry must be a {form}")));
    }
    Ok(Feature {
        role,
        id,
        name,
        shapes,
        place,
        properties: one.properties,
    })
}

fn id_of(value: &Value) -> Option<String> {
    let number = || value.as_number().map(ToString::to_string);
    value.as_str().map(str::to_owned).or_else(number)
}

pub fn wrong(place: &str, reason: impl Into<String>) -> FloorPlanError {
    FloorPlanError::Geometry {
        place: place.to_owned(),
        reason: reason.into(),
    }
}

/// Turns all coordinates into meters, from one origin for all levels.
fn place(
    all: &mut [Feature],
    (declared, is_in_degrees): (&mut Drawn, bool),
    reading: &Reading,
) -> Result<(), FloorPlanError> {
    let points = || {
        let shapes = all.iter().flat_map(|feature| &feature.shapes);
        shapes.flat_map(|shape| &shape.rings).flatten()
    };
    let corner = |pick: fn(f64, f64) -> f64| {
        points()
            .copied()
            .reduce(|a, b| [pick(a[0], b[0]), pick(a[1], b[1])])
    };
    let (Some(low), Some(high)) = (corner(f64::min), corner(f64::max)) else {
        return Ok(());
    };
    let is_small = (0..2).all(|k| high[k] - low[k] < MOST_DEGREES);
    let are_on_earth = [low, high]
        .iter()
        .all(|[x, y]| x.abs() <= 360.0 && y.abs() <= 90.0);
    let says_unit = reading.unit.is_some() || declared.unit.is_some();
    if is_in_degrees || (is_small && are_on_earth && !says_unit) {
        if !are_on_earth || reading.unit.is_some() {
            let reason = "the coordinates are degrees, as the file says: remove `plan.unit`";
            return Err(wrong("plan.unit", reason));
        }
        let origin = reading.origin.unwrap_or(low);
        let plane = Plane::at(origin);
        let [longitude, latitude] = origin.map(|degrees| degrees.to_string());
        declared.notes.push(format!(
            "the coordinates are degrees: x and y are meters east and north of longitude {longitude}, latitude \
             {latitude}; `plan.origin` sets this point"
        ));
        for p in all
            .iter_mut()
            .flat_map(|feature| &mut feature.shapes)
            .flat_map(|shape| &mut shape.rings)
            .flatten()
        {
            *p = plane.meters(*p);
        }
        return Ok(());
    }
    // All shapes at once: one origin, one unit and one note for all.
    let counts: Vec<usize> = all.iter().map(|feature| feature.shapes.len()).collect();
    declared.shapes = all
        .iter_mut()
        .flat_map(|feature| feature.shapes.drain(..))
        .collect();
    declared.place(reading)?;
    let mut shapes = std::mem::take(&mut declared.shapes).into_iter();
    for (feature, count) in all.iter_mut().zip(counts) {
        feature.shapes.extend(shapes.by_ref().take(count));
    }
    Ok(())
}

/// The storeys, from the lowest up.
fn storeys(all: &[Feature], reading: &Reading) -> Result<Vec<Storey>, FloorPlanError> {
    let mut storeys = Vec::new();
    for (k, level) in all.iter().filter(|one| one.role == Role::Level).enumerate() {
        let number = |key: &str| match level.properties.get(key) {
            None | Some(Value::Null) => Ok(None),
            Some(value) => value
                .as_f64()
                .map(Some)
                .ok_or_else(|| wrong(&level.place, format!("`{key}` must be a number"))),
        };
        let (ordinal, elevation) = (number("ordinal")?, number("elevation")?);
        let elevation = match (elevation, ordinal, reading.storey_height) {
            (Some(elevation), ..) => elevation,
            (None, Some(ordinal), Some(height)) => ordinal * height,
            (None, Some(_), None) => {
                let reason = "has no `elevation`: give `plan.storey_height`, the meters from one `ordinal` to the \
                              next, or each level a property `elevation` in meters";
                return Err(wrong(&level.place, reason));
            }
            (None, None, _) => {
                let reason = "has neither an `ordinal` nor an `elevation` in meters: give it one";
                return Err(wrong(&level.place, reason));
            }
        };
        let numbered = || match ordinal {
            Some(ordinal) => format!("level {}", brief(ordinal)),
            None => format!("level {}", k + 1),
        };
        storeys.push((
            level.place.clone(),
            Storey {
                id: level.id.clone().unwrap_or_default(),
                name: level.name.clone().unwrap_or_else(numbered),
                elevation,
            },
        ));
    }
    if storeys.is_empty() {
        let reason = "it has no features with the `feature_type` level";
        return Err(FloorPlanError::Levels(reason.to_owned()));
    }
    for (k, (place, storey)) in storeys.iter().enumerate() {
        for (other, earlier) in &storeys[..k] {
            if earlier.name == storey.name {
                let name = shown(&storey.name);
                let reason =
                    format!("has the name `{name}`, as {other} has: give each a name of its own");
                return Err(wrong(place, reason));
            }
            if earlier.id == storey.id {
                let reason = format!("has the id `{}`, as {other} has", shown(&storey.id));
                return Err(wrong(place, reason));
            }
        }
    }
    storeys.sort_by(|a, b| a.1.elevation.total_cmp(&b.1.elevation));
    Ok(storeys.into_iter().map(|(_, storey)| storey).collect())
}

impl Site {
    /// Sorts a feature into its list.
    fn take(&mut self, feature: Feature) -> Result<(), FloorPlanError> {
        if feature.role == Role::Level {
            return Ok(());
        }
        let level = self.level_of(&feature)?;
        let word = match feature.properties.get("category").and_then(Value::as_str) {
            Some(word) => word.trim().to_lowercase(),
            None => "unspecified".to_owned(),
        };
        let category = match (feature.role, Category::of_word(&word)) {
            (Role::Unit, None) => {
                let near = suggestion(&word, Category::words());
                let reason = format!(
                    "the category `{}` is unknown{near}; `unspecified` is floor, `structure` is solid",
                    shown(&word)
                );
                return Err(wrong(&feature.place, reason));
            }
            (_, category) => category.unwrap_or(Category::Floor),
        };
        // Of several polygons, the largest has the name.
        let mut shapes = feature.shapes;
        let mut parts = shapes.iter_mut();
        if feature.role == Role::Opening {
            parts.for_each(|part| part.name = feature.name.clone());
        } else if let Some(first) = parts.next() {
            let larger = |a: &Shape, b: &Shape| a.extent() >= b.extent();
            let largest = parts.fold(first, |a, b| if larger(a, b) { a } else { b });
            largest.name = feature.name;
        }
        match feature.role {
            Role::Level => {}
            Role::Unit => self.units.extend(shapes.into_iter().map(|shape| Unit {
                level,
                category,
                word: word.clone(),
                shape,
            })),
            Role::Opening => {
                let openings = shapes.into_iter().map(|shape| Opening { level, shape });
                self.openings.extend(openings);
            }
            Role::Fixture => self
                .fixtures
                .extend(shapes.into_iter().map(|shape| (level, shape))),
        }
        Ok(())
    }

    /// The number of the level on which a feature lies.
    fn level_of(&self, feature: &Feature) -> Result<usize, FloorPlanError> {
        let ids = || self.storeys.iter().map(|storey| storey.id.as_str());
        let known = || {
            let all: Vec<String> = self
                .storeys
                .iter()
                .map(|storey| format!("`{}` ({})", shown(&storey.id), shown(&storey.name)))
                .collect();
            all.join(", ")
        };
        let given = feature.properties.get("level_id").and_then(id_of);
        let Some(id) = given else {
            let reason = format!(
                "has no `level_id`: give the id of its level; there are {}",
                known()
            );
            return Err(wrong(&feature.place, reason));
        };
        ids().position(|known| known == id).ok_or_else(|| {
            let reason = format!(
                "its level_id `{}` is that of no level; there are {}",
                shown(&id),
                known()
            );
            wrong(&feature.place, reason)
        })
    }
}
