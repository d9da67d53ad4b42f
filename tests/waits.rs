//! People who wait for a passage: the longest queues, recomputed from positions and speeds and the plan alone.

use std::collections::BTreeMap;

use sandbox::engine::journeys::{Kind, Status};
use sandbox::runs::drive::Run;
use sandbox::runs::summary::Summary;
use serde_json::{Value, json};

use crate::common::simulated::scenario;
use crate::common::waits::{Person, Plan, Point};

/// Numbers from 0 to 1 that depend on `state` alone.
fn random(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1);
    (*state >> 40) as f64 / (1_u64 << 24) as f64
}

/// A run, and its longest queues by what they are before, recomputed from positions and speeds in each second.
fn recomputed(document: &Value) -> (Summary, BTreeMap<String, (u32, f64)>) {
    let mut run = Run::new(scenario(document, &[]).unwrap()).unwrap();
    let points = |ring: &Value| serde_json::from_value::<Vec<Point>>(ring.clone()).unwrap();
    let obstacles = document["obstacles"].as_array();
    let doors = document["doors"].as_array().into_iter().flatten();
    let doors = doors.map(|door| {
        let line = serde_json::from_value::<[Point; 2]>(door["line"].clone()).unwrap();
        (door["name"].as_str().unwrap().to_owned(), line)
    });
    let plan = Plan {
        floor: points(&document["walkable_area"][0][0]),
        obstacles: obstacles.into_iter().flatten().map(points).collect(),
        doors: doors.collect(),
    };
    let openings = plan.openings();
    // How many seconds in a row each person was seen walking.
    let mut walked: BTreeMap<u32, u32> = BTreeMap::new();
    let mut longest: BTreeMap<String, (u32, f64)> = BTreeMap::new();
    while run.end.is_none() {
        run.simulation.evaluate().unwrap();
        run.measure();
        let frame = run.simulation.frame();
        if frame
            .clock
            .frame()
            .is_multiple_of(frame.clock.frame_at(1.0))
        {
            let (agents, scene) = (frame.agents, run.simulation.scene());
            let mut people = Vec::new();
            let mut now = BTreeMap::new();
            for i in agents.present() {
                let trip = agents.trip[i].unwrap();
                if trip.status != Status::Walking || trip.hold.is_some() {
                    continue;
                }
                let count = walked.get(&agents.id[i]).map_or(0, |count| count + 1);
                now.insert(agents.id[i], count);
                let place = &scene.journeys.places[usize::from(trip.place)];
                let Some([a, b]) = place.line() else {
                    continue;
                };
                let own = agents.preferred_speed.get(i);
                let pace = own.copied().unwrap_or(scene.preferred_speed);
                people.push(Person {
                    at: agents.position[i].into(),
                    is_slow: count >= 3 && agents.velocity[i].norm() < 0.5 * pace,
                    to: (place.name.clone(), [a.into(), b.into()]),
                });
            }
            walked = now;
            for (name, count) in plan.queues(&openings, &people) {
                let most = longest.entry(name).or_insert((0, 0.0));
                if count > most.0 {
                    *most = (count, frame.clock.time());
                }
            }
        }
        run.simulation.integrate().unwrap();
    }
    (Summary::of(&run), longest)
}

/// Checks the longest queues of a run before passages without a line of their own; returns them, the longest first.
fn check(document: &Value) -> Vec<(String, u32)> {
    let (summary, longest) = recomputed(document);
    let queues = document["queues"].as_array().into_iter().flatten();
    let lines: Vec<&str> = queues
        .map(|queue| queue["name"].as_str().unwrap())
        .collect();
    let found = summary.longest_queues.iter();
    let found = found.filter(|queue| !lines.contains(&queue.before.as_str()));
    let by_name = found
        .clone()
        .map(|queue| (queue.before.clone(), (queue.agents, queue.at_secs)));
    assert_eq!(by_name.collect::<BTreeMap<_, _>>(), longest, "{document}");
    found
        .map(|queue| (queue.before.clone(), queue.agents))
        .collect()
}

/// A room of 10 m × 10 m with `people`, a wall of 0.2 m with a gap of `width`, and an exit in the last wall of a room
/// of
/// `depth` meters behind it.
fn two_rooms(people: u32, width: f64, depth: f64) -> Value {
    let [low, high] = [5.0 - 0.5 * width, 5.0 + 0.5 * width];
    let end = 10.2 + depth;
    json!({
        "profile": "steer+sph", "seed": 1, "duration_secs": 15,
        "walkable_area": [[[[0, 0], [10, 0], [10, low], [10.2, low], [10.2, 0], [end, 0], [end, 10], [10.2, 10],
                            [10.2, high], [10, high], [10, 10], [0, 10]]]],
        "exits": [{"name": "e", "line": [[end, 1], [end, 9]]}],
        "crowds": [{"area": [[0.5, 0.5], [9, 0.5], [9, 9.5], [0.5, 9.5]], "number": people}],
    })
}

