//! `sandbox convert` and the list of `sandbox draw`: what a plan names, and the same floor in other formats.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::common::program::{json as printed, refused, run_in, stderr, text};

fn feature(name: &str, kind: &str, geometry: Value) -> Value {
    json!({"type": "Feature", "properties": {"name": name, "kind": kind}, "geometry": geometry})
}

fn rectangle([a, b]: [f64; 2], [c, d]: [f64; 2]) -> Value {
    json!({"type": "Polygon", "coordinates": [[[a, c], [b, c], [b, d], [a, d], [a, c]]]})
}

/// A hall of 20 m by 10 m with a column, a crowd of 4 m by 8 m, an exit of 1.5 m and a desk.
fn write_plan(folder: &Path) {
    let plan = json!({"type": "FeatureCollection", "features": [
        feature("hall", "floor", rectangle([0.0, 20.0], [0.0, 10.0])),
        feature("column", "obstacle", rectangle([12.0, 13.0], [4.0, 6.0])),
        feature("main door", "exit", json!({"type": "LineString", "coordinates": [[20, 5], [20, 6.5]]})),
        feature("stalls", "crowd", rectangle([5.0, 9.0], [1.0, 9.0])),
        feature("desk", "waypoint", json!({"type": "Point", "coordinates": [15, 3]})),
    ]});
    fs::write(folder.join("hall.geojson"), plan.to_string()).unwrap();
}

/// The area of a ring, m².
fn size(ring: &Value) -> f64 {
    let points: Vec<[f64; 2]> = serde_json::from_value(ring.clone()).unwrap();
    let next = points.iter().cycle().skip(1);
    let twice: f64 = points
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
        .sum();
    0.5 * twice.abs()
}

/// A JSON file.
fn content(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn draw_lists_what_a_plan_names() {
    let folder = tempfile::tempdir().unwrap();
    write_plan(folder.path());
    let drawn = run_in(
        folder.path(),
        &["draw", "hall.geojson", "-o", "hall.svg", "--json"],
    );
    let places = printed(&drawn)["places"].clone();
    let of = |name: &str| {
        let mut all = places.as_array().unwrap().iter();
        all.find(|place| place["name"] == name).unwrap().clone()
    };
    assert_eq!(places.as_array().unwrap().len(), 5);
    assert_eq!(of("stalls")["size"], 32.0);
    assert_eq!(of("stalls")["extent"], json!([[5.0, 1.0], [9.0, 9.0]]));
    assert_eq!(
        [&of("main door")["kind"], &of("main door")["form"]],
        ["exit", "line"]
    );
    assert_eq!(of("main door")["size"], 1.5);
    assert_eq!(of("desk")["form"], "point");
    let as_text = run_in(
        folder.path(),
        &["draw", "hall.geojson", "-o", "hall.svg", "--force"],
    );
    let said = String::from_utf8(as_text.stdout).unwrap();
    for line in ["place", "main door", "stalls"] {
        assert!(said.contains(line), "{said}");
    }
    let row = said
        .lines()
        .find(|line| line.starts_with("stalls"))
        .unwrap();
    let words: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(
        words[1..],
        ["crowd", "32.0", "m²", "5.00", "1.00", "9.00", "9.00"]
    );
}

#[test]
fn a_plan_becomes_a_scenario_that_runs_alone() {
    let folder = tempfile::tempdir().unwrap();
    write_plan(folder.path());
    let converted = run_in(
        folder.path(),
        &["convert", "hall.geojson", "-o", "hall.json"],
    );
    assert!(converted.status.success(), "{}", stderr(&converted));
    let scenario: Value = content(&folder.path().join("hall.json"));
    assert_eq!(
        scenario["exits"],
        json!([{"name": "main door", "line": [[20.0, 5.0], [20.0, 6.5]]}])
    );
    let floor = scenario["walkable_area"][0].as_array().unwrap();
    assert_eq!([size(&floor[0]), size(&floor[1])], [200.0, 2.0]);
    assert_eq!(scenario["crowds"][0]["density"], 1.0);
    assert_eq!(size(&scenario["crowds"][0]["area"]), 32.0);
    // Without the plan beside it.
    fs::remove_file(folder.path().join("hall.geojson")).unwrap();
    let ran = printed(&run_in(folder.path(), &["run", "hall.json", "--json"]));
    assert_eq!(ran["agents"], 32);
    assert_eq!(ran["remaining"], 0);
}

#[test]
fn a_scenario_as_geojson_has_the_same_floor_and_places() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = json!({
        "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]], [[3, 3], [3, 4], [4, 4], [4, 3]]]],
        "obstacles": [[[10, 2], [10, 8]], [[6, 6], [7, 6], [7, 7]], [[12, 2], [14, 2], [12, 2]]],
        "exits": [{"name": "east", "line": [[20, 4], [20, 6]]}],
        "zones": [{"name": "slow", "area": [[15, 0], [17, 0], [17, 10], [15, 10]], "speed_factor": 0.5}],
        "crowds": [{"name": "all", "area": [[1, 1], [2, 1], [2, 9], [1, 9]], "number": 5}],
        "profile": "steer+sph", "duration_secs": 20,
    });
    fs::write(folder.path().join("own.json"), scenario.to_string()).unwrap();
    let converted = run_in(folder.path(), &["convert", "own.json", "-o", "own.geojson"]);
    assert!(converted.status.success(), "{}", stderr(&converted));
    let plan: Value = content(&folder.path().join("own.geojson"));
    let features = plan["features"].as_array().unwrap();
    let kinds: Vec<&str> = features
        .iter()
        .map(|one| one["properties"]["kind"].as_str().unwrap())
        .collect();
    assert_eq!(
        kinds,
        ["floor", "wall", "obstacle", "wall", "exit", "zone", "crowd"]
    );
    assert_eq!(
        features[1]["geometry"],
        json!({"type": "LineString", "coordinates": [[10.0, 2.0], [10.0, 8.0]]})
    );
    // The same people on that plan, named.
    let named = json!({
        "walkable_area": "own.geojson", "exits": ["east"], "zones": [{"name": "slow", "speed_factor": 0.5}],
        "crowds": [{"name": "all", "area": "all", "number": 5}], "profile": "steer+sph", "duration_secs": 20,
    });
    fs::write(folder.path().join("named.json"), named.to_string()).unwrap();
    let left = |file: &str| {
        let ran = printed(&run_in(folder.path(), &["run", file, "--json"]));
        [ran["agents"].clone(), ran["t100_secs"].clone()]
    };
    assert_eq!(left("own.json"), left("named.json"));
}

#[test]
fn wrong_outputs_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    write_plan(folder.path());
    let plan = folder.path().join("hall.geojson");
    let out = folder.path().join("hall.dxf");
    refused(
        &["convert", text(&plan), "-o", text(&out)],
        2,
        &["must end in .json or .geojson"],
    );
    refused(
        &["convert", text(&plan), "-o", text(&plan)],
        2,
        &["hall.geojson"],
    );
}
