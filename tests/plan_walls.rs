//! Walls that a plan gives as lines stay walls: nobody walks through them, and the way leads round them.

use std::fs;

use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError, parse};
use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};

use crate::common;

/// The thickness that such walls get, meters.
const THICKNESS: f64 = 0.01;

/// Two rooms of 10 m by 10 m side by side, each with its own wall between them, and a door of 1 m in both.
fn two_rooms(door: [f64; 2]) -> String {
    let [low, high] = door;
    let room = |id: u32, far: u32| {
        format!(
            r#"<room id="{id}" caption="room {id}"><subroom id="0" class="floor"><polygon caption="wall">
            <vertex px="10" py="{low}"/><vertex px="10" py="0"/><vertex px="{far}" py="0"/><vertex px="{far}" py="10"/>
            <vertex px="10" py="10"/><vertex px="10" py="{high}"/></polygon></subroom></room>"#
        )
    };
    format!(
        r#"<geometry unit="m"><rooms>{}{}</rooms><transitions><transition id="0" caption="gate"
        room1_id="0" subroom1_id="0" room2_id="1" subroom2_id="0">
        <vertex px="10" py="{low}"/><vertex px="10" py="{high}"/></transition></transitions></geometry>"#,
        room(0, 0),
        room(1, 20)
    )
}

/// A room of 10 m by 10 m with more in it.
fn room(more: &str, attributes: &str) -> String {
    format!(
        r#"<geometry><rooms><room id="0" {attributes}><subroom id="0"><polygon caption="wall">
        <vertex px="0" py="0"/><vertex px="10" py="0"/><vertex px="10" py="10"/><vertex px="0" py="10"/>
        <vertex px="0" py="0"/></polygon>{more}</subroom></room></rooms></geometry>"#
    )
}

fn area(plan: &FloorPlan) -> f64 {
    plan.walkable.iter().map(|area| area.area()).sum()
}

fn is_floor(plan: &FloorPlan, x: f64, y: f64) -> bool {
    plan.walkable
        .iter()
        .any(|area| area.contains(Vector::new(x, y)))
}

/// The places of one person on the way from a point to another one on a plan, every frame.
fn way(plan: &str, name: &str, ends: [[f64; 2]; 2]) -> Vec<Vector> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), plan).unwrap();
    let [from, to] = ends;
    let document = json!({
        "walkable_area": name, "profile": "steer+sph", "duration_secs": 60,
        "agents": [{"position": from, "goal": to, "remove_within": 0.3, "preferred_speed": 1.3}],
    });
    let path = folder.path().join("walk.json");
    fs::write(&path, document.to_string()).unwrap();
    let scenario = Scenario::load(&path, &[]).unwrap();
    let mut simulation = Simulation::new(scenario.scene).unwrap();
    let mut places = Vec::new();
    for _ in 0..3000 {
        let Some(&place) = simulation.frame().agents.position.first() else {
            return places;
        };
        places.push(place);
        common::run(&mut simulation, 1);
    }
    panic!("{name}: still there after 60 s");
}

