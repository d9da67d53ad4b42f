//! Lifts and escalators of buildings.

use std::collections::{BTreeMap, BTreeSet};

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use serde_json::{Value, json};

use crate::common::buildings::{each, each_of, read, refused, tower};

/// The number of random buildings.
const RANDOM_BUILDINGS: u64 = 60;
/// The end of the longest runs, frames.
const LONGEST: u32 = 100_000;

#[test]
fn people_who_cannot_walk_down_take_the_lift() {
    let scenario = read(&tower());
    // The stops of lifts count as used places.
    assert_eq!(scenario.notes, [""; 0]);
    // For each change of a level of a person: the time step, and the place before and after it.
    let mut last = BTreeMap::new();
    let mut rides = Vec::new();
    let mut frame = 0;
    let mut present = BTreeSet::new();
    let out = each(&scenario, |id, place, level| {
        if !present.insert(id) {
            present = BTreeSet::from([id]);
            frame += 1;
        }
        let before = last.insert(id, (place, level.to_owned()));
        if let Some((from, old)) = before.filter(|(_, old)| old != level) {
            rides.push((frame, id, old, level.to_owned(), (from, place)));
        }
    });
    assert_eq!(out, 20);
    // Everybody rides once, in the cabin, at most six in a ride.
    assert_eq!(rides.len(), 20);
    let mut sizes: BTreeMap<u64, usize> = BTreeMap::new();
    for (frame, id, _, to, (from, place)) in &rides {
        assert_eq!(to, "ground");
        assert!(
            (from - place).norm() < 0.1,
            "person {id} jumps from {from} to {place}"
        );
        for p in [from, place] {
            assert!(p.x > 4.9 && p.x < 7.1 && p.y > 7.9 && p.y < 10.1, "{p}");
        }
        *sizes.entry(*frame).or_default() += 1;
    }
    assert!(sizes.values().all(|&size| size <= 6), "{sizes:?}");
    // A ride from the second floor takes 2 · 2 s for the doors and 8 s for 8 m, and so does the way back.
    let frames: Vec<u64> = sizes.keys().copied().collect();
    let least = 2.0 * (4.0 + 4.0) / 0.02;
    for pair in frames.windows(2) {
        assert!((pair[1] - pair[0]) as f64 >= least, "{frames:?}");
    }
}

/// Storeys above each other that only lifts join, each of which stops at some of them. Each building has one exit.
fn random(rng: &mut ChaCha8Rng) -> Value {
    let storeys = rng.random_range(2..=5);
    let count = rng.random_range(1..=3);
    let cabin = [rng.random_range(1.4..2.4), rng.random_range(1.4..2.4)];
    // Lift k lies behind the rear wall, 5 m to the right of the one before.
    let corner = |k: usize| [1.0 + 5.0 * k as f64, 8.0];
    let mut floor = vec![[0.0, 0.0], [16.0, 0.0], [16.0, 8.0]];
    for k in (0..count).rev() {
        let [x, y] = corner(k);
        let [width, depth] = cabin;
        floor.extend([
            [x + width, y],
            [x + width, y + depth],
            [x, y + depth],
            [x, y],
        ]);
    }
    floor.push([0.0, 8.0]);
    let out = rng.random_range(0..storeys);
    let name = |storey: usize| format!("storey {storey}");
    let mut heights = vec![0.0];
    for _ in 1..storeys {
        heights.push(heights.last().unwrap() + rng.random_range(2.5..5.0));
    }
    // The first lift stops everywhere, others at some storeys.
    let mut areas = Vec::new();
    let lifts: Vec<Value> = (0..count)
        .map(|k| {
            let [x, y] = corner(k);
            let [width, depth] = cabin;
            let there = (0..storeys).filter(|_| k == 0 || rng.random_bool(0.8));
            let mut there: Vec<usize> = there.collect();
            if there.len() < 2 {
                there = vec![0, 1];
            }
            let stop = |storey: &usize| format!("before {k} on {storey}");
            for storey in &there {
                areas.push(json!({
                    "name": stop(storey), "level": name(*storey),
                    "area": [[x - 0.8, y - 3.0], [x + 3.2, y - 3.0], [x + 3.2, y - 1.0], [x - 0.8, y - 1.0]],
                }));
            }
            json!({
                "name": format!("lift {k}"), "capacity": rng.random_range(1..=5),
                "cabin": [[x, y], [x + width, y], [x + width, y + depth], [x, y + depth]],
                "stops": there.iter().map(stop).collect::<Vec<_>>(),
                "speed": rng.random_range(0.5..3.0), "door_secs": rng.random_range(0.0..4.0),
            })
        })
        .collect();
    let levels: Vec<Value> = (0..storeys)
        .map(|k| json!({"name": name(k), "elevation": heights[k], "walkable_area": [[floor]]}))
        .collect();
    let crowds: Vec<Value> = (0..storeys)
        .map(|k| {
            let number = rng.random_range(1..=6);
            json!({"level": name(k), "area": [[1, 1], [15, 1], [15, 4], [1, 4]], "number": number,
                   "uses_stairs": rng.random_bool(0.5)})
        })
        .collect();
    // With RVO people can stop before a narrow cabin.
    let profile = ["steer+sph", "sph", "walk+sph", "sf->sph"][rng.random_range(0..4)];
    json!({
        "profile": profile,
        "duration_secs": 3000,
        "levels": levels, "waiting_areas": areas, "lifts": lifts, "crowds": crowds,
        "exits": [{"name": "out", "level": name(out), "line": [[0, 2], [0, 3.5]]}],
        "stop": {"when_empty": true},
    })
}

