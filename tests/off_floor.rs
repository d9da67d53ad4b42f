//! Zones, and regions and lines of measurements, must reach the floor.

use sandbox::scenario::Scenario;
use serde_json::{Value, json};

const OFF: &str = "lies in obstacles or outside of the walkable area; move it onto the floor";

/// A hall of 10 m by 10 m with a pillar and one more key.
fn message(key: &str, value: &Value) -> Option<String> {
    let hall = json!({
        "walkable_area": [[[[0, 0], [10, 0], [10, 10], [0, 10]]]],
        "obstacles": [[[4, 4], [6, 4], [6, 6], [4, 6]]],
        "goal": [9, 9], "agents": [{"position": [1, 1]}], key: value,
    });
    let read = Scenario::parse(&hall.to_string(), "hall.json", &[]);
    read.err().map(|error| error.to_string())
}

fn expect(key: &str, value: &Value, place: Option<&str>) {
    let expected = place.map(|place| format!("hall.json: {place}: {OFF}"));
    assert_eq!(message(key, value), expected, "{value}");
}

#[test]
fn zones_off_the_floor_are_refused() {
    for (area, is_on) in [
        (json!([[20, 0], [25, 0], [25, 5]]), false),
        (json!([[10, 0], [15, 0], [15, 5]]), false), // along the wall
        (json!([[4, 4], [6, 4], [6, 6], [4, 6]]), false),
        (json!([[9, 0], [15, 0], [15, 5]]), true),
        (json!([[3, 3], [7, 3], [7, 7], [3, 7]]), true),
    ] {
        let zones = json!([{"area": area, "speed_factor": 0.5}]);
        expect("zones", &zones, (!is_on).then_some("zones[0].area"));
    }
}

#[test]
fn measured_regions_off_the_floor_are_refused() {
    for (kind, mut keys) in [
        ("density", json!({"at_secs": 1})),
        ("walks", json!({})),
        ("exposure", json!({})),
        ("service_levels", json!({})),
        ("crowd_pressure", json!({})),
        ("unbalanced", json!({})),
        ("body_forces", json!({})),
        ("front", json!({})),
        ("oscillation", json!({})),
        ("contacts", json!({"at_secs": 1})),
        ("line_flow", json!({"line": [[1, 1], [2, 2]]})),
    ] {
        for (region, is_on) in [
            (json!([[100, 100], [110, 110]]), false),
            (json!([[4.5, 4.5], [5.5, 5.5]]), false),
            (json!([[-5, -5], [1, 1]]), true),
        ] {
            keys["region"] = region;
            let place = format!("measurements[1].{kind}.region");
            let measurements = json!([{"closest": {}}, {kind: keys.clone()}]);
            expect("measurements", &measurements, (!is_on).then_some(&place));
        }
    }
}

#[test]
fn measured_lines_off_the_floor_are_refused() {
    for (line, is_on) in [
        (json!([[100, 100], [110, 110]]), false),
        (json!([[4.5, 5], [5.5, 5]]), false),
        (json!([[-5, 5], [0.5, 5]]), true),
        (json!([[0, 2], [0, 4]]), true), // along the wall, as an exit
    ] {
        let measurements = json!([{"line_flow": {"line": line}}]);
        let place = (!is_on).then_some("measurements[0].line_flow.line");
        expect("measurements", &measurements, place);
    }
}

#[test]
fn without_walls_everything_is_floor() {
    let region = json!([[1e5, 1e5], [2e5, 2e5]]);
    let open = json!({"zones": [{"area": [[99, 0], [100, 0], [100, 1]], "speed_factor": 0.5}],
                      "measurements": [{"walks": {"region": region}}]});
    Scenario::parse(&open.to_string(), "open.json", &[]).unwrap();
}

#[test]
fn every_corner_of_a_jittered_source_stays_in_front_of_exits() {
    let room = |y: f64| {
        json!({
            "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10]]]],
            "exits": [{"name": "east", "line": [[12, 4], [12, 6]]}],
            "sources": [{"min": [11.9, y], "max": [11.9, y], "columns": 1, "rows": 1, "jitter": 0.4, "every_secs": 1}],
        })
    };
    let read = |y| Scenario::parse(&room(y).to_string(), "room.json", &[]);
    // Only the corner toward the exit lies behind it.
    for y in [3.65, 6.35] {
        let error = read(y).unwrap_err().to_string();
        let expected = "room.json: sources[0]: an agent starts at (12.30, ";
        assert!(error.starts_with(expected), "{error}");
    }
    assert!(read(8.0).is_ok());
}