/// The length of a way, meters.
fn length(way: &[Vector]) -> f64 {
    way.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// Where a way crosses the line x = 10, m.
fn crossings(way: &[Vector], x: f64) -> Vec<f64> {
    let crossed = way
        .windows(2)
        .filter(|pair| (pair[0].x < x) != (pair[1].x < x));
    crossed.map(|pair| 0.5 * (pair[0].y + pair[1].y)).collect()
}

#[test]
fn the_wall_between_two_rooms_is_one_wall_with_its_door() {
    let plan = parse(&two_rooms([4.0, 5.0])).unwrap();
    // 9 m of wall are drawn twice and stand once.
    assert!(
        (area(&plan) - (200.0 - 9.0 * THICKNESS)).abs() < 1e-3,
        "{}",
        area(&plan)
    );
    for y in [0.5, 2.0, 3.9, 5.1, 8.0, 9.9] {
        assert!(!is_floor(&plan, 10.0, y), "the wall at {y}");
        assert!(is_floor(&plan, 10.0 - THICKNESS, y) && is_floor(&plan, 10.0 + THICKNESS, y));
    }
    assert!(
        is_floor(&plan, 10.0, 4.01) && is_floor(&plan, 10.0, 4.99),
        "the whole door"
    );
    let said = "walls that are lines, 9.0 m in all, stand on the floor 0.01 m thick";
    assert_eq!(plan.notes, [said]);
}

#[test]
fn people_pass_such_a_wall_by_its_door_alone() {
    let walked = way(
        &two_rooms([4.0, 5.0]),
        "rooms.xml",
        [[9.0, 7.5], [11.0, 7.5]],
    );
    let [at] = crossings(&walked, 10.0)[..] else {
        panic!("{:?}", crossings(&walked, 10.0))
    };
    assert!(at > 4.0 && at < 5.0, "through the wall at {at}");
    // Round the upper edge of the door, at a quarter of a meter from it.
    let shortest = 2.0 * f64::hypot(1.0, 7.5 - 5.0);
    assert!(
        length(&walked) > shortest - 0.3,
        "{} m of {shortest}",
        length(&walked)
    );
}

// Written after the method was fixed.
#[test]
fn a_crowd_behind_such_a_wall_leaves_by_the_door() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("rooms.xml"), two_rooms([8.5, 9.7])).unwrap();
    let document = json!({
        "walkable_area": "rooms.xml", "profile": "steer+sph", "duration_secs": 60, "seed": 3,
        "crowds": [{"area": [[1, 1], [9, 1], [9, 9], [1, 9]], "number": 30, "goal": [18, 2], "remove_within": 1}],
    });
    let path = folder.path().join("crowd.json");
    fs::write(&path, document.to_string()).unwrap();
    let mut simulation = Simulation::new(Scenario::load(&path, &[]).unwrap().scene).unwrap();
    let mut before: Vec<(u32, Vector)> = Vec::new();
    let mut passed = 0;
    while !simulation.frame().agents.is_empty() && simulation.frame().clock.time() < 60.0 {
        let agents = &simulation.frame().agents;
        let now: Vec<(u32, Vector)> = agents
            .id
            .iter()
            .copied()
            .zip(agents.position.iter().copied())
            .collect();
        for (id, place) in &now {
            let last = before
                .iter()
                .find(|(known, _)| known == id)
                .map(|(_, last)| *last);
            let Some(last) = last.filter(|last| (last.x < 10.0) != (place.x < 10.0)) else {
                continue;
            };
            let y = 0.5 * (last.y + place.y);
            assert!(y > 8.5 && y < 9.7, "person {id} through the wall at {y}");
            passed += 1;
        }
        before = now;
        common::run(&mut simulation, 1);
    }
    assert!(passed >= 30, "{passed} have passed");
    assert_eq!(simulation.frame().agents.len(), 0);
}

#[test]
fn inner_walls_and_screens_of_a_room_stand_in_it() {
    let partition =
        r#"<polygon caption="wall"><vertex px="5" py="2"/><vertex px="5" py="8"/></polygon>"#;
    let screen = r#"<obstacle id="0"><polygon><vertex px="6" py="3"/><vertex px="6" py="7"/><vertex px="6" py="3"/>
        </polygon></obstacle>"#;
    for (more, x, long) in [(partition, 5.0, 6.0), (screen, 6.0, 4.0)] {
        let text = room(more, "");
        let plan = parse(&text).unwrap();
        assert!(
            (area(&plan) - (100.0 - long * THICKNESS)).abs() < 1e-3,
            "{more}: {}",
            area(&plan)
        );
        assert!(!is_floor(&plan, x, 5.0));
        let walked = way(&text, "room.xml", [[3.0, 5.0], [9.0, 5.0]]);
        let [at] = crossings(&walked, x)[..] else {
            panic!("{more}")
        };
        assert!((at - 5.0).abs() > 0.5 * long, "{more}: through it at {at}");
    }
}