#[test]
fn a_crowd_before_an_opening_is_its_queue_wherever_the_exit_lies() {
    // 150 people before 1.2 m: with the exit in the opening, 124 were counted; 6 m behind it, none.
    for (width, depth) in [(1.2, 6.0), (1.0, 5.0), (1.0, 10.0)] {
        let queues = check(&two_rooms(150, width, depth));
        let (before, agents) = &queues[0];
        assert_eq!(before, "the opening at (10, 5)");
        assert!((115..=140).contains(agents), "{queues:?}");
    }
    for behind in [0.2, 2.0] {
        let mut document = two_rooms(150, 1.0, 6.0);
        let x = 10.2 + behind;
        document["exits"][0]["line"] = json!([[x, 0], [x, 10]]);
        let queues = check(&document);
        let longest = &queues[0];
        assert!(
            longest.0 == "e" && (115..=140).contains(&longest.1),
            "{queues:?}"
        );
    }
}

#[test]
fn a_crowd_before_a_closed_door_is_its_queue() {
    let mut document = two_rooms(40, 2.0, 9.8);
    document["doors"] =
        json!([{"name": "gate", "line": [[10.1, 4], [10.1, 6]], "closed_secs": [[0, 60]]}]);
    document["duration_secs"] = json!(25);
    assert_eq!(check(&document), [("gate".to_owned(), 40)]);
}

/// Random scenes: a hall, and what lies between it and the exit.
fn scene(kind: u32, seed: u64) -> Value {
    let mut state = 100 * seed + u64::from(kind) + 1;
    for _ in 0..5 {
        random(&mut state);
    }
    let people = 30 + (50.0 * random(&mut state)) as u32;
    let width = 0.8 + 0.6 * random(&mut state);
    let mut document = two_rooms(people, width, 3.5 + 6.0 * random(&mut state));
    document["seed"] = json!(seed);
    let line = [[10.1, 5.0 - 0.5 * width], [10.1, 5.0 + 0.5 * width]];
    let jamb = [4.0 + random(&mut state), 5.5 + random(&mut state)];
    match kind {
        0 => document["doors"] = json!([{"name": "d", "line": line}]),
        1 => {} // an undeclared opening
        2 => document["doors"] = json!([{"name": "d", "line": line, "closed_secs": [[0, 8]]}]),
        3 => {
            // The exit lies in the opening.
            document["exits"][0]["line"] = json!([[10.2, line[0][1]], [10.2, line[1][1]]]);
            document["walkable_area"] = json!([[[
                [0, 0],
                [10, 0],
                [10, line[0][1]],
                [10.2, line[0][1]],
                [10.2, line[1][1]],
                [10, line[1][1]],
                [10, 10],
                [0, 10]
            ]]]);
        }
        4 => document["exits"][0]["line"] = json!([[13.0, 0.0], [13.0, 10.0]]),
        // Two rooms in series: a second wall in the hall.
        5 => {
            document["obstacles"] = json!([
                [[6, 0], [6.3, 0], [6.3, jamb[0]], [6, jamb[0]]],
                [[6, jamb[1]], [6.3, jamb[1]], [6.3, 10], [6, 10]]
            ]);
            document["crowds"][0]["area"] = json!([[0.5, 0.5], [5.5, 0.5], [5.5, 9.5], [0.5, 9.5]]);
        }
        // Pillars in the hall.
        6 => {
            let pillar = |x: f64, y: f64| [[x, y], [x + 0.4, y], [x + 0.4, y + 0.4], [x, y + 0.4]];
            document["obstacles"] = json!([
                pillar(7.0, 2.6),
                pillar(7.3, jamb[1]),
                pillar(8.0, jamb[0] - 0.7)
            ]);
            document["crowds"][0]["area"] = json!([[0.5, 0.5], [6.5, 0.5], [6.5, 9.5], [0.5, 9.5]]);
        }
        // A wall between the opening and the exit: people turn around its end.
        7 => {
            document["obstacles"] = json!([[[11.5, 1.5], [11.7, 1.5], [11.7, 10], [11.5, 10]]]);
            document["exits"][0]["line"] = json!([[12.9, 0], [12.9, 10]]);
        }
        // A second exit in the hall.
        8 => {
            let exits = document["exits"].as_array_mut().unwrap();
            exits.push(json!({"name": "side", "line": [[0.0, 7.0], [0.0, 8.0]]}));
        }
        // A waypoint line behind the opening.
        9 => {
            document["waypoints"] = json!([{"name": "w", "line": [[11.5, 3], [11.5, 7]]}]);
            document["journeys"] = json!([{"name": "j", "stages": ["w", "e"]}]);
            document["crowds"][0]["journey"] = json!("j");
        }
        // Two openings in one wall.
        10 => {
            document["obstacles"] = json!([
                [[6, 0], [6.3, 0], [6.3, 2], [6, 2]],
                [[6, 3], [6.3, 3], [6.3, 7], [6, 7]],
                [[6, 8.2], [6.3, 8.2], [6.3, 10], [6, 10]]
            ]);
            document["crowds"][0]["area"] = json!([[0.5, 0.5], [5.5, 0.5], [5.5, 9.5], [0.5, 9.5]]);
        }
        // People who queue on a line behind the opening.
        _ => {
            document["queues"] =
                json!([{"name": "till", "path": [[12, 5], [12, 9]], "service_secs": 1}]);
            document["journeys"] = json!([{"name": "j", "stages": ["till", "e"]}]);
            document["crowds"][0]["journey"] = json!("j");
        }
    }
    document
}