#[test]
fn everybody_gets_out_of_random_buildings_by_lifts_and_changes_levels_in_cabins_only() {
    (0..RANDOM_BUILDINGS).into_par_iter().for_each(|seed| {
        let document = random(&mut ChaCha8Rng::seed_from_u64(seed));
        let scenario = read(&document);
        let people = scenario.scene.agents.len();
        let mut last: BTreeMap<u32, (Vector, String)> = BTreeMap::new();
        let left = each_of(&scenario, LONGEST, |id, p, level| {
            let Some((before, old)) = last.insert(id, (p, level.to_owned())) else {
                return;
            };
            let step = (p - before).norm();
            assert!(step < 0.1, "{seed}: {id} jumps by {step} m at {p}");
            let in_cabin = |lift: &Value| {
                let [low, high] = [0, 2].map(|k| {
                    let corner = &lift["cabin"][k];
                    Vector::new(corner[0].as_f64().unwrap(), corner[1].as_f64().unwrap())
                });
                let margin = 0.1;
                p.x > low.x - margin
                    && p.x < high.x + margin
                    && p.y > low.y - margin
                    && p.y < high.y + margin
            };
            let mut lifts = document["lifts"].as_array().unwrap().iter();
            assert!(
                old == level || lifts.any(in_cabin),
                "{seed}: {id} at {p} from {old} to {level}"
            );
        });
        assert_eq!(left, people, "{seed}: {document}");
    });
}

#[test]
fn rides_are_the_same_on_any_number_of_threads_and_when_resumed() {
    let scenario = read(&tower());
    let digest = |frames: u64, saved_at: Option<u64>, threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut simulation = Simulation::new(scenario.scene.clone()).unwrap();
            for frame in 0..frames {
                if Some(frame) == saved_at {
                    let state = postcard::to_stdvec(&simulation.state()).unwrap();
                    let state = postcard::from_bytes(&state).unwrap();
                    simulation = Simulation::resumed(scenario.scene.clone(), state).unwrap();
                }
                simulation.step().unwrap();
            }
            simulation.digest()
        })
    };
    let whole = digest(3000, None, 1);
    assert_eq!(digest(3000, None, 3), whole);
    for saved_at in [501, 1203, 2404] {
        assert_eq!(
            digest(3000, Some(saved_at), 2),
            whole,
            "saved at {saved_at}"
        );
    }
}

