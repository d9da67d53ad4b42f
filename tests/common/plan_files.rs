//! Plan files with several levels, made of numbers, and what scenarios have of them.

use std::fs;
use std::path::Path;

use sandbox::engine::geometry::Area;
use sandbox::engine::math::Vector;
use sandbox::scenario::{Scenario, ScenarioError};
use serde_json::{Value, json};
use tempfile::TempDir;

/// The outline of a rectangle from its ranges of x and y.
pub fn rectangle([a, b]: [f64; 2], [c, d]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[a, c], [b, c], [b, d], [a, d]]
}

/// A feature of IMDF.
pub fn feature(kind: &str, id: &str, geometry: Value, properties: Value) -> Value {
    json!({"type": "Feature", "feature_type": kind, "id": id, "geometry": geometry, "properties": properties})
}

pub fn level(id: &str, ordinal: i32, name: Value) -> Value {
    feature(
        "level",
        id,
        Value::Null,
        json!({"ordinal": ordinal, "name": name, "category": "unspecified"}),
    )
}

pub fn unit(level: &str, category: &str, name: &str, ring: Vec<[f64; 2]>) -> Value {
    let closed: Vec<[f64; 2]> = ring.iter().chain(ring.first()).copied().collect();
    let geometry = json!({"type": "Polygon", "coordinates": [closed]});
    let name = if name.is_empty() {
        Value::Null
    } else {
        json!({"en": name})
    };
    let id = format!("unit {category} {}", ring[0][0]);
    feature(
        "unit",
        &id,
        geometry,
        json!({"level_id": level, "category": category, "name": name}),
    )
}

pub fn opening(level: &str, name: &str, line: [[f64; 2]; 2]) -> Value {
    let geometry = json!({"type": "LineString", "coordinates": line});
    let name = if name.is_empty() {
        Value::Null
    } else {
        json!({"en": name})
    };
    feature(
        "opening",
        name.as_str().unwrap_or("o"),
        geometry,
        json!({"level_id": level, "category": "pedestrian", "name": name}),
    )
}

pub fn collection(features: &[Value]) -> Value {
    json!({"type": "FeatureCollection", "features": features})
}

/// A scenario with the keys of `base` whose `levels` are a file with this content.
pub fn load(file: &str, content: &str, base: &Value) -> Result<Scenario, ScenarioError> {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join(file), content).unwrap();
    load_in(folder.path(), file, base)
}

/// As [`load`], with what lies in a folder.
pub fn load_in(folder: &Path, levels: &str, base: &Value) -> Result<Scenario, ScenarioError> {
    let mut document = base.clone();
    document["levels"] = json!(levels);
    let path = folder.join("house.json");
    fs::write(&path, document.to_string()).unwrap();
    Scenario::load(&path, &[])
}

/// The area of the floor of a level, m².
pub fn size(scenario: &Scenario, level: &str) -> f64 {
    let levels = scenario.scene.levels.clone().unwrap();
    let own = levels.all().iter().find(|own| own.name == level).unwrap();
    own.floor.iter().map(Area::area).sum()
}

/// The height of a level at a place, meters.
pub fn height(scenario: &Scenario, level: &str, at: [f64; 2]) -> f64 {
    let levels = scenario.scene.levels.clone().unwrap();
    let own = levels.all().iter().find(|own| own.name == level).unwrap();
    own.height(Vector::from(at))
}

/// The joins, each as the names of its levels and its line, from the document that needs no file.
pub fn joins(scenario: &Scenario) -> Vec<(Vec<String>, [[f64; 2]; 2])> {
    let joins = scenario.document["joins"].as_array().unwrap().iter();
    let read = joins.map(|join| {
        let mut names: Vec<String> = serde_json::from_value(join["levels"].clone()).unwrap();
        names.sort();
        let mut line: [[f64; 2]; 2] = serde_json::from_value(join["line"].clone()).unwrap();
        line.sort_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])));
        (names, line)
    });
    read.collect()
}

pub fn is_near(found: f64, expected: f64, within: f64) {
    assert!(
        (found - expected).abs() < within,
        "{found} instead of {expected}"
    );
}

/// An element of XML with vertices.
pub fn path(tag: &str, points: &[[f64; 2]]) -> String {
    let vertices = points.iter();
    let vertices = vertices.map(|[x, y]| format!("<vertex px=\"{x}\" py=\"{y}\"/>"));
    let name = tag.split(' ').next().unwrap_or_default();
    format!("<{tag}>{}</{name}>", vertices.collect::<String>())
}

/// A room of one subroom in the ranges of x and y; `about` are its own attributes and those of the subroom.
pub fn room(id: u32, about: [&str; 2], x: [f64; 2], y: [f64; 2]) -> String {
    let ring = rectangle(x, y);
    let walls = path("polygon", &[ring[0], ring[1], ring[2], ring[3], ring[0]]);
    let [room, subroom] = about;
    format!("<room id=\"{id}\" {room}><subroom id=\"0\" {subroom}>{walls}</subroom></room>")
}

/// A transition between two rooms; -1 is outside.
pub fn transition(id: u32, caption: &str, [one, other]: [i32; 2], line: [[f64; 2]; 2]) -> String {
    let side = |k: u32, room: i32| {
        format!(
            "room{k}_id=\"{room}\" subroom{k}_id=\"{}\"",
            if room < 0 { -1 } else { 0 }
        )
    };
    let tag = format!(
        "transition id=\"{id}\" caption=\"{caption}\" {} {}",
        side(1, one),
        side(2, other)
    );
    path(&tag, &line)
}

pub fn geometry(rooms: &[String], transitions: &[String]) -> String {
    format!(
        "<geometry version=\"0.8\" unit=\"m\"><rooms>{}</rooms><transitions>{}</transitions></geometry>",
        rooms.concat(),
        transitions.concat()
    )
}

/// A drawing: closed outlines and lines on layers, in the unit with this number, each coordinate `scale` times the
/// meters from `corner`.
pub fn drawing(
    unit: u32,
    (scale, corner): (f64, [f64; 2]),
    shapes: &[(&str, Vec<[f64; 2]>)],
) -> String {
    let mut text = format!(
        "0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 9 $INSUNITS 70 {unit} 0 ENDSEC 0 SECTION 2 ENTITIES "
    );
    for (layer, points) in shapes {
        let closed = u8::from(points.len() > 2);
        text += &format!("0 LWPOLYLINE 8 {layer} 90 {} 70 {closed} ", points.len());
        for [x, y] in points {
            let [x, y] = [(x - corner[0]) * scale, (y - corner[1]) * scale];
            text += &format!("10 {x} 20 {y} ");
        }
    }
    text += "0 ENDSEC 0 EOF";
    text.split_whitespace().collect::<Vec<_>>().join("\n")
}