// Written after the method was fixed.
#[test]
fn lines_of_geojson_and_well_known_text_are_walls() {
    let floor = json!([[[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]]);
    let feature = |kind: &str, geometry: Value| {
        let properties = json!({"kind": kind});
        json!({"type": "Feature", "properties": properties, "geometry": geometry})
    };
    let document = json!({"type": "FeatureCollection", "features": [
        feature("floor", json!({"type": "Polygon", "coordinates": floor})),
        feature("wall", json!({"type": "LineString", "coordinates": [[0, 6], [7, 6], [7, 9]]})),
    ]});
    let text =
        "GEOMETRYCOLLECTION (POLYGON ((0 0, 10 0, 10 10, 0 10)), LINESTRING (0 6, 7 6, 7 9))";
    for plan in [parse(&document.to_string()).unwrap(), parse(text).unwrap()] {
        // 7 m and 3 m, which share a square at the bend.
        let expected = 100.0 - 10.0 * THICKNESS;
        assert!(
            (area(&plan) - expected).abs() < THICKNESS * THICKNESS,
            "{} of {expected}",
            area(&plan)
        );
        assert!(!is_floor(&plan, 0.004, 6.0), "closed to the outer wall");
        assert!(!is_floor(&plan, 7.004, 6.004), "closed at the bend");
        assert!(is_floor(&plan, 7.0, 9.02));
    }
    let door = feature(
        "door",
        json!({"type": "LineString", "coordinates": [[3, 6], [4.5, 6]]}),
    );
    let mut open = document.clone();
    open["features"].as_array_mut().unwrap().push(door);
    let plan = parse(&open.to_string()).unwrap();
    assert!(
        is_floor(&plan, 3.02, 6.0) && is_floor(&plan, 4.48, 6.0),
        "a door opens a wall"
    );
    assert!(!is_floor(&plan, 2.98, 6.0) && !is_floor(&plan, 4.52, 6.0));
}

#[test]
fn an_obstacle_of_two_points_is_a_wall() {
    let document = json!({
        "walkable_area": [[[[0, 0], [10, 0], [10, 10], [0, 10]]]],
        "obstacles": [[[5, 2], [5, 8]], [[7, 3], [8, 3], [7, 3]]],
        "agents": [{"position": [3, 5], "goal": [9, 5]}], "profile": "steer+sph", "duration_secs": 10,
    });
    let scenario = Scenario::parse(&document.to_string(), "screen.json", &[]).unwrap();
    let walls = &scenario.scene.walls;
    assert!(walls.obstacle_at(Vector::new(5.0, 5.0)).is_some());
    assert!(walls.obstacle_at(Vector::new(7.5, 3.0)).is_some());
    assert_eq!(walls.obstacle_at(Vector::new(5.0 + THICKNESS, 5.0)), None);
    assert_eq!(scenario.notes, Vec::<String>::new());
}

// Written after the method was fixed.
#[test]
fn walls_along_the_edge_of_the_floor_take_no_room_from_it() {
    // The outline of a room is drawn as a wall, too, and once more a few millimeters beside it.
    let text = "POLYGON ((0 0, 10 0, 10 10, 0 10)); LINESTRING (0 0, 10 0, 10 10, 0 10, 0 0); \
                LINESTRING (0.004 0, 0.004 10)";
    let plan = parse(text).unwrap();
    assert_eq!(area(&plan), 100.0);
    assert_eq!(plan.notes, Vec::<String>::new());
}

/// Two rooms at the heights 0 m and 3.5 m.
fn storeys(from: f64) -> String {
    let room = |id: u32, caption: &str, height: f64, [a, b]: [f64; 2]| {
        format!(
            r#"<room id="{id}" caption="{caption}" zpos="{height}"><subroom id="0"><polygon caption="wall">
            <vertex px="{a}" py="0"/><vertex px="{b}" py="0"/><vertex px="{b}" py="8"/><vertex px="{a}" py="8"/>
            <vertex px="{a}" py="0"/></polygon></subroom></room>"#
        )
    };
    let rooms = [
        room(0, "hall", 0.0, [0.0, 20.0]),
        room(1, "gallery", 3.5, [from, from + 15.0]),
    ];
    format!("<geometry><rooms>{}</rooms></geometry>", rooms.concat())
}

#[test]
fn storeys_that_overlap_are_refused_or_one_is_taken_by_name() {
    let error = parse(&storeys(15.0)).unwrap_err().to_string();
    for said in [
        "storeys overlap",
        "hall",
        "gallery",
        "40.0 m²",
        "plan.storey",
    ] {
        assert!(error.contains(said), "{said}: {error}");
    }
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("house.xml"), storeys(15.0)).unwrap();
    let document =
        json!({"walkable_area": "house.xml", "plan": {"storey": "gallery"}, "agents": []});
    let path = folder.path().join("house.json");
    fs::write(&path, document.to_string()).unwrap();
    let floor = |settings: &[&str]| {
        let settings: Vec<Setting> = settings.iter().map(|text| text.parse().unwrap()).collect();
        let scenario = Scenario::load(&path, &settings)?;
        let inside = [10.0, 25.0].map(|x| {
            scenario
                .scene
                .walls
                .obstacle_at(Vector::new(x, 4.0))
                .is_none()
        });
        Ok::<_, sandbox::scenario::ScenarioError>(inside)
    };
    assert_eq!(floor(&[]).unwrap(), [false, true]);
    assert_eq!(floor(&["plan.storey=hall"]).unwrap(), [true, false]);
    assert_eq!(floor(&["plan.storey=0"]).unwrap(), [true, false]);
    let wrong = floor(&["plan.storey=cellar"]).unwrap_err().to_string();
    assert!(
        wrong.contains("cellar") && wrong.contains("gallery, hall"),
        "{wrong}"
    );
    // Beside each other they are one floor, and that is said.
    let beside = parse(&storeys(20.0)).unwrap();
    assert_eq!(beside.walkable.len(), 2, "the wall between them stays");
    assert!(
        beside.notes[0].contains("the heights 0, 3.5 m do not overlap"),
        "{:?}",
        beside.notes
    );
}

