//! Agents that stand exactly on a line: of a closed exit, of their waypoint, of their exit.

use sandbox::engine::math::Vector;
use serde_json::{Value, json};

use crate::common::simulated::{after, go_on, measured, scenario, start};

/// Turns points of the plane.
fn turned(document: &Value, degrees: f64) -> Value {
    let (sin, cos) = degrees.to_radians().sin_cos();
    match document {
        Value::Array(pair) if pair.len() == 2 && pair.iter().all(Value::is_number) => {
            let [x, y] = [&pair[0], &pair[1]].map(|value| value.as_f64().unwrap());
            json!([x * cos - y * sin, x * sin + y * cos])
        }
        Value::Array(values) => values.iter().map(|one| turned(one, degrees)).collect(),
        Value::Object(entries) => {
            let times = |key: &str| key.ends_with("_secs");
            let entry = |(key, value): (&String, &Value)| {
                let value = match times(key) {
                    true => value.clone(),
                    false => turned(value, degrees),
                };
                (key.clone(), value)
            };
            Value::Object(entries.iter().map(entry).collect())
        }
        value => value.clone(),
    }
}

/// People who enter on the line of an exit that is closed, wait in a hall, and leave by it when it is open.
fn visit() -> Value {
    json!({
        "profile": "steer+sph", "duration_secs": 130,
        "walkable_area": [[[[0, 0], [20, 0], [20, 4], [0, 4]]]],
        "entrances": [{
            "name": "in", "line": [[20, 0.5], [20, 3.5]], "per_sec": 1, "number": 20, "journey": "visit"
        }],
        "waiting_areas": [
            {"name": "hall", "area": [[2, 0.5], [8, 0.5], [8, 3.5], [2, 3.5]], "until_secs": 60}
        ],
        "exits": [{"name": "out", "line": [[20, 0], [20, 4]], "closed_secs": [[0, 60]]}],
        "journeys": [{"name": "visit", "stages": ["hall", "out"]}],
        "stop": {"when_empty": true}
    })
}

#[test]
fn agents_walk_in_from_the_line_of_a_closed_exit_in_every_direction_and_profile() {
    let mut all: Vec<(Value, f64)> = Vec::new();
    for profile in ["steer+sph", "sph", "sf", "rvo", "walk+sph"] {
        let mut document = visit();
        document["profile"] = json!(profile);
        all.push((document, 0.0));
    }
    all.extend([37.0, 90.0, 211.0].map(|degrees| (visit(), degrees)));
    let mut swapped = visit();
    swapped["exits"][0]["line"] = json!([[20, 4], [20, 0]]);
    all.push((swapped, 0.0));
    for (document, degrees) in all {
        let said = format!("{} {degrees}", document["profile"]);
        let document = turned(&document, degrees);
        let mut simulation = start(&document, &[]);
        go_on(&mut simulation, 50.0);
        let agents = simulation.frame().agents;
        assert!(agents.entered() >= 18, "{said}: {}", agents.entered());
        let line: Vec<Vector> =
            serde_json::from_value::<Vec<[f64; 2]>>(document["exits"][0]["line"].clone())
                .unwrap()
                .into_iter()
                .map(Vector::from)
                .collect();
        let along = (line[1] - line[0]).normalize();
        let first = agents.entered() - 3;
        let on_line = agents.present().filter(|&i| agents.id[i] < first);
        let on_line = on_line.filter(|&i| along.perp(&(agents.position[i] - line[0])).abs() < 0.5);
        assert_eq!(on_line.count(), 0, "{said}");
        let summary = measured(document);
        let hall = summary.places.iter().find(|place| place.name == "hall");
        assert_eq!(summary.remaining, 0, "{said}");
        assert!(hall.unwrap().waited_secs.unwrap() > 20.0, "{said}");
    }
}

#[test]
fn no_agent_gets_out_through_a_closed_exit_on_whose_line_it_entered() {
    // Their goal is beyond the line: they stay on it.
    let mut document = visit();
    (document["exits"][0]["closed_secs"], document["journeys"]) = (
        json!([[0, 1000]]),
        json!([{"name": "visit", "stages": ["out"]}]),
    );
    document["waiting_areas"] = json!([]);
    for line in [[[20, 0], [20, 4]], [[20, 4], [20, 0]]] {
        document["exits"][0]["line"] = json!(line);
        let simulation = after(&document, &[], 60.0);
        let agents = simulation.frame().agents;
        assert!(agents.present().count() >= 2);
        assert!(agents.position.iter().all(|p| p.x < 20.0 + 1e-6));
    }
}

/// A room with a waypoint across it, an exit at its end, and one agent.
fn passing(position: [f64; 2], stages: &Value) -> Value {
    json!({
        "profile": "steer+sph", "duration_secs": 60,
        "walkable_area": [[[[0, 0], [14, 0], [14, 8], [0, 8]]]],
        "waypoints": [{"name": "line", "line": [[4, 0], [4, 8]]}],
        "exits": [{"name": "out", "line": [[14, 3], [14, 5]]}],
        "journeys": [{"name": "j", "stages": stages}],
        "agents": [{"position": position, "journey": "j"}],
        "stop": {"when_empty": true}
    })
}

