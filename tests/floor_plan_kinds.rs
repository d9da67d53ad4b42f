//! The kinds of features in GeoJSON, and polygons without effect.

use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError};
use serde_json::{Value, json};

fn square(x: f64, y: f64, side: f64) -> Value {
    json!([[
        [x, y],
        [x + side, y],
        [x + side, y + side],
        [x, y + side],
        [x, y]
    ]])
}

/// A hall of 10 m by 10 m, and a square with the given properties.
fn hall_with(square: &Value, properties: &Value) -> String {
    let feature = |properties: &Value, coordinates: &Value| {
        json!({"type": "Feature", "properties": properties,
               "geometry": {"type": "Polygon", "coordinates": coordinates}})
    };
    let hall = feature(&json!({"name": "hall"}), &self::square(0.0, 0.0, 10.0));
    let features = [hall, feature(properties, square)];
    json!({"type": "FeatureCollection", "features": features}).to_string()
}

fn plan_with(square: &Value, properties: &Value) -> Result<FloorPlan, FloorPlanError> {
    floor_plan::parse(&hall_with(square, properties))
}

fn area(plan: &FloorPlan) -> f64 {
    plan.walkable.iter().map(|area| area.area()).sum()
}

#[test]
fn an_unknown_kind_is_refused_with_the_feature_and_the_known_kinds() {
    let pillar = square(4.0, 4.0, 1.0);
    for (kind, fix) in [
        (
            json!("Obstackle"),
            "kind `Obstackle` is unknown; did you mean `obstacle`?",
        ),
        (
            json!("tree"),
            "kind `tree` is unknown; write `floor`, `obstacle`, `wall`, `door`, `exit`, `entrance`, `crowd`, \
             `waypoint`, `waiting area`, `queue`, `zone` or `place`",
        ),
    ] {
        let given = plan_with(&pillar, &json!({"kind": kind, "name": "pillar"}));
        let expected = format!("feature 2 (pillar): {fix}");
        assert_eq!(given.unwrap_err().to_string(), expected);
    }
    let misnamed = plan_with(&pillar, &json!({"type": "obstacle"}));
    let expected = "feature 2: the property `type` is `obstacle`, but only `kind` says what a feature is; rename it";
    assert_eq!(misnamed.unwrap_err().to_string(), expected);
}

#[test]
fn known_kinds_have_any_case_and_other_properties_do_not_matter() {
    let pillar = square(4.0, 4.0, 1.0);
    for (properties, expected) in [
        (json!({"kind": "OBSTACLE"}), 99.0),
        (json!({"kind": "obstacles"}), 99.0),
        (json!({"kind": "column"}), 99.0),
        (json!({"kind": "wall"}), 99.0),
        (json!({"kind": "crowd", "name": "stalls"}), 100.0),
        (json!({"kind": " obstacle "}), 99.0),
        (json!({"kind": "Floor"}), 100.0),
        (json!({"kind": ""}), 100.0),
        (json!({"kind": null, "name": "obstacle"}), 100.0),
        (json!({"kind": "floor", "type": "obstacle"}), 100.0),
        (json!({"type": "wall", "height": 3, "tags": ["a"]}), 100.0),
    ] {
        let plan = plan_with(&pillar, &properties).unwrap();
        assert!((area(&plan) - expected).abs() < 1e-9, "{properties}");
    }
}

#[test]
fn every_polygon_of_an_obstacle_file_is_an_obstacle_of_any_kind() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walls.geojson");
    let text = hall_with(&square(20.0, 0.0, 1.0), &json!({"kind": "wall"}));
    std::fs::write(&path, text).unwrap();
    let plan = floor_plan::read_obstacles(&path).unwrap();
    assert_eq!((plan.obstacles.len(), plan.notes.len()), (2, 0));
}

#[test]
fn polygons_without_effect_are_noted() {
    let [off, inside] = [
        "feature 2 (shop): obstacles wholly off the floor have no effect; move or remove them",
        "feature 2 (shop): floor wholly inside other floor (feature 1 (hall)) adds nothing; remove it, or make it an \
         obstacle",
    ];
    for (place, kind, expected) in [
        ([50.0, 50.0], "obstacle", vec![off]),
        ([10.0, 0.0], "obstacle", vec![off]), // along an edge
        ([9.5, 5.0], "obstacle", vec![]),
        ([4.0, 4.0], "obstacle", vec![]),
        ([4.0, 4.0], "floor", vec![inside]),
        ([9.0, 0.0], "floor", vec![inside]),
        ([9.5, 5.0], "floor", vec![]),
        ([10.0, 0.0], "floor", vec![]),
        ([50.0, 50.0], "floor", vec![]),
    ] {
        let shop = square(place[0], place[1], 1.0);
        let plan = plan_with(&shop, &json!({"kind": kind, "name": "shop"})).unwrap();
        assert_eq!(plan.notes, expected, "{kind} at {place:?}");
    }
}

#[test]
fn holes_off_the_floor_are_noted() {
    let note = |holes: &str| {
        format!("{holes}: holes wholly off the floor have no effect; move or remove them")
    };
    let hall = "POLYGON ((0 0, 9 0, 9 9, 0 9)";
    let [off, far] = ["(20 0, 22 0, 22 2, 20 2)", "(0 50, 2 50, 2 52, 0 52)"];
    let other = "POLYGON ((20 0, 29 0, 29 9, 20 9))";
    for (plan, notes) in [
        (format!("{hall}, {off})"), vec![note("hole 1")]),
        (
            format!("{hall}, (1 1, 2 1, 2 2), {off}, {far})"),
            vec![note("hole 2 and 1 more")],
        ),
        // It is cut out of another floor.
        (format!("{hall}, {off})\n{other}"), vec![]),
        (format!("{hall}, (8 8, 12 8, 12 12, 8 12))"), vec![]),
        (format!("{hall}, (-5 4, 14 4, 14 5, -5 5))"), vec![]),
        // Beside the floor, along its edge.
        (
            format!("{hall}, (9 1, 10 1, 10 2, 9 2))"),
            vec![note("hole 1")],
        ),
    ] {
        assert_eq!(floor_plan::parse(&plan).unwrap().notes, notes, "{plan}");
    }
}

#[test]
fn of_equal_floors_all_but_the_first_are_noted() {
    let rooms = ["POLYGON ((0 0, 9 0, 9 9, 0 9))"; 3].join("\n");
    let note = "line 2 and 1 more: floor wholly inside other floor (line 1) adds nothing; remove it, or make it an \
                obstacle";
    assert_eq!(floor_plan::parse(&rooms).unwrap().notes, [note]);
    // An area in the hole of another one is no part of it.
    let yard =
        "POLYGON ((0 0, 9 0, 9 9, 0 9), (1 1, 8 1, 8 8, 1 8))\nPOLYGON ((3 3, 5 3, 5 5, 3 5))";
    assert!(floor_plan::parse(yard).unwrap().notes.is_empty());
}