#[test]
fn stairs_are_noted() {
    let text = room("", "caption=\"stairwell\"")
        .replace("<subroom id=\"0\">", "<subroom id=\"0\" class=\"stair\">");
    let notes = parse(&text).unwrap().notes;
    let said = "stairs are floor here, on which people walk as on the flat: room 0 (stairwell), subroom 0; give a \
                `zone` with a `speed_factor`";
    assert_eq!(notes, [said]);
}

fn hall(crs: Option<&str>, unit: f64) -> Value {
    let p = |x: f64, y: f64| json!([x / unit, y / unit]);
    let ring = [
        p(0.0, 0.0),
        p(20.0, 0.0),
        p(20.0, 10.0),
        p(0.0, 10.0),
        p(0.0, 0.0),
    ];
    let mut document = json!({"type": "Polygon", "coordinates": [ring]});
    if let Some(name) = crs {
        document["crs"] = json!({"type": "name", "properties": {"name": name}});
    }
    document
}

#[test]
fn coordinates_in_other_units_are_converted_or_refused() {
    let survey_foot = 1200.0 / 3937.0;
    let meters =
        |document: &Value| parse(&document.to_string()).map(|plan| (area(&plan), plan.notes));
    assert_eq!(meters(&hall(None, 1.0)).unwrap(), (200.0, vec![]));
    assert_eq!(
        meters(&hall(Some("EPSG:25832"), 1.0)).unwrap(),
        (200.0, vec![])
    );
    for (name, unit) in [
        ("urn:ogc:def:crs:EPSG::2263", survey_foot),
        ("EPSG:2222", 0.3048),
    ] {
        let (area, notes) = meters(&hall(Some(name), unit)).unwrap();
        assert!((area - 200.0).abs() < 1e-6, "{name}: {area} m²");
        assert!(
            notes[0].contains(name) && notes[0].contains("foot"),
            "{notes:?}"
        );
    }
    let degrees = meters(&hall(Some("EPSG:4326"), 1.0)).unwrap_err();
    assert!(matches!(degrees, FloorPlanError::Degrees(_)), "{degrees}");
    let (_, notes) = meters(&hall(Some("my own grid"), 1.0)).unwrap();
    assert!(notes[0].contains("my own grid is not known"), "{notes:?}");
}

// Written after the method was fixed.
#[test]
fn a_scenario_gives_the_unit_and_the_origin_of_its_plan() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hall.wkt");
    fs::write(
        &path,
        "POLYGON ((4000000 7000000, 4012000 7000000, 4012000 7005000, 4000000 7005000))",
    )
    .unwrap();
    let reading = floor_plan::Reading {
        unit: Some("mm".to_owned()),
        origin: Some([4000.0, 7000.0]),
        ..Default::default()
    };
    let plan = floor_plan::read_as(&path, &reading).unwrap();
    let points: Vec<Vector> = plan.walkable[0].exterior.points().to_vec();
    let furthest = points.iter().fold(Vector::zeros(), |most, p| most.sup(p));
    assert!(
        (furthest - Vector::new(12.0, 5.0)).norm() < 1e-9,
        "{furthest}"
    );
    let wrong = floor_plan::Reading {
        unit: Some("rod".to_owned()),
        ..Default::default()
    };
    let error = floor_plan::read_as(&path, &wrong).unwrap_err().to_string();
    assert!(
        error.contains("`rod` is no unit of plans; write m, cm, mm, ft or in"),
        "{error}"
    );
}

#[test]
fn an_empty_polygon_among_others_is_left_out() {
    let square = json!([[[0, 0], [10, 0], [10, 20], [0, 20], [0, 0]]]);
    let document = json!({"type": "MultiPolygon", "coordinates": [[], square]});
    assert_eq!(area(&parse(&document.to_string()).unwrap()), 200.0);
    let nothing = json!({"type": "MultiPolygon", "coordinates": [[], []]});
    let error = parse(&nothing.to_string()).unwrap_err();
    assert!(matches!(error, FloorPlanError::EmptyGeometry(_)), "{error}");
}
