//! Plan files in shapes that their reading was not built on: flights that turn on a landing, three storeys, stairs in
//! the middle of a hall, degrees, folders and archives. Written after the method was fixed.

use std::fs;

use sandbox::scenario::Scenario;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::buildings::each;
use crate::common::plan_files::{
    collection, feature, geometry, height, is_near, joins, level, load, load_in, opening, path,
    rectangle, size, unit,
};

/// A room with its subrooms: class, plane, and the ranges of x and y, centimeters.
fn room(id: u32, about: &str, subrooms: &[(&str, [f64; 3], [f64; 4])]) -> String {
    let subroom = |(k, (class, plane, [a, b, c, d])): (usize, &(&str, [f64; 3], [f64; 4]))| {
        let ring = rectangle([*a, *b], [*c, *d]);
        let walls = path(
            "polygon caption=\"wall\"",
            &[&ring[..], &ring[..1]].concat(),
        );
        let [along, across, above] = plane;
        let plane = format!("A_x=\"{along}\" B_y=\"{across}\" C_z=\"{above}\"");
        format!("<subroom id=\"{k}\" closed=\"0\" class=\"{class}\" {plane}>{walls}</subroom>")
    };
    let all: String = subrooms.iter().enumerate().map(subroom).collect();
    format!("<room id=\"{id}\" {about}>{all}</room>")
}

fn door(kind: &str, id: u32, [one, other]: [(i32, i32); 2], line: [[f64; 2]; 2]) -> String {
    let side = |k: u32, (room, subroom): (i32, i32)| {
        format!("room{k}_id=\"{room}\" subroom{k}_id=\"{subroom}\"")
    };
    path(
        &format!("{kind} id=\"{id}\" {} {}", side(1, one), side(2, other)),
        &line,
    )
}

