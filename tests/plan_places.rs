//! Areas, lines and points of a plan are used by their names, and a corrected drawing needs no other scenario.

use std::fs;

use sandbox::scenario::{Scenario, ScenarioError};
use serde_json::{Value, json};
use tempfile::TempDir;

fn feature(name: &str, kind: &str, geometry: Value) -> Value {
    json!({"type": "Feature", "properties": {"name": name, "kind": kind}, "geometry": geometry})
}

fn rectangle([a, b]: [f64; 2], [c, d]: [f64; 2]) -> Value {
    json!({"type": "Polygon", "coordinates": [[[a, c], [b, c], [b, d], [a, d], [a, c]]]})
}

/// A hall of 20 m by 10 m; the door in its right wall is `wide`, and an exit area lies before its left wall.
fn plan(wide: f64) -> Value {
    json!({"type": "FeatureCollection", "features": [
        feature("hall", "floor", rectangle([0.0, 20.0], [0.0, 10.0])),
        feature("main door", "exit", json!({"type": "LineString", "coordinates": [[20, 5], [20, 5.0 + wide]]})),
        feature("side", "exit", rectangle([-0.5, 0.8], [2.0, 4.0])),
        feature("stalls", "crowd", rectangle([5.0, 9.0], [1.0, 9.0])),
        feature("desk", "waypoint", json!({"type": "Point", "coordinates": [12, 3]})),
        feature("rope", "queue", json!({"type": "LineString", "coordinates": [[15, 5], [13, 5], [13, 8]]})),
        feature("ramp", "zone", rectangle([16.0, 18.0], [0.0, 10.0])),
    ]})
}

fn load(wide: f64, keys: &Value) -> Result<Scenario, ScenarioError> {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("plan.geojson"), plan(wide).to_string()).unwrap();
    let mut document =
        json!({"walkable_area": "plan.geojson", "duration_secs": 10, "profile": "steer+sph"});
    document
        .as_object_mut()
        .unwrap()
        .extend(keys.as_object().unwrap().clone());
    let path = folder.path().join("hall.json");
    fs::write(&path, document.to_string()).unwrap();
    Scenario::load(&path, &[])
}

fn keys() -> Value {
    json!({
        "exits": ["main door", "side"],
        "waypoints": ["desk"],
        "queues": [{"name": "rope", "service_secs": 5}],
        "zones": [{"name": "ramp", "speed_factor": 0.5}],
        "journeys": [{"name": "buy", "stages": ["rope", "desk", "main door"]}],
        "crowds": [{"area": "stalls", "number": 12, "journey": "buy"}],
        "measurements": [{"line_flow": {"name": "door", "line": "main door"}}],
    })
}

#[test]
fn names_stand_for_the_geometry_of_the_plan() {
    let document = load(1.2, &keys()).unwrap().document;
    assert_eq!(
        document["exits"][0],
        json!({"name": "main door", "line": [[20.0, 5.0], [20.0, 6.2]]})
    );
    // People come to the exit area from the right: its edge within the hall.
    let line = &document["exits"][1]["line"];
    let ends: Vec<[f64; 2]> = serde_json::from_value(line.clone()).unwrap();
    let [[a, low], [b, high]] = ends[..] else {
        panic!("{line}")
    };
    assert_eq!([a, b, low.min(high), low.max(high)], [0.8, 0.8, 2.0, 4.0]);
    assert_eq!(
        document["waypoints"][0],
        json!({"name": "desk", "at": [12.0, 3.0]})
    );
    assert_eq!(
        document["queues"][0]["path"],
        json!([[15.0, 5.0], [13.0, 5.0], [13.0, 8.0]])
    );
    assert_eq!(document["zones"][0]["area"].as_array().unwrap().len(), 4);
    assert_eq!(document["crowds"][0]["area"].as_array().unwrap().len(), 4);
    assert_eq!(
        document["measurements"][0]["line_flow"]["line"],
        json!([[20.0, 5.0], [20.0, 6.2]])
    );
}

// Written after the method was fixed.
#[test]
fn an_exit_area_across_a_corridor_has_its_line_halfway() {
    let folder = TempDir::new().unwrap();
    let corridor = json!({"type": "FeatureCollection", "features": [
        feature("corridor", "floor", rectangle([0.0, 20.0], [0.0, 3.0])),
        feature("out", "exit", rectangle([8.0, 10.0], [-1.0, 4.0])),
    ]});
    fs::write(folder.path().join("plan.geojson"), corridor.to_string()).unwrap();
    let document = json!({"walkable_area": "plan.geojson", "exits": ["out"], "agents": []});
    let path = folder.path().join("corridor.json");
    fs::write(&path, document.to_string()).unwrap();
    let line = Scenario::load(&path, &[]).unwrap().document["exits"][0]["line"].clone();
    let mut ends: Vec<[f64; 2]> = serde_json::from_value(line).unwrap();
    ends.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let off = ends
        .iter()
        .flatten()
        .zip([9.0, 0.0, 9.0, 3.0])
        .map(|(x, y)| (x - y).abs());
    assert!(off.fold(0.0, f64::max) < 1e-9, "{ends:?}");
}

#[test]
fn a_corrected_drawing_needs_no_change_of_the_scenario() {
    let top = |wide: f64| load(wide, &keys()).unwrap().document["exits"][0]["line"][1].clone();
    assert_eq!(
        [1.2, 2.5].map(top),
        [json!([20.0, 6.2]), json!([20.0, 7.5])]
    );
}

#[test]
fn wrong_names_are_refused_with_their_place() {
    let said = |change: Value| {
        let mut all = keys();
        all.as_object_mut()
            .unwrap()
            .extend(change.as_object().unwrap().clone());
        load(1.2, &all).unwrap_err().to_string()
    };
    let unknown = said(json!({"exits": ["main dor"]}));
    assert!(
        unknown.contains("exits[0]: the plan has no place with the name `main dor`"),
        "{unknown}"
    );
    assert!(unknown.contains("main door"), "{unknown}");
    let form = said(json!({"crowds": [{"area": "rope", "number": 3, "journey": "buy"}]}));
    assert!(
        form.contains("crowds[0].area: `rope` is a line with bends of the plan"),
        "{form}"
    );
    let line = said(json!({"exits": ["desk", "main door"]}));
    assert!(
        line.contains("exits[0]: `desk` is a point of the plan; `line` needs another form"),
        "{line}"
    );
}

// Written after the method was fixed.
#[test]
fn two_places_of_one_name_cannot_be_told_apart() {
    let folder = TempDir::new().unwrap();
    let mut twice = plan(1.0);
    let again = feature("side", "exit", rectangle([3.0, 4.0], [9.0, 10.5]));
    twice["features"].as_array_mut().unwrap().push(again);
    fs::write(folder.path().join("plan.geojson"), twice.to_string()).unwrap();
    let document = json!({"walkable_area": "plan.geojson", "exits": ["side"], "agents": []});
    let path = folder.path().join("hall.json");
    fs::write(&path, document.to_string()).unwrap();
    let error = Scenario::load(&path, &[]).unwrap_err().to_string();
    assert!(
        error.contains("the plan has 2 places with the name `side`"),
        "{error}"
    );
}
