//! What is said of buildings that cannot be run, and of doubtful ones.

use sandbox::scenario::Scenario;
use serde_json::{Value, json};

use crate::common::buildings::{each, folded, house, read, refused};

#[test]
fn wrong_buildings_are_refused_with_their_place() {
    let with = |path: &str, value: Value| {
        let mut document = house();
        match document.pointer_mut(path) {
            Some(place) => *place = value,
            None => {
                let (parent, key) = path.rsplit_once('/').unwrap();
                document.pointer_mut(parent).unwrap()[key] = value;
            }
        }
        document
    };
    let cases = [
        (
            with("/exits/0/level", json!("grund")),
            "exits[0].level: there is no level named `grund`; did you mean `ground`?",
        ),
        (
            with("/exits/0/level", Value::Null),
            "exits[0]: missing key `level`: one of `ground`, `stairs`, `upper`",
        ),
        (
            with("/levels/0/elevation", Value::Null),
            "levels[0]: `ground`: a floor needs an `elevation`",
        ),
        (
            with("/levels/1/elevation", json!(1)),
            "levels[1]: `stairs`: stairs and ramps have the heights of the floors that they join",
        ),
        (
            with("/levels/2/name", json!("ground")),
            "levels[2].name: there are two levels named `ground`",
        ),
        (
            with("/joins/1/line", json!([[15, 0], [15, 1.5]])),
            "joins[1].line: must be an edge of both levels, from end to end: `stairs` lies on neither side of it",
        ),
        (
            with("/joins/0/line", json!([[10, 0], [10, 3]])),
            "joins[0].line: must be an edge of both levels, from end to end: `stairs` lies on neither side of it",
        ),
        (
            with("/joins/0/levels", json!(["ground", "ground"])),
            "joins[0].levels: a join needs two different levels",
        ),
        (
            with("/joins/0/levels", json!(["ground", "stair"])),
            "joins[0].levels[1]: there is no level named `stair`; did you mean `stairs`?",
        ),
        (
            with("/levels/2/elevation", json!(0)),
            "levels[1]: `stairs`: it needs joins with floors of two heights, one at its lower and one at its",
        ),
        (
            with("/walkable_area", json!([[[[0, 0], [1, 0], [1, 1]]]])),
            "walkable_area: cannot be with `levels`: the levels have their own",
        ),
        (
            with("/doors", json!([{"name": "d", "line": [[1, 1], [1, 2]]}])),
            "doors[0]: missing key `level`: one of `ground`, `stairs`, `upper`",
        ),
        (
            with("/levels", json!([])),
            "joins: there are no `levels` to join",
        ),
        (
            with(
                "/crowds/0/area",
                json!([[24, 0], [30, 0], [30, 6], [24, 6]]),
            ),
            "crowds[0].area: lies in obstacles or outside of the walkable area",
        ),
        (
            with(
                "/measurements",
                json!([{"density": {"at_secs": 8, "level": "upper"}}]),
            ),
            "measurements[0].density.level: is that of a `region` or `line`, and there is none",
        ),
        (
            with("/agents", json!([{"level": "stairs", "position": [8, 1]}])),
            "an agent starts at (8, 1) on `stairs`, outside of this level; move it onto the floor, or name the level",
        ),
        (
            with(
                "/levels/0/obstacles",
                json!([[[9.8, 0.6], [10, 0.6], [10, 0.9], [9.8, 0.9]]]),
            ),
            "joins[0].line: must be an edge of both levels, from end to end: `ground` has a wall or an obstacle at a",
        ),
        (
            with(
                "/exits",
                json!([{"name": "beside", "level": "ground", "line": [[10, 1.5], [10, 2.7]]}]),
            ),
            "exits[0].line: touches the join of `ground` and `stairs`: end it 2 cm or more before that",
        ),
        (with("/levels/0/kind", json!("stair")), "levels[0].kind"),
        (with("/levels/0/height", json!(3)), "levels[0]"),
    ];
    for (document, expected) in cases {
        let said = refused(&document);
        assert!(said.contains(expected), "{said}\ninstead of: {expected}");
    }
}

#[test]
fn stairs_too_narrow_for_people_are_refused_as_on_a_floor() {
    let mut document = house();
    let area = json!([[[[10, 0], [14, 0], [14, 0.3], [10, 0.3]]]]);
    document["levels"][1]["walkable_area"] = area;
    document["joins"][0]["line"] = json!([[10, 0], [10, 0.3]]);
    document["joins"][1]["line"] = json!([[14, 0], [14, 0.3]]);
    for choice in ["shortest", "quickest"] {
        document["route_choice"] = json!(choice);
        let said = refused(&document);
        assert!(said.contains("has a passage narrower than"), "{said}");
    }
}

