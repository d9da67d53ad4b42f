//! New goals for agents, given from outside during a run.

use sandbox::engine::journeys::Status;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::{ActionError, Simulation};
use serde_json::{Value, json};

use crate::common::simulated::{after, go_on, scenario, start};

/// A corridor of 2 m width with a corner at (10, 2), and agents in its first arm.
fn corner() -> Value {
    json!({
        "walkable_area": [[[[0, 0], [12, 0], [12, 10], [10, 10], [10, 2], [0, 2]]]],
        "goal": [9, 1],
        "grids": [{"min": [1, 0.5], "max": [4, 1.5], "columns": 4, "rows": 2}],
    })
}

/// A room with a queue and an exit.
fn shop() -> Value {
    json!({
        "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
        "exits": [{"name": "east", "line": [[20, 4], [20, 6]]}],
        "queues": [{"name": "till", "path": [[16, 8], [9, 8], [9, 2]], "service_secs": 3}],
        "journeys": [{"name": "buy", "stages": ["till", "east"]}],
        "grids": [{"min": [1, 2], "max": [4, 8], "columns": 3, "rows": 5, "journey": "buy"}],
    })
}

fn all_to(simulation: &Simulation, goal: Vector) -> Vec<(u32, Vector)> {
    let ids = simulation.frame().agents.id.iter();
    ids.map(|&id| (id, goal)).collect()
}

/// A simulation whose agents see their goals at the start, with the floor for later goals.
fn with_floor(document: &Value) -> Simulation {
    let scenario = scenario(document, &[]).unwrap();
    let floor = scenario.floor().unwrap().unwrap();
    let mut simulation = start(document, &[]);
    simulation.set_later_routes(floor);
    simulation
}

#[test]
fn agents_walk_around_the_corner_to_a_new_goal() {
    let mut simulation = with_floor(&corner());
    go_on(&mut simulation, 2.0);
    let goal = Vector::new(11.0, 9.0);
    let new = all_to(&simulation, goal);
    simulation.set_goals(&new).unwrap();
    go_on(&mut simulation, 30.0);
    for position in &simulation.frame().agents.position {
        assert!((position - goal).norm() < 1.5, "{position:?}");
    }
    assert_eq!(simulation.outcome().contained.count, 0);
}

#[test]
fn the_same_goals_give_the_same_bits() {
    let run = || {
        let mut simulation = with_floor(&corner());
        for k in 0..20 {
            go_on(&mut simulation, 0.5 * f64::from(k + 1));
            let to = Vector::new(11.0, 3.0 + 0.25 * f64::from(k));
            simulation.set_goals(&[(k % 8, to)]).unwrap();
        }
        simulation.digest()
    };
    assert_eq!(run(), run());
}

#[test]
fn goals_that_no_agent_has_any_more_take_no_memory() {
    let mut simulation = with_floor(&corner());
    let mut goals = |k: u32| {
        let goal = Vector::new(11.0, 4.0 + f64::from(k) * 1e-3);
        let new = all_to(&simulation, goal);
        simulation.set_goals(&new).unwrap();
        simulation.step().unwrap();
        let routes = simulation.scene().routes.as_ref();
        routes.unwrap().goals().len()
    };
    let first = goals(0);
    assert!((1..1200).all(|k| goals(k) <= first + 1));
}

#[test]
fn agents_leave_a_queue_and_the_others_move_up() {
    let mut simulation = after(&shop(), &[], 25.0);
    let queued = |simulation: &Simulation| -> Vec<(u32, u32)> {
        let agents = simulation.frame().agents;
        let trips = agents.trip.iter().zip(&agents.id);
        let tickets = trips.filter_map(|(trip, &id)| match trip.as_ref()?.status {
            Status::Queued { ticket, .. } => Some((ticket, id)),
            _ => None,
        });
        let mut tickets: Vec<_> = tickets.collect();
        tickets.sort_unstable();
        tickets
    };
    let before = queued(&simulation);
    assert!(before.len() >= 4, "{before:?}");
    let (_, second) = before[1];
    let goal = Vector::new(2.0, 1.0);
    simulation.set_goals(&[(second, goal)]).unwrap();
    simulation.evaluate().unwrap();
    let behind = queued(&simulation);
    let order = |all: &[(u32, u32)]| -> Vec<u32> { all.iter().map(|&(_, id)| id).collect() };
    let mut expected = order(&before);
    expected.retain(|&id| id != second);
    assert_eq!(order(&behind), expected);
    for pair in behind.windows(2) {
        assert_eq!(pair[1].0, pair[0].0 + 1, "no ticket is missing: {behind:?}");
    }
    go_on(&mut simulation, 90.0);
    let arrived = simulation.outcome().arrivals.iter();
    assert_eq!(arrived.count(), 14, "all others have been served");
    let agents = simulation.frame().agents;
    assert_eq!(agents.id, [second]);
    assert!((agents.position[0] - goal).norm() < 0.5);
    let places = &simulation.progress().places;
    assert!(places.iter().all(|place| place.bound == 0), "{places:?}");
}

#[test]
fn unknown_agents_and_goals_in_walls_are_errors_that_change_nothing() {
    let mut simulation = with_floor(&corner());
    go_on(&mut simulation, 1.0);
    let before = simulation.digest();
    let goal = |x, y| Vector::new(x, y);
    let all = all_to(&simulation, goal(5.0, 5.0));
    let in_wall = simulation.set_goals(&all).unwrap_err();
    assert!(matches!(in_wall, ActionError::NotOnFloor(_)), "{in_wall}");
    for number in [f64::NAN, f64::INFINITY, 1e300] {
        let error = simulation.set_goals(&[(0, goal(number, 1.0))]).unwrap_err();
        assert!(matches!(error, ActionError::NotOnFloor(_)), "{error}");
    }
    let new = [(0, goal(8.0, 1.0)), (8, goal(8.0, 1.0))];
    let absent = simulation.set_goals(&new).unwrap_err();
    let text = "agent 8: not present at 1.00 s: only 8 agents have entered, with ids from 0";
    assert_eq!(absent.to_string(), text);
    assert_eq!(simulation.digest(), before);
}
