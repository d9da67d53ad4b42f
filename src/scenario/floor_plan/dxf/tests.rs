//! What the shapes of drawings are, and their names. `tests/dxf.rs` tests floors and obstacles.

use super::drawn;
use crate::floor_plan::kind::Kind;
use crate::floor_plan::reading::{Drawn, Reading};
use crate::floor_plan::shape::{Form, Shape};

/// The section ENTITIES of a drawing in meters: group codes and values, separated by spaces.
fn read(entities: &str, reading: &Reading) -> Drawn {
    let header =
        "0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 9 $INSUNITS 70 6 0 ENDSEC 0 SECTION 2 ENTITIES";
    let all = format!("{header} {entities} 0 ENDSEC 0 EOF");
    let lines: Vec<&str> = all.split_whitespace().collect();
    drawn(lines.join("\n").as_bytes(), reading).unwrap()
}

fn line(layer: &str, [a, b, c, d]: [f64; 4]) -> String {
    format!("0 LINE 8 {layer} 10 {a} 20 {b} 11 {c} 21 {d} ")
}

fn rectangle(layer: &str, [x, y, width, height]: [f64; 4]) -> String {
    let [right, top] = [x + width, y + height];
    format!(
        "0 LWPOLYLINE 8 {layer} 70 1 10 {x} 20 {y} 10 {right} 20 {y} 10 {right} 20 {top} 10 {x} 20 {top} "
    )
}

fn text(layer: &str, [x, y]: [f64; 2], says: &str) -> String {
    format!("0 TEXT 8 {layer} 10 {x} 20 {y} 40 0.3 1 {says} ")
}

/// The kinds, forms and names of shapes that have names.
fn named(shapes: &[Shape]) -> Vec<(Kind, Form, &str)> {
    let named = shapes
        .iter()
        .filter_map(|shape| Some((shape.kind, shape.form, shape.name.as_deref()?)));
    named.collect()
}

#[test]
fn places_are_named_by_texts_else_by_kinds_and_numbers() {
    let entities = [
        rectangle("floor", [0.0, 0.0, 20.0, 10.0]),
        line("exits", [20.0, 1.0, 20.0, 3.0]),
        line("exits", [20.0, 5.0, 20.0, 7.0]),
        rectangle("distributions", [1.0, 1.0, 4.0, 4.0]),
        "0 POINT 8 waypoints 10 9 20 5 ".to_owned(),
        line("doors", [8.0, 0.0, 8.0, 10.0]),
        text("A-ANNO", [20.2, 6.0], "East"),
        text("A-ANNO", [2.0, 2.0], "number=20"),
        text("A-ANNO", [2.0, 3.0], "Choir"),
        text("A-ANNO", [8.2, 8.0], "Foyer"),
    ];
    let found = read(&entities.concat(), &Reading::default());
    assert_eq!(
        named(&found.shapes),
        [
            (Kind::Floor, Form::Area, "Foyer"),
            (Kind::Exit, Form::Line, "exit 1"),
            (Kind::Exit, Form::Line, "East"),
            (Kind::Crowd, Form::Area, "Choir"),
            (Kind::Waypoint, Form::Point, "waypoint 1"),
            (Kind::Door, Form::Line, "door 1"),
        ]
    );
    let expected = "left out: layer \"A-ANNO\" (1 entity, the first a TEXT at (2, 2)); `plan.layers` says what a \
                    layer is";
    assert_eq!(found.notes, [expected]);
}

#[test]
fn rooms_between_walls_are_places_with_the_names_of_their_texts() {
    let entities = [
        rectangle("walls", [0.0, 0.0, 10.0, 5.0]),
        line("walls", [6.0, 0.0, 6.0, 2.0]),
        line("walls", [6.0, 3.0, 6.0, 5.0]),
        line("doors", [6.0, 2.0, 6.0, 3.0]),
        line("walls", [2.0, 2.0, 3.0, 2.0]),
        text("names", [5.7, 2.5], "Kitchen"),
        text("names", [8.0, 1.0], "Hall"),
    ];
    let found = read(&entities.concat(), &Reading::default());
    assert_eq!(
        named(&found.shapes),
        [
            (Kind::Place, Form::Area, "Kitchen"),
            (Kind::Place, Form::Area, "Hall"),
            (Kind::Door, Form::Line, "door 1"),
        ]
    );
    let sizes = |kind: Kind, form: Form| -> Vec<f64> {
        let some = found
            .shapes
            .iter()
            .filter(|shape| shape.kind == kind && shape.form == form);
        some.map(|shape| shape.area().unwrap().area()).collect()
    };
    assert_eq!(sizes(Kind::Floor, Form::Area), [50.0]);
    assert_eq!(sizes(Kind::Place, Form::Area), [30.0, 20.0]);
    let walls = found.shapes.iter().filter(|shape| shape.kind == Kind::Wall);
    assert_eq!(walls.filter(|shape| shape.form == Form::Line).count(), 4);
}

