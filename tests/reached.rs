//! What a body cannot reach is no part of a line or area: it is no goal, and leads nowhere. What is refused, and who
//! arrives, does not depend on where a plan lies, how it is turned, and whether it is mirrored.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::journeys::Place;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

use crate::common::simulated::{scenario, start};

/// Everybody walks to an exit within this time, seconds.
const LONG: f64 = 90.0;

/// A motion of the plane.
type Motion = fn([f64; 2]) -> [f64; 2];

const MOTIONS: [Motion; 4] = [
    |p| p,
    |[x, y]| [x - 4.0, y + 31.25],
    |[x, y]| [-y, x],
    |[x, y]| [3.0 - x, y],
];

/// A document whose points are moved.
fn moved(value: &Value, motion: Motion) -> Value {
    match value {
        Value::Array(items) => match items[..] {
            [Value::Number(ref x), Value::Number(ref y)] => {
                json!(motion([x, y].map(|x| x.as_f64().unwrap())))
            }
            _ => items.iter().map(|item| moved(item, motion)).collect(),
        },
        Value::Object(keys) => {
            let moved = |(key, value): (&String, &Value)| match &**key {
                "closed_secs" => (key.clone(), value.clone()),
                _ => (key.clone(), moved(value, motion)),
            };
            Value::Object(keys.iter().map(moved).collect())
        }
        _ => value.clone(),
    }
}

/// The number of agents that are left after [`LONG`]; `None` if the document is refused because of a way.
fn left(document: &Value) -> Option<usize> {
    if let Err(error) = scenario(document, &[]) {
        let reasons = ["no way leads from", "nobody can get to"];
        assert!(reasons.iter().any(|why| error.contains(why)), "{error}");
        return None;
    }
    let mut simulation = start(document, &[]);
    let last = simulation.frame().clock.frame_at(LONG);
    loop {
        let count = simulation.frame().agents.present().count();
        if count == 0 || simulation.frame().clock.frame() >= last {
            return Some(count);
        }
        simulation.step().unwrap();
    }
}

/// Checks the answer for a document in four positions: `is_open`: all arrive; otherwise it is refused.
fn check(what: &str, document: &Value, is_open: bool) {
    for (k, motion) in MOTIONS.into_iter().enumerate() {
        let moved = moved(document, motion);
        let expected = is_open.then_some(0);
        assert_eq!(left(&moved), expected, "{what}, motion {k}: {moved}");
    }
}

fn rectangle(low: [f64; 2], high: [f64; 2]) -> Value {
    json!([low, [high[0], low[1]], high, [low[0], high[1]]])
}

/// A room of 8 × 8 m with these bodies.
fn room(bodies: &[Value]) -> Value {
    json!({
        "profile": "steer+sph", "walkable_area": [[rectangle([0.0, 0.0], [8.0, 8.0])]], "obstacles": bodies,
        "exits": [{"name": "e", "line": [[3, 8], [5, 8]]}],
    })
}

#[test]
fn a_piece_of_a_line_behind_a_wall_is_no_goal() {
    for choice in ["shortest", "quickest"] {
        let mut waypoint = room(&[rectangle([3.95, 2.0], [4.05, 8.0])]);
        waypoint["route_choice"] = json!(choice);
        waypoint["agents"] = json!([{"position": [6, 6]}, {"position": [6.6, 6]}]);
        let mut exits = waypoint.clone();
        for over in [1e-7, 0.01, 0.15] {
            waypoint["waypoints"] = json!([{"name": "w", "line": [[1, 5], [4.05 + over, 5]]}]);
            waypoint["exits"] = json!([{"name": "e", "line": [[1, 8], [3, 8]]}]);
            waypoint["journeys"] = json!([{"name": "j", "stages": ["w", "e"]}]);
            for agent in waypoint["agents"].as_array_mut().unwrap() {
                agent["journey"] = json!("j");
            }
            check("waypoint", &waypoint, true);
            exits["exits"] = json!([{"name": "e", "line": [[3.1, 8], [4.05 + over, 8]]},
                                    {"name": "f", "line": [[8, 0.2], [8, 1.4]]}]);
            check("exit", &exits, true);
        }
        let mut area = exits.clone();
        area["exits"] = json!([{"name": "e", "line": [[1, 8], [3, 8]]}]);
        area["waiting_areas"] =
            json!([{"name": "a", "area": rectangle([0.5, 3.0], [4.06, 7.0]), "for_secs": 1}]);
        area["journeys"] = json!([{"name": "j", "stages": ["a", "e"]}]);
        for agent in area["agents"].as_array_mut().unwrap() {
            agent["journey"] = json!("j");
        }
        check("waiting area", &area, true);
    }
}

