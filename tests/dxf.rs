//! Defects of drawings. The areas and coordinates that are expected are computed by hand.

use std::f64::consts::PI;

use crate::dxf_drawing::Drawing;
use sandbox::engine::math::Vector;
use sandbox::scenario::floor_plan::{self, FloorPlan, Reading};

pub fn area(plan: &FloorPlan) -> f64 {
    plan.walkable.iter().map(|area| area.area()).sum()
}

pub fn is_floor(plan: &FloorPlan, x: f64, y: f64) -> bool {
    plan.walkable
        .iter()
        .any(|area| area.contains(Vector::new(x, y)))
}

#[track_caller]
pub fn is_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() < tolerance,
        "{found} instead of {expected}"
    );
}

fn rectangle(x: f64, y: f64, width: f64, height: f64) -> [[f64; 2]; 4] {
    [
        [x, y],
        [x + width, y],
        [x + width, y + height],
        [x, y + height],
    ]
}

/// The four walls of a rectangle, each a line of its own that ends `short` before its end.
fn walls(drawing: Drawing, corners: [[f64; 2]; 4], short: f64) -> Drawing {
    (0..4).fold(drawing, |drawing, k| {
        let [a, b] = [corners[k], corners[(k + 1) % 4]];
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let share = 1.0 - short / length;
        let end = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
        drawing.line("walls", a, end)
    })
}

#[test]
fn gaps_of_a_centimeter_between_walls_are_closed_with_a_note() {
    let drawing = walls(
        Drawing::new(6).section("ENTITIES"),
        rectangle(0.0, 0.0, 8.0, 5.0),
        0.01,
    );
    let plan = drawing.end().read();
    is_near(area(&plan), 40.0, 1e-6);
    let gaps = plan.notes.iter().find(|note| note.contains("gaps"));
    let expected = "4 gaps between ends of lines closed, the largest 0.01 m at ";
    assert!(gaps.unwrap().starts_with(expected), "{gaps:?}");
    let wider = walls(
        Drawing::new(6).section("ENTITIES"),
        rectangle(0.0, 0.0, 8.0, 5.0),
        0.3,
    );
    let refused = wider.end().refused();
    assert!(
        refused.starts_with("the walls enclose no area: the nearest open ends of walls are "),
        "{refused}"
    );
    assert!(
        refused.contains("0.3 m apart; close them, draw an exit or a door between them"),
        "{refused}"
    );
}

#[test]
fn doubled_walls_are_one() {
    let mut drawing = Drawing::new(6).section("ENTITIES");
    for shift in [0.0, 0.0, 0.004] {
        drawing = walls(drawing, rectangle(shift, shift, 8.0, 5.0), 0.0);
    }
    let plan = drawing.end().read();
    // Between the second and the third rectangle are strips of 4 mm, which no one reaches.
    is_near(area(&plan), 7.996 * 4.996, 1e-6);
    assert!(is_floor(&plan, 0.1, 0.1));
}

#[test]
fn an_exploded_outline_is_joined_in_any_order_and_direction() {
    let [a, b, c, d] = rectangle(1.0, 1.0, 6.0, 4.0);
    let drawing = Drawing::new(6).section("ENTITIES");
    let drawing = drawing.line("floor", c, d).line("floor", a, b);
    let drawing = drawing
        .line("floor", c, b)
        .line("floor", [d[0], d[1] - 0.01], a);
    is_near(area(&drawing.end().read()), 24.0, 1e-6);
}

#[test]
fn texts_name_rooms_and_other_layers_are_left_out_with_a_note() {
    let drawing = Drawing::new(6).section("ENTITIES");
    let drawing = drawing.polyline("floor", true, &rectangle(0.0, 0.0, 8.0, 5.0));
    let drawing = drawing.text("A-ANNO", [3.0, 2.0], "{\\fArial|b0;Gro\\U+00DFer Saal}");
    let drawing = drawing
        .text("A-DIMS", [3.2, 4.1], "3.50")
        .line("A-DIMS", [0.0, 5.5], [8.0, 5.5]);
    let plan = drawing.end().read();
    assert_eq!(plan.names[0].text, "Großer Saal");
    let expected = "left out: layer \"A-DIMS\" (2 entities, the first a LINE at (0, 5.5)); `plan.layers` says what a \
                    layer is";
    assert_eq!(plan.notes, [expected]);
}

