//! Rooms at different heights: one floor has no storeys.

use std::ops::Range;

use roxmltree::Node;

use super::{caption, id, wrong};
use crate::error::quote::shown;
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::reading::{Drawn, Reading};
use crate::floor_plan::shape::Shape;
use crate::floor_plan::unite::shared;

/// Rooms at different heights overlap if they share at least this, m².
const OVERLAP: f64 = 0.1;

/// A subroom, with its shapes.
pub struct Room {
    /// Its name in messages.
    pub name: String,
    /// The numbers of its room and of itself.
    pub side: [String; 2],
    /// The caption of its room.
    pub storey: Option<String>,
    /// The height of its floor, meters; `None` for one that rises, or whose height is not given.
    pub height: Option<f64>,
    /// Whether it is a stair.
    is_stair: bool,
    /// Its class, in lowercase.
    pub class: String,
    /// Its own caption.
    pub caption: Option<String>,
    /// How much its floor rises along x and y, meters per meter.
    pub rise: [f64; 2],
    /// Its shapes: first its floor.
    pub shapes: Range<usize>,
}

impl Room {
    pub fn of(room: Node, subroom: Node, shapes: Range<usize>) -> Self {
        let number = |node: Node, name: &str| node.attribute(name)?.trim().parse::<f64>().ok();
        let class = subroom
            .attribute("class")
            .unwrap_or_default()
            .to_lowercase();
        let is_stair =
            class.contains("stair") || class.contains("escalator") || class.contains("ramp");
        let [along, across, above] =
            ["A_x", "B_y", "C_z"].map(|name| number(subroom, name).unwrap_or(0.0));
        let is_level = !is_stair && along == 0.0 && across == 0.0;
        let height = number(room, "zpos").unwrap_or(0.0) + above;
        let of_room = caption(room).map_or(String::new(), |name| format!(" ({name})"));
        Self {
            name: format!("room {}{of_room}, subroom {}", id(room), id(subroom)),
            side: [id(room), id(subroom)].map(str::to_owned),
            storey: caption(room),
            height: is_level.then_some(height),
            is_stair,
            class,
            caption: caption(subroom),
            rise: [along, across],
            shapes,
        }
    }

    /// Whether it belongs to the storey with this name or height.
    fn is_of(&self, storey: &str) -> bool {
        let height: Option<f64> = storey.trim().parse().ok();
        self.storey.as_deref() == Some(storey) || (height.is_some() && height == self.height)
    }

    fn height(&self) -> String {
        self.height
            .map_or("a stair".to_owned(), |height| format!("at {height} m"))
    }
}

/// The rooms of one storey if `reading` names one, else all. Refuses rooms that overlap at different heights, and notes
/// stairs.
pub fn choose(
    rooms: Vec<Room>,
    reading: &Reading,
    drawn: &mut Drawn,
) -> Result<Vec<Room>, FloorPlanError> {
    let kept = match &reading.storey {
        Some(storey) if !rooms.iter().any(|room| room.is_of(storey)) => {
            return Err(unknown(storey, &rooms));
        }
        Some(storey) => rooms
            .into_iter()
            .filter(|room| room.is_of(storey))
            .collect(),
        None => rooms,
    };
    refuse_overlaps(&kept, &drawn.shapes)?;
    let shapes = kept
        .iter()
        .flat_map(|room| &drawn.shapes[room.shapes.clone()]);
    drawn.shapes = shapes.cloned().collect();
    drawn.notes.extend(heights_noted(&kept));
    drawn.notes.extend(stairs_noted(&kept));
    Ok(kept)
}

/// A note on floors at several heights, if there are any.
fn heights_noted(rooms: &[Room]) -> Option<String> {
    let mut heights: Vec<f64> = rooms.iter().filter_map(|room| room.height).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let listed: Vec<String> = heights.iter().map(f64::to_string).collect();
    let note = || {
        format!(
            "the floors at the heights {} m do not overlap and are one floor here; heights are not used",
            listed.join(", ")
        )
    };
    (heights.len() > 1).then(note)
}

/// A note on stairs, if there are any.
fn stairs_noted(rooms: &[Room]) -> Option<String> {
    let with_stairs = rooms.iter().filter(|room| room.is_stair);
    let stairs: Vec<&str> = with_stairs.map(|room| &*room.name).collect();
    let first = shown(stairs.first()?);
    let more = match stairs.len() {
        1 => String::new(),
        count => format!(" and {} more", count - 1),
    };
    Some(format!(
        "stairs are floor here, on which people walk as on the flat: {first}{more}; give a `zone` with a `speed_factor`"
    ))
}

fn unknown(storey: &str, rooms: &[Room]) -> FloorPlanError {
    let mut known: Vec<String> = rooms
        .iter()
        .filter_map(|room| room.storey.clone())
        .collect();
    known.extend(
        rooms
            .iter()
            .filter_map(|room| room.height)
            .map(|height| height.to_string()),
    );
    known.sort();
    known.dedup();
    let reason = format!(
        "no room has the name or height `{}`; there are {}",
        shown(storey),
        known.join(", ")
    );
    wrong("plan.storey", reason)
}

/// Rooms at different heights must not overlap: people would walk from one to the other.
fn refuse_overlaps(rooms: &[Room], shapes: &[Shape]) -> Result<(), FloorPlanError> {
    for (k, one) in rooms.iter().enumerate() {
        for other in &rooms[..k] {
            if one.height == other.height {
                continue;
            }
            let [a, b] = [one, other].map(|room| &shapes[room.shapes.start]);
            let shared = shared(a.area()?, b.area()?)?;
            if shared >= OVERLAP {
                let reason = format!(
                    "storeys overlap in plan: {} ({}) and {} ({}) share {shared:.1} m²; a floor has no storeys: take \
                     all as levels with `\"levels\": \"FILE.xml\"`, or one by its name or height with `plan.storey`",
                    shown(&other.name),
                    other.height(),
                    shown(&one.name),
                    one.height(),
                );
                return Err(wrong("", reason));
            }
        }
    }
    Ok(())
}
