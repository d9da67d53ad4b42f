//! Buildings in the words of IMDF. Areas, joins and heights are recomputed from the numbers that the files are made of.

use std::fs;

use sandbox::scenario::Scenario;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::buildings::each;
use crate::common::plan_files::{
    collection, height, is_near, joins, level, load, opening, rectangle, size, unit,
};

/// Two floors with a flight between them, a room behind a door, and an elevator.
fn features() -> Vec<Value> {
    vec![
        level("L0", 0, json!({"en": "Ground"})),
        level("L1", 1, json!("Upper")),
        unit("L0", "walkway", "Hall", rectangle([0.0, 10.0], [0.0, 6.0])),
        unit("L0", "room", "Shop", rectangle([0.0, 4.0], [6.0, 10.0])),
        unit(
            "L0",
            "stairs",
            "Stairs",
            rectangle([10.0, 14.0], [0.0, 1.5]),
        ),
        unit("L0", "elevator", "", rectangle([10.0, 12.0], [4.0, 6.0])),
        unit("L1", "lobby", "Lobby", rectangle([14.0, 20.0], [0.0, 6.0])),
        opening("L0", "shop door", [[1.0, 6.0], [2.2, 6.0]]),
        opening("L0", "street", [[0.0, 2.0], [0.0, 3.2]]),
        opening("L0", "foot", [[10.0, 0.0], [10.0, 1.5]]),
        opening("L0", "lift", [[10.0, 4.5], [10.0, 5.5]]),
        opening("L1", "head", [[14.0, 0.0], [14.0, 1.5]]),
    ]
}

/// People of a scenario of such a building.
fn people() -> Value {
    json!({
        "profile": "steer+sph",
        "duration_secs": 200,
        "plan": {"storey_height": 3.2},
        "crowds": [{"area": "Lobby", "number": 20}, {"area": "Shop", "number": 10}],
        "exits": ["street"],
        "stop": {"when_empty": true},
    })
}

#[test]
fn levels_and_joins_of_imdf_are_those_of_the_file() {
    let scenario = load(
        "house.geojson",
        &collection(&features()).to_string(),
        &people(),
    )
    .unwrap();
    // A wall of 1 cm stands between hall and shop: 4 m without the door of 1.2 m.
    is_near(
        size(&scenario, "Ground"),
        10.0 * 6.0 + 4.0 * 4.0 - 0.01 * 2.8,
        1e-3,
    );
    is_near(size(&scenario, "Stairs"), 4.0 * 1.5, 1e-9);
    is_near(size(&scenario, "Upper"), 36.0, 1e-9);
    let at = |a: &str, b: &str, line: [[f64; 2]; 2]| (vec![a.to_owned(), b.to_owned()], line);
    let expected = [
        at("Ground", "Stairs", [[10.0, 0.0], [10.0, 1.5]]),
        at("Stairs", "Upper", [[14.0, 0.0], [14.0, 1.5]]),
    ];
    assert_eq!(joins(&scenario), expected);
    // One ordinal is 3.2 m, and the flight 4 m long.
    for x in [10.0, 11.0, 13.0, 14.0] {
        is_near(
            height(&scenario, "Stairs", [x, 0.7]),
            3.2 * (x - 10.0) / 4.0,
            1e-9,
        );
    }
    is_near(height(&scenario, "Upper", [15.0, 1.0]), 3.2, 1e-9);
    // Names without `level` get that of what they name.
    let document = &scenario.document;
    assert_eq!(
        document["exits"][0],
        json!({"name": "street", "level": "Ground", "line": [[0.0, 2.0], [0.0, 3.2]]})
    );
    assert_eq!(document["crowds"][0]["level"], "Upper");
    let notes = scenario.notes.join("\n");
    assert!(
        notes
            .contains("units left out, no one walks on them: unit 6 (unit elevator 10) (elevator)"),
        "{notes}"
    );
    assert!(
        notes.contains("openings that join nothing are walls: opening 11 (lift)"),
        "{notes}"
    );
    assert_eq!(each(&scenario, |_, _, _| {}), 30);
    let again = Scenario::parse(&scenario.to_text(), "house.json", &[]).unwrap();
    assert_eq!(again.scene.levels, scenario.scene.levels);
}

#[test]
fn an_elevation_in_meters_wins_over_the_ordinal() {
    let mut features = features();
    features[1]["properties"]["elevation"] = json!(2.75);
    let mut base = people();
    let content = |features: &[Value]| collection(features).to_string();
    let scenario = load("house.geojson", &content(&features), &base).unwrap();
    is_near(height(&scenario, "Upper", [15.0, 1.0]), 2.75, 1e-12);
    // Then no height of storeys is needed.
    features[0]["properties"]["elevation"] = json!(-0.25);
    base["plan"] = Value::Null;
    let scenario = load("house.geojson", &content(&features), &base).unwrap();
    is_near(height(&scenario, "Stairs", [12.0, 1.0]), 1.25, 1e-9);
}

