//! DXF, the exchange format of CAD programs: from the first ASCII versions to 2018, and binary files.
//!
//! | step | file |
//! |---|---|
//! | group codes and values | `pairs`, `letters` |
//! | entities, layers, blocks | `record`, `entities`, `hatch`, `file` |
//! | blocks at their places | `blocks`, `map` |
//! | what layers are, what is left out | `layers` |
//! | unit and origin | `units` |
//! | curves as straight lines | `curves`, `spline` |
//! | names of places | `names` |
//! | floors and obstacles that are drawn as areas | `items`, `shapes`, `joined` |
//! | the floor between walls that are drawn as lines | `rooms`, `gaps`, `network`, `faces` |

mod blocks;
mod curves;
mod entities;
mod faces;
mod file;
mod gaps;
mod hatch;
mod items;
mod joined;
mod layers;
mod letters;
mod map;
mod names;
mod network;
mod pairs;
mod record;
mod rooms;
mod rows;
mod shapes;
mod spline;
mod units;

use super::error::FloorPlanError;
use super::kind::Kind;
use super::reading::{Drawn, Reading};
use layers::Sorted;
use pairs::{Pairs, SENTINEL};
use units::Frame;

/// How drawings of AutoCAD in its own format begin.
const DWG: &[u8] = b"AC10";

/// Whether a file is a DXF: a binary one, or one that begins with a comment or a section.
pub fn is_dxf(bytes: &[u8]) -> bool {
    if bytes.starts_with(SENTINEL) {
        return true;
    }
    let start = bytes.trim_ascii_start();
    let is_number =
        start.first().is_some_and(u8::is_ascii_digit) || start.starts_with(b"\xef\xbb\xbf");
    let first = is_number.then(|| Pairs::new(start).next());
    matches!(first, Some(Ok(Some(pair))) if pair.is(0, "SECTION"))
}

/// Whether a file is a DWG.
pub fn is_dwg(bytes: &[u8]) -> bool {
    let version = bytes.strip_prefix(DWG).and_then(|rest| rest.get(..2));
    version.is_some_and(|version| version.iter().all(u8::is_ascii_digit))
}

/// An error of the file.
fn syntax(reason: impl Into<String>) -> FloorPlanError {
    FloorPlanError::Syntax {
        format: "DXF",
        reason: reason.into(),
    }
}

/// Reads a drawing.
///
/// # Errors
/// It is not a valid DXF, no layer says what it is, the unit cannot be guessed, an outline is open, or walls enclose
/// nothing. The message has the place and the fix.
pub fn drawn(bytes: &[u8], reading: &Reading) -> Result<Drawn, FloorPlanError> {
    if is_dwg(bytes) {
        return Err(syntax("it is a DWG; save the drawing as DXF"));
    }
    let drawing = file::read(bytes)?;
    let placed = blocks::placed(&drawing)?;
    let mut sorted = Sorted::new(&drawing, placed, reading)?;
    let Some([built, all]) = items::extents(&sorted)? else {
        return Err(sorted.nothing());
    };
    let (unit, unit_note) = units::unit(reading.unit.as_deref(), drawing.header.unit, &built)?;
    let frame = Frame::new(unit, &built, &all, reading.origin);
    let mut items = items::items(&sorted, &frame, reading.gap())?;
    if !items.iter().any(|item| item.kind.is_built()) {
        return Err(sorted.nothing());
    }
    let mut labels = names::labels(&sorted, &frame);
    names::by_texts(&mut items, &mut labels);
    names::by_numbers(&mut items);
    let mut notes: Vec<String> = drawing.letters.note().into_iter().collect();
    notes.extend(layers::missing(&drawing, reading));
    notes.extend(unit_note.into_iter().chain(frame.note()));
    let (mut shapes, mut gaps) = (Vec::new(), Vec::new());
    let has_floor = items.iter().any(|item| item.kind == Kind::Floor);
    let has_walls = items.iter().any(|item| item.kind == Kind::Wall);
    if has_walls && !has_floor {
        let rooms = rooms::rooms(&items, &mut labels, reading)
            .map_err(|error| with(error, &(moved(&frame) + &sorted.left_out())))?;
        shapes.extend(rooms.shapes);
        notes.extend(rooms.notes);
        gaps.extend(rooms.gaps);
        items.retain(|item| item.kind != Kind::Wall);
        names::first_of_doors(&mut items);
    } else if !reading.inside.is_empty() {
        notes.push("`plan.inside` has no effect: the floor is drawn as areas".to_owned());
    }
    let areas = shapes::shapes(&items, reading.gap(), &sorted)?;
    shapes.extend(areas.shapes);
    notes.extend(areas.notes);
    gaps.extend(areas.gaps);
    notes.extend(rooms::gaps_note(&gaps));
    for label in labels
        .iter()
        .filter(|label| label.is_unknown && !label.is_used)
    {
        sorted.leave_out(label.placed);
    }
    notes.extend(sorted.notes(&frame));
    Ok(Drawn {
        shapes,
        notes,
        ..Drawn::default()
    })
}

