//! Rejects zones, regions and lines off the floor: there is nothing to slow or to measure.

use super::error::{Problem, Under};
use super::file::File;
use super::floor_plan::{FloorPlanError, is_line_on_floor, is_on_floor};
use super::measurements::Observed;
use crate::engine::scene::Scene;

/// The reason why an area or a line is refused.
pub(super) const OFF: &str =
    "lies in obstacles or outside of the walkable area; move it onto the floor";

/// Rejects zones, and regions and lines of measurements, that lie wholly in obstacles or outside of the walkable area.
pub(super) fn check(keys: &File, scene: &Scene) -> Result<(), Problem> {
    let walls = &scene.walls;
    for (k, zone) in scene.journeys.zones.iter().enumerate() {
        let place = format!("zones[{k}].area");
        accept(is_on_floor(zone.area.points(), walls)).under(&place)?;
    }
    for (k, measurement) in keys.measurements.iter().enumerate() {
        for (key, observed) in measurement.observed_places() {
            let found = match observed {
                Observed::Region(region) => is_on_floor(&region.corners(), walls),
                Observed::Line(ends) => is_line_on_floor(ends, walls),
            };
            accept(found).under(&format!("measurements[{k}].{key}"))?;
        }
    }
    Ok(())
}

fn accept(is_on: Result<bool, FloorPlanError>) -> Result<(), Problem> {
    match is_on {
        Ok(true) => Ok(()),
        Ok(false) => Err(Problem::new("", OFF)),
        Err(error) => Err(Problem::new("", error.to_string())),
    }
}
