//! GeoJSON (RFC 7946), in meters. The only file that names the geojson crate.

use crate::error::quote::shown;
use crate::error::suggestion;
use crate::kinds;
use geojson::feature::Id;
use geojson::{Feature, GeoJson, Geometry, GeometryValue, Position};
use serde_json::{Map, Value};

use super::error::FloorPlanError;
use super::kind::Kind;
use super::reading::Drawn;
use super::shape::{Form, Geometry as Parts, Shape, part};
use super::units::{Coordinates, of_system};

/// The property that says what a feature is. Without it, a feature is floor.
const KIND: &str = "kind";
/// The property with the name of a feature.
const NAME: &str = "name";

/// What `text` has. If `all_obstacles`, every polygon and line is an obstacle, of any kind.
pub fn drawn(text: &str, all_obstacles: bool) -> Result<Drawn, FloorPlanError> {
    let mut document: Value = serde_json::from_str(text).map_err(|error| syntax(&error))?;
    if kinds::is_scenario(&document) {
        let reason = "it is a scenario, whose plan is in its `walkable_area`".to_owned();
        let format = "GeoJSON";
        return Err(FloorPlanError::Syntax { format, reason });
    }
    let mut drawn = Drawn::default();
    declared(&document, &mut drawn)?;
    without_empty_polygons(&mut document);
    let shapes = &mut drawn.shapes;
    let mut add = |one: &Feature, place: &str| feature(one, place, all_obstacles, shapes);
    match serde_json::from_value(document).map_err(|error| syntax(&error))? {
        GeoJson::Geometry(geometry) => add(&Feature::from(geometry), "")?,
        GeoJson::Feature(one) => add(&one, "")?,
        GeoJson::FeatureCollection(collection) => {
            for (k, one) in collection.features.iter().enumerate() {
                add(one, &named(one, k))?;
            }
        }
    }
    Ok(drawn)
}

/// A feature that says what it is by its members and properties.
pub struct Described {
    /// Its number, from 1.
    pub number: usize,
    pub id: Option<String>,
    /// The members beside those of GeoJSON.
    pub members: Map<String, Value>,
    pub properties: Map<String, Value>,
    /// Its geometry; `None` if it has none.
    pub geometry: Option<Geometry>,
}

impl Described {
    /// Its parts in messages called `place`, of one kind.
    pub fn shapes(&self, place: &str, kind: Kind) -> Result<Vec<Shape>, FloorPlanError> {
        let mut shapes = Vec::new();
        match &self.geometry {
            Some(geometry) => parts(geometry, place)?.shapes(place, kind, &mut shapes)?,
            None => return Err(FloorPlanError::EmptyGeometry(place.to_owned())),
        }
        Ok(shapes)
    }
}

/// The features of a collection, in no unit yet.
pub struct Collection {
    pub features: Vec<Described>,
    /// Whether it declares that its coordinates are degrees.
    pub is_in_degrees: bool,
    /// The unit that it declares, and notes on it.
    pub drawn: Drawn,
}

/// The features of `text`.
pub fn collection(text: &str) -> Result<Collection, FloorPlanError> {
    let mut document: Value = serde_json::from_str(text).map_err(|error| syntax(&error))?;
    let mut drawn = Drawn::default();
    let is_in_degrees = match declared(&document, &mut drawn) {
        Err(FloorPlanError::Degrees(_)) => true,
        other => other.map(|()| false)?,
    };
    without_empty_polygons(&mut document);
    let given = serde_json::from_value(document).map_err(|error| syntax(&error))?;
    let GeoJson::FeatureCollection(collection) = given else {
        return Err(syntax(&"levels are features of a FeatureCollection"));
    };
    let described = |(k, feature): (usize, Feature)| Described {
        number: k + 1,
        id: feature.id.map(|id| match id {
            Id::String(text) => text,
            Id::Number(number) => number.to_string(),
        }),
        members: feature.foreign_members.unwrap_or_default(),
        properties: feature.properties.unwrap_or_default(),
        geometry: feature.geometry,
    };
    let features = collection.features.into_iter().enumerate();
    Ok(Collection {
        features: features.map(described).collect(),
        is_in_degrees,
        drawn,
    })
}