#[test]
fn flights_that_turn_on_landings_lead_down_three_storeys_of_jupedsim() {
    // Two staircases above each other: east to a landing, then north. Heights are meters times 100.
    let stairs = |id: u32, base: f64| {
        room(
            id,
            &format!("caption=\"staircase {id}\" zpos=\"{base}\""),
            &[
                ("stair", [0.5, 0.0, -500.0], [1000.0, 1320.0, 0.0, 150.0]),
                ("subroom", [0.0, 0.0, 160.0], [1320.0, 1500.0, 0.0, 150.0]),
                ("stair", [0.0, 0.5, 85.0], [1320.0, 1500.0, 150.0, 470.0]),
            ],
        )
    };
    let hall = |id: u32, name: &str, base: f64, low: f64| {
        let about = format!("caption=\"{name}\" zpos=\"{base}\"");
        // Of the upper floors, the part behind the second flight reaches back over the ground floor.
        let mut parts = vec![("subroom", [0.0; 3], [0.0, 1000.0, low, 900.0])];
        if base > 0.0 {
            parts.push(("subroom", [0.0; 3], [1000.0, 1600.0, 470.0, 900.0]));
        }
        room(id, &about, &parts)
    };
    let rooms = [
        hall(0, "ground", 0.0, 0.0),
        stairs(1, 0.0),
        hall(2, "first", 320.0, 0.0),
        stairs(3, 320.0),
        hall(4, "second", 640.0, 300.0),
    ];
    let of_staircase = |id: i32, from: i32, to: i32| {
        [
            door(
                "transition",
                10 + id as u32,
                [(from, 0), (id, 0)],
                [[1000.0, 0.0], [1000.0, 150.0]],
            ),
            door(
                "crossing",
                20 + id as u32,
                [(id, 0), (id, 1)],
                [[1320.0, 0.0], [1320.0, 150.0]],
            ),
            door(
                "crossing",
                30 + id as u32,
                [(id, 1), (id, 2)],
                [[1320.0, 150.0], [1500.0, 150.0]],
            ),
            door(
                "transition",
                40 + id as u32,
                [(id, 2), (to, 1)],
                [[1320.0, 470.0], [1500.0, 470.0]],
            ),
            door(
                "crossing",
                50 + id as u32,
                [(to, 0), (to, 1)],
                [[1000.0, 500.0], [1000.0, 850.0]],
            ),
        ]
        .concat()
    };
    let out = door(
        "transition",
        1,
        [(0, 0), (-1, -1)],
        [[0.0, 200.0], [0.0, 350.0]],
    );
    let doors = [of_staircase(1, 0, 2), of_staircase(3, 2, 4), out];
    let xml = geometry(&rooms, &doors).replace("unit=\"m\"", "unit=\"cm\"");
    let base = json!({
        "profile": "steer+sph", "duration_secs": 300, "stop": {"when_empty": true},
        "crowds": [{"level": "second", "area": [[1, 4], [9, 4], [9, 8], [1, 8]], "number": 25}],
        "exits": [{"name": "street", "level": "ground", "line": "transition 1"}],
    });
    let scenario = load("tower.xml", &xml, &base).unwrap();
    let names: Vec<String> = {
        let levels = scenario.scene.levels.clone().unwrap();
        levels
            .all()
            .iter()
            .map(|level| level.name.clone())
            .collect()
    };
    let expected = [
        "ground",
        "1.6 m",
        "first",
        "4.8 m",
        "second",
        "room 1, subroom 0",
        "room 1, subroom 2",
        "room 3, subroom 0",
        "room 3, subroom 2",
    ];
    assert_eq!(names, expected);
    // Planes of the file: z = A x + B y + C, on the base of the room.
    for [x, y] in [[10.0, 0.2], [11.5, 0.7], [13.2, 1.5]] {
        is_near(
            height(&scenario, "room 1, subroom 0", [x, y]),
            0.5 * x - 5.0,
            1e-6,
        );
        is_near(
            height(&scenario, "room 3, subroom 0", [x, y]),
            0.5 * x - 5.0 + 3.2,
            1e-6,
        );
    }
    for [x, y] in [[13.3, 1.5], [14.0, 3.0], [15.0, 4.7]] {
        is_near(
            height(&scenario, "room 3, subroom 2", [x, y]),
            0.5 * y + 0.85 + 3.2,
            1e-6,
        );
    }
    is_near(height(&scenario, "4.8 m", [14.0, 1.0]), 4.8, 1e-9);
    is_near(size(&scenario, "ground"), 90.0, 1e-6);
    // The wall at x = 10 m is open from 5 to 8.5 m of 4.7 to 9 m.
    is_near(
        size(&scenario, "first"),
        90.0 + 6.0 * 4.3 - 0.01 * 0.8,
        1e-3,
    );
    is_near(
        size(&scenario, "second"),
        60.0 + 6.0 * 4.3 - 0.01 * 0.8,
        1e-3,
    );
    assert_eq!(joins(&scenario).len(), 8);
    assert_eq!(each(&scenario, |_, _, _| {}), 25);
}

/// A place in meters from 13° 24′ E, 52° 30′ N as degrees with seven digits, by the radii of curvature.
fn degrees([x, y]: [f64; 2]) -> [f64; 2] {
    let (half_axis, flattening) = (6_378_137.0_f64, 1.0 / 298.257_223_563);
    let eccentricity = flattening * (2.0 - flattening);
    let latitude = 52.5_f64.to_radians();
    let w = (1.0 - eccentricity * latitude.sin().powi(2)).sqrt();
    let meridian = half_axis * (1.0 - eccentricity) / w.powi(3);
    let across = half_axis / w * latitude.cos();
    let rounded = |angle: f64| (angle * 1e7).round() / 1e7;
    [
        rounded(13.4 + (x / across).to_degrees()),
        rounded(52.5 + (y / meridian).to_degrees()),
    ]
}

/// A building in degrees: three storeys of one hall each, with stairs in its middle. The halls have no holes, and the
/// upper stairs are drawn on both of their levels.
fn in_degrees() -> Vec<Value> {
    let hall = || rectangle([0.0, 24.0], [0.0, 12.0]);
    let [low, high] = [[5.0, 7.0], [8.0, 10.0]];
    let flight = |y: [f64; 2]| rectangle([8.0, 13.0], y);
    let at = |x: f64, [a, b]: [f64; 2]| [[x, a], [x, b]];
    let mut all = vec![
        level("a", 0, json!({"de": "Erdgeschoss", "en": "Ground floor"})),
        level("b", 1, json!({"en": "First floor"})),
        level("c", 2, json!({"en": "Second floor"})),
        unit("a", "walkway", "", hall()),
        unit("b", "walkway", "", hall()),
        unit("c", "auditorium", "Upper hall", hall()),
        unit("a", "stairs", "Main stairs", flight(low)),
        unit("b", "stairs", "Main stairs", flight(high)),
        unit("c", "stairs", "Main stairs", flight(high)),
        opening("a", "", at(8.0, low)),
        opening("b", "", at(13.0, low)),
        opening("b", "", at(13.0, high)),
        opening("c", "", at(8.0, high)),
        opening("a", "Main entrance", at(24.0, [3.0, 5.0])),
    ];
    for one in all.iter_mut().filter(|one| one["geometry"].is_object()) {
        turn(&mut one["geometry"]["coordinates"]);
    }
    all
}

