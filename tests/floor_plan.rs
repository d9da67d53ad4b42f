//! A floor plan gives the same walls in every format and however it is split into pieces.

use std::fs;

use sandbox::engine::geometry::Polygon;
use sandbox::engine::math::Vector;
use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError, Label, parse, parse_wkt};
use sandbox::scenario::quote::shown;
use sandbox::scenario::{Scenario, Setting};
use serde_json::{Value, json};

fn read(name: &str, text: &str) -> Result<FloorPlan, FloorPlanError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    floor_plan::read(&path)
}

fn json(document: &Value) -> Result<FloorPlan, FloorPlanError> {
    read("plan.geojson", &document.to_string())
}

/// The walls of a plan, sorted, because rings may begin at any point.
fn walls(plan: FloorPlan) -> Vec<[f64; 4]> {
    let mut walls: Vec<[f64; 4]> = plan
        .solids()
        .unwrap()
        .iter()
        .flat_map(|solid| solid.edges().collect::<Vec<_>>())
        .map(|(a, b)| [a.x, a.y, b.x, b.y])
        .collect();
    walls.sort_by(|a, b| a.partial_cmp(b).unwrap());
    walls
}

fn solid(plan: FloorPlan, x: f64, y: f64) -> bool {
    let solids: Vec<Polygon> = plan.solids().unwrap();
    solids.iter().any(|solid| solid.contains(Vector::new(x, y)))
}

const ROOM: &str = "POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0), (2 2, 2 3, 3 3, 3 2, 2 2))";

fn feature(coordinates: Value, kind: &str) -> Value {
    json!({"type": "Feature", "properties": {"kind": kind},
           "geometry": {"type": "Polygon", "coordinates": coordinates}})
}

fn room() -> Value {
    json!([[[0, 0], [10, 0], [10, 10], [0, 10], [0, 0]]])
}

fn pillar() -> Value {
    json!([[[2, 2], [3, 2], [3, 3], [2, 3], [2, 2]]])
}

#[test]
fn all_routes_of_writing_a_room_with_a_pillar_give_the_same_walls() {
    let expected = walls(parse_wkt(ROOM).unwrap());
    assert_eq!(expected.len(), 8);
    for text in [
        // Reversed rings, another first point, repeated points, a third coordinate.
        "POLYGON ((10 10, 10 0, 0 0, 0 10, 10 10), (3 3, 3 2, 2 2, 2 3, 3 3))",
        "polygon((0 0,10 0,10 0,10 10,0 10),(2 2,2 2.5,2 3,3 3,3 2,2 2,2 2))",
        "POLYGON Z ((0 0 5, 10 0 5, 10 10 5, 0 10 5, 0 0 5), (2 2 1, 3 2 1, 3 3 1, 2 3 1, 2 2 1))",
        "SRID=25832;POLYGON ((0 0, 10 0, 10 10, 0 10, 0 0), (2 2, 2 3, 3 3, 3 2, 2 2))",
        // Two halves that share an edge through the pillar, overlapping areas, one geometry per line.
        "MULTIPOLYGON (((0 0, 10 0, 10 2.5, 3 2.5, 3 2, 2 2, 2 2.5, 0 2.5, 0 0)), \
         ((0 2.5, 2 2.5, 2 3, 3 3, 3 2.5, 10 2.5, 10 10, 0 10, 0 2.5)))",
        "GEOMETRYCOLLECTION (POLYGON ((0 0, 10 0, 10 10, 0 10), (2 2, 3 2, 3 3, 2 3)), \
         MULTIPOLYGON (((4 4, 9 4, 9 9, 4 9)), ((0 0, 1 0, 1 1, 0 1))))",
        "POLYGON ((0 0, 10 0, 10 10, 0 10), (2 2, 3 2, 3 3, 2 3))\nPOLYGON ((4 4, 9 4, 9 9, 4 9))\n",
    ] {
        assert_eq!(walls(read("plan.wkt", text).unwrap()), expected, "{text}");
    }
    let features = |features: Value| json!({"type": "FeatureCollection", "features": features});
    let whole = json!([room()[0], pillar()[0]]);
    for document in [
        json!({"type": "Polygon", "coordinates": whole}),
        json!({"type": "MultiPolygon", "coordinates": [whole]}),
        json!({"type": "GeometryCollection",
               "geometries": [{"type": "Polygon", "coordinates": whole}]}),
        feature(whole.clone(), "floor"),
        features(json!([
            feature(room(), "floor"),
            feature(pillar(), "obstacle")
        ])),
        // An obstacle inside the pillar, along its walls.
        features(json!([
            feature(whole.clone(), "floor"),
            feature(json!([[[2, 2], [3, 2], [3, 2.5], [2, 2.5]]]), "Obstacle")
        ])),
    ] {
        assert_eq!(walls(json(&document).unwrap()), expected, "{document}");
    }
}

