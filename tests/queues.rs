//! Queues.

use sandbox::engine::journeys::Status;
use sandbox::engine::simulation::Simulation;
use serde_json::{Value, json};

use crate::common::simulated::{after, go_on, measured, scenario};

/// A room of 20 × 10 m with an exit in its right wall and a queue along `path` before it.
fn room<const N: usize>(path: [[i32; 2]; N]) -> Value {
    json!({
        "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
        "exits": [{"name": "east", "line": [[20, 4], [20, 6]]}],
        "queues": [{"name": "till", "path": path.as_slice(), "service_secs": 3}],
        "journeys": [{"name": "buy", "stages": ["till", "east"]}],
    })
}

#[test]
fn a_queue_serves_in_order_of_arrival_with_its_rate() {
    let mut document = room([[16, 8], [9, 8], [9, 2]]);
    document["grids"] =
        json!([{"min": [1, 2], "max": [4, 8], "columns": 3, "rows": 5, "journey": "buy"}]);
    let mut simulation = after(&document, &[], 25.0);
    let tickets = |simulation: &Simulation| -> Vec<(u32, f64)> {
        let agents = simulation.frame().agents;
        let queued = agents.trip.iter().zip(&agents.position);
        let mut queued: Vec<(u32, f64)> = queued
            .filter_map(|(trip, p)| match trip.as_ref()?.status {
                Status::Queued { ticket, .. } => Some((ticket, p.x)),
                _ => None,
            })
            .collect();
        queued.sort_by_key(|&(ticket, _)| ticket);
        queued
    };
    let queued = tickets(&simulation);
    assert!(queued.len() >= 6, "{queued:?}");
    // They stand half a meter apart along the path, the first at its front.
    assert!((queued[0].1 - 16.0).abs() < 0.4, "{queued:?}");
    for pair in queued[..6].windows(2) {
        assert!((0.3..0.7).contains(&(pair[0].1 - pair[1].1)), "{queued:?}");
    }
    go_on(&mut simulation, 80.0);
    let times: Vec<f64> = simulation
        .outcome()
        .arrivals
        .iter()
        .map(|a| a.time)
        .collect();
    assert_eq!(times.len(), 15);
    let mean = (times[14] - times[0]) / 14.0;
    assert!((3.0..4.5).contains(&mean), "{mean} s per agent");
}

#[test]
fn a_queue_that_is_too_long_for_its_room_gathers_at_its_end() {
    // 30 people for a queue with room for seven: a wall stands 1 m behind its path.
    let document = json!({
        "walkable_area": [[[[0, 0], [12, 0], [12, 6], [6, 6], [6, 2], [4, 2], [4, 6], [0, 6]]]],
        "exits": [{"name": "east", "line": [[12, 4], [12, 5]]}],
        "queues": [{"name": "till", "path": [[9, 4], [7, 4]], "service_secs": 3}],
        "journeys": [{"name": "buy", "stages": ["till", "east"]}],
        "crowds": [{"area": [[0, 2], [4, 2], [4, 6], [0, 6]], "number": 30, "journey": "buy"}],
    });
    let simulation = after(&document, &[], 110.0);
    let places = simulation.progress().places.iter();
    let passed: Vec<u32> = places.map(|place| place.passed).collect();
    assert_eq!(passed, [30, 30]);
}

#[test]
fn a_queue_through_a_wall_is_refused() {
    let mut document = room([[16, 8], [9, 8], [9, 2]]);
    document["obstacles"] = json!([[[8, 4], [10, 4], [10, 5], [8, 5]]]);
    let message = scenario(&document, &[]).unwrap_err();
    let expected = "f.json: queues[0].path[1]: a wall stands between this point and the next; \
                    lead the path around it";
    assert_eq!(message, expected);
}

/// The mean delay of agents that walk 2 m to the end of a queue of `length` meters, which leads on to an exit; the path
/// turns half way if `turns`.
fn delay(length: f64, turns: bool, positions: &[[f64; 2]]) -> f64 {
    let corner = match turns {
        true => json!([
            [25, 5],
            [25.0 - 0.5 * length, 5],
            [25.0 - 0.5 * length, 5.0 + 0.5 * length]
        ]),
        false => json!([[25, 5], [25.0 - length, 5]]),
    };
    let agents: Vec<Value> = positions
        .iter()
        .map(|[x, y]| json!({"position": [x, y], "journey": "buy"}))
        .collect();
    let summary = measured(json!({
        "profile": "walk+sph", "duration_secs": 600, "stop": {"when_empty": true},
        "walkable_area": [[[[0, 0], [30, 0], [30, 20], [0, 20]]]],
        "exits": [{"name": "east", "line": [[30, 4], [30, 6]]}],
        "queues": [{"name": "till", "path": corner, "service_secs": 3}],
        "journeys": [{"name": "buy", "stages": ["till", "east"]}],
        "agents": agents,
        "measurements": [{"egress": {}}],
    }));
    summary.metric("delay_secs").unwrap()
}

#[test]
fn the_walk_along_an_empty_queue_is_no_delay() {
    let alone = |length: f64| delay(length, false, &[[23.0 - length, 5.0]]);
    let delays = [5.0, 10.0, 17.0].map(alone);
    for secs in delays {
        assert!((2.5..3.5).contains(&secs), "{delays:?}");
        assert!((secs - delays[0]).abs() < 0.3, "{delays:?}");
    }
    let around = [5.0, 10.0, 17.0].map(|length| {
        let start = [25.0 - 0.5 * length, 7.0 + 0.5 * length];
        delay(length, true, &[start])
    });
    for secs in around {
        assert!((secs - delays[0]).abs() < 0.3, "{around:?}");
    }
}