/// Takes polygons without rings out of MultiPolygons, at any depth: the reader refuses them.
fn without_empty_polygons(value: &mut Value) {
    if value["type"] == "MultiPolygon" {
        if let Some(polygons) = value["coordinates"].as_array_mut() {
            polygons.retain(|polygon| polygon.as_array().is_none_or(|rings| !rings.is_empty()));
        }
        return;
    }
    match value {
        Value::Array(list) => list.iter_mut().for_each(without_empty_polygons),
        Value::Object(keys) => {
            let with_geometry = ["features", "geometry", "geometries"];
            let inner = keys
                .iter_mut()
                .filter(|(key, _)| with_geometry.contains(&key.as_str()));
            inner.for_each(|(_, one)| without_empty_polygons(one));
        }
        _ => {}
    }
}

fn syntax(error: &impl ToString) -> FloorPlanError {
    FloorPlanError::Syntax {
        format: "GeoJSON",
        reason: error.to_string(),
    }
}

/// The unit of the coordinate system that files older than RFC 7946 may declare.
fn declared(document: &Value, drawn: &mut Drawn) -> Result<(), FloorPlanError> {
    let Some(name) = document["crs"]["properties"]["name"].as_str() else {
        return Ok(());
    };
    match of_system(name) {
        Coordinates::Meters => {}
        Coordinates::Degrees => return Err(FloorPlanError::Degrees(format!("crs {name}"))),
        Coordinates::Other(unit, meters) => {
            drawn.unit = Some((format!("the unit of {}, the {unit},", shown(name)), meters));
        }
        Coordinates::Unknown => drawn.notes.push(format!(
            "the coordinate system {} is not known: its coordinates are taken as meters; `plan.unit` says otherwise",
            shown(name)
        )),
    }
    Ok(())
}

fn name(feature: &Feature) -> Option<&str> {
    let name = feature.properties.as_ref()?.get(NAME)?.as_str()?.trim();
    (!name.is_empty()).then_some(name)
}

/// The name of feature `k` in messages: its number from 1, and its `name` if it has one.
fn named(feature: &Feature, k: usize) -> String {
    match name(feature) {
        Some(name) => format!("feature {} ({name})", k + 1),
        None => format!("feature {}", k + 1),
    }
}

/// What a feature is, by its property `kind`; `None` without one. An unknown kind is an error, so that no misspelled
/// obstacle becomes floor.
fn kind(feature: &Feature, place: &str) -> Result<Option<Kind>, FloorPlanError> {
    let Some(properties) = &feature.properties else {
        return Ok(None);
    };
    let wrong = |reason: String| FloorPlanError::Geometry {
        place: place.to_owned(),
        reason,
    };
    let Some(given) = properties.get(KIND).filter(|kind| !kind.is_null()) else {
        let is_obstacle =
            |value: &Value| value.as_str().and_then(Kind::of_word) == Some(Kind::Obstacle);
        let mut others = properties.iter().filter(|(key, _)| *key != NAME);
        return match others.find(|(_, value)| is_obstacle(value)) {
            None => Ok(None),
            Some((key, value)) => Err(wrong(format!(
                "the property `{}` is `{}`, but only `{KIND}` says what a feature is; rename it",
                shown(key),
                shown(value.as_str().unwrap_or_default())
            ))),
        };
    };
    let word = given.as_str().map_or(given.to_string(), str::to_owned);
    match Kind::of_word(&word) {
        _ if word.trim().is_empty() => Ok(None),
        Some(kind) => Ok(Some(kind)),
        None => {
            let suggested = suggestion(&word.to_lowercase(), Kind::words());
            let near = match suggested.as_str() {
                "" => format!("; write {}", listed(Kind::words())),
                near => near.to_owned(),
            };
            Err(wrong(format!("{KIND} `{}` is unknown{near}", shown(&word))))
        }
    }
}

/// Words as a list with `or`.
fn listed(words: impl Iterator<Item = &'static str>) -> String {
    let quoted: Vec<String> = words.map(|word| format!("`{word}`")).collect();
    match quoted.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => quoted.concat(),
    }
}