#[test]
fn names_of_features_lie_inside_of_them() {
    // An L, whose middle is outside, and a room around a pillar, which is not named.
    let l = json!([[[0, 0], [9, 0], [9, 1], [1, 1], [1, 9], [0, 9], [0, 0]]]);
    let square = json!([[[10, 0], [20, 0], [20, 10], [10, 10], [10, 0]]]);
    let pillar = json!([[[13, 3], [17, 3], [17, 7], [13, 7], [13, 3]]]);
    let named = |coordinates: &Value, name: &str, kind: &str| {
        let mut feature = feature(coordinates.clone(), kind);
        feature["properties"]["name"] = json!(name);
        feature
    };
    let features = [
        named(&l, "corridor", "floor"),
        named(&square, "room", "floor"),
    ];
    let mut features = features.to_vec();
    features.push(feature(pillar, "obstacle"));
    let plan = json(&json!({"type": "FeatureCollection", "features": features})).unwrap();
    let label = |text: &str, [x, y, width]: [f64; 3]| Label {
        text: text.to_owned(),
        at: Vector::new(x, y),
        width: Some(width),
    };
    let expected = [
        label("corridor", [0.5, 4.5, 1.0]),
        label("room", [15.0, 5.0, 10.0]),
    ];
    assert_eq!(plan.names, expected);
}

#[test]
fn empty_names_are_no_names_and_the_largest_of_several_polygons_has_the_name() {
    let small = json!([[[20, 0], [21, 0], [21, 1], [20, 1], [20, 0]]]);
    let large = json!([[[0, 0], [8, 0], [8, 8], [0, 8], [0, 0]]]);
    let named = |name: &str| {
        let document = json!({"type": "Feature", "properties": {"name": name},
            "geometry": {"type": "MultiPolygon", "coordinates": [small, large]}});
        json(&document).unwrap().names
    };
    assert_eq!([named(""), named(" ")], [[], []]);
    let [label] = named(" hall ").try_into().unwrap();
    assert_eq!(
        (label.text.as_str(), label.at),
        ("hall", Vector::new(4.0, 4.0))
    );
}

#[test]
fn a_scenario_takes_the_names_of_its_plans_as_labels() {
    let folder = tempfile::tempdir().unwrap();
    let mut room = feature(json!([[[0, 0], [8, 0], [8, 8], [0, 8], [0, 0]]]), "floor");
    room["properties"]["name"] = json!("hall");
    std::fs::write(folder.path().join("plan.geojson"), room.to_string()).unwrap();
    let own = json!({"walkable_area": "plan.geojson", "labels": [{"text": "here", "at": [1, 2]}]});
    let file = folder.path().join("own.json");
    std::fs::write(&file, own.to_string()).unwrap();
    let scenario = Scenario::load(&file, &[]).unwrap();
    let label = |text: &str, [x, y]: [f64; 2], width| Label {
        text: text.to_owned(),
        at: Vector::new(x, y),
        width,
    };
    let expected = [
        label("here", [1.0, 2.0], None),
        label("hall", [4.0, 4.0], Some(8.0)),
    ];
    assert_eq!(scenario.labels, expected);
    // The document of a recording or checkpoint has them without the file.
    let again = Scenario::parse(&scenario.to_text(), "again.json", &[]).unwrap();
    assert_eq!(again.labels, scenario.labels);
    // Another plan replaces them.
    let plan = parse("POLYGON ((0 0, 9 0, 9 9, 0 9))").unwrap();
    let settings = Setting::floor_plan(&plan, "--geometry other.wkt");
    assert_eq!(Scenario::load(&file, &settings).unwrap().labels, []);
}

