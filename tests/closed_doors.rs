//! Declared doors: whom they count, whom they hold back, and what is said of people who stand before them.

use sandbox::engine::forces::legs::lean;
use sandbox::runs::drive::Run;
use serde_json::{Value, json};

use crate::common::simulated::{measured, scenario};

#[test]
fn a_door_counts_the_people_who_walk_or_queue_through_it() {
    let queue = json!({
        "profile": "steer+sph", "stop": {"when_empty": true},
        "walkable_area": [[[[0, 0], [12, 0], [12, 6], [0, 6]]]],
        "obstacles": [[[5.9, 0], [6.1, 0], [6.1, 2.5], [5.9, 2.5]], [[5.9, 3.5], [6.1, 3.5], [6.1, 6], [5.9, 6]]],
        "exits": [{"name": "e", "line": [[12, 2], [12, 4]]}],
        "doors": [{"name": "d", "line": [[6, 2.5], [6, 3.5]]}],
        "queues": [{"name": "q", "path": [[8, 3], [2, 3]], "service_secs": 1}],
        "journeys": [{"name": "j", "stages": ["q", "e"]}],
        "crowds": [{"area": [[0.5, 0.5], [5, 0.5], [5, 5.5], [0.5, 5.5]], "number": 12, "journey": "j"}],
    });
    let mut waypoints = queue.clone();
    // There and back again, three times: each person counts once.
    waypoints["waypoints"] =
        json!([{"name": "a", "at": [9, 3], "within": 1}, {"name": "b", "at": [3, 3], "within": 1}]);
    waypoints["journeys"][0]["stages"] = json!(["a", "b", "a", "b", "a", "e"]);
    waypoints["queues"] = json!([]);
    waypoints["crowds"][0]["number"] = json!(3);
    for (document, people) in [(queue, 12), (waypoints, 3)] {
        let summary = measured(document);
        assert_eq!(summary.arrived, people, "{summary:?}");
        for place in &summary.places {
            assert_eq!(place.passed as usize, people, "{place:?}");
        }
    }
}

/// A crowd before a door that closes after a second.
fn before_a_closing_door(profile: &str) -> Value {
    json!({
        "profile": profile, "duration_secs": 30,
        "walkable_area": [[[[0, 0], [12, 0], [12, 6], [0, 6]]]],
        "obstacles": [[[5.9, 0], [6.1, 0], [6.1, 2.5], [5.9, 2.5]], [[5.9, 3.5], [6.1, 3.5], [6.1, 6], [5.9, 6]]],
        "exits": [{"name": "e", "line": [[12, 2], [12, 4]]}],
        "doors": [{"name": "d", "line": [[6, 2.5], [6, 3.5]]}],
        "events": [{"at_secs": 1, "close": "d"}],
        "crowds": [{"area": [[0.5, 0.5], [5, 0.5], [5, 5.5], [0.5, 5.5]], "number": 15}],
    })
}

#[test]
fn people_before_a_closed_door_are_stuck_because_it_is_closed() {
    let causes = |document: Value| {
        let summary = measured(document);
        let causes = summary.stuck_because.into_iter();
        causes
            .map(|group| (group.agents, group.cause))
            .collect::<Vec<_>>()
    };
    let mut by_event = before_a_closing_door("steer+sph");
    assert_eq!(
        causes(by_event.clone()),
        [(15, "the door `d` is closed".to_owned())]
    );
    by_event["events"] = json!([]);
    by_event["doors"][0]["closed_secs"] = json!([[0, 600]]);
    assert_eq!(
        causes(by_event),
        [(15, "the door `d` is closed until 600 s".to_owned())]
    );
    let mut exit = before_a_closing_door("steer+sph");
    exit["doors"] = json!([]);
    exit["events"] = json!([]);
    exit["exits"][0]["closed_secs"] = json!([[0, 90]]);
    exit["duration_secs"] = json!(40);
    assert_eq!(
        causes(exit),
        [(15, "the exit `e` is closed until 90 s".to_owned())]
    );
}

#[test]
fn legs_stay_within_the_limit_of_the_lean_where_a_closed_door_holds_the_body_back() {
    let mut document = before_a_closing_door("legs+sph");
    document["crowds"][0]["number"] = json!(40);
    // The limit is reached.
    document["parameters"] = json!({"lean_limit": 0.05});
    document["duration_secs"] = json!(20);
    let mut run = Run::new(scenario(&document, &[]).unwrap()).unwrap();
    let (mut most, mut held) = (0.0_f64, 0);
    while run.end.is_none() {
        run.simulation.evaluate().unwrap();
        run.measure();
        run.simulation.integrate().unwrap();
        let agents = run.simulation.frame().agents;
        for i in 0..agents.len() {
            most = most.max(lean(agents, i).norm());
            held += usize::from((agents.position[i].x - 6.0).abs() < 0.002);
        }
    }
    assert!(held > 100, "{held}");
    assert!((0.049..=0.05 + 1e-12).contains(&most), "{most}");
}