fn turn(coordinates: &mut Value) {
    match coordinates {
        Value::Array(list) if list.iter().all(Value::is_number) && list.len() == 2 => {
            let [x, y] = [0, 1].map(|k| list[k].as_f64().unwrap());
            *coordinates = json!(degrees([x, y]));
        }
        Value::Array(list) => list.iter_mut().for_each(turn),
        _ => {}
    }
}

fn check_degrees(scenario: &Scenario) {
    // A digit is 1.1 cm of 24 and 12 m.
    is_near(size(scenario, "Ground floor"), 288.0 - 10.0, 0.4);
    is_near(size(scenario, "First floor"), 288.0 - 20.0, 0.4);
    is_near(size(scenario, "Second floor"), 288.0 - 10.0, 0.4);
    is_near(size(scenario, "Main stairs (Ground floor)"), 10.0, 0.1);
    is_near(
        height(scenario, "Main stairs (First floor)", [10.5, 9.0]),
        1.5 * 3.5,
        0.01,
    );
    let lines: Vec<[[f64; 2]; 2]> = joins(scenario).into_iter().map(|(_, line)| line).collect();
    let expected = [
        [[8.0, 5.0], [8.0, 7.0]],
        [[13.0, 5.0], [13.0, 7.0]],
        [[13.0, 8.0], [13.0, 10.0]],
        [[8.0, 8.0], [8.0, 10.0]],
    ];
    assert_eq!(lines.len(), expected.len());
    for (found, expected) in lines.iter().zip(expected) {
        let found = found.iter().flatten();
        found
            .zip(expected.iter().flatten())
            .for_each(|(x, y)| is_near(*x, *y, 0.02));
    }
    let notes = scenario.notes.join("\n");
    for said in [
        "meters east and north of longitude 13.4, latitude 52.5; `plan.origin` sets this point",
        "is the flight from another level, drawn once more",
        "level `First floor`: its floor has no hole where stairs come: 10.",
    ] {
        assert!(notes.contains(said), "{said}: {notes}");
    }
    assert_eq!(each(scenario, |_, _, _| {}), 30);
}

fn visitors() -> Value {
    json!({
        "profile": "steer+sph", "duration_secs": 300, "stop": {"when_empty": true},
        "plan": {"storey_height": 3.5},
        "crowds": [{"level": "Second floor", "area": [[15, 1], [23, 1], [23, 11], [15, 11]], "number": 30}],
        "exits": ["Main entrance"],
    })
}

#[test]
fn stairs_in_the_middle_of_halls_in_degrees_lead_out() {
    let content = collection(&in_degrees()).to_string();
    check_degrees(&load("halls.geojson", &content, &visitors()).unwrap());
    // With another origin all is moved by as much.
    let mut moved = visitors();
    let [longitude, latitude] = degrees([-20.0, 10.0]);
    moved["plan"]["origin"] = json!([longitude, latitude]);
    moved["crowds"][0]["area"] = json!("Upper hall");
    let moved = load("halls.geojson", &content, &moved).unwrap();
    let found = joins(&moved)[0].1;
    for (x, y) in found.iter().flatten().zip([28.0, -5.0, 28.0, -3.0]) {
        is_near(*x, y, 0.02);
    }
}