#[test]
fn hatches_are_areas_with_holes() {
    let mut drawing = Drawing::new(6).section("ENTITIES");
    drawing.add(&[(0, "HATCH"), (8, "floor"), (91, "2")]);
    drawing.add(&[(92, "3"), (72, "0"), (73, "1"), (93, "4")]);
    for p in rectangle(0.0, 0.0, 10.0, 6.0) {
        drawing.point(10, p);
    }
    // A hole of two clockwise half circles, of which the angles count clockwise.
    drawing.add(&[(97, "0"), (92, "0"), (93, "2")]);
    for (from, to) in [("0", "180"), ("180", "360")] {
        drawing.add(&[
            (72, "2"),
            (10, "4"),
            (20, "3"),
            (40, "1"),
            (50, from),
            (51, to),
            (73, "0"),
        ]);
    }
    drawing.add(&[(97, "0"), (75, "0"), (76, "1"), (98, "0")]);
    let plan = drawing.end().read();
    is_near(area(&plan), 60.0 - PI, 0.005 * 2.0 * PI);
    assert!(!is_floor(&plan, 4.0, 3.0) && is_floor(&plan, 5.1, 3.0));
}

#[test]
fn millimeters_become_meters_and_an_unlikely_unit_is_replaced() {
    let of_unit = |unit: i32| {
        let corners = rectangle(0.0, 0.0, 24_300.0, 12_100.0);
        let drawing = Drawing::new(unit)
            .section("ENTITIES")
            .polyline("floor", true, &corners);
        drawing.end()
    };
    let plan = of_unit(4).read();
    is_near(area(&plan), 24.3 * 12.1, 1e-6);
    assert_eq!(
        plan.notes,
        ["millimeters, as the header says: 24.3 by 12.1 m"]
    );
    let plan = of_unit(6).read();
    is_near(area(&plan), 24.3 * 12.1, 1e-6);
    let expected = "taken as millimeters, 24.3 by 12.1 m: the header says meters, which would be 24300 by 12100 m; \
                    `plan.unit` says otherwise";
    assert_eq!(plan.notes, [expected]);
    let reading = Reading {
        unit: Some("cm".to_owned()),
        ..Reading::default()
    };
    is_near(
        area(&of_unit(4).read_as(&reading).unwrap()),
        243.0 * 121.0,
        1e-4,
    );
}

#[test]
fn a_plan_kilometers_from_the_origin_is_moved_by_whole_meters() {
    let drawing = Drawing::new(6).section("ENTITIES");
    let drawing = drawing.polyline("floor", true, &rectangle(3_000.25, -2_500.5, 8.0, 5.0));
    let plan = drawing.end().read();
    is_near(area(&plan), 40.0, 1e-6);
    assert!(
        is_floor(&plan, 0.26, 0.51) && !is_floor(&plan, 0.24, 0.51) && is_floor(&plan, 8.2, 5.4)
    );
    assert_eq!(
        plan.notes,
        ["moved by (-3000, 2501) m, so that it begins near the origin"]
    );
}

#[test]
fn bulges_are_arcs_to_both_sides() {
    // A square with a half disk outwards on the right, and a quarter of a circle inwards at the top.
    let quarter = -(PI / 8.0).tan();
    let vertices = [
        ([0.0, 0.0], 0.0),
        ([6.0, 0.0], 1.0),
        ([6.0, 6.0], quarter),
        ([0.0, 6.0], 0.0),
    ];
    let plan = Drawing::new(6)
        .section("ENTITIES")
        .bulges("floor", true, &vertices)
        .end()
        .read();
    let radius = 6.0 / 2.0_f64.sqrt();
    let segment = radius * radius * (PI / 4.0 - 0.5);
    let length = 3.0 * PI + radius * PI / 2.0;
    is_near(area(&plan), 36.0 + 4.5 * PI - segment, 0.005 * length);
    assert!(is_floor(&plan, 8.98, 3.0) && !is_floor(&plan, 9.01, 3.0));
    let sagitta = radius - 3.0;
    assert!(
        is_floor(&plan, 3.0, 6.0 - sagitta - 0.01) && !is_floor(&plan, 3.0, 6.0 - sagitta + 0.01)
    );
}