#[test]
fn an_agent_that_starts_on_its_waypoint_has_passed_it() {
    let journey = json!(["line", "out"]);
    let beside = measured(passing([3.99, 4.0], &journey)).t100_secs.unwrap();
    for degrees in [0.0, 30.0, 90.0, 123.0] {
        let document = turned(&passing([4.0, 4.0], &journey), degrees);
        let on = measured(document).t100_secs.unwrap();
        assert!(
            (on - beside).abs() < 0.3,
            "{degrees}: {on} s, beside it {beside} s"
        );
    }
}

#[test]
fn an_agent_that_starts_on_its_exit_leaves_at_once_or_when_it_opens_or_walks() {
    let journey = json!(["out"]);
    let here = |key: &str, value: Value| {
        let mut document = passing([14.0, 4.0], &journey);
        match key {
            "closed_secs" => document["exits"][0][key] = value,
            _ => document["agents"][0][key] = value,
        }
        measured(document).t100_secs.unwrap()
    };
    assert!(here("closed_secs", json!([])) <= 0.1 + 1e-9);
    let opened = here("closed_secs", json!([[0, 10]]));
    assert!((10.0..10.2).contains(&opened), "{opened}");
    let started = here("premovement_secs", json!(7));
    assert!((7.0..7.2).contains(&started), "{started}");
}

#[test]
fn a_limited_exit_is_the_cause_of_being_stuck_before_it() {
    for rate in [0.01, 0.04] {
        let document = json!({
            "profile": "steer+sph", "duration_secs": 60,
            "walkable_area": [[[[0, 0], [20, 0], [20, 6], [0, 6]]]],
            "exits": [{"name": "check", "line": [[20, 2], [20, 4]], "most_per_sec": rate}],
            "crowds": [{"area": [[10, 1], [18, 1], [18, 5], [10, 5]], "number": 4}],
        });
        let said = measured(document);
        let wait = 1.0 / rate;
        let cause = format!(
            "the exit `check` lets one person pass every {wait:.1} s (`most_per_sec` {rate})"
        );
        let causes: Vec<&str> = said.stuck_because.iter().map(|one| &*one.cause).collect();
        assert_eq!(causes, [cause]);
    }
}

/// Two rooms with an opening between them, and an exit or a door in it.
fn two_rooms() -> Value {
    json!({
        "profile": "steer+sph", "duration_secs": 60,
        "walkable_area": [[
            [[0, 0], [20, 0], [20, 6], [0, 6]],
            [[10, 0], [10.2, 0], [10.2, 2.4], [10, 2.4]],
            [[10, 3.6], [10.2, 3.6], [10.2, 6], [10, 6]]
        ]],
        "exits": [{"name": "way out", "line": [[10.1, 2.4], [10.1, 3.6]]}],
        "crowds": [{"name": "c", "area": [[1, 1], [8, 1], [8, 5], [1, 5]], "number": 12}],
    })
}

#[test]
fn a_door_on_the_line_of_an_exit_is_refused() {
    let mut document = two_rooms();
    document["doors"] = json!([
        {"name": "fire door", "line": [[10.1, 2.4], [10.1, 3.6]], "closed_secs": [[0, 1000]]}
    ]);
    let error = scenario(&document, &[]).unwrap_err();
    let said = "doors[0].line: `fire door` lies on the line of the exit `way out`, where people leave whatever the \
                door says: give the exit the `closed_secs`, or move one of them";
    assert!(error.contains(said), "{error}");
}

#[test]
fn an_exit_on_the_line_of_another_gets_a_note() {
    let mut document = two_rooms();
    document["exits"] = json!([
        {"name": "a", "line": [[20, 2], [20, 4]]}, {"name": "b", "line": [[20, 3], [20, 5]]},
        {"name": "c", "line": [[20, 0], [20, 1]]}
    ]);
    let notes = scenario(&document, &[]).unwrap().notes;
    let doubled: Vec<&String> = notes
        .iter()
        .filter(|note| note.contains("lies on the line of"))
        .collect();
    assert_eq!(doubled.len(), 1, "{notes:?}");
    assert!(doubled[0].starts_with("exits[1].line: `b` lies on the line of `a`: "));
}

#[test]
fn an_exit_that_was_closed_until_the_end_is_the_cause_of_being_stuck_before_it() {
    for (closed, said) in [
        (json!([[0, 60]]), "the exit `east` was closed until 60 s"),
        (json!([[6, 59]]), "the exit `east` was closed until 59 s"),
        (json!([[6, 61]]), "the exit `east` is closed until 61 s"),
    ] {
        let document = json!({
            "profile": "steer+sph", "duration_secs": 60, "motivation": 1,
            "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10]]]],
            "exits": [{"name": "east", "line": [[12, 4], [12, 6]], "closed_secs": closed}],
            "crowds": [{"area": [[1, 1], [6, 1], [6, 9], [1, 9]], "number": 40}],
        });
        let summary = measured(document);
        let causes: Vec<&str> = summary
            .stuck_because
            .iter()
            .map(|one| &*one.cause)
            .collect();
        assert_eq!(causes, [said]);
    }
}
