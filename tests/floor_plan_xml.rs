//! JuPedSim's XML geometry: the same walls as in WKT, doors between subrooms, and errors with their place.

use sandbox::engine::geometry::Area;
use sandbox::scenario::floor_plan::{FloorPlan, parse, parse_wkt};

/// An element with vertices.
fn path(tag: &str, points: &[[f64; 2]]) -> String {
    let vertices = points.iter();
    let vertices = vertices.map(|[x, y]| format!("<vertex px=\"{x}\" py=\"{y}\"/>"));
    let name = tag.split(' ').next().unwrap_or_default();
    format!("<{tag}>{}</{name}>", vertices.collect::<String>())
}

/// A plan of rooms, with transitions.
fn plan(unit: &str, rooms: &str, transitions: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- a plan -->\n<geometry version=\"0.8\" unit=\"{unit}\">\
         <rooms>{rooms}</rooms><transitions>{transitions}</transitions></geometry>"
    )
}

fn room(content: &str) -> String {
    format!("<room id=\"0\"><subroom id=\"1\" closed=\"0\">{content}</subroom></room>")
}

fn size(plan: &FloorPlan) -> f64 {
    plan.walkable.iter().map(Area::area).sum()
}

const SQUARE: [[f64; 2]; 5] = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];

#[test]
fn a_room_with_an_obstacle_is_the_same_as_in_wkt() {
    let expected =
        parse_wkt("POLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 2 1, 2 2, 1 2, 1 1))").unwrap();
    let pillar = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]];
    for (unit, factor) in [("m", 1.0), ("cm", 100.0)] {
        let scaled = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
            points.iter().map(|p| p.map(|x| x * factor)).collect()
        };
        let walls = path("polygon caption=\"wall\"", &scaled(&SQUARE));
        let pillar = path("polygon", &scaled(&pillar));
        let obstacles = format!("<obstacles><obstacle id=\"0\">{pillar}</obstacle></obstacles>");
        let found = parse(&plan(unit, &room(&(walls + &obstacles)), "")).unwrap();
        assert_eq!(found.walkable.len(), 1);
        assert_eq!(found.walkable[0].holes.len(), 1);
        assert!((size(&found) - size(&expected)).abs() < 1e-6, "{unit}");
    }
}

#[test]
fn doors_join_the_subrooms_on_their_two_sides() {
    // Two rooms of 4 m by 4 m side by side; the wall between them is open from y = 1 to y = 2.
    let left = [
        [4.0, 1.0],
        [4.0, 0.0],
        [0.0, 0.0],
        [0.0, 4.0],
        [4.0, 4.0],
        [4.0, 2.0],
    ];
    let right = [[4.0, 2.0], [4.0, 4.0], [8.0, 4.0]];
    // In two pieces, one of them written backward.
    let rest = [[4.0, 1.0], [4.0, 0.0], [8.0, 0.0], [8.0, 4.0]];
    let door = [[4.0, 1.0], [4.0, 2.0]];
    let rooms = room(&path("polygon", &left))
        + &format!(
            "<room id=\"7\"><subroom id=\"0\">{}{}</subroom></room>",
            path("polygon", &right),
            path("polygon", &rest)
        );
    let tag =
        "transition id=\"0\" room1_id=\"0\" subroom1_id=\"1\" room2_id=\"7\" subroom2_id=\"0\"";
    let found = parse(&plan("m", &rooms, &path(tag, &door))).unwrap();
    assert_eq!(found.walkable.len(), 1);
    // The wall between them is 3 m long and 1 cm thick.
    assert!((size(&found) - 31.97).abs() < 1e-6, "{}", size(&found));
    // The same rooms as subrooms of one room, joined by a crossing.
    let crossing = path(
        "crossing id=\"0\" subroom1_id=\"0\" subroom2_id=\"1\"",
        &door,
    );
    let subrooms = format!(
        "<room id=\"0\"><subroom id=\"0\">{}</subroom><subroom id=\"1\">{}{}</subroom>\
         <crossings>{crossing}</crossings></room>",
        path("polygon", &left),
        path("polygon", &right),
        path("polygon", &rest)
    );
    let found = parse(&plan("m", &subrooms, "")).unwrap();
    assert!((size(&found) - 31.97).abs() < 1e-6, "{}", size(&found));
}

#[test]
fn captions_name_rooms_and_those_of_the_editor_do_not() {
    let named = |caption: &str| {
        let room = format!(
            "<room id=\"0\" caption=\"{caption}\"><subroom id=\"1\">{}</subroom></room>",
            path("polygon", &SQUARE)
        );
        let names = parse(&plan("m", &room, "")).unwrap().names;
        names
            .into_iter()
            .map(|label| (label.text, label.at))
            .collect::<Vec<_>>()
    };
    assert_eq!(named("hall"), [("hall".to_owned(), [2.0, 2.0].into())]);
    assert_eq!([named("room"), named(" ")], [[], []]);
}

#[test]
fn errors_name_the_place_and_the_fix() {
    let wall = path("polygon", &[[0.0, 0.0], [4.0, 0.0]]);
    let far = path("polygon", &[[9.0, 9.0], [9.0, 5.0]]);
    let bad = "<polygon><vertex px=\"0\" py=\"0\"/><vertex px=\"1\" py=\"one\"/></polygon>";
    for (text, words) in [
        (
            plan("m", &room(&(wall + &far)), ""),
            "room 0, subroom 1: the walls do not join: no wall or door leads from (4, 0) to the wall that begins at \
             (9, 9)",
        ),
        (
            plan("m", &room(bad), ""),
            "room 0, subroom 1: vertex 2 has no number py",
        ),
        (
            plan("ft", &room(""), ""),
            "the unit is \"ft\"; write unit=\"m\"",
        ),
        (plan("m", &room(""), ""), "it has no walls"),
        (plan("m", "", ""), "has no polygons"),
        ("<gml/>".to_owned(), "its first element is <gml>"),
        ("<geometry><rooms>".to_owned(), "not valid XML of JuPedSim"),
        (
            "<!DOCTYPE a [<!ENTITY b \"b\">]><geometry/>".to_owned(),
            "not valid XML of JuPedSim",
        ),
        ("<a>".repeat(100_000), "not valid XML of JuPedSim"),
    ] {
        let said = parse(&text).unwrap_err().to_string();
        assert!(said.contains(words), "{said}");
        assert!(said.len() < 1000);
    }
}