#[test]
fn obstacles_without_a_floor_stand_in_an_open_plane() {
    let plan = json(&feature(pillar(), "obstacle")).unwrap();
    assert!(plan.walkable.is_empty());
    assert!(solid(plan.clone(), 2.5, 2.5));
    assert!(!solid(plan, 20.0, 2.5));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walls.wkt");
    fs::write(&path, ROOM).unwrap();
    let plan = floor_plan::read_obstacles(&path).unwrap();
    assert!(solid(plan.clone(), 1.0, 1.0));
    assert!(!solid(plan.clone(), 2.5, 2.5), "the hole of an obstacle");
    assert!(!solid(plan, 11.0, 1.0));
    // A thin post is valid.
    fs::write(&path, "POLYGON ((0 0, 0.1 0, 0.1 0.1, 0 0.1))").unwrap();
    assert!(floor_plan::read_obstacles(&path).is_ok());
}

#[test]
fn areas_have_solid_between_them_and_may_lie_in_holes_of_others() {
    let text = "MULTIPOLYGON (((0 0, 9 0, 9 9, 0 9), (1 1, 8 1, 8 8, 1 8)), ((3 3, 5 3, 5 5, 3 5)), \
                ((20 0, 30 0, 30 9, 20 9)))";
    let plan = parse_wkt(text).unwrap();
    assert_eq!(plan.walkable.len(), 3);
    for (x, expected) in [
        (0.5, false),
        (2.0, true),
        (4.0, false),
        (6.0, true),
        (8.5, false),
    ] {
        assert_eq!(solid(plan.clone(), x, 4.0), expected, "{x}");
    }
    for (x, expected) in [(15.0, true), (25.0, false), (31.0, true), (-1.0, true)] {
        assert_eq!(solid(plan.clone(), x, 4.0), expected, "{x}");
    }
    assert_eq!(plan.solids().unwrap().len(), 1);
}

#[test]
fn holes_may_touch_the_outline_and_each_other() {
    // A hole with an edge on the outline is a notch. A hole with only a corner on it stays a hole.
    let notch = parse_wkt("POLYGON ((0 0, 9 0, 9 9, 0 9), (0 3, 2 3, 2 5, 0 5))").unwrap();
    assert_eq!(notch.walkable[0].holes.len(), 0);
    assert!((notch.walkable[0].area() - 77.0).abs() < 1e-9);
    let touching = "POLYGON ((0 0, 9 0, 9 9, 0 9), (0 4, 2 3, 2 5), (2 5, 4 5, 4 6))";
    let touching = parse_wkt(touching).unwrap();
    let free: f64 = touching.walkable.iter().map(|area| area.area()).sum();
    assert!((free - 78.0).abs() < 1e-9);
    assert!(solid(touching.clone(), 1.5, 4.0) && solid(touching.clone(), 3.5, 5.5));
    assert!(!solid(touching, 0.2, 1.0));
    // Holes that share an edge are merged. A hole that cuts the floor in two leaves two areas.
    let shared = "POLYGON ((0 0, 9 0, 9 9, 0 9), (1 1, 2 1, 2 2, 1 2), (2 1, 3 1, 3 2, 2 2))";
    assert_eq!(parse_wkt(shared).unwrap().walkable[0].holes.len(), 1);
    let cut = "POLYGON ((0 0, 9 0, 9 9, 0 9), (-1 4, 10 4, 10 5, -1 5))";
    assert_eq!(parse_wkt(cut).unwrap().walkable.len(), 2);
}

