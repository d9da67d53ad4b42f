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

#[cfg(test)]
mod tests;

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
        let rooms = rooms::rooms(&items, &mut labels, reading);
        let rooms = rooms.map_err(|error| with(error, &sorted.left_out()))?;
        shapes.extend(rooms.shapes);
        notes.extend(rooms.notes);
        gaps.extend(rooms.gaps);
        items.retain(|item| item.kind != Kind::Wall);
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
