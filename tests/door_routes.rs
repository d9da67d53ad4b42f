//! Doors on routes: people pass open doors, and wait before closed ones or walk around them. Which lines of doors are
//! accepted, and the errors of the others.

use sandbox::engine::breakdown::Breakdown;
use serde_json::{Value, json};

use crate::common::simulated::{after, go_on, scenario, start};
use crate::route_choice::two_rooms;

/// Two rooms with two doors of 1 m; the southern one is a door of the scenario.
fn with_door(change: &Value) -> Value {
    let mut document = two_rooms(&[(5.0, 1.0), (15.0, 1.0)], 12);
    document["route_choice"] = json!("shortest");
    document["crowds"][0]["area"] = json!([[2, 2], [8, 2], [8, 8], [2, 8]]);
    let mut door = json!({"name": "south", "line": [[10.1, 4.5], [10.1, 5.5]]});
    for (key, value) in change.as_object().unwrap() {
        door[key] = value.clone();
    }
    document["doors"] = json!([door]);
    document
}

/// The number of agents that have passed the door, and that have left, after a minute.
fn through_door(document: &Value) -> [usize; 2] {
    let simulation = after(document, &[], 60.0);
    let door = simulation.progress().places.last().unwrap().passed;
    [door as usize, simulation.outcome().arrivals.len()]
}

#[test]
fn people_pass_one_way_doors_in_their_direction_only() {
    assert_eq!(through_door(&with_door(&json!({}))), [12, 12]);
    assert_eq!(
        through_door(&with_door(&json!({"one_way": [1, 0]}))),
        [12, 12]
    );
    assert_eq!(
        through_door(&with_door(&json!({"one_way": [-1, 0.2]}))),
        [0, 12]
    );
}

#[test]
fn people_walk_around_closed_doors_and_wait_where_no_other_way_leads() {
    assert_eq!(
        through_door(&with_door(&json!({"closed_secs": [[0, 100]]}))),
        [0, 12]
    );
    let mut sole = with_door(&json!({"closed_secs": [[0, 20]]}));
    sole["walkable_area"].as_array_mut().unwrap().pop();
    let mut simulation = start(&sole, &[]);
    go_on(&mut simulation, 19.9);
    let agents = simulation.frame().agents;
    assert_eq!(agents.len(), 12);
    assert!(agents.position.iter().all(|p| p.x < 10.1));
    go_on(&mut simulation, 60.0);
    assert_eq!(simulation.outcome().arrivals.len(), 12);
}

#[test]
fn a_breakdown_says_that_a_way_is_closed_and_until_when() {
    let text = |closed: Value, at: f64| {
        let mut document = with_door(&json!({"closed_secs": closed}));
        document["walkable_area"].as_array_mut().unwrap().pop();
        document["route_choice"] = json!("quickest");
        let mut simulation = after(&document, &[], at);
        simulation.evaluate().unwrap();
        Breakdown::of(&simulation, 0).unwrap().to_string()
    };
    let closed = text(json!([[0, 20], [30, 40]]), 5.0);
    let routes: Vec<&str> = closed
        .lines()
        .filter(|line| line.contains("door `south`"))
        .collect();
    assert!(
        routes[0].trim().starts_with("closed until 20.00 s: "),
        "{closed}"
    );
    assert!(!routes[0].contains("through after"), "{closed}");
    assert!(
        closed.contains("bound for it, the way is closed until 20.00 s"),
        "{closed}"
    );
    assert!(!closed.contains("; walking "), "{closed}");
    let ever = text(json!([[0, 20], [20, 1000]]), 5.0);
    assert!(ever.contains("the way is closed until 1000.00 s"), "{ever}");
    let open = text(json!([[10, 20]]), 5.0);
    assert!(
        !open.contains("closed") && open.contains("; walking "),
        "{open}"
    );
}

/// A corridor of 20 × 3 m with a narrow place at x = 10 to 10.2 m, and a door with this line.
fn corridor(line: &Value) -> Value {
    json!({
        "profile": "steer+sph", "walkable_area": [[[[0, 0], [20, 0], [20, 3], [0, 3]]]],
        "obstacles": [[[10, 0], [10.2, 0], [10.2, 0.5], [10, 0.5]],
                      [[10, 2.5], [10.2, 2.5], [10.2, 3], [10, 3]]],
        "doors": [{"name": "d", "line": line, "closed_secs": [[0, 15]]}],
        "exits": [{"name": "e", "line": [[20, 1], [20, 2]]}],
        "agents": [{"position": [6, 1.5]}],
    })
}

