//! GeoJSON (RFC 7946), in meters. The only file that names the geojson crate.

use crate::error::quote::shown;
use crate::error::suggestion;
use crate::kinds;
use geojson::{Feature, GeoJson, Geometry, GeometryValue, Position};
use serde_json::Value;

use super::error::FloorPlanError;
use super::shape::{Geometry as Parts, Shape, part};
use super::wkt::IN_DEGREES;

/// The property that says what a feature is. Without it, a feature is floor.
const KIND: &str = "kind";
/// Its values, in any case.
const FLOOR: &str = "floor";
const OBSTACLE: &str = "obstacle";
/// The property with the name of a feature.
const NAME: &str = "name";

/// The polygons of `text`. If `all_obstacles`, every polygon is an obstacle, of any kind.
pub fn shapes(text: &str, all_obstacles: bool) -> Result<Vec<Shape>, FloorPlanError> {
    let document: Value = serde_json::from_str(text).map_err(|error| syntax(&error))?;
    if kinds::is_scenario(&document) {
        let reason = "it is a scenario, whose plan is in its `walkable_area`".to_owned();
        let format = "GeoJSON";
        return Err(FloorPlanError::Syntax { format, reason });
    }
    refuse_degrees(&document)?;
    let mut shapes = Vec::new();
    let mut add = |one: &Feature, place: &str| {
        let is_obstacle = all_obstacles || is_obstacle(one, place)?;
        feature(one, place, is_obstacle, &mut shapes)
    };
    match serde_json::from_value(document).map_err(|error| syntax(&error))? {
        GeoJson::Geometry(geometry) => collect(&geometry, "", all_obstacles, &mut shapes)?,
        GeoJson::Feature(one) => add(&one, "")?,
        GeoJson::FeatureCollection(collection) => {
            for (k, one) in collection.features.iter().enumerate() {
                add(one, &named(one, k))?;
            }
        }
    }
    Ok(shapes)
}

fn syntax(error: &impl ToString) -> FloorPlanError {
    FloorPlanError::Syntax {
        format: "GeoJSON",
        reason: error.to_string(),
    }
}

/// Files older than RFC 7946 may declare their coordinate system.
fn refuse_degrees(document: &Value) -> Result<(), FloorPlanError> {
    let Some(name) = document["crs"]["properties"]["name"].as_str() else {
        return Ok(());
    };
    let code = name.rsplit(':').next().and_then(|code| code.parse().ok());
    let known = code.is_some_and(|code| IN_DEGREES.contains(&code));
    if known || name.to_ascii_uppercase().contains("CRS84") {
        return Err(FloorPlanError::Degrees(format!("crs {name}")));
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

/// Is this feature an obstacle? An unknown kind is an error, so that no misspelled obstacle becomes floor.
fn is_obstacle(feature: &Feature, place: &str) -> Result<bool, FloorPlanError> {
    let Some(properties) = &feature.properties else {
        return Ok(false);
    };
    let wrong = |reason: String| FloorPlanError::Geometry {
        place: place.to_owned(),
        reason,
    };
    let says = |value: &Value, kind: &str| {
        let text = value.as_str().map(str::trim);
        text.is_some_and(|text| text.eq_ignore_ascii_case(kind))
    };
    match properties.get(KIND).filter(|kind| !kind.is_null()) {
        None => {
            let mut others = properties.iter().filter(|(key, _)| *key != NAME);
            match others.find(|(_, value)| says(value, OBSTACLE)) {
                None => Ok(false),
                Some((key, _)) => Err(wrong(format!(
                    "the property `{}` is `{OBSTACLE}`, but only `{KIND}` says what a feature is; rename it",
                    shown(key)
                ))),
            }
        }
        Some(kind) if says(kind, OBSTACLE) => Ok(true),
        Some(kind) if says(kind, FLOOR) || says(kind, "") => Ok(false),
        Some(kind) => {
            let given = kind.as_str().map_or(kind.to_string(), str::to_owned);
            let near = suggestion(&given.to_lowercase(), [FLOOR, OBSTACLE]);
            let near = match near.as_str() {
                "" => format!("; write `{OBSTACLE}` or `{FLOOR}`"),
                near => near.to_owned(),
            };
            Err(wrong(format!(
                "{KIND} `{}` is unknown{near}",
                shown(&given)
            )))
        }
    }
}

fn feature(
    feature: &Feature,
    place: &str,
    is_obstacle: bool,
    shapes: &mut Vec<Shape>,
) -> Result<(), FloorPlanError> {
    match &feature.geometry {
        Some(geometry) => {
            let first = shapes.len();
            collect(geometry, place, is_obstacle, shapes)?;
            // Of several polygons, the largest has the name.
            let parts = shapes[first..].iter_mut();
            let largest = parts.max_by(|a, b| a.extent().total_cmp(&b.extent()));
            if let Some(largest) = largest {
                largest.name = name(feature).map(str::to_owned);
            }
            Ok(())
        }
        None => Err(FloorPlanError::EmptyGeometry(place.to_owned())),
    }
}

fn collect(
    geometry: &Geometry,
    place: &str,
    is_obstacle: bool,
    shapes: &mut Vec<Shape>,
) -> Result<(), FloorPlanError> {
    parts(geometry).polygons(place, &mut |polygon, place| {
        let rings = rings(polygon, &place)?;
        shapes.push(Shape::new(place, rings, is_obstacle));
        Ok(())
    })
}

fn parts(geometry: &Geometry) -> Parts<&[Vec<Position>]> {
    match &geometry.value {
        GeometryValue::Polygon { coordinates } => Parts::Polygon(coordinates),
        GeometryValue::MultiPolygon { coordinates } => {
            let polygons = coordinates.iter().map(Vec::as_slice).map(Parts::Polygon);
            Parts::Several("polygon", polygons.collect())
        }
        GeometryValue::GeometryCollection { geometries } => {
            Parts::Several("geometry", geometries.iter().map(parts).collect())
        }
        other => Parts::Other(other.type_name()),
    }
}

/// The rings of a polygon, meters.
fn rings(rings: &[Vec<Position>], place: &str) -> Result<Vec<Vec<[f64; 2]>>, FloorPlanError> {
    let point = |r: usize, k: usize, position: &Position| match position.as_slice() {
        [x, y, ..] => Ok([*x, *y]),
        few => Err(FloorPlanError::Geometry {
            place: part(&part(place, "ring", r), "position", k),
            reason: format!("has {} number(s); write [x, y]", few.len()),
        }),
    };
    let ring = |(r, ring): (usize, &Vec<Position>)| {
        let positions = ring.iter().enumerate();
        positions.map(|(k, one)| point(r, k, one)).collect()
    };
    rings.iter().enumerate().map(ring).collect()
}
