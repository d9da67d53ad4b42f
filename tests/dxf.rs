//! Defects of drawings, and drawings of other programs (`tests/data/dxf`). The areas and coordinates that are expected
//! are computed here by other means.

use std::f64::consts::PI;
use std::fmt::Display;
use std::fs;
use std::path::Path;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError, Reading};

/// A drawing in the making: group codes and values, one per line.
#[derive(Default)]
struct Drawing(String);

impl Drawing {
    /// A drawing in a unit: 4 is millimeters, 6 meters.
    fn new(unit: i32) -> Self {
        let mut drawing = Self::default();
        drawing.add(&[
            (0, "SECTION"),
            (2, "HEADER"),
            (9, "$ACADVER"),
            (1, "AC1027"),
            (9, "$INSUNITS"),
        ]);
        drawing.pair(70, unit);
        drawing.pair(0, "ENDSEC");
        drawing
    }

    fn pair(&mut self, code: i32, value: impl Display) {
        self.0 += &format!("{code}\n{value}\n");
    }

    fn add(&mut self, pairs: &[(i32, &str)]) {
        for &(code, value) in pairs {
            self.pair(code, value);
        }
    }

    /// Begins a section.
    fn section(mut self, name: &str) -> Self {
        self.add(&[(0, "SECTION"), (2, name)]);
        self
    }

    /// Ends a section.
    fn end(mut self) -> Self {
        self.pair(0, "ENDSEC");
        self
    }

    fn point(&mut self, code: i32, [x, y]: [f64; 2]) {
        self.pair(code, x);
        self.pair(code + 10, y);
    }

    fn line(mut self, layer: &str, from: [f64; 2], to: [f64; 2]) -> Self {
        self.add(&[(0, "LINE"), (8, layer)]);
        self.point(10, from);
        self.point(11, to);
        self
    }

    /// A polyline from vertices with bulges.
    fn bulges(mut self, layer: &str, is_closed: bool, vertices: &[([f64; 2], f64)]) -> Self {
        self.add(&[(0, "LWPOLYLINE"), (8, layer)]);
        self.pair(90, vertices.len());
        self.pair(70, i32::from(is_closed));
        for &(at, bulge) in vertices {
            self.point(10, at);
            self.pair(42, bulge);
        }
        self
    }

    fn polyline(self, layer: &str, is_closed: bool, points: &[[f64; 2]]) -> Self {
        let vertices: Vec<_> = points.iter().map(|&at| (at, 0.0)).collect();
        self.bulges(layer, is_closed, &vertices)
    }

    fn text(mut self, layer: &str, at: [f64; 2], text: &str) -> Self {
        self.add(&[(0, "TEXT"), (8, layer), (40, "0.3"), (1, text)]);
        self.point(10, at);
        self
    }

    /// A block, as part of the section BLOCKS.
    fn block(mut self, name: &str, base: [f64; 2], content: Self) -> Self {
        self.add(&[(0, "BLOCK"), (8, "0"), (2, name)]);
        self.point(10, base);
        self.0 += &content.0;
        self.pair(0, "ENDBLK");
        self
    }

    /// A block at a place, with factors along its axes and a turn in degrees.
    fn insert(mut self, layer: &str, name: &str, at: [f64; 2], [x, y, turn]: [f64; 3]) -> Self {
        self.add(&[(0, "INSERT"), (8, layer), (2, name)]);
        self.point(10, at);
        for (code, value) in [(41, x), (42, y), (50, turn)] {
            self.pair(code, value);
        }
        self
    }

    fn read_as(mut self, reading: &Reading) -> Result<FloorPlan, FloorPlanError> {
        self.pair(0, "EOF");
        floor_plan::parse_bytes(self.0.as_bytes(), reading)
    }

    fn read(self) -> FloorPlan {
        self.read_as(&Reading::default()).unwrap()
    }

    fn refused(self) -> String {
        self.read_as(&Reading::default()).unwrap_err().to_string()
    }
}

fn area(plan: &FloorPlan) -> f64 {
    plan.walkable.iter().map(|area| area.area()).sum()
}

fn is_floor(plan: &FloorPlan, x: f64, y: f64) -> bool {
    plan.walkable
        .iter()
        .any(|area| area.contains(Vector::new(x, y)))
}

#[track_caller]
fn is_near(found: f64, expected: f64, tolerance: f64) {
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
    assert_eq!(
        gaps.unwrap(),
        "4 gaps between ends of lines closed, the largest 0.01 m at (7.99, 0); `plan.gap` says otherwise"
    );
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
    let expected = "LINE on layer \"floor\" (line 18): the outline of the floor is open at (0, 0), where no line \
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
    is_near(area(&rooms(true).read()), 50.0, 1e-6);
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
    is_near(area(&rooms(false).read_as(&reading).unwrap()), 50.0, 1e-6);
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
    let expected = "LINE on layer \"walls\" (line 18): line 22: group code 10 needs a number, found `NaN`; save the \
                    drawing again";
    assert_eq!(wrong.end().refused(), expected);
}

/// A drawing of `tests/data/dxf`.
fn file(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/dxf");
    fs::read(folder.join(name)).unwrap()
}

fn plan(name: &str) -> FloorPlan {
    floor_plan::parse_bytes(&file(name), &Reading::default()).unwrap()
}

