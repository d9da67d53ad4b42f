//! Random busy scenes: a hall in which people enter, wait, queue, choose, are pushed and leave, all within seconds.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

/// The profiles of busy scenes: those of the paper, one with a walking law, and one that changes with the density.
const PROFILES: [&str; 8] = [
    "sf", "rvo", "sf+sph", "sph", "sf->sph", "rvo->sph", "walk+sph", "rvo+sph",
];

/// Any of the values.
pub fn one<T: Clone>(rng: &mut ChaCha8Rng, values: &[T]) -> T {
    values[rng.random_range(0..values.len())].clone()
}

/// A hall of 30 m × 12 m with two walls, exits, waypoints, a waiting area, a queue, zones and events, with 20 to
/// `most` agents from the first frame on, and more that enter.
pub fn hall(rng: &mut ChaCha8Rng, most: u32) -> Value {
    let agents = rng.random_range(20..=most);
    let left = agents / 2;
    let journeys = ["one", "two", "three"];
    let profiles = [(); 2].map(|()| one(rng, &PROFILES));
    let service = one(
        rng,
        &[
            json!(0.4),
            json!({"exponential": 0.5}),
            json!({"uniform": [0.1, 1]}),
        ],
    );
    let arrivals = one(rng, &["constant", "poisson"]);
    let mut exit = json!({"name": "east", "line": [[30, 2], [30, 4]]});
    if rng.random() {
        exit["most_per_sec"] = json!(rng.random_range(0.5..4.0));
    }
    let from = rng.random_range(0.0..3.0);
    let people = (0..6).map(|k| {
        let enters = f64::from(k) * rng.random_range(0.0..1.0);
        [f64::from(k), enters, 9.8 + f64::from(k), 11.2, 1.0, 0.0]
    });
    let people: Vec<[f64; 6]> = people.collect();
    let mut hall = json!({
        "name": "hall", "seed": rng.random_range(0..1000), "duration_secs": 60, "profile": profiles[0],
        "walkable_area": [[[[0, 0], [30, 0], [30, 12], [0, 12]]]],
        "obstacles": [[[9, 0], [9.3, 0], [9.3, 8], [9, 8]], [[20, 4], [20.3, 4], [20.3, 12], [20, 12]]],
        "exits": [exit, {"name": "north", "line": [[22, 12], [24, 12]], "closed_secs": [[from, from + 1.0]]}],
        "waypoints": [{"name": "gap", "line": [[9.3, 8.3], [9.3, 11.7]]},
                      {"name": "spot", "at": [15, 8], "within": 1.5}],
        "waiting_areas": [{"name": "pit", "area": [[11, 1], [18, 1], [18, 6], [11, 6]],
                           "for_secs": {"exponential": 1}}],
        "queues": [{"name": "till", "path": [[18, 10], [11, 10], [11, 7]], "servers": rng.random_range(1..4),
                    "service_secs": service}],
        "zones": [{"name": "slow", "area": [[20.5, 0], [25, 0], [25, 12], [20.5, 12]],
                   "speed_factor": rng.random_range(0.3..1.5)}],
        "journeys": journeys.map(|name| json!({"name": name, "stages": stages(rng)})),
        "crowds": [
            {"area": [[0.5, 0.5], [8.5, 0.5], [8.5, 11.5], [0.5, 11.5]], "number": left, "journey": one(rng, &journeys),
             "premovement_secs": {"uniform": [0, 3]}, "preferred_speed": {"uniform": [0.8, 1.8]}},
            {"area": [[10, 0.5], [19.5, 0.5], [19.5, 11], [10, 11]], "number": agents - left,
             "journey": one(rng, &journeys), "profile": profiles[1]},
            {"area": [[25, 6], [29, 6], [29, 11], [25, 11]], "number": 8, "goal": [29, 1], "remove_within": 1},
        ],
        "entrances": [{"name": "west", "line": [[0, 2], [0, 10]], "per_sec": rng.random_range(1.0..20.0),
                       "arrivals": arrivals, "journey": one(rng, &journeys)}],
        "sources": [{"min": [25, 6], "max": [28, 8], "columns": 3, "rows": 2, "every_secs": 0.7, "times": 5,
                     "start_secs": rng.random_range(0.0..2.0), "journey": one(rng, &journeys)}],
        "from": {"people": people, "journey": one(rng, &journeys)},
        "events": [{"at_secs": rng.random_range(0.0..5.0), "release": "pit"},
                   {"at_secs": rng.random_range(0.0..4.0), "for_secs": 0.6, "region": [[2, 2], [15, 9]],
                    "goal_scale": 3, "ignore_contact": true}],
    });
    if rng.random() {
        hall["route_choice"] = json!("quickest");
        hall["knowledge"] = json!(one(rng, &["floor", "sight"]));
    }
    if rng.random() {
        let closed = [from, from + 1.5];
        hall["doors"] = json!([{"name": "door", "line": [[20.15, 0], [20.15, 4]], "closed_secs": [closed]},
                               {"name": "valve", "line": [[9.15, 8], [9.15, 12]], "one_way": [1, 0]}]);
    }
    hall
}

/// One to three stages, of which the last are exits.
fn stages(rng: &mut ChaCha8Rng) -> Vec<Value> {
    let places = ["gap", "spot", "pit", "till"];
    let mut stages: Vec<Value> = Vec::new();
    for _ in 0..rng.random_range(1..3) {
        let (a, b) = (one(rng, &places), one(rng, &places));
        stages.push(if a == b { json!(a) } else { choice(rng, a, b) });
    }
    stages.push(choice(rng, "east", "north"));
    stages
}

fn choice(rng: &mut ChaCha8Rng, a: &str, b: &str) -> Value {
    match rng.random_range(0..4) {
        0 => json!({"nearest": [a, b]}),
        1 => json!({"quickest": [a, b]}),
        2 => json!({"fewest": [a, b]}),
        _ => json!({"shares": {a: 1, b: rng.random_range(0.5..2.0)}}),
    }
}

/// A corridor without end.
pub fn ring(rng: &mut ChaCha8Rng) -> Value {
    json!({
        "name": "ring", "seed": rng.random_range(0..1000), "duration_secs": 60, "profile": one(rng, &PROFILES),
        "periodic": {"axis": "x", "length": 20}, "walkable_area": [[[[0, 0], [20, 0], [20, 4], [0, 4]]]],
        "grids": [{"min": [0, 0.3], "max": [20, 3.7], "columns": rng.random_range(15..35), "rows": 5, "jitter": 0.05,
                   "preferred_speed": {"uniform": [0.8, 1.8]}}],
    })
}