#[test]
fn impossible_slopes_are_noted() {
    let note = |height: f64, kind: &str| {
        let mut document = house();
        document["levels"][1]["kind"] = json!(kind);
        document["levels"][2]["elevation"] = json!(height);
        let notes = read(&document).notes;
        notes.into_iter().find(|note| note.contains("per meter"))
    };
    // 4 m long.
    assert_eq!(note(4.0, "stairs"), None);
    assert_eq!(note(0.6, "ramp"), None);
    let said =
        "levels[1]: `stairs` rises 3 m per meter: check elevations, and that the unit is meters";
    assert_eq!(note(12.0, "stairs").as_deref(), Some(said));
    assert!(
        note(1.0, "ramp")
            .unwrap()
            .contains("rises 0.25 m per meter")
    );
}

#[test]
fn a_level_can_have_a_plan_file_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let upper = r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "Hall"},
        "geometry": {"type": "Polygon", "coordinates": [[[14, 0], [20, 0], [20, 6], [14, 6], [14, 0]]]}}]}"#;
    std::fs::write(folder.path().join("upper.geojson"), upper).unwrap();
    let ground = "POLYGON ((0 0, 10 0, 10 6, 0 6, 0 0), (4 2, 4 3, 5 3, 5 2, 4 2))";
    std::fs::write(folder.path().join("ground.wkt"), ground).unwrap();
    let mut document = house();
    document["levels"][0]["walkable_area"] = json!("ground.wkt");
    document["levels"][2]["walkable_area"] = json!("upper.geojson");
    let path = folder.path().join("house.json");
    std::fs::write(&path, document.to_string()).unwrap();
    let scenario = Scenario::load(&path, &[]).unwrap();
    let levels = scenario.scene.levels.clone().unwrap();
    let size = |k: usize| -> f64 { levels.all()[k].floor.iter().map(|area| area.area()).sum() };
    assert!((size(0) - 59.0).abs() < 1e-6 && (size(2) - 36.0).abs() < 1e-6);
    let label = scenario
        .labels
        .iter()
        .find(|label| label.text == "Hall")
        .unwrap();
    assert_eq!(levels.level(label.at), 2);
    assert_eq!(each(&scenario, |_, _, _| {}), 40);
    // What is written has no files.
    let again = Scenario::parse(&scenario.to_text(), "house.json", &[]).unwrap();
    assert_eq!(again.scene.levels, scenario.scene.levels);
    document["levels"][2]["walkable_area"] = json!("roof.geojson");
    std::fs::write(&path, document.to_string()).unwrap();
    let said = Scenario::load(&path, &[]).unwrap_err().to_string();
    assert!(
        said.contains("levels[2].walkable_area") && said.contains("roof.geojson"),
        "{said}"
    );
}

#[test]
fn walks_are_measured_in_the_building() {
    // The exit lies right below the person, two levels away.
    let mut document = folded();
    document["crowds"] = json!([]);
    document["agents"] = json!([{"level": "upper", "position": [9, 5]}]);
    document["duration_secs"] = json!(30);
    let notes = read(&document).notes;
    assert!(
        !notes.iter().any(|note| note.contains("nobody can leave")),
        "{notes:?}"
    );
    // 9 m along x at 1.4 m/s.
    document["exits"] = json!([{"name": "street", "level": "ground", "line": [[0, 4], [0, 5.5]]}]);
    document["duration_secs"] = json!(6);
    let notes = read(&document).notes;
    let said = "nobody can leave within 6 s: those nearest to their exit walk for 7 s or more";
    assert!(notes.iter().any(|note| note.contains(said)), "{notes:?}");
}

#[test]
fn nobody_looks_farther_than_levels_lie_apart() {
    let mut document = house();
    document["profile"] = json!("sf");
    document["parameters"] = json!({"avoidance_radius": 18});
    let said = refused(&document);
    assert!(
        said.contains("levels: people look 18 m far, and in buildings at most 17 m"),
        "{said}"
    );
    document["parameters"] = json!({"avoidance_radius": 16});
    read(&document);
}

#[test]
fn messages_name_places_of_the_building() {
    let mut document = house();
    document["agents"] = json!([{"level": "upper", "position": [25, 3]}]);
    let said = refused(&document);
    assert!(said.contains("(25, 3) on `upper`"), "{said}");
    // Without the stairs, no way leads down.
    let mut document = house();
    document["joins"] = json!([{"levels": ["ground", "stairs"], "line": [[10, 0], [10, 1.5]]}]);
    let floor = document["levels"][1]["walkable_area"].clone();
    document["levels"][1] = json!({"name": "stairs", "elevation": 0, "walkable_area": floor});
    let said = refused(&document);
    assert!(
        said.contains("no way leads from") && said.contains("on `upper`"),
        "{said}"
    );
}