#[cfg(feature = "program")]
#[test]
fn an_archive_of_imdf_is_read_as_its_files() {
    use crate::common::zips::{Packing, zip};
    let all = in_degrees();
    let of_kind = |kind: &str| {
        let own: Vec<Value> = all
            .iter()
            .filter(|one| one["feature_type"] == kind)
            .cloned()
            .collect();
        collection(&own).to_string()
    };
    let [levels, units, openings] = ["level", "unit", "opening"].map(of_kind);
    let files: [(&str, &[u8]); 4] = [
        ("venue/level.geojson", levels.as_bytes()),
        ("venue/unit.geojson", units.as_bytes()),
        ("venue/opening.geojson", openings.as_bytes()),
        ("venue/manifest.json", b"{\"version\": \"1.0.0\"}"),
    ];
    let folder = TempDir::new().unwrap();
    fs::write(
        folder.path().join("venue.zip"),
        zip(&files, Packing::Deflated),
    )
    .unwrap();
    check_degrees(&load_in(folder.path(), "venue.zip", &visitors()).unwrap());
}

#[test]
fn a_folder_of_imdf_has_a_landing_and_steps() {
    let stated = |mut level: Value, elevation: f64| {
        level["properties"]["elevation"] = json!(elevation);
        level
    };
    let levels = [
        stated(level("L1", 1, json!("Upper")), 3.0),
        stated(level("LM", 0, json!("Landing")), 1.5),
        stated(level("L0", 0, json!("Ground")), 0.0),
    ];
    let units = [
        unit("L0", "walkway", "", rectangle([0.0, 10.0], [0.0, 8.0])),
        unit("L0", "stairs", "", rectangle([10.0, 13.0], [0.0, 2.0])),
        unit("LM", "walkway", "", rectangle([13.0, 15.0], [0.0, 2.0])),
        unit("LM", "stairs", "", rectangle([13.0, 15.0], [2.0, 5.0])),
        unit(
            "L1",
            "room",
            "Front room",
            rectangle([11.0, 19.0], [5.0, 12.0]),
        ),
        unit("L1", "steps", "", rectangle([19.0, 20.0], [6.0, 8.0])),
        unit(
            "L1",
            "restroom.female",
            "Back room",
            rectangle([20.0, 26.0], [5.0, 12.0]),
        ),
        unit("L1", "column", "", rectangle([22.0, 23.0], [8.0, 9.0])),
    ];
    let openings = [
        opening("L0", "out", [[0.0, 1.0], [0.0, 2.5]]),
        opening("L0", "", [[10.0, 0.0], [10.0, 2.0]]),
        opening("LM", "", [[13.0, 0.0], [13.0, 2.0]]),
        opening("LM", "", [[13.0, 2.0], [15.0, 2.0]]),
        opening("L1", "", [[13.0, 5.0], [15.0, 5.0]]),
        opening("L1", "", [[19.0, 6.0], [19.0, 8.0]]),
        opening("L1", "", [[20.0, 8.0], [20.0, 6.0]]),
    ];
    let desk =
        json!({"type": "Polygon", "coordinates": [[[16, 8], [18, 8], [18, 9], [16, 9], [16, 8]]]});
    let fixtures = [feature(
        "fixture",
        "f",
        desk,
        json!({"level_id": "L1", "category": "desk"}),
    )];
    let venue = [feature(
        "venue",
        "v",
        Value::Null,
        json!({"category": "school"}),
    )];
    let folder = TempDir::new().unwrap();
    let inside = folder.path().join("school");
    fs::create_dir(&inside).unwrap();
    let files: [(&str, &[Value]); 5] = [
        ("level", &levels),
        ("unit", &units),
        ("opening", &openings),
        ("fixture", &fixtures),
        ("venue", &venue),
    ];
    for (name, features) in files {
        // The names of the files say what their features are.
        let mut content = collection(features);
        for one in content["features"].as_array_mut().unwrap() {
            one.as_object_mut().unwrap().remove("feature_type");
        }
        fs::write(inside.join(format!("{name}.geojson")), content.to_string()).unwrap();
    }
    let base = json!({
        "profile": "steer+sph", "duration_secs": 200, "stop": {"when_empty": true},
        "crowds": [{"area": "Back room", "number": 20}], "exits": ["out"],
        "measurements": [{"line_flow": {"name": "door", "level": "Landing", "line": "door 1"}}],
    });
    let scenario = load_in(folder.path(), "school", &base).unwrap();
    is_near(
        size(&scenario, "Upper"),
        8.0 * 7.0 + 2.0 + 6.0 * 7.0 - 1.0 - 2.0,
        1e-3,
    );
    is_near(size(&scenario, "Landing"), 4.0, 1e-9);
    is_near(height(&scenario, "stairs (Ground)", [11.0, 1.0]), 0.5, 1e-9);
    is_near(
        height(&scenario, "stairs (Landing)", [14.0, 4.0]),
        2.5,
        1e-9,
    );
    assert_eq!(scenario.files.len(), 5);
    let notes = scenario.notes.join("\n");
    assert!(notes.contains("features left out: 1 venue"), "{notes}");
    assert!(
        notes.contains("steps that lead to no other level are floor"),
        "{notes}"
    );
    assert_eq!(each(&scenario, |_, _, _| {}), 20);
}