#[test]
fn corners_are_exact_far_from_the_origin_and_at_odd_angles() {
    let (sine, cosine) = 0.3_f64.sin_cos();
    let place = |x: f64, y: f64| {
        [
            cosine * x - sine * y + 512_345.678_9,
            sine * x + cosine * y - 9e5,
        ]
    };
    let ring = |points: [[f64; 2]; 4]| points.map(|[x, y]| place(x, y)).to_vec();
    let outline = ring([[0.0, 0.0], [70.1, 0.0], [70.1, 31.7], [0.0, 31.7]]);
    let hole = ring([[7.3, 3.1], [8.9, 3.1], [8.9, 4.7], [7.3, 4.7]]);
    let plan = FloorPlan::walkable(&[vec![outline.clone(), hole.clone()]]).unwrap();
    let mut corners: Vec<[f64; 2]> = plan.walkable[0]
        .rings()
        .flat_map(|ring| ring.points().iter().map(|p| [p.x, p.y]))
        .collect();
    let mut given = [outline, hole].concat();
    let order = |a: &[f64; 2], b: &[f64; 2]| a.partial_cmp(b).unwrap();
    corners.sort_by(order);
    given.sort_by(order);
    assert_eq!(corners, given);
}

#[test]
fn invalid_floor_plans_are_refused_with_the_place_and_the_fix() {
    let crs = |name: &str| {
        json!({"type": "FeatureCollection", "features": [feature(room(), "floor")],
               "crs": {"type": "name", "properties": {"name": name}}})
        .to_string()
    };
    assert!(read("plan", &crs("urn:ogc:def:crs:EPSG::25832")).is_ok());
    let line = json!({"type": "Feature", "properties": {"name": "track 4", "kind": "floor"}, "geometry":
                      {"type": "LineString", "coordinates": [[0, 0], [1, 1]]}});
    let track = json!({"type": "FeatureCollection", "features": [feature(room(), "floor"), line]});
    for (text, parts) in [
        ("", vec!["has no polygons"]),
        ("POLYGON EMPTY", vec!["the geometry is empty"]),
        ("GEOMETRYCOLLECTION EMPTY", vec!["empty"]),
        (
            r#"{"type": "FeatureCollection", "features": []}"#,
            vec!["has no polygons"],
        ),
        ("POLYGON ((0 0, 1 0, 1", vec!["not valid WKT", "line 1"]),
        (
            "  0\nSECTION",
            vec!["not valid DXF", "the file ends before the drawing does"],
        ),
        (
            "POLYGON ((0 0, 9 0, 9 9))\n rubbish",
            vec!["not valid WKT", "line 2"],
        ),
        (
            "{\"type\": \"Polygon\",\n \"coordinates\": ",
            vec!["not valid GeoJSON", "line 2"],
        ),
        (
            r#"{"type": "Polygon"}"#,
            vec!["not valid GeoJSON", "coordinates"],
        ),
        ("POINT (9 9)", vec!["a POINT has no area"]),
        (
            "GEOMETRYCOLLECTION (POLYGON ((0 0, 9 0, 9 9)), POINT (1 1))",
            vec!["geometry 2", "POINT"],
        ),
        (
            &track.to_string(),
            vec!["feature 2 (track 4)", "LineString"],
        ),
        (
            &crs("urn:ogc:def:crs:OGC:1.3:CRS84"),
            vec!["degrees", "CRS84", "UTM", "subtract an origin near"],
        ),
        (&crs("EPSG:4326"), vec!["degrees", "EPSG:4326"]),
        (
            "SRID=4326;POLYGON ((0 0, 9 0, 9 9))",
            vec!["degrees", "SRID=4326"],
        ),
        (
            "POLYGON ((8.41 49.01, 8.42 49.01, 8.42 49.02, 8.41 49.02))",
            vec!["too small for a person", "degrees", "subtract an origin"],
        ),
        (
            "POLYGON ((0 0, 4 4, 4 0, 0 4))",
            vec![
                "the outline crosses or touches itself: the edge from (0, 0) to (4, 4) meets the edge from \
                 (4, 0) to (0, 4)",
            ],
        ),
        (
            "POLYGON ((0 0, 9 0, 9 9), (5 1, 8 1, 6 1))",
            vec!["hole 1 crosses", "the edge from (5, 1) to (8, 1)"],
        ),
        ("POLYGON ((0 0, 1 1, 0 0))", vec!["2 different point(s)"]),
        (
            "POLYGON ((0 0, 9 0, 9 9))\nPOLYGON ((2000000 0, 2000009 0, 2000009 9))",
            vec!["line 2", "(2000000, 0)", "subtract a point near the site"],
        ),
        (
            "POLYGON ((0 0, 9 0, 9 9), (1 1, 2 1, 1e7 2))",
            vec!["(10000000, 2) is out of range"],
        ),
        (
            r#"{"type": "Polygon", "coordinates": [[[0, 0], [1], [1, 1]]]}"#,
            vec!["ring 1, position 2: has 1 number(s); write [x, y]"],
        ),
        (
            r#"{"type": "MultiPolygon", "coordinates": [[[[0, 0], [9, 0], [9, 9]], [[]]]]}"#,
            vec!["polygon 1, ring 2, position 1: has 0 number(s)"],
        ),
    ] {
        let error = read("hall.plan", text).unwrap_err().to_string();
        for part in parts.into_iter().chain(["hall.plan: "]) {
            assert!(error.contains(part), "{text}: {error}");
        }
    }
    let full = json!({"type": "FeatureCollection",
                      "features": [feature(pillar(), ""), feature(room(), "obstacle")]});
    let error = json(&full).unwrap_err().to_string();
    assert!(
        error.ends_with("holes and obstacles leave no room for a person"),
        "{error}"
    );
    let missing = floor_plan::read(std::path::Path::new("no/such.wkt")).unwrap_err();
    let said = missing.to_string();
    assert!(said.starts_with("no/such.wkt: cannot be read"), "{said}");
}