/// Adds the parts of a feature. All polygons and lines are obstacles if `all_obstacles`.
fn feature(
    feature: &Feature,
    place: &str,
    all_obstacles: bool,
    shapes: &mut Vec<Shape>,
) -> Result<(), FloorPlanError> {
    let Some(geometry) = &feature.geometry else {
        return Err(FloorPlanError::EmptyGeometry(place.to_owned()));
    };
    let given = if all_obstacles {
        Some(Kind::Obstacle)
    } else {
        kind(feature, place)?
    };
    let first = shapes.len();
    parts(geometry, place)?.shapes(place, given.unwrap_or_default(), shapes)?;
    let own = name(feature);
    for shape in &mut shapes[first..] {
        shape.kind = match (given, shape.form) {
            (Some(Kind::Floor), Form::Line) => {
                return Err(FloorPlanError::no_area(&shape.place, "LineString"));
            }
            (Some(Kind::Obstacle), Form::Line) | (None, Form::Line) => Kind::Wall,
            (None, Form::Point) if own.is_some() => Kind::Place,
            (None, Form::Point)
            | (Some(Kind::Floor | Kind::Obstacle | Kind::Wall), Form::Point) => {
                return Err(FloorPlanError::no_area(&shape.place, "Point"));
            }
            (Some(Kind::Wall), Form::Area) => Kind::Obstacle,
            (kind, _) => kind.unwrap_or_default(),
        };
    }
    // Of several polygons, the largest has the name.
    let parts = shapes[first..].iter_mut();
    let largest = parts.max_by(|a, b| a.extent().total_cmp(&b.extent()));
    if let Some(largest) = largest {
        largest.name = own.map(str::to_owned);
    }
    Ok(())
}

/// The parts of a geometry, meters.
fn parts(geometry: &Geometry, place: &str) -> Result<Parts, FloorPlanError> {
    let point = |place: &str, k: usize, position: &Position| match position.as_slice() {
        [x, y, ..] => Ok([*x, *y]),
        few => Err(FloorPlanError::Geometry {
            place: part(place, "position", k),
            reason: format!("has {} number(s); write [x, y]", few.len()),
        }),
    };
    let line = |positions: &[Position], place: &str| {
        let positions = positions.iter().enumerate();
        positions
            .map(|(k, one)| point(place, k, one))
            .collect::<Result<Vec<_>, _>>()
    };
    let area = |rings: &[Vec<Position>], place: &str| {
        let numbered = rings.iter().enumerate();
        let rings = numbered.map(|(r, ring)| line(ring, &part(place, "ring", r)));
        rings.collect::<Result<_, _>>().map(Parts::Area)
    };
    let several = |word: &'static str, parts: Vec<Result<Parts, FloorPlanError>>| {
        let parts = parts.into_iter().collect::<Result<_, _>>()?;
        Ok(Parts::Several(word, parts))
    };
    match &geometry.value {
        GeometryValue::Polygon { coordinates } => area(coordinates, place),
        GeometryValue::LineString { coordinates } => line(coordinates, place).map(Parts::Line),
        GeometryValue::Point { coordinates } => point(place, 0, coordinates).map(Parts::Point),
        GeometryValue::MultiPolygon { coordinates } => {
            let numbered = coordinates.iter().enumerate();
            let polygons = numbered.map(|(k, one)| area(one, &part(place, "polygon", k)));
            several("polygon", polygons.collect())
        }
        GeometryValue::MultiLineString { coordinates } => {
            let numbered = coordinates.iter().enumerate();
            let lines =
                numbered.map(|(k, one)| Ok(Parts::Line(line(one, &part(place, "line", k))?)));
            several("line", lines.collect())
        }
        GeometryValue::MultiPoint { coordinates } => {
            let numbered = coordinates.iter().enumerate();
            let points = numbered.map(|(k, one)| Ok(Parts::Point(point(place, k, one)?)));
            several("point", points.collect())
        }
        GeometryValue::GeometryCollection { geometries } => {
            let numbered = geometries.iter().enumerate();
            let geometries = numbered.map(|(k, one)| parts(one, &part(place, "geometry", k)));
            several("geometry", geometries.collect())
        }
    }
}