#[test]
fn an_open_outline_is_refused_with_its_end_layer_and_line() {
    let [a, b, c, d] = rectangle(0.0, 0.0, 8.0, 5.0);
    let drawing = Drawing::new(6).section("ENTITIES");
    let drawing = drawing
        .line("floor", a, b)
        .line("floor", b, c)
        .line("floor", c, d);
    let open = [0.0, 0.35];
    let expected = "LINE on layer \"floor\" (line 20): the outline of the floor is open at (0, 0), where no line \
                    continues; the nearest other open end is (0, 0.35), 0.35 m away; close it, give a larger \
                    `plan.gap`, or say in `plan.layers` that the layer is `wall` if its lines are walls";
    assert_eq!(drawing.line("floor", d, open).end().refused(), expected);
}

#[test]
fn an_open_room_is_refused_with_the_nearest_ends() {
    let wall = [
        [3.0, 0.0],
        [0.0, 0.0],
        [0.0, 5.0],
        [8.0, 5.0],
        [8.0, 0.0],
        [3.9, 0.0],
    ];
    let room = || {
        Drawing::new(6)
            .section("ENTITIES")
            .polyline("walls", false, &wall)
    };
    // Another room, so that something is enclosed.
    let drawing = room().polyline("walls", true, &rectangle(8.0, 0.0, 3.0, 3.0));
    let reading = Reading {
        inside: vec![[4.0, 2.0]],
        ..Reading::default()
    };
    let expected = "the floor around (4, 2) is open to the outside: the nearest open ends of walls are (3, 0) and \
                    (3.9, 0), 0.9 m apart; close them, draw an exit or a door between them, or give a larger \
                    `plan.gap`";
    let refused = drawing.end().read_as(&reading).unwrap_err();
    assert_eq!(refused.to_string(), expected);
    let plan = room().line("exits", [3.0, 0.0], [3.9, 0.0]).end().read();
    is_near(area(&plan), 40.0, 1e-6);
    let expected = "walls are lines: the floor is what can be reached from (4, 2.5): 40 m²; `plan.inside` says \
                    otherwise";
    assert_eq!(plan.notes, [expected]);
}

#[test]
fn doors_join_rooms_and_given_points_choose_them() {
    let rooms = |door: bool| {
        let drawing = walls(
            Drawing::new(6).section("ENTITIES"),
            rectangle(0.0, 0.0, 10.0, 5.0),
            0.0,
        );
        let drawing =
            drawing
                .line("walls", [6.0, 0.0], [6.0, 2.0])
                .line("walls", [6.0, 3.0], [6.0, 5.0]);
        let layer = if door { "doors" } else { "walls" };
        drawing.line(layer, [6.0, 2.0], [6.0, 3.0]).end()
    };
    // The wall between the rooms is 4 m long and 1 cm thick.
    is_near(area(&rooms(true).read()), 49.96, 1e-6);
    let largest = rooms(false).read();
    is_near(area(&largest), 30.0, 1e-6);
    assert!(
        largest.notes[0].ends_with("Other enclosed areas: 20 m² around (8, 2.5)"),
        "{:?}",
        largest.notes
    );
    let reading = Reading {
        inside: vec![[9.0, 1.0], [1.0, 1.0]],
        ..Reading::default()
    };
    is_near(area(&rooms(false).read_as(&reading).unwrap()), 49.95, 1e-6);
}

