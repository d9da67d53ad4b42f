//! How runs end, and which agents are stuck.

use sandbox::engine::simulation::Fault;
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::drive::{End, Observer, Run};
use sandbox::scenario::Scenario;
use sandbox::scenario::measurements::StuckGroup;
use serde_json::{Value, json};

fn start(document: &Value) -> Run {
    let scenario = Scenario::parse(&document.to_string(), "test.json", &[]).unwrap();
    Run::new(scenario).unwrap()
}

fn drive(run: &mut Run) -> End {
    let observers: &mut [Box<dyn Observer<Fault>>] = &mut [];
    run.drive(observers, || false).unwrap()
}

/// Runs a scenario to its end.
fn ended(document: &Value) -> Run {
    let mut run = start(document);
    let end = drive(&mut run);
    assert_eq!(run.end, Some(end));
    run
}

fn stuck(run: &Run) -> Vec<StuckGroup> {
    run.metrics.stuck(&run.simulation)
}

/// Two agents walk to the right. A wall of 4 m crosses the way of the first.
fn wall() -> Value {
    json!({
        "duration_secs": 30,
        "obstacles": [[[5, -2], [5.5, -2], [5.5, 2], [5, 2]]],
        "agents": [
            {"position": [0, 0], "goal": [10, 0], "remove_within": 0.5},
            {"position": [0, 9], "goal": [10, 9], "remove_within": 0.5}
        ]
    })
}

fn with(mut document: Value, key: &str, value: Value) -> Value {
    document[key] = value;
    document
}

/// The only group of stuck agents.
fn only(run: &Run) -> StuckGroup {
    let groups = stuck(run);
    assert_eq!(groups.len(), 1, "{groups:?}");
    groups[0].clone()
}

#[test]
fn an_agent_before_a_wall_is_stuck_unless_it_finds_routes() {
    let run = ended(&with(wall(), "navigation", json!("straight")));
    let group = only(&run);
    assert_eq!((group.agents, group.agent), (1, 0));
    assert!(
        group
            .cause
            .starts_with("a wall lies between it and its goal"),
        "{group:?}"
    );
    // It has walked 4.5 m at up to 1.4 m/s, and stands at the wall.
    assert!((20.0..27.0).contains(&group.for_secs), "{group:?}");
    assert!((group.at[0] - 4.77).abs() < 0.05, "{group:?}");
    let run = ended(&with(wall(), "navigation", json!("paths")));
    assert_eq!(stuck(&run), []);
    assert_eq!(run.simulation.outcome().arrivals.len(), 2);
}

#[test]
fn an_agent_is_not_stuck_before_20_seconds() {
    let document = with(wall(), "navigation", json!("straight"));
    let run = ended(&with(document, "duration_secs", json!(22)));
    assert_eq!(stuck(&run), []);
}

#[test]
fn a_goal_inside_an_obstacle_is_a_cause_and_agents_that_stay_at_their_goal_are_not_stuck() {
    let mut document = with(wall(), "navigation", json!("straight"));
    document["agents"][0]["goal"] = json!([5.25, 0]);
    document["agents"][0]["remove_within"] = json!(0.2);
    let group = only(&ended(&document));
    assert_eq!(group.cause, "its goal (5.25, 0) lies inside an obstacle");
    // Without `remove_within` agents never leave: they wait before the wall, like a crowd before a stage.
    document["agents"] = json!([{"position": [0, 0], "goal": [5.25, 0]}]);
    assert_eq!(stuck(&ended(&document)), []);
}

#[test]
fn agents_before_a_closed_exit_are_stuck_because_it_is_closed() {
    let document = json!({
        "duration_secs": 60,
        "walkable_area": [[[[0, 0], [10, 0], [10, 4], [0, 4]]]],
        "exits": [{"name": "east", "line": [[10, 1], [10, 3]], "closed_secs": [[0, 50]]}],
        "journeys": [{"name": "out", "stages": ["east"]}],
        "grids": [{"min": [2, 1], "max": [4, 3], "columns": 2, "rows": 2, "journey": "out"}]
    });
    let run = ended(&with(document.clone(), "duration_secs", json!(49)));
    let group = only(&run);
    assert_eq!(
        (group.agents, group.cause.as_str()),
        (4, "the exit `east` is closed until 50 s")
    );
    // It opens at 50 s.
    assert_eq!(stuck(&ended(&document)), []);
}

#[test]
fn a_passage_that_is_too_narrow_is_a_cause() {
    let document = json!({
        "duration_secs": 30,
        "navigation": "straight",
        "obstacles": [
            [[5, 0.15], [6, 0.15], [6, 3], [5, 3]],
            [[5, -3], [6, -3], [6, -0.15], [5, -0.15]]
        ],
        "agents": [{"position": [2, 0], "goal": [9, 0], "remove_within": 0.5, "radius": 0.24}]
    });
    let group = only(&ended(&document));
    assert_eq!(group.cause, "the passage ahead is narrower than its body");
}

