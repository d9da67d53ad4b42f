//! Which stairs and ramps lead where: by the openings on their edges.

use super::categories::Category;
use super::edges::is_on_edge;
use super::features::{Site, wrong};
use crate::error::quote::shown;
use crate::floor_plan::error::FloorPlanError;
use crate::floor_plan::unite::shared;

/// A unit with this part of the area of another one is the same flight, drawn once more.
const SAME: f64 = 0.9;

/// A unit that is a level of its own.
#[derive(Debug)]
pub struct Flight {
    /// The number of the unit.
    pub unit: usize,
    /// The numbers of the openings at its ends.
    pub openings: Vec<usize>,
}

/// The flights of a site. Steps that lead to no other level become floor, and flights that are drawn on both of their
/// levels holes of the second one, with notes.
///
/// # Errors
/// A flight joins one level only.
pub fn flights(site: &mut Site) -> Result<Vec<Flight>, FloorPlanError> {
    let mut flights: Vec<Flight> = Vec::new();
    let mut lone = Vec::new();
    for unit in 0..site.units.len() {
        if !site.units[unit].category.is_flight() {
            continue;
        }
        let openings = ends(site, unit);
        let level = site.units[unit].level;
        let is_own = |opening: &&usize| site.openings[**opening].level == level;
        let own = openings.iter().filter(is_own).count();
        if own > 0 && own < openings.len() {
            let again = flights.iter().any(|known| known.openings == openings);
            match again {
                true => drawn_again(site, unit),
                false => flights.push(Flight { unit, openings }),
            }
        } else {
            lone.push((unit, openings));
        }
    }
    for (unit, openings) in lone {
        if is_known(site, unit, &flights)? {
            drawn_again(site, unit);
            continue;
        }
        let place = site.units[unit].shape.place.clone();
        if site.units[unit].category == Category::Steps {
            site.units[unit].category = Category::Floor;
            let note =
                "steps that lead to no other level are floor, on which people walk as on the flat";
            site.notes.push(format!("{}: {note}", shown(&place)));
            continue;
        }
        let own = &site.storeys[site.units[unit].level].name;
        let mut joined: Vec<String> = openings
            .iter()
            .map(|&opening| {
                format!(
                    "`{}`",
                    shown(&site.storeys[site.openings[opening].level].name)
                )
            })
            .collect();
        joined.dedup();
        let joins = match joined.is_empty() {
            true => "no floor".to_owned(),
            false => format!("only {}", joined.join(" and ")),
        };
        let reason = format!(
            "joins {joins}: openings must lie on its edge, one with the `level_id` of its own level, `{}`, and one \
             with that of the next level",
            shown(own)
        );
        return Err(wrong(&place, reason));
    }
    Ok(flights)
}

/// The openings on the edge of a unit that are its ends: those of its own level, and those of the nearest level above
/// that has any, else of the nearest below.
fn ends(site: &Site, unit: usize) -> Vec<usize> {
    let of = &site.units[unit];
    let at_edge = |opening: &usize| is_on_edge(&site.openings[*opening].shape, &of.shape.rings);
    let all: Vec<usize> = (0..site.openings.len()).filter(at_edge).collect();
    let levels = || all.iter().map(|&opening| site.openings[opening].level);
    let above = levels().filter(|&level| level > of.level).min();
    let next = above.or_else(|| levels().filter(|&level| level < of.level).max());
    let leads_there = |&opening: &usize| {
        let level = site.openings[opening].level;
        level == of.level || Some(level) == next
    };
    all.iter().copied().filter(leads_there).collect()
}

/// Whether a unit lies where a flight leads to its level.
fn is_known(site: &Site, unit: usize, flights: &[Flight]) -> Result<bool, FloorPlanError> {
    let own = site.units[unit].shape.area()?;
    for flight in flights {
        let mut ends = flight.openings.iter();
        if ends.any(|&opening| site.openings[opening].level == site.units[unit].level) {
            let other = site.units[flight.unit].shape.area()?;
            if shared(own, other)? > SAME * own.area() {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

fn drawn_again(site: &mut Site, unit: usize) {
    let unit = &mut site.units[unit];
    unit.category = Category::Hole;
    let note = "is the flight from another level, drawn once more";
    site.notes
        .push(format!("{} {note}", shown(&unit.shape.place)));
}