#[test]
fn nested_mirrored_blocks_are_at_their_places() {
    // A right triangle in a block on the layer of the block; twice in another block, once mirrored.
    let triangle = Drawing::default().polyline("0", true, &[[1.0, 1.0], [3.0, 1.0], [1.0, 2.0]]);
    let pair = Drawing::default().insert("0", "triangle", [0.0, 0.0], [1.0, 1.0, 0.0]);
    let pair = pair.insert("0", "triangle", [0.0, 0.0], [-1.0, 1.0, 0.0]);
    let drawing = Drawing::new(6).section("BLOCKS");
    let drawing = drawing
        .block("triangle", [1.0, 1.0], triangle)
        .block("pair", [0.0, 0.0], pair);
    let drawing =
        drawing
            .end()
            .section("ENTITIES")
            .polyline("floor", true, &rectangle(0.0, 0.0, 20.0, 10.0));
    // Turned by a quarter, twice as large, and mirrored along its second axis.
    let drawing = drawing.insert("columns", "pair", [10.0, 5.0], [2.0, -2.0, 90.0]);
    let plan = drawing.end().read();
    is_near(area(&plan), 200.0 - 2.0 * 4.0, 1e-6);
    // (x, y) of the pair → (10 + 2 y, 5 + 2 x): the scale gives (2 x, −2 y), the turn (2 y, 2 x).
    for [x, y] in [[0.5, 0.5], [-0.5, 0.5]] {
        assert!(!is_floor(&plan, 10.0 + 2.0 * y, 5.0 + 2.0 * x));
    }
    for [x, y] in [[0.5, -0.5], [1.5, 0.5], [-1.5, 0.5]] {
        assert!(is_floor(&plan, 10.0 + 2.0 * y, 5.0 + 2.0 * x));
    }
}

#[test]
fn exploded_blocks_join_lines_of_several_blocks() {
    let half =
        Drawing::default()
            .line("0", [0.0, 0.0], [4.0, 0.0])
            .line("0", [4.0, 0.0], [4.0, 3.0]);
    let drawing = Drawing::new(6)
        .section("BLOCKS")
        .block("half", [0.0, 0.0], half)
        .end()
        .section("ENTITIES");
    let drawing = drawing.insert("floor", "half", [0.0, 0.0], [1.0, 1.0, 0.0]);
    let plan = drawing
        .insert("floor", "half", [4.0, 3.0], [1.0, 1.0, 180.0])
        .end()
        .read();
    is_near(area(&plan), 12.0, 1e-6);
}

#[test]
fn blocks_that_contain_themselves_or_are_too_many_are_refused() {
    let own = Drawing::default().insert("0", "own", [0.0, 0.0], [1.0, 1.0, 0.0]);
    let drawing = Drawing::new(6)
        .section("BLOCKS")
        .block("own", [0.0, 0.0], own)
        .end();
    let refused = drawing
        .section("ENTITIES")
        .insert("walls", "own", [0.0, 0.0], [1.0, 1.0, 0.0])
        .end()
        .refused();
    assert!(
        refused.contains("the block \"own\" contains itself; explode it"),
        "{refused}"
    );
    let wall = Drawing::default().line("0", [0.0, 0.0], [1.0, 0.0]);
    let drawing = Drawing::new(6)
        .section("BLOCKS")
        .block("wall", [0.0, 0.0], wall)
        .end()
        .section("ENTITIES");
    let mut drawing = drawing.insert("walls", "wall", [0.0, 0.0], [1.0, 1.0, 0.0]);
    drawing.add(&[(70, "30000"), (71, "30000")]);
    let refused = drawing.end().refused();
    assert!(refused.contains("more than 2000000 entities"), "{refused}");
}

#[test]
fn other_files_are_refused_with_what_they_are() {
    let refused = |bytes: &[u8]| {
        floor_plan::parse_bytes(bytes, &Reading::default())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        refused(b"AC1032\0\0\0"),
        "not valid DXF: it is a DWG; save the drawing as DXF"
    );
    let truncated =
        "not valid DXF: line 6: the file ends before the drawing does; copy or save it again";
    assert_eq!(refused(b"0\nSECTION\n2\nENTITIES\n0\nLINE\n"), truncated);
    let code = refused(b"0\nSECTION\n2\nENTITIES\nabc\nLINE\n");
    assert!(code.starts_with(
        "not valid DXF: line 5: expected a group code (an integer up to 1071), found `abc`"
    ));
    let empty = Drawing::new(6).section("ENTITIES").end().refused();
    assert!(
        empty.contains("has no entities in its model space"),
        "{empty}"
    );
    let unknown = Drawing::new(6)
        .section("ENTITIES")
        .line("A", [0.0, 0.0], [1.0, 0.0]);
    let expected = "no layer says what it is; `plan.layers` says so, for example {\"A\": \"wall\"}. Layers: layer \
                    \"A\" (1 entity)";
    assert_eq!(unknown.end().refused(), expected);
    let wrong = Drawing::new(6)
        .section("ENTITIES")
        .line("walls", [f64::NAN, 0.0], [1.0, 0.0]);
    let expected = "LINE on layer \"walls\" (line 20): line 24: group code 10 needs a number, found `NaN`; save the \
                    drawing again";
    assert_eq!(wrong.end().refused(), expected);
}