#[test]
fn a_door_from_wall_to_wall_is_one_wherever_it_lies_in_the_opening() {
    let lines = [
        json!([[10, 0.5], [10, 2.5]]),
        json!([[10.2, 2.5], [10.2, 0.5]]),
        json!([[10, 0.5], [10.2, 2.5]]),
        json!([[10.1, 0.5], [10.1, 2.5]]),
        json!([[10, 0], [10, 3]]),
        json!([[10, 0.3], [10, 2.7]]),
        json!([[10, -0.1], [10, 3.1]]),
        json!([[10.1, 0.2], [10.1, 2.8]]),
        json!([[10.1, 0.54], [10.1, 2.46]]),
        json!([[9.97, 0.5], [9.97, 2.5]]),
        json!([[9.9, 0], [9.9, 3]]),
    ];
    for line in &lines {
        let mut simulation = start(&corridor(line), &[]);
        go_on(&mut simulation, 14.9);
        let p = simulation.frame().agents.position[0];
        assert!(p.x > 9.0 && p.x < 10.21, "{line}: {p}");
        go_on(&mut simulation, 40.0);
        assert_eq!(simulation.outcome().arrivals.len(), 1, "{line}");
        let door = simulation.progress().places.last().unwrap();
        assert_eq!(door.passed, 1, "{line}");
    }
    let free = scenario(&corridor(&json!([[10.1, 0.5], [10.1, 2.3]])), &[]).unwrap_err();
    assert!(
        free.contains("`d`: it ends at (10.1, 2.3), not at a wall"),
        "{free}"
    );
}

#[test]
fn two_doors_on_one_line_are_named_and_two_side_by_side_are_accepted() {
    let mut two = corridor(&json!([[9, 0], [9, 3]]));
    let mut other = two["doors"][0].clone();
    other["name"] = json!("valve");
    two["doors"].as_array_mut().unwrap().push(other);
    for line in [
        json!([[9, 0], [9, 3]]),
        json!([[9, 3], [9, 0]]),
        json!([[9, 1], [9, 3]]),
    ] {
        two["doors"][1]["line"] = line;
        let error = scenario(&two, &[]).unwrap_err();
        let said = "doors[1].line: `valve` lies on the line of `d`: draw one door";
        assert!(error.contains(said), "{error}");
    }
    two["doors"][0]["line"] = json!([[9, 0], [9, 1.5]]);
    two["doors"][1]["line"] = json!([[9, 1.5], [9, 3]]);
    two["doors"][0]["closed_secs"] = json!([[0, 100]]);
    two["doors"][1]["closed_secs"] = json!([]);
    let simulation = after(&two, &[], 40.0);
    assert_eq!(simulation.outcome().arrivals.len(), 1);
    let places = &simulation.progress().places;
    let passed: Vec<u32> = places.iter().map(|place| place.passed).collect();
    assert_eq!(passed, [1, 0, 1]);
}

#[test]
fn doors_that_cannot_be_used_are_errors_with_their_place() {
    let error = |document: &Value| scenario(document, &[]).unwrap_err();
    let lone = |mut document: Value| {
        document["walkable_area"].as_array_mut().unwrap().pop();
        document
    };
    let closed = error(&lone(with_door(&json!({"one_way": [-1, 0]}))));
    assert!(
        closed.contains("one-way doors on every way lead only away from it"),
        "{closed}"
    );
    let open = error(&with_door(&json!({"line": [[10.1, 4.5], [10.1, 5.2]]})));
    assert!(
        open.contains("doors[0].line") && open.contains("walk around"),
        "{open}"
    );
    let along = error(&with_door(&json!({"one_way": [0, 1]})));
    assert!(along.contains("doors[0].one_way"), "{along}");
    let mut stage = with_door(&json!({}));
    stage["journeys"] = json!([{"name": "j", "stages": ["south", "end"]}]);
    assert!(error(&stage).contains("is a door"));
    let mut straight = with_door(&json!({}));
    straight["navigation"] = json!("straight");
    assert!(error(&straight).contains("navigation"));
}