#[test]
fn layers_are_what_the_scenario_says_and_thin_walls_are_bodies() {
    let entities = [
        rectangle("A1", [0.0, 0.0, 20.0, 10.0]),
        rectangle("A2", [5.0, 0.0, 0.2, 6.0]),
        rectangle("A2", [10.0, 0.0, 4.0, 4.0]),
        rectangle("doors", [1.0, 1.0, 1.0, 1.0]),
        line("Defpoints", [0.0, 0.0, 90.0, 90.0]),
    ];
    let layers = [
        ("a1", "floor"),
        ("A2", "wall"),
        ("doors", "none"),
        ("A3", "exit"),
    ];
    let reading = Reading {
        layers: layers
            .map(|(name, kind)| (name.to_owned(), kind.to_owned()))
            .into(),
        inside: vec![[1.0, 1.0]],
        ..Reading::default()
    };
    let found = read(&entities.concat(), &reading);
    let kinds: Vec<(Kind, Form)> = found
        .shapes
        .iter()
        .map(|shape| (shape.kind, shape.form))
        .collect();
    assert_eq!(
        kinds,
        [
            (Kind::Floor, Form::Area),
            (Kind::Obstacle, Form::Area),
            (Kind::Wall, Form::Line)
        ]
    );
    assert_eq!(
        found.notes,
        [
            "`plan.layers` names \"A3\", which the drawing does not have",
            "`plan.inside` has no effect: the floor is drawn as areas",
            "left out: layer \"Defpoints\" (1 entity, the first a LINE at (0, 0)); `plan.layers` says what a layer is",
        ]
    );
}

#[test]
fn exits_drawn_as_areas_end_the_floor_only_at_the_outside() {
    // A room with an opening of 1 m on the right, an exit across it, and another one inside.
    let entities = [
        line("walls", [0.0, 0.0, 8.0, 0.0]),
        line("walls", [8.0, 0.0, 8.0, 2.0]),
        line("walls", [8.0, 3.0, 8.0, 5.0]),
        line("walls", [8.0, 5.0, 0.0, 5.0]),
        line("walls", [0.0, 5.0, 0.0, 0.0]),
        rectangle("exits", [7.5, 1.5, 1.0, 2.0]),
        rectangle("exits", [1.0, 1.0, 1.0, 1.0]),
    ];
    let found = read(&entities.concat(), &Reading::default());
    let floors = found
        .shapes
        .iter()
        .filter(|shape| shape.kind == Kind::Floor);
    let sizes: Vec<f64> = floors.map(|shape| shape.area().unwrap().area()).collect();
    // The exit reaches 0.5 m beyond the walls.
    assert!(
        (sizes[0] - 41.0).abs() < 1e-9 && sizes.len() == 1,
        "{sizes:?}"
    );
}

#[test]
fn hidden_entities_and_those_of_paper_space_are_left_out() {
    let mut entities = rectangle("floor", [0.0, 0.0, 20.0, 10.0]);
    entities += "0 CIRCLE 8 columns 67 1 10 5 20 5 40 1 0 CIRCLE 8 columns 60 1 10 5 20 5 40 1 ";
    entities += "0 MLINE 8 walls 10 5 20 5 0 VIEWPORT 8 walls 10 5 20 5 ";
    let found = read(&entities, &Reading::default());
    assert_eq!(found.shapes.len(), 1);
    let expected = "not read: 1 entity on known layers, the first a MLINE on layer \"walls\" (line 66); explode it \
                    into lines";
    assert_eq!(found.notes, [expected]);
}

#[test]
fn a_door_along_a_wall_without_a_gap_stays_closed_with_a_note() {
    let entities = [
        rectangle("walls", [0.0, 0.0, 10.0, 5.0]),
        line("walls", [6.0, 0.0, 6.0, 5.0]),
        line("doors", [6.0, 2.0, 6.0, 3.0]),
    ];
    let found = read(&entities.concat(), &Reading::default());
    let expected = "LINE on layer \"doors\" (line 54): doors along walls without a gap stay closed; interrupt the walls \
                    there";
    assert_eq!(found.notes[1], expected);
}

#[test]
fn layers_that_are_off_or_frozen_are_left_out_and_lost_letters_are_noted() {
    let layer = |name: &str, color: i32, flags: i32| {
        format!("0\nLAYER\n2\n{name}\n62\n{color}\n70\n{flags}\n")
    };
    let header = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n9\n$DWGCODEPAGE\n3\nANSI_1251\n9\n$INSUNITS\n70\n6\n0\n\
                  ENDSEC\n0\nSECTION\n2\nTABLES\n";
    let layers = [
        layer("columns", -7, 0),
        layer("furniture", 7, 1),
        layer("walls \u{f8}", 7, 0),
    ];
    let entities = [
        rectangle("floor", [0.0, 0.0, 9.0, 9.0]),
        rectangle("columns", [1.0, 1.0, 1.0, 1.0]),
        rectangle("furniture", [3.0, 3.0, 1.0, 1.0]),
    ];
    let mut text = header.to_owned() + &layers.concat() + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    text += &entities.concat().replace(' ', "\n");
    text += "0\nENDSEC\n0\nEOF\n";
    let found = drawn(text.as_bytes(), &Reading::default()).unwrap();
    assert_eq!(found.shapes.len(), 1);
    assert_eq!(
        found.notes,
        [
            "the code page ANSI_1251 is not read: other letters than those of ASCII are `?` in names; save the drawing as \
             DXF of version 2007 or later",
            "left out, because they are off or frozen: layer \"columns\" (1 entity), layer \"furniture\" (1 entity)",
        ]
    );
}