/// A room with a waypoint from wall to wall, an exit behind it, and people before it.
fn gate(bodies: &[Value], people: &[[f64; 2]]) -> Value {
    let mut gate = room(bodies);
    gate["waypoints"] = json!([{"name": "w", "line": [[0, 4], [8, 4]]}]);
    gate["journeys"] = json!([{"name": "j", "stages": ["w", "e"]}]);
    let people = people.iter();
    gate["agents"] = people
        .map(|at| json!({"position": at, "journey": "j"}))
        .collect();
    gate
}

#[test]
fn a_pillar_at_a_gate_does_not_close_it_and_a_wall_does() {
    let pillar = rectangle([0.2, 3.8], [0.8, 4.2]);
    check("pillar", &gate(&[pillar], &[[6.0, 1.0]]), true);
    let mut wall = gate(&[rectangle([1.5, 0.0], [1.6, 8.0])], &[[6.0, 1.0]]);
    wall["exits"][0]["line"] = json!([[0.1, 8], [1.4, 8]]);
    check("wall", &wall, false);
    wall["agents"][0]["position"] = json!([0.8, 1.0]);
    check("the other room", &wall, true);
}

#[test]
fn gates_with_pillars_are_open_wherever_the_hall_lies() {
    (0..120_u64).into_par_iter().for_each(|seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut bodies = Vec::new();
        let gap = rng.random_range(0.05..0.42);
        let [width, half] = [rng.random_range(0.3..1.2), rng.random_range(0.05..0.6)];
        bodies.push(match rng.random_bool(0.5) {
            true => rectangle([gap, 4.0 - half], [gap + width, 4.0 + half]),
            false => rectangle([8.0 - gap - width, 4.0 - half], [8.0 - gap, 4.0 + half]),
        });
        if rng.random_bool(0.4) {
            let x = rng.random_range(3.0..5.0);
            bodies.push(rectangle([x, 3.7], [x + 0.4, 4.1]));
        }
        // A wall through the room: people and the exit are on one side of it, or not.
        let (mut is_open, mut at) = (true, rng.random_range(2.0..6.0));
        if rng.random_bool(0.3) {
            let x = rng.random_range(5.6..5.9);
            bodies.push(rectangle([x, 0.0], [x + 0.05, 8.0]));
            at = if rng.random_bool(0.5) { 6.3 } else { 2.5 };
            is_open = at < x;
        }
        check(
            &format!("seed {seed}"),
            &gate(&bodies, &[[at, 1.0]]),
            is_open,
        );
    });
}

/// Two rooms with a thin wall between, which leaves a passage at its lower end, and a line that reaches over the wall.
fn over_a_wall(rng: &mut ChaCha8Rng) -> Value {
    let x = rng.random_range(3.5..4.5);
    let thick: f64 = rng.random_range(0.02..0.3);
    let mut floor = room(&[rectangle([x, rng.random_range(1.2..3.0)], [x + thick, 8.0])]);
    floor["profile"] = json!(["steer+sph", "sph"][rng.random_range(0..2)]);
    floor["route_choice"] = json!(["shortest", "quickest"][rng.random_range(0..2)]);
    let over = 10_f64.powf(rng.random_range(-7.0..-0.52));
    let mut people = Vec::new();
    for _ in 0..3 {
        let at = [rng.random_range(x + 1.0..7.5), rng.random_range(4.0..7.5)];
        people.push(json!({"position": at}));
    }
    people.push(json!({"position": [rng.random_range(0.5..2.5), rng.random_range(0.5..7.5)]}));
    if rng.random_bool(0.5) {
        let y = rng.random_range(3.5..7.0);
        floor["waypoints"] = json!([{"name": "w", "line": [[rng.random_range(0.5..2.0), y], [x + thick + over, y]]}]);
        floor["exits"][0]["line"] = json!([[0.5, 8], [2.5, 8]]);
        floor["journeys"] = json!([{"name": "j", "stages": ["w", "e"]}]);
        people
            .iter_mut()
            .for_each(|one| one["journey"] = json!("j"));
    } else {
        floor["exits"] = json!([{"name": "e", "line": [[x - rng.random_range(0.8..1.5), 8], [x + thick + over, 8]]}]);
        if rng.random_bool(0.7) {
            let other = json!({"name": "f", "line": [[8, 0.2], [8, 1.4]]});
            floor["exits"].as_array_mut().unwrap().push(other);
        }
    }
    floor["agents"] = json!(people);
    floor
}