/// A room of 10 m by 5 m with an opening of 1 m in its right wall, and what stands there.
fn room_with_an_opening(there: impl Fn(Drawing) -> Drawing) -> FloorPlan {
    let walls = [
        [10.0, 2.0],
        [10.0, 0.0],
        [0.0, 0.0],
        [0.0, 5.0],
        [10.0, 5.0],
        [10.0, 3.0],
    ];
    let drawing = Drawing::new(6)
        .section("ENTITIES")
        .polyline("walls", false, &walls);
    there(drawing).end().read()
}

/// The leaf of a door and the arc in which it swings, to the right or to the left.
fn leaf(drawing: Drawing, side: f64) -> Drawing {
    let arc = (0..=8).map(|k| f64::from(k) * PI / 16.0);
    let arc: Vec<[f64; 2]> = arc
        .map(|turn| [10.0 + side * turn.cos(), 2.0 + turn.sin()])
        .collect();
    let leaf = drawing.line("doors", [10.0, 2.0], [10.0 + side, 2.0]);
    leaf.polyline("doors", false, &arc)
}

#[test]
fn an_exit_ends_the_floor_however_its_door_opens() {
    let exit = |drawing: Drawing| drawing.line("exits", [10.0, 2.0], [10.0, 3.0]);
    let plain = room_with_an_opening(exit);
    let outward = room_with_an_opening(|drawing| exit(leaf(drawing, 1.0)));
    let inward = room_with_an_opening(|drawing| exit(leaf(drawing, -1.0)));
    for plan in [plain, outward, inward] {
        is_near(area(&plan), 50.0, 1e-6);
        assert!(!is_floor(&plan, 10.3, 2.3));
        assert_eq!(plan.notes.len(), 1, "{:?}", plan.notes);
    }
    // Without an exit, the door ends the floor, and a note says that nobody leaves there.
    let forgotten = room_with_an_opening(|drawing| leaf(drawing, 1.0));
    let said =
        "door 1 and 1 more, at (10, 2), ends the floor at the outside: people leave by exits alone";
    assert!(
        forgotten.notes.iter().any(|note| note.contains(said)),
        "{:?}",
        forgotten.notes
    );
}

#[test]
fn rooms_without_a_wall_between_them_get_no_name() {
    let named = |door: bool| {
        room_with_an_opening(|drawing| {
            let drawing = drawing.line("exits", [10.0, 2.0], [10.0, 3.0]);
            let drawing =
                drawing
                    .line("walls", [4.0, 0.0], [4.0, 2.0])
                    .line("walls", [4.0, 3.0], [4.0, 5.0]);
            let drawing = if door {
                drawing.line("doors", [4.0, 2.0], [4.0, 3.0])
            } else {
                drawing
            };
            drawing
                .text("names", [1.0, 1.0], "Foyer")
                .text("names", [6.0, 1.0], "Hall")
        })
    };
    let names = |plan: &FloorPlan| -> Vec<String> {
        let rooms = plan
            .places
            .iter()
            .filter(|place| !place.name.contains("exit 1"));
        rooms
            .filter(|place| !place.name.starts_with("door"))
            .map(|place| place.name.clone())
            .collect()
    };
    assert_eq!(names(&named(true)), ["Foyer", "Hall"]);
    let open = named(false);
    assert_eq!(names(&open), Vec::<String>::new());
    let said = "the texts \"Foyer\", \"Hall\" are in one area of 50 m², which gets no name";
    assert!(
        open.notes.iter().any(|note| note.contains(said)),
        "{:?}",
        open.notes
    );
}