#[test]
fn the_longest_queues_follow_from_positions_and_the_plan() {
    for kind in 0..6 {
        for seed in 0..2 {
            check(&scene(kind, seed));
        }
    }
}

/// These kinds were written after the definition was fixed.
#[test]
fn the_longest_queues_of_other_scenes_follow_from_positions_and_the_plan() {
    for kind in 6..11 {
        for seed in 0..2 {
            check(&scene(kind, seed));
        }
    }
}

#[test]
fn people_outside_of_the_line_of_a_queue_are_counted_with_their_times() {
    // A line for four people in a room for forty.
    let mut document = scene(11, 3);
    document["queues"][0] =
        json!({"name": "till", "path": [[12, 8], [12, 9.4]], "service_secs": 4});
    document["duration_secs"] = json!(40);
    let mut run = Run::new(scenario(&document, &[]).unwrap()).unwrap();
    let (mut most, mut seconds) = (0, BTreeMap::<u32, u32>::new());
    while run.end.is_none() {
        run.simulation.evaluate().unwrap();
        run.measure();
        let frame = run.simulation.frame();
        if frame
            .clock
            .frame()
            .is_multiple_of(frame.clock.frame_at(1.0))
        {
            let (agents, scene) = (frame.agents, run.simulation.scene());
            let places = &scene.journeys.places;
            let till = places
                .iter()
                .position(|place| place.name == "till")
                .unwrap();
            let Kind::Queue(queue) = &places[till].kind else {
                panic!("a queue");
            };
            let (mut joined, mut around) = (Vec::new(), Vec::new());
            for i in agents.present() {
                let trip = agents.trip[i].unwrap();
                let [x, y] = [agents.position[i].x, agents.position[i].y];
                // The line: from its front to the wall at y = 10.
                let distance = (x - 12.0).hypot(y - y.clamp(8.0, 8.0 + queue.length));
                let own = agents.preferred_speed.get(i).copied();
                let pace = own.unwrap_or(scene.preferred_speed);
                let is_slow = agents.velocity[i].norm() < 0.5 * pace;
                match trip.status {
                    _ if usize::from(trip.place) != till => {}
                    Status::Queued { ticket, .. } => joined.push((ticket, agents.id[i])),
                    Status::Walking if is_slow && frame.clock.time() >= 3.0 => {
                        around.push((distance, agents.id[i]));
                    }
                    _ => {}
                }
            }
            joined.sort_unstable();
            around.sort_by(|a, b| a.0.total_cmp(&b.0));
            let places_on_line = 1 + (queue.length / queue.spacing) as usize;
            let mut ids: Vec<u32> = joined
                .iter()
                .skip(places_on_line)
                .map(|one| one.1)
                .collect();
            let mut before = 0.0;
            for (distance, id) in around {
                // While there is room on the line, no agent stands outside of it.
                if distance - before > 3.0 || joined.len() < places_on_line {
                    break;
                }
                before = distance;
                ids.push(id);
            }
            most = most.max(ids.len() as u32);
            for id in ids {
                *seconds.entry(id).or_default() += 1;
            }
        }
        run.simulation.integrate().unwrap();
    }
    let summary = Summary::of(&run);
    let till = summary
        .longest_queues
        .iter()
        .find(|queue| queue.before == "till")
        .unwrap();
    let outside = till.outside.unwrap();
    let (people, sum) = (seconds.len() as u32, seconds.values().sum::<u32>());
    assert!(people > 10, "{outside:?}");
    assert_eq!((outside.agents, outside.people), (most, people));
    assert_eq!(outside.mean_secs, f64::from(sum) / f64::from(people));
    assert_eq!(
        outside.longest_secs,
        f64::from(*seconds.values().max().unwrap())
    );
}