/// What an error says of the move of a drawing to the origin.
fn moved(frame: &Frame) -> String {
    frame
        .note()
        .map_or(String::new(), |note| format!("; the drawing is {note}"))
}

/// An error with more at its end.
fn with(error: FloorPlanError, more: &str) -> FloorPlanError {
    match error {
        FloorPlanError::Geometry { place, reason } => FloorPlanError::Geometry {
            place,
            reason: reason + more,
        },
        other => other,
    }
}

/// What the shapes of drawings are, and their names. `tests/dxf.rs` tests floors and obstacles.
#[cfg(test)]
mod tests {
    use super::*;
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
                "left out: layer \"Defpoints\" (1 entity, the first a LINE at (0, 0)); `plan.layers` says what a \
                 layer is",
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
        entities +=
            "0 CIRCLE 8 columns 67 1 10 5 20 5 40 1 0 CIRCLE 8 columns 60 1 10 5 20 5 40 1 ";
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
        let expected = "LINE on layer \"doors\" (line 54): doors along walls without a gap stay closed; interrupt the \
                        walls there";
        assert_eq!(found.notes[1], expected);
    }

    #[test]
    fn layers_that_are_off_or_frozen_are_left_out_and_lost_letters_are_noted() {
        let layer = |name: &str, color: i32, flags: i32| {
            format!("0\nLAYER\n2\n{name}\n62\n{color}\n70\n{flags}\n")
        };
        let header = "0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 9 $DWGCODEPAGE 3 ANSI_1251 9 $INSUNITS 70 6 0 ENDSEC 0 \
                      SECTION 2 TABLES ";
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
        let mut text =
            header.replace(' ', "\n") + &layers.concat() + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
        text += &entities.concat().replace(' ', "\n");
        text += "0\nENDSEC\n0\nEOF\n";
        let found = drawn(text.as_bytes(), &Reading::default()).unwrap();
        assert_eq!(found.shapes.len(), 1);
        assert_eq!(
            found.notes,
            [
                "the code page ANSI_1251 is not read: other letters than those of ASCII are `?` in names; save the \
                 drawing as DXF of version 2007 or later",
                "left out, because they are off or frozen: layer \"columns\" (1 entity), layer \"furniture\" (1 \
                 entity)",
            ]
        );
    }

    #[test]
    fn attributes_of_blocks_name_their_shapes() {
        let attribute =
            |tag: &str, says: &str| format!("0\nATTRIB\n8\n0\n10\n0\n20\n0\n2\n{tag}\n1\n{says}\n");
        let mut text = "0 SECTION 2 BLOCKS 0 BLOCK 2 gate 10 0 20 0 ".to_owned();
        text += &line("0", [0.0, 0.0, 2.0, 0.0]);
        text += &line("0", [0.0, 0.1, 2.0, 0.1]);
        text += "0 ENDBLK 0 ENDSEC 0 SECTION 2 ENTITIES ";
        text += &rectangle("floor", [0.0, 0.0, 9.0, 9.0]);
        text += "0 INSERT 8 exits 2 GATE 66 1 10 3 20 0 ";
        let mut text = text.replace(' ', "\n");
        text += &attribute("WIDTH", "two m");
        text += &attribute("GATE_NAME", "North gate");
        text += "0\nSEQEND\n0\nINSERT\n8\nexits\n2\ngate\n10\n6\n20\n0\n0\nENDSEC\n0\nEOF\n";
        let found = drawn(text.as_bytes(), &Reading::default()).unwrap();
        let names: Vec<&str> = named(&found.shapes)
            .into_iter()
            .map(|(.., name)| name)
            .collect();
        assert_eq!(names, ["North gate", "North gate", "exit 1", "exit 1"]);
        assert_eq!(found.shapes[1].rings[0], [[3.0, 0.0], [5.0, 0.0]]);
    }
}