#[test]
fn nobody_stays_behind_the_end_of_a_line_over_a_wall() {
    (0..180_u64).into_par_iter().for_each(|seed| {
        let floor = over_a_wall(&mut ChaCha8Rng::seed_from_u64(seed));
        for motion in [MOTIONS[0], MOTIONS[(seed as usize) % 3 + 1]] {
            let floor = moved(&floor, motion);
            assert_eq!(left(&floor), Some(0), "seed {seed}: {floor}");
        }
    });
}

/// A hall with counters beside the lines that people walk to, at any angle, and thin walls between.
fn with_counters(rng: &mut ChaCha8Rng) -> Value {
    let y = rng.random_range(3.0..6.0);
    let mut bodies = Vec::new();
    // Counters along the line, behind it or on it.
    for from in [0.8, 3.2, 5.8] {
        let low = y + rng.random_range(-0.15..0.2);
        let high = low + rng.random_range(0.3..0.9);
        if rng.random_bool(0.7) {
            bodies.push(rectangle(
                [from, low],
                [from + rng.random_range(0.3..1.2), high],
            ));
        }
    }
    let mut hall = gate(
        &bodies,
        &[
            [rng.random_range(0.5..7.5), 1.0],
            [rng.random_range(0.5..7.5), 1.8],
        ],
    );
    let slope = rng.random_range(-0.05..0.05);
    hall["waypoints"][0]["line"] = json!([[0, y - slope], [8, y + slope]]);
    let width = rng.random_range(0.9..2.0);
    let from = rng.random_range(0.2..7.8 - width);
    hall["exits"][0]["line"] = json!([[from, 8], [from + width, 8]]);
    hall
}

#[test]
fn counters_along_a_line_stop_nobody() {
    (0..60_u64).into_par_iter().for_each(|seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(1000 + seed);
        let hall = with_counters(&mut rng);
        check(&format!("seed {seed}"), &hall, true);
    });
}

#[test]
fn a_line_along_a_wall_that_nobody_can_get_to_is_refused() {
    let mut along = gate(&[], &[[4.0, 4.0]]);
    for (away, is_open) in [(0.05, false), (0.1, false), (0.4, true)] {
        along["waypoints"][0]["line"] = json!([[1, away], [7, away]]);
        check(&format!("{away} m"), &along, is_open);
        along["waypoints"][0]["line"] = json!([[1, 8.0 - away], [2.5, 8.0 - away]]);
        check(&format!("{away} m"), &along, is_open);
    }
    // The angle of a hall changes nothing.
    let turned = |angle: f64| -> Value {
        let (sine, cosine) = angle.sin_cos();
        let turn = |[x, y]: [f64; 2]| [x * cosine - y * sine, x * sine + y * cosine];
        let hall = gate(&[], &[[4.0, 4.0]]);
        let points = |value: &Value| -> Value {
            let points = value.as_array().unwrap().iter();
            points
                .map(|p| json!(turn([p[0].as_f64().unwrap(), p[1].as_f64().unwrap()])))
                .collect()
        };
        let mut turned = hall.clone();
        turned["walkable_area"] = json!([[points(&hall["walkable_area"][0][0])]]);
        turned["waypoints"][0]["line"] = points(&json!([[0.0, 4.0], [8.0, 4.0]]));
        turned["exits"][0]["line"] = points(&hall["exits"][0]["line"]);
        turned["agents"][0]["position"] = json!(turn([6.0, 1.0]));
        turned
    };
    for k in 0..8 {
        assert_eq!(left(&turned(TAU * f64::from(k) / 8.3)), Some(0));
    }
}

#[test]
fn people_can_get_to_all_lines_of_the_shipped_scenarios() {
    let folders = ["", "verification", "validation", "questions"];
    let folders =
        folders.map(|folder| format!("{}/scenarios/{folder}", env!("CARGO_MANIFEST_DIR")));
    let files = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let files = files.map(|file| file.unwrap().path());
    let mut lines = 0;
    for file in files.filter(|file| file.extension().is_some_and(|ext| ext == "json")) {
        // Scenes of data need files that are not here.
        let Ok(scenario) = Scenario::load(&file, &[]) else {
            continue;
        };
        let places = scenario.scene.journeys.places.iter();
        for place in places.filter(|place| place.line().is_some()) {
            let whole = Place::new(place.name.clone(), place.kind.clone());
            assert_eq!(
                place.goals,
                whole.goals,
                "{}: {}",
                file.display(),
                place.name
            );
            lines += 1;
        }
    }
    assert!(lines > 50, "{lines}");
}