#[test]
fn rooms_of_an_office_with_double_walls_and_door_blocks_are_joined() {
    let plan = plan("office.dxf");
    let [rooms, openings, corridor] = [4.0 * 4.0 * 5.0, 4.0 * 1.0 * 0.2, 16.6 * 2.0];
    is_near(area(&plan), rooms + openings + corridor, 1e-6);
    // Not the hollow outer walls.
    assert!(!is_floor(&plan, -0.1, 3.0) && !is_floor(&plan, 4.1, 4.0));
    assert!(
        plan.notes[0].starts_with("taken as millimeters, 17.2 by "),
        "{:?}",
        plan.notes
    );
}

#[test]
fn a_round_hall_far_away_has_the_area_of_its_circles() {
    let plan = plan("arena.dxf");
    let hall = 0.75 * PI * 400.0 + 200.0 + 0.5 * 0.01 * 20.0;
    let stage = 8.0 * 4.0 + PI * 4.0;
    let columns = 8.0 * PI * 0.25;
    // Straight parts leave out two thirds of the tolerance on average.
    let arcs = PI * (30.0 + 4.0 + 8.0);
    is_near(area(&plan), hall - stage - columns, 0.005 * arcs);
    // Moved by 345 and 5,268 km: the lower left corner is the origin.
    let [x, y] = [20.0, 20.0];
    assert!(is_floor(&plan, x + 6.05, y) && !is_floor(&plan, x + 5.95, y));
    let angle = PI / 8.0 + 2.0 * PI / 4.0;
    assert!(!is_floor(
        &plan,
        x + 10.0 * angle.cos(),
        y + 10.0 * angle.sin()
    ));
    let expected = "moved by (-345000, -5268010) m, so that it begins near the origin";
    assert!(
        plan.notes.iter().any(|note| note == expected),
        "{:?}",
        plan.notes
    );
}

#[test]
fn a_station_of_blocks_has_all_its_mirrored_columns() {
    let plan = plan("station.dxf");
    let hall = 30.0 * 16.0 - 2.0 * 2.0;
    let group = 4.0 * 0.6 * 0.4 / 2.0;
    is_near(area(&plan), hall - 6.0 * group - 1.5 * 1.5 * group, 1e-6);
    // Within each of the four columns of the group at (14, 11).
    for [right, up] in [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]] {
        assert!(!is_floor(&plan, 14.0 + 0.3 * right, 11.0 + 0.3 * up));
        assert!(is_floor(&plan, 14.0 + 0.7 * right, 11.0 + 0.5 * up));
    }
}

#[test]
fn a_theater_has_the_area_that_ezdxf_gives() {
    let plan = plan("theater.dxf");
    // By `make.py`: shapely and ezdxf's curves within 0.1 mm.
    is_near(area(&plan), 415.6095, 0.005 * 80.0);
    assert!(
        !is_floor(&plan, 4.0, 4.0) && !is_floor(&plan, 10.0, 13.0) && !is_floor(&plan, 18.0, 9.0)
    );
}

#[test]
fn binary_files_give_the_same_plans_as_text() {
    for name in ["arena", "theater"] {
        let [text, binary] = [
            plan(&format!("{name}.dxf")),
            plan(&format!("{name}_binary.dxf")),
        ];
        assert!(!text.walkable.is_empty());
        assert_eq!(text, binary);
    }
}

#[test]
fn damaged_files_give_plans_or_errors() {
    let names = [
        "office",
        "arena",
        "station",
        "theater",
        "arena_binary",
        "theater_binary",
    ];
    let files = names.map(|name| file(&format!("{name}.dxf")));
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for k in 0..20_000 {
        let mut bytes = files[k % files.len()].clone();
        for _ in 0..random.random_range(1..6) {
            damage(&mut bytes, &mut random);
        }
        let reading = Reading::default();
        match floor_plan::parse_bytes(&bytes, &reading) {
            Ok(plan) => assert!(plan.solids().is_ok()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// Changes bytes at one place.
fn damage(bytes: &mut Vec<u8>, random: &mut ChaCha8Rng) {
    let values: [&[u8]; 8] = [
        b"-1",
        b"1e300",
        b"nan",
        b"0",
        b"99999999999",
        b"INSERT",
        b"LINE",
        b"floor",
    ];
    let from = random.random_range(0..bytes.len().max(1)).min(bytes.len());
    let line = bytes[from..]
        .iter()
        .position(|&byte| byte == b'\n')
        .unwrap_or(0);
    match random.random_range(0..5) {
        0 => bytes.truncate(from.max(1)),
        1 => bytes
            .iter_mut()
            .skip(from)
            .take(1)
            .for_each(|byte| *byte = random.random()),
        2 => drop(bytes.drain(from..from + line)),
        3 => {
            let end = bytes[from + line..]
                .iter()
                .skip(1)
                .position(|&byte| byte == b'\n');
            let to = from + line + end.unwrap_or(0);
            bytes.splice(
                from + line..to,
                [b"\n", values[random.random_range(0..8)]].concat(),
            );
        }
        _ => {
            let to = (from + random.random_range(0..200)).min(bytes.len());
            let copy = bytes[from..to].to_vec();
            bytes.splice(from..from, copy);
        }
    }
}
