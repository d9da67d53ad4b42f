//! Houses of two floors, and runs of buildings.

use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

/// A house of two floors with a flight of stairs, in which people upstairs walk to the street.
pub fn house() -> Value {
    json!({
        "profile": "steer+sph",
        "duration_secs": 120,
        "levels": [
            {"name": "ground", "elevation": 0, "walkable_area": [[[[0, 0], [10, 0], [10, 6], [0, 6]]]]},
            {"name": "stairs", "kind": "stairs", "walkable_area": [[[[10, 0], [14, 0], [14, 1.5], [10, 1.5]]]]},
            {"name": "upper", "elevation": 2.5, "walkable_area": [[[[14, 0], [20, 0], [20, 6], [14, 6]]]]},
        ],
        "joins": [
            {"levels": ["ground", "stairs"], "line": [[10, 0], [10, 1.5]]},
            {"levels": ["stairs", "upper"], "line": [[14, 0], [14, 1.5]]},
        ],
        "crowds": [{"name": "people", "level": "upper", "area": [[14, 0], [20, 0], [20, 6], [14, 6]], "number": 40}],
        "exits": [{"name": "street", "level": "ground", "line": [[0, 2], [0, 3.2]]}],
        "stop": {"when_empty": true},
    })
}

/// A house whose upper floor lies above the ground floor: the stairs turn back over it by a landing. The hall goes on
/// beside and behind the stairs.
pub fn folded() -> Value {
    json!({
        "profile": "sph",
        "duration_secs": 120,
        "levels": [
            {"name": "ground", "elevation": 0,
             "walkable_area": [[[[0, 0], [10, 0], [10, 6], [0, 6]], [[4, 2], [8, 2], [8, 3.5], [4, 3.5]]]]},
            {"name": "up", "kind": "stairs", "walkable_area": [[[[4, 2], [8, 2], [8, 3.5], [4, 3.5]]]]},
            {"name": "upper", "elevation": 3, "walkable_area": [[[[8, 0], [12, 0], [12, 6], [8, 6]]]]},
        ],
        "joins": [
            {"levels": ["ground", "up"], "line": [[4, 2], [4, 3.5]]},
            {"levels": ["up", "upper"], "line": [[8, 2], [8, 3.5]]},
        ],
        "crowds": [{"level": "upper", "area": [[8, 0], [12, 0], [12, 6], [8, 6]], "number": 30}],
        "exits": [{"name": "street", "level": "ground", "line": [[10, 4], [10, 5.2]]}],
        "stop": {"when_empty": true},
    })
}

/// Three storeys above each other that only a lift joins. It has a cabin of 2 m × 2 m behind the waiting areas.
pub fn tower() -> Value {
    let floor = json!([[[
        [0, 0],
        [12, 0],
        [12, 8],
        [7, 8],
        [7, 10],
        [5, 10],
        [5, 8],
        [0, 8],
    ]]]);
    json!({
        "profile": "steer+sph",
        "duration_secs": 600,
        "levels": [
            {"name": "ground", "elevation": 0, "walkable_area": floor},
            {"name": "first floor", "elevation": 4, "walkable_area": floor},
            {"name": "second floor", "elevation": 8, "walkable_area": floor},
        ],
        "waiting_areas": [
            {"name": "lift, ground", "level": "ground", "area": [[4, 5], [8, 5], [8, 7], [4, 7]]},
            {"name": "lift, first", "level": "first floor", "area": [[4, 5], [8, 5], [8, 7], [4, 7]]},
            {"name": "lift, second", "level": "second floor", "area": [[4, 5], [8, 5], [8, 7], [4, 7]]},
        ],
        "lifts": [{
            "name": "lift", "cabin": [[5, 8], [7, 8], [7, 10], [5, 10]], "capacity": 6,
            "stops": ["lift, ground", "lift, first", "lift, second"], "speed": 1, "door_secs": 2,
        }],
        "crowds": [
            {"level": "second floor", "area": [[1, 1], [11, 1], [11, 4], [1, 4]], "number": 15},
            {"level": "first floor", "area": [[1, 1], [11, 1], [11, 4], [1, 4]], "number": 5},
        ],
        "exits": [{"name": "street", "level": "ground", "line": [[0, 2], [0, 4]]}],
        "stop": {"when_empty": true},
    })
}

pub fn read(document: &Value) -> Scenario {
    Scenario::parse(&document.to_string(), "house.json", &[]).unwrap()
}

pub fn refused(document: &Value) -> String {
    let problem = Scenario::parse(&document.to_string(), "house.json", &[]);
    problem.unwrap_err().to_string()
}

/// Runs to the end; calls `see` with the id, the place in the building and the name of the level of every agent.
/// Returns the number of agents that have left.
pub fn each(scenario: &Scenario, see: impl FnMut(u32, Vector, &str)) -> usize {
    each_of(scenario, 15_000, see)
}

/// The same for at most this many frames.
pub fn each_of(scenario: &Scenario, frames: u32, mut see: impl FnMut(u32, Vector, &str)) -> usize {
    let levels = scenario.scene.levels.clone().unwrap();
    let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
    for _ in 0..frames {
        simulation.evaluate().unwrap();
        let agents = simulation.frame().agents;
        for (&id, &p) in agents.id.iter().zip(&agents.position) {
            see(
                id,
                levels.in_building(p),
                &levels.all()[levels.level(p)].name,
            );
        }
        if agents.is_empty() {
            break;
        }
        simulation.integrate().unwrap();
    }
    simulation.outcome().arrivals.len()
}