#[test]
fn people_who_may_not_use_stairs_take_the_lift_and_others_the_stairs() {
    let mut document = tower();
    let levels = document["levels"].as_array_mut().unwrap();
    levels.truncate(2);
    levels.push(
        json!({"name": "stairs", "kind": "stairs", "walkable_area": [[[
            [12, 3], [18, 3], [18, 4.5], [12, 4.5],
        ]]]}),
    );
    levels.push(
        json!({"name": "landing", "elevation": 4, "walkable_area": [[[
            [18, 3], [20, 3], [20, 7], [18, 7],
        ]]]}),
    );
    levels.push(
        json!({"name": "bridge", "elevation": 4, "walkable_area": [[[
            [12, 5.5], [18, 5.5], [18, 7], [12, 7],
        ]]]}),
    );
    document["joins"] = json!([
        {"levels": ["ground", "stairs"], "line": [[12, 3], [12, 4.5]]},
        {"levels": ["stairs", "landing"], "line": [[18, 3], [18, 4.5]]},
        {"levels": ["landing", "bridge"], "line": [[18, 5.5], [18, 7]]},
        {"levels": ["bridge", "first floor"], "line": [[12, 5.5], [12, 7]]},
    ]);
    document["waiting_areas"]
        .as_array_mut()
        .unwrap()
        .truncate(2);
    document["lifts"][0]["stops"] = json!(["lift, ground", "lift, first"]);
    document["crowds"] = json!([
        {"name": "walkers", "level": "first floor", "area": [[1, 1], [11, 1], [11, 2], [1, 2]], "number": 6},
        {"name": "wheelchairs", "level": "first floor", "area": [[1, 3], [11, 3], [11, 4], [1, 4]], "number": 4,
         "uses_stairs": false},
    ]);
    let scenario = read(&document);
    let mut seen: BTreeMap<u32, BTreeSet<String>> = BTreeMap::new();
    let out = each(&scenario, |id, _, level| {
        seen.entry(id).or_default().insert(level.to_owned());
    });
    assert_eq!(out, 10);
    for (id, levels) in seen {
        assert_eq!(
            levels.contains("stairs"),
            id < 6,
            "person {id} was on {levels:?}"
        );
        assert!(levels.contains("ground"));
    }
    // Without the lift they have no way.
    document["lifts"] = json!([]);
    let problem = refused(&document);
    assert!(problem.contains("crowds[1].uses_stairs"), "{problem}");
    assert!(
        problem.contains("no way without stairs leads from `first floor` to an exit"),
        "{problem}"
    );
}

#[test]
fn journeys_name_the_level_to_which_a_lift_goes() {
    let mut document = tower();
    document["crowds"] = json!([
        {"level": "ground", "area": [[1, 1], [3, 1], [3, 3], [1, 3]], "number": 3, "journey": "up and down"},
    ]);
    document["journeys"] = json!([{"name": "up and down", "stages": [
        {"lifts": ["lift"], "to": "second floor"}, "shop", {"lifts": ["lift"], "to": "ground"}, "street",
    ]}]);
    document["waypoints"] = json!([{"name": "shop", "level": "second floor", "at": [2, 2]}]);
    let scenario = read(&document);
    let mut seen: BTreeMap<u32, Vec<String>> = BTreeMap::new();
    let out = each(&scenario, |id, _, level| {
        let levels = seen.entry(id).or_default();
        if levels.last().is_none_or(|last| last != level) {
            levels.push(level.to_owned());
        }
    });
    assert_eq!(out, 3);
    for levels in seen.values() {
        assert_eq!(levels, &["ground", "second floor", "ground"]);
    }
}

