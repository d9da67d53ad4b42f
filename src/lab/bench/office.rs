//! An office floor: rooms on both sides of corridors, which lead to two aisles with exits at both ends.

use serde_json::{Value, json};

use super::timing::{failed, ms_per_frame};
use crate::error::LabError;
use engine::simulation::Simulation;
use scenario::Scenario;

/// The sides of a room, and the width of its door, meters.
const ROOM: [f64; 2] = [5.8, 5.0];
const DOOR: f64 = 0.9;
/// The thickness of walls, meters.
const WALL: f64 = 0.2;
/// The widths of corridors and aisles, meters.
const CORRIDOR: f64 = 2.4;
const AISLE: f64 = 3.0;
/// Areas that join overlap by this, meters.
const OVERLAP: f64 = 0.1;
/// The rooms on each side of a corridor, and the people in each room.
const ROOMS: u32 = 10;
const PEOPLE: u32 = 50;

/// An office floor with some corridors, after `frames` frames. 1,000 people per corridor leave with a `route_choice`.
///
/// # Errors
/// The simulation fails.
pub fn settled(corridors: u32, frames: u64, route_choice: &str) -> Result<Simulation, LabError> {
    let mut document = scenario(corridors);
    document["route_choice"] = json!(route_choice);
    let parsed = Scenario::parse(&document.to_string(), "office floor", &[]);
    let scenario = parsed.map_err(|error| LabError::of("office floor", error))?;
    let mut simulation = Simulation::new(scenario.scene).map_err(failed)?;
    ms_per_frame(&mut simulation, frames)?;
    Ok(simulation)
}

fn rectangle([x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> Value {
    json!([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
}

fn scenario(corridors: u32) -> Value {
    let pitch = ROOM[0] + WALL;
    let across = 2.0 * (ROOM[1] + WALL) + CORRIDOR;
    let length = f64::from(ROOMS) * pitch;
    let height = f64::from(corridors) * (across + WALL);
    let aisles = [[-AISLE, 0.0], [length, length + AISLE]];
    let mut areas = aisles
        .map(|x| rectangle([x[0], x[1]], [0.0, height]))
        .to_vec();
    let mut crowds = Vec::new();
    for corridor in 0..corridors {
        let low = f64::from(corridor) * (across + WALL);
        let walls = [low + ROOM[1], low + ROOM[1] + WALL + CORRIDOR];
        let middle = [walls[0] + WALL, walls[1]];
        areas.push(rectangle([-OVERLAP, length + OVERLAP], middle));
        for (room, [from, wall]) in (0..2 * ROOMS).zip(
            [[low, walls[0]], [walls[1] + WALL, walls[1]]]
                .into_iter()
                .cycle(),
        ) {
            let left = 0.5 * WALL + f64::from(room / 2) * pitch;
            let door = left + 0.5 * (ROOM[0] - DOOR);
            let (x, y) = ([left, left + ROOM[0]], [from, from + ROOM[1]]);
            areas.push(rectangle(x, y));
            let through = [wall - OVERLAP, wall + WALL + OVERLAP];
            areas.push(rectangle([door, door + DOOR], through));
            let inside = |[a, b]: [f64; 2]| [a + 0.3, b - 0.3];
            crowds.push(json!({"area": rectangle(inside(x), inside(y)), "number": PEOPLE}));
        }
    }
    let exits = aisles.iter().flat_map(|x| {
        [0.0, height]
            .map(|y| json!({"name": format!("({}, {y})", x[0]), "line": [[x[0], y], [x[1], y]]}))
    });
    json!({
        "duration_secs": 60, "profile": "walk+sph",
        "walkable_area": areas.into_iter().map(|area| json!([area])).collect::<Vec<_>>(),
        "exits": exits.collect::<Vec<_>>(), "crowds": crowds,
    })
}