#[test]
fn wrong_files_of_levels_are_refused_with_the_feature_and_the_fix() {
    let with = |k: usize, key: &str, value: Value| {
        let mut features = features();
        features[k]["properties"][key] = value;
        features
    };
    let without = |k: usize| {
        let mut features = features();
        features.remove(k);
        features
    };
    let moved = |k: usize, line: [[f64; 2]; 2]| {
        let mut features = features();
        features[k]["geometry"]["coordinates"] = json!(line);
        features
    };
    let cases = [
        (
            with(3, "level_id", json!("L7")),
            "unit 4 (Shop): its level_id `L7` is that of no level; there are `L0` (Ground), `L1` (Upper)",
        ),
        (
            with(3, "level_id", Value::Null),
            "unit 4 (Shop): has no `level_id`",
        ),
        (
            with(3, "category", json!("rooom")),
            "unit 4 (Shop): the category `rooom` is unknown; did you mean `room`?",
        ),
        (
            with(1, "name", json!("Ground")),
            "level 2 (Ground): has the name `Ground`, as level 1 (Ground) has: give each a name of its own",
        ),
        (
            moved(7, [[1.0, 7.0], [2.2, 7.0]]),
            "opening 8 (shop door): lies on no edge of a unit of `Ground`, from end to end: draw it along the",
        ),
        (
            without(11),
            "unit 5 (Stairs): joins only `Ground`: openings must lie on its edge, one with the `level_id` of",
        ),
        (
            moved(11, [[14.0, 0.5], [14.0, 1.7]]),
            "unit 5 (Stairs): joins only `Ground`",
        ),
        (
            vec![
                features()[0].clone(),
                features()[2].clone(),
                features()[8].clone(),
            ],
            "it has one level only, `Ground`: name it under `walkable_area` instead of `levels`",
        ),
        (
            features()[2..].to_vec(),
            "it has no features with the `feature_type` level",
        ),
        (
            with(1, "ordinal", Value::Null),
            "level 2 (Upper): has neither an `ordinal` nor an `elevation`",
        ),
    ];
    for (features, expected) in cases {
        let said = load(
            "house.geojson",
            &collection(&features).to_string(),
            &people(),
        );
        let said = said.unwrap_err().to_string();
        assert!(said.contains(expected), "{said}\ninstead of: {expected}");
    }
    let mut base = people();
    base["plan"] = Value::Null;
    let said = load("house.geojson", &collection(&features()).to_string(), &base)
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("level 1 (Ground): has no `elevation`: give `plan.storey_height`"),
        "{said}"
    );
    let wkt = load(
        "house.wkt",
        "POLYGON ((0 0, 9 0, 9 9, 0 9, 0 0))",
        &people(),
    )
    .unwrap_err()
    .to_string();
    assert!(
        wkt.contains("WKT has one floor: name it under `walkable_area` of a level"),
        "{wkt}"
    );
    let plain = r#"{"type": "FeatureCollection", "features": []}"#;
    let plain = load("house.geojson", plain, &people())
        .unwrap_err()
        .to_string();
    assert!(plain.contains("have no `feature_type`"), "{plain}");
}

#[test]
fn one_storey_of_such_a_file_is_a_plan() {
    let folder = TempDir::new().unwrap();
    fs::write(
        folder.path().join("house.geojson"),
        collection(&features()).to_string(),
    )
    .unwrap();
    let path = folder.path().join("floor.json");
    let floor = |plan: Value| {
        let document = json!({"walkable_area": "house.geojson", "plan": plan, "agents": []});
        fs::write(&path, document.to_string()).unwrap();
        Scenario::load(&path, &[])
    };
    let all = floor(json!({"storey_height": 3})).unwrap_err().to_string();
    assert!(
        all.contains("it has the levels `Ground`, `Upper`: take all with `\"levels\":"),
        "{all}"
    );
    let one = floor(json!({"storey_height": 3, "storey": "Ground"})).unwrap();
    let area = |points: &Value| -> f64 {
        let points: Vec<[f64; 2]> = serde_json::from_value(points.clone()).unwrap();
        let next = points.iter().cycle().skip(1);
        0.5 * points
            .iter()
            .zip(next)
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
            .sum::<f64>()
    };
    let polygons = one.document["walkable_area"].as_array().unwrap();
    let rings = polygons
        .iter()
        .flat_map(|polygon| polygon.as_array().unwrap());
    is_near(rings.map(area).sum(), 76.0 - 0.028, 1e-3);
}

#[test]
fn names_on_several_levels_need_a_level() {
    let mut features = features();
    features[11]["properties"]["name"] = json!("street");
    let load = |base: &Value| load("house.geojson", &collection(&features).to_string(), base);
    let said = load(&people()).unwrap_err().to_string();
    assert!(
        said.contains(
            "exits[0]: `street` is a place on the levels `Ground`, `Upper`: give `level`, too"
        ),
        "{said}"
    );
    let mut base = people();
    base["exits"] = json!([{"name": "street", "level": "Ground"}]);
    let exit = &load(&base).unwrap().document["exits"][0];
    assert_eq!(exit["line"], json!([[0.0, 2.0], [0.0, 3.2]]));
    base["exits"] = json!([{"name": "way out", "level": "Ground", "line": "shop"}]);
    let said = load(&base).unwrap_err().to_string();
    assert!(
        said.contains("the plan of `Ground` has no place with the name `shop`"),
        "{said}"
    );
    base["exits"] = json!([{"name": "way out", "level": "Ground", "line": "Lobby"}]);
    let said = load(&base).unwrap_err().to_string();
    assert!(said.contains("that of `Upper` has one"), "{said}");
}