#[test]
fn names_of_plans_are_known_on_each_of_three_levels() {
    let named = |name: &str, kind: &str, geometry: Value| {
        let properties = json!({"name": name, "kind": kind});
        json!({"type": "Feature", "properties": properties, "geometry": geometry})
    };
    let area = |x: [f64; 2], y: [f64; 2]| {
        let ring = rectangle(x, y);
        let closed = [&ring[..], &ring[..1]].concat();
        json!({"type": "Polygon", "coordinates": [closed]})
    };
    let line = |points: &[[f64; 2]]| json!({"type": "LineString", "coordinates": points});
    let folder = TempDir::new().unwrap();
    let write = |file: &str, features: &[Value]| {
        fs::write(folder.path().join(file), collection(features).to_string()).unwrap();
    };
    write(
        "cellar.geojson",
        &[
            named("cellar", "floor", area([0.0, 12.0], [0.0, 8.0])),
            named("gate", "exit", line(&[[0.0, 3.0], [0.0, 5.0]])),
            named("desk", "queue", line(&[[3.0, 6.0], [6.0, 6.0]])),
        ],
    );
    write(
        "slope.geojson",
        &[
            named("slope", "floor", area([12.0, 30.0], [0.0, 2.0])),
            named("middle", "waypoint", line(&[[20.0, 0.0], [20.0, 2.0]])),
        ],
    );
    write(
        "yard.geojson",
        &[
            named("yard", "floor", area([30.0, 40.0], [0.0, 8.0])),
            named("group", "crowd", area([33.0, 39.0], [1.0, 7.0])),
            named("mud", "zone", area([31.0, 32.0], [0.0, 8.0])),
        ],
    );
    let document = json!({
        "profile": "steer+sph", "duration_secs": 200, "stop": {"when_empty": true},
        "levels": [
            {"name": "low", "elevation": -2, "walkable_area": "cellar.geojson"},
            {"name": "ramp", "kind": "ramp", "walkable_area": "slope.geojson"},
            {"name": "high", "elevation": 0, "walkable_area": "yard.geojson"},
        ],
        "joins": [
            {"levels": ["low", "ramp"], "line": [[12, 0], [12, 2]]},
            {"levels": ["ramp", "high"], "line": [[30, 0], [30, 2]]},
        ],
        "exits": ["gate"],
        "waypoints": [{"name": "middle", "level": "ramp"}],
        "queues": [{"name": "desk", "service_secs": 1}],
        "zones": [{"name": "mud", "speed_factor": 0.6}],
        "journeys": [{"name": "way", "stages": ["middle", "desk", "gate"]}],
        "crowds": [{"area": "group", "number": 10, "journey": "way"}],
        "labels": [{"text": "here", "at": "yard"}],
        "measurements": [{"line_flow": {"name": "flow", "line": "middle"}}],
    });
    let file = folder.path().join("house.json");
    fs::write(&file, document.to_string()).unwrap();
    let scenario = Scenario::load(&file, &[]).unwrap();
    let found = &scenario.document;
    let on = |list: &str| found[list][0]["level"].as_str().unwrap().to_owned();
    let levels = ["exits", "waypoints", "queues", "zones", "crowds"].map(on);
    assert_eq!(levels, ["low", "ramp", "low", "high", "high"]);
    let labels = found["labels"].as_array().unwrap();
    let here = labels.iter().find(|label| label["text"] == "here").unwrap();
    assert_eq!(
        *here,
        json!({"text": "here", "level": "high", "at": [35.0, 4.0]})
    );
    let flow = &found["measurements"][0]["line_flow"];
    assert_eq!(flow["level"], "ramp");
    assert_eq!(flow["line"], json!([[20.0, 0.0], [20.0, 2.0]]));
    assert_eq!(each(&scenario, |_, _, _| {}), 10);
}
