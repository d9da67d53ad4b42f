//! A dense hall with pillars between the agents and their goal: a crowd that needs path maps.

use serde_json::{Value, json};

use super::timing::{failed, ms_per_frame};
use crate::error::LabError;
use engine::simulation::Simulation;
use scenario::Scenario;
use scenario::catalog::WalkingLawKind;

/// The distances between the middles of pillars, meters.
const PITCH: [f64; 2] = [7.0, 8.5];
/// The side of a pillar, meters.
const PILLAR: f64 = 0.8;
/// The agents of a bay: columns and rows, at 4.7 P/m².
const AGENTS: [u32; 2] = [12, 13];
/// The rectangle in which they start, around the middle of the bay, meters.
const START: [f64; 2] = [5.4, 6.2];
/// The width of the door, and the side of the lobby behind it, meters.
const DOOR: f64 = 6.0;
const LOBBY: f64 = 24.0;

/// A hall of `columns` × `rows` bays of 156 agents, with a pillar on the left of each, after `frames` frames. All
/// agents walk to one goal, in a lobby behind a door, under a walking law.
///
/// # Errors
/// The simulation fails.
pub fn settled(
    [columns, rows]: [u32; 2],
    frames: u64,
    walking_law: WalkingLawKind,
) -> Result<Simulation, LabError> {
    let mut document = scenario(columns, rows);
    document["parameters"] = json!({ "walking_law": walking_law });
    let text = document.to_string();
    let parsed = Scenario::parse(&text, "hall", &[]);
    let scenario = parsed.map_err(|error| LabError::of("hall", error))?;
    let mut simulation = Simulation::new(scenario.scene).map_err(failed)?;
    ms_per_frame(&mut simulation, frames)?;
    Ok(simulation)
}

fn scenario(columns: u32, rows: u32) -> Value {
    let [width, height] = [PITCH[0] * f64::from(columns), PITCH[1] * f64::from(rows)];
    let (middle, right) = (0.5 * height, width + 1.0);
    let [low, high] = [-0.5, 0.5].map(|side| middle + side * DOOR);
    let [bottom, top] = [-0.5, 0.5].map(|side| middle + side * LOBBY);
    let walkable = json!([
        [0.0, 0.0],
        [width, 0.0],
        [width, low],
        [right, low],
        [right, bottom],
        [right + LOBBY, bottom],
        [right + LOBBY, top],
        [right, top],
        [right, high],
        [width, high],
        [width, height],
        [0.0, height]
    ]);
    let places = (0..columns).flat_map(|x| (0..rows).map(move |y| [x, y].map(f64::from)));
    let bays: Vec<[f64; 2]> = places.collect();
    let around = |[x, y]: [f64; 2], place: [f64; 2], size: [f64; 2]| {
        let middle = [(x + place[0]) * PITCH[0], (y + place[1]) * PITCH[1]];
        let end = |side: f64| [0, 1].map(|k| middle[k] + side * size[k]);
        [end(-0.5), end(0.5)]
    };
    let pillar = |&bay: &[f64; 2]| {
        let [[x0, y0], [x1, y1]] = around(bay, [0.1, 0.5], [PILLAR; 2]);
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    };
    let grid = |&bay: &[f64; 2]| {
        let [min, max] = around(bay, [0.6, 0.5], START);
        json!({
            "min": min, "max": max, "columns": AGENTS[0], "rows": AGENTS[1], "jitter": 0.05,
            "goal": [right + 0.5 * LOBBY, middle], "remove_within": 1.0
        })
    };
    json!({
        "duration_secs": 60, "profile": "sph", "walkable_area": [[walkable]],
        "obstacles": bays.iter().map(pillar).collect::<Vec<_>>(),
        "grids": bays.iter().map(grid).collect::<Vec<_>>()
    })
}