#[test]
fn deeply_nested_plans_are_refused_without_a_stack_overflow() {
    let wkt = |depth: usize| format!("\n{}", "GEOMETRYCOLLECTION (".repeat(depth));
    let json = |depth: usize| {
        let open = r#"{"type": "GeometryCollection", "geometries": ["#.repeat(depth);
        format!("{open}{}", "]}".repeat(depth))
    };
    let said = |text: String| {
        let thread = std::thread::Builder::new().stack_size(1 << 20);
        let read = move || floor_plan::parse(&text).unwrap_err().to_string();
        thread.spawn(read).unwrap().join().unwrap()
    };
    for depth in [65, 2_000, 20_000, 1_000_000] {
        assert_eq!(
            said(wkt(depth)),
            "not valid WKT: line 2, column 1300: more than 64 parentheses are open"
        );
    }
    assert!(said(wkt(64)).starts_with("not valid WKT: line 2: "));
    assert!(said("()".repeat(300_000)).starts_with("not valid WKT: line 1: "));
    assert_eq!(
        said(json(60)),
        format!(
            "{}: the geometry is empty; remove it",
            shown(&nested_place(59))
        )
    );
    for depth in [70, 20_000] {
        assert!(
            said(json(depth)).starts_with("not valid GeoJSON: recursion limit exceeded at line 1")
        );
    }
}

/// The place of the first geometry in the first geometry, and so on, `depth` times.
fn nested_place(depth: usize) -> String {
    vec!["geometry 1"; depth].join(", ")
}
