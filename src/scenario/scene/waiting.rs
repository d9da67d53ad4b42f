//! Waiting areas: the free part of the given area, and the spots in it.

use crate::error::quote::shown;
use crate::error::{Problem, Under};
use crate::floor_plan::{Rings, free, parts_on_floor};
use crate::keys::places::WaitingArea;
use crate::scene::off_floor::OFF;
use crate::scene::places::ring;
use crate::scene::spots::{FROM_WALLS, spots};
use engine::geometry::{Area, Ring, Walls};
use engine::journeys::{Kind, WaitingArea as Waiting};
use engine::math::{Vector, direction, perpendicular};

/// A smaller part of an area that lies in walls comes from rounding.
const ROUNDING: f64 = 1e-6;
/// A note says how much of an area is free if it is less than this part.
const NEARLY_ALL: f64 = 0.99;

/// The waiting area of a file, and a note if much of it is not free. `behind` are the floors behind exits and
/// entrances, on which agents do not wait.
///
/// If a part of the area is not free, agents wait in the rest, in the largest part if walls divide it. They have
/// arrived when they are well inside: its sides lie along walls, or end there, where bodies do not fit.
pub fn waiting_area(
    given: &WaitingArea,
    walls: &Walls,
    behind: &Rings,
) -> Result<(Kind, Option<String>), Problem> {
    let whole = ring(&given.area).under("area")?;
    let parts = parts_on_floor(&whole, walls, behind)
        .map_err(|error| Problem::new("area", error.to_string()))?;
    let part = largest(&parts).ok_or_else(|| Problem::new("area", OFF))?;
    // Pillars in it do not change its outline.
    let share = part.exterior.area() / whole.area();
    let free = part.area() / whole.area();
    let note = (free < NEARLY_ALL).then(|| note(&given.name, parts.len(), free));
    // Routes lead to an area as it is drawn if hardly anything stands in its sides, and nothing at its corners.
    let mut corners = whole.points().iter();
    let is_clear = share >= NEARLY_ALL && corners.all(|&p| walls.obstacle_at(p).is_none());
    let is_whole = is_clear || share > 1.0 - ROUNDING;
    let [around, area] = match is_whole {
        true => [whole.clone(), whole],
        false => [part.exterior.clone(), inner(&part.exterior).under("area")?],
    };
    let times = given.for_secs.as_ref().map(|secs| secs.times());
    let lasting = times.transpose().under("for_secs")?;
    let waiting = Waiting {
        spots: spots(&around, walls, given.facing.map(Into::into)),
        area,
        until: given.until_secs,
        lasting,
    };
    Ok((Kind::Waiting(waiting), note))
}

/// The largest part of a ring that is as far from its sides as spots are from walls; all of it if it is narrow.
fn inner(ring: &Ring) -> Result<Ring, Problem> {
    let sides = around(ring, FROM_WALLS);
    let parts = free(&[vec![ring.points().to_vec()]], &sides)
        .map_err(|error| Problem::new("", error.to_string()))?;
    Ok(largest(&parts).map_or_else(|| ring.clone(), |part| part.exterior.clone()))
}

fn largest(parts: &[Area]) -> Option<&Area> {
    parts.iter().max_by(|a, b| a.area().total_cmp(&b.area()))
}

/// Rectangles around the sides of `ring` that reach `distance` meters from them, counterclockwise.
fn around(ring: &Ring, distance: f64) -> Rings {
    let corners = ring.points();
    let ends = corners.iter().cycle().skip(1);
    let rectangle = |(start, end): (&Vector, &Vector)| {
        let along = direction(end - start) * distance;
        let (start, end, left) = (start - along, end + along, perpendicular(along));
        vec![start - left, end - left, end + left, start + left]
    };
    corners.iter().zip(ends).map(rectangle).collect()
}

fn note(name: &str, parts: usize, share: f64) -> String {
    let (name, percent) = (shown(name), 100.0 * share);
    match parts {
        1 => format!("area: {percent:.1} % of `{name}` is free floor; agents wait there"),
        _ => format!(
            "area: walls divide the free floor of `{name}` into {parts} parts; agents wait in the largest, \
             {percent:.1} % of the area: draw it within one room if they should wait in another"
        ),
    }
}