#[test]
fn wrong_lifts_are_refused_with_their_place_and_what_to_do() {
    let change = |pointer: &str, value: Value| {
        let mut document = tower();
        *document.pointer_mut(pointer).unwrap() = value;
        refused(&document)
    };
    let cases = [
        (
            "/lifts/0/cabin",
            json!([[5, 8], [7, 8], [7, 10.5], [5, 10.5]]),
            "lifts[0].cabin: must lie on the floor of each",
        ),
        (
            "/lifts/0/stops",
            json!(["lift, ground", "lift"]),
            "lifts[0].stops[1]: there is no place named `lift`",
        ),
        (
            "/lifts/0/stops",
            json!(["lift, ground", "street"]),
            "lifts[0].stops[1]: `street` is no waiting area",
        ),
        (
            "/lifts/0/stops",
            json!(["lift, ground", "lift, ground"]),
            "has one stop on `ground`",
        ),
        (
            "/lifts/0/capacity",
            json!(60),
            "lifts[0].capacity: a cabin of 4 m² takes at most",
        ),
        (
            "/waiting_areas/0/area",
            json!([[4, 5], [8, 5], [8, 9], [4, 9]]),
            "the waiting area reaches into the cabin",
        ),
        ("/lifts/0/name", json!("x"), "x"),
    ];
    for (pointer, value, wanted) in &cases[..6] {
        let problem = change(pointer, value.clone());
        assert!(problem.contains(wanted), "{pointer}: {problem}");
    }
    let mut document = tower();
    document["journeys"] = json!([{"name": "j", "stages": [{"lifts": ["lift"], "to": "roof"}]}]);
    assert!(
        refused(&document).contains("journeys[0].stages[0].to: there is no level named `roof`")
    );
    document["journeys"] = json!([{"name": "j", "stages": [{"lifts": ["lft"], "to": "ground"}]}]);
    assert!(refused(&document).contains("there is no lift named `lft`"));
    document["journeys"] = json!([{"name": "j", "stages": [{"lifts": ["lift"]}]}]);
    assert!(refused(&document).contains("give `lifts` and `to`"));
}

/// A house with an escalator from the ground floor to the upper floor.
fn escalator(runs: &str) -> Value {
    json!({
        "profile": "steer+sph",
        "duration_secs": 200,
        "levels": [
            {"name": "ground", "elevation": 0, "walkable_area": [[[[0, 0], [10, 0], [10, 6], [0, 6]]]]},
            {"name": "escalator", "kind": "escalator", "runs": runs, "belt_speed": 0.5,
             "walkable_area": [[[[10, 2], [18, 2], [18, 3.2], [10, 3.2]]]]},
            {"name": "upper", "elevation": 4, "walkable_area": [[[[18, 0], [26, 0], [26, 6], [18, 6]]]]},
        ],
        "joins": [
            {"levels": ["ground", "escalator"], "line": [[10, 2], [10, 3.2]]},
            {"levels": ["escalator", "upper"], "line": [[18, 2], [18, 3.2]]},
        ],
        "crowds": [{"level": "ground", "area": [[1, 1], [8, 1], [8, 5], [1, 5]], "number": 20}],
        "exits": [{"name": "door", "level": "upper", "line": [[26, 2], [26, 4]]}],
        "stop": {"when_empty": true},
    })
}

#[test]
fn an_escalator_carries_standing_people_at_the_speed_of_its_steps() {
    let scenario = read(&escalator("up"));
    let mut spans: BTreeMap<u32, [u64; 2]> = BTreeMap::new();
    let (mut frame, mut present) = (0, BTreeSet::new());
    let out = each(&scenario, |id, place, level| {
        if !present.insert(id) {
            present = BTreeSet::from([id]);
            frame += 1;
        }
        if level == "escalator" && (12.0..17.0).contains(&place.x) {
            let span = spans.entry(id).or_insert([frame, frame]);
            span[1] = frame;
        }
    });
    assert_eq!(out, 20);
    assert_eq!(spans.len(), 20);
    // 5 m seen from above, on a slope of 1 in 2.
    let expected = 5.0 / (0.5 / 1.25_f64.sqrt());
    for [from, to] in spans.values() {
        let took = (to - from) as f64 * 0.02;
        assert!(
            (took - expected).abs() < 0.15 * expected,
            "{took} s instead of {expected} s"
        );
    }
}

#[test]
fn an_escalator_leads_in_one_direction() {
    let problem = refused(&escalator("down"));
    assert!(
        problem.contains("one-way doors on every way lead only away from it"),
        "{problem}"
    );
    let mut document = escalator("up");
    document["levels"][1]
        .as_object_mut()
        .unwrap()
        .remove("runs");
    assert!(refused(&document).contains("an escalator `runs` `up` or `down`: say which"));
    let mut document = escalator("up");
    document["levels"][0]["belt_speed"] = json!(0.5);
    assert!(refused(&document).contains("are for levels of the kind `escalator`"));
}