#[test]
fn slow_agents_are_not_stuck_and_agents_that_do_not_want_to_walk_are() {
    let mut document = wall();
    document["duration_secs"] = json!(50);
    document["agents"] = json!([
        {"position": [0, 0], "goal": [4, 0], "remove_within": 0.5, "preferred_speed": 0.01},
        {"position": [0, 9], "goal": [4, 9], "remove_within": 0.5, "preferred_speed": 0}
    ]);
    let group = only(&ended(&document));
    assert_eq!(
        (group.agent, group.cause.as_str()),
        (1, "its preferred speed is 0")
    );
}

#[test]
fn two_agents_that_meet_in_a_narrow_corridor_block_each_other() {
    let document = json!({
        "duration_secs": 40,
        "walkable_area": [[[[0, 0], [12, 0], [12, 0.8], [0, 0.8]]]],
        "agents": [
            {"position": [1, 0.4], "goal": [11, 0.4], "remove_within": 0.3},
            {"position": [11, 0.4], "goal": [1, 0.4], "remove_within": 0.3}
        ]
    });
    let group = only(&ended(&document));
    assert_eq!(
        (group.agents, group.cause.as_str()),
        (
            2,
            "agents that walk the other way block it; in narrow places that can last for good"
        )
    );
}

#[test]
fn two_agents_that_are_exactly_head_on_are_told_from_those_without_room_to_pass() {
    let corridor = |shift: f64| {
        json!({
            "profile": "sph",
            "duration_secs": 50,
            "stop": {"when_empty": true},
            "walkable_area": [[[[0, 0], [12, 0], [12, 1.7], [0, 1.7]]]],
            "agents": [
                {"position": [1, 0.85], "goal": [11, 0.85], "remove_within": 0.6, "radius": 0.24},
                {"position": [11, 0.85 + shift], "goal": [1, 0.85], "remove_within": 0.6, "radius": 0.24}
            ]
        })
    };
    let group = only(&ended(&corridor(0.0)));
    let cause = "two agents exactly head-on block each other; move one by a centimeter";
    assert_eq!((group.agents, group.cause.as_str()), (2, cause));
    // The advice helps.
    let moved = ended(&corridor(0.01));
    assert_eq!(moved.simulation.outcome().arrivals.len(), 2);
}

#[test]
fn a_resumed_run_knows_since_when_agents_are_stuck() {
    let document = with(wall(), "navigation", json!("straight"));
    let whole = ended(&document);
    let mut first = start(&document);
    for _ in 0..600 {
        first.simulation.evaluate().unwrap();
        first.metrics.observe(&first.simulation);
        first.simulation.integrate().unwrap();
    }
    first.simulation.evaluate().unwrap();
    first.metrics.observe(&first.simulation);
    let checkpoint = Checkpoint::of(&first.scenario, &first.simulation, &first.metrics);
    let scenario = checkpoint.scenario(&[]).unwrap();
    let mut second = checkpoint.resume(scenario).unwrap();
    drive(&mut second);
    assert_eq!(stuck(&second), stuck(&whole));
    assert_eq!(second.simulation.digest(), whole.simulation.digest());
}

#[test]
fn a_run_says_why_it_ended() {
    let free = json!({
        "duration_secs": 30,
        "agents": [{"position": [0, 0], "goal": [5, 0], "remove_within": 0.5}]
    });
    assert_eq!(ended(&free).end, Some(End::Duration));
    let empty = with(free.clone(), "stop", json!({"when_empty": true}));
    assert_eq!(ended(&empty).end, Some(End::Empty));
    let mut idle = with(wall(), "stop", json!({"idle_secs": 5}));
    idle["navigation"] = json!("straight");
    assert_eq!(ended(&idle).end, Some(End::Idle));
}

#[test]
fn limited_moves_are_counted_where_they_happen() {
    let run = ended(&with(wall(), "duration_secs", json!(2)));
    let outcome = run.simulation.outcome();
    let frames = run.simulation.frame().clock.frame();
    assert_eq!(outcome.moves, 2 * frames);
    assert_eq!((outcome.clamped.count, outcome.clamped.spot()), (0, None));
    // 40 agents in 1 m² push each other apart at the highest speed.
    let document = json!({
        "duration_secs": 0.5,
        "grids": [{"min": [7, 7], "max": [8, 8], "columns": 8, "rows": 5, "goal": [7.5, 7.5]}]
    });
    let run = ended(&document);
    let clamped = &run.simulation.outcome().clamped;
    let (at, there) = clamped.spot().unwrap();
    assert!(
        clamped.count > 40 && there <= clamped.count && 2 * there > clamped.count,
        "{clamped:?}"
    );
    assert!((at.x - 7.5).hypot(at.y - 7.5) <= 1.5, "{at:?}");
}
