//! Interventions in a scenario file: what they do at their frames, and what is refused.

use crate::common::simulated::{driven, scenario};
use crate::common::vector;
use sandbox::engine::simulation::{EventKind, Simulation};
use sandbox::runs::drive::Run;
use sandbox::runs::summary::Summary;
use serde_json::{Value, json};

/// Nine people walk through a hall to an exit; others may enter at the top.
fn hall(interventions: Value) -> Value {
    json!({
        "duration_secs": 12,
        "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]]]],
        "exits": [{"name": "east", "line": [[20, 4], [20, 6]]}],
        "waiting_areas": [{"name": "square", "area": [[9, 2], [12, 2], [12, 8], [9, 8]], "for_secs": 90}],
        "journeys": [{"name": "out", "stages": ["east"]}, {"name": "stay", "stages": ["square", "east"]}],
        "zones": [{"name": "mud", "area": [[6, 0], [9, 0], [9, 10], [6, 10]]}],
        "grids": [
            {"name": "people", "min": [1, 3], "max": [4, 7], "columns": 3, "rows": 3, "journey": "out"},
            {"name": "others", "min": [10, 4], "max": [11, 5], "columns": 1, "rows": 1, "journey": "stay"},
        ],
        "entrances": [{"name": "top", "line": [[12, 10], [14, 10]], "at_secs": [100], "journey": "out"}],
        "interventions": interventions,
    })
}

/// The simulation in the frame with this number, evaluated.
fn at(interventions: Value, frame: u64) -> Simulation {
    let document = hall(interventions);
    let mut run = Run::new(scenario(&document, &[]).unwrap()).unwrap();
    while run.simulation.frame().clock.frame() < frame {
        run.simulation.step().unwrap();
    }
    run.simulation.evaluate().unwrap();
    run.simulation
}

#[test]
fn an_intervention_acts_at_the_beginning_of_its_frame() {
    let remove = json!([{"frame": 7, "remove": [2]}]);
    assert!(at(remove.clone(), 6).present(2).is_ok());
    let after = at(remove, 7);
    assert!(after.present(2).is_err());
    let removed = after.outcome().removed[0];
    assert_eq!((removed.id, removed.time), (2, 7.0 * 0.02));
    // With a time instead, in the next coarse frame.
    let remove = json!([{"at_secs": 0.13, "remove": [2]}]);
    assert!(at(remove.clone(), 9).present(2).is_ok());
    assert!(at(remove, 10).present(2).is_err());
}

#[test]
fn people_enter_in_their_order_where_there_is_room() {
    let add = json!({"group": "others", "positions": [[5, 9], [5, 9.1], [0.1, 9], [6, 9]], "velocities":
        [[0.5, 0], [0, 0], [0, 0], [0, 0]]});
    let simulation = at(json!([{"frame": 3, "add": add}]), 3);
    let agents = simulation.frame().agents;
    assert_eq!(agents.entered(), 12); // of the four, one has no room beside another, and one none at the wall
    let [first, second] = [10, 11].map(|id| agents.index_of(id).unwrap());
    assert_eq!(agents.position[first], vector(5.0, 9.0));
    assert_eq!(agents.velocity[first], vector(0.5, 0.0));
    assert_eq!(agents.position[second], vector(6.0, 9.0));
    let event = simulation.events().last().unwrap();
    assert_eq!(
        (event.kind, &*event.name),
        (EventKind::Intervention, "2 of 4 agents enter")
    );
}

#[test]
fn a_report_counts_people_who_were_removed() {
    let document = hall(json!([{"frame": 5, "remove": [0, 1, 99]}]));
    let run = driven(&document);
    let summary = Summary::of(&run);
    assert_eq!((summary.agents, summary.removed), (10, 2));
    assert_eq!(summary.arrived + summary.remaining + summary.removed, 10);
    let words = run.simulation.events().iter().map(|event| &*event.name);
    assert!(
        words
            .into_iter()
            .any(|name| name == "2 of 3 agents are removed")
    );
    let without = serde_json::to_value(Summary::of(&driven(&hall(json!([]))))).unwrap();
    assert!(without.get("removed").is_none());
    // Those who stay all leave: the times are of them alone.
    let mut longer = hall(json!([{"frame": 5, "remove": [0, 1, 9]}]));
    longer["duration_secs"] = json!(40);
    let summary = Summary::of(&driven(&longer));
    assert_eq!((summary.arrived, summary.remaining), (7, 0));
    assert!(summary.t100_secs.is_some());
}

#[test]
fn what_is_no_intervention_is_refused_with_its_place() {
    for (given, said) in [
        (
            json!({"remove": [1]}),
            "interventions[0]: give `frame` or `at_secs`, and not both",
        ),
        (
            json!({"frame": 1}),
            "interventions[0]: give one of `add`, `remove`",
        ),
        (
            json!({"frame": 1, "remove": [1], "open": "east"}),
            "and `set_zone`, not `open` and `remove`",
        ),
        (
            json!({"frame": 1, "add": {"group": "peple", "positions": [[1, 1]]}}),
            "interventions[0].add.group: no group is named `peple`; did you mean `people`?",
        ),
        (
            json!({"frame": 1, "add": {"group": "people", "positions": [[1, 1]], "velocities": [[1, 0], [1, 0]]}}),
            "interventions[0].add.velocities: 2 for 1 positions; give one for each",
        ),
        (
            json!({"frame": 1, "add": {"group": "people", "positions": [[30, 1]]}}),
            "interventions[0].add.positions[0]: (30, 1) lies in an obstacle or outside of the walkable area",
        ),
        (
            json!({"frame": 1, "set_goal": {"agents": [1], "goals": [[1, 50]]}}),
            "interventions[0].set_goal.goals[0]: (1, 50) lies in an obstacle or outside of the walkable area",
        ),
        (
            json!({"frame": 1, "remove": [4, 1, 4]}),
            "interventions[0].remove[2]: agent 4 is given twice; remove one",
        ),
        (
            json!({"frame": 1, "set_goal": {"agents": [1, 2], "goals": [[1, 5], [2, 5], [3, 5]]}}),
            "interventions[0].set_goal.goals: 3 for 2 agents; give one for all, or one for each",
        ),
        (
            json!({"frame": 1, "set_journey": {"agents": [1], "journey": "in"}}),
            "interventions[0].set_journey.journey: no journey is named `in`; there are out, stay",
        ),
        (
            json!({"frame": 1, "set_speed": {"agents": [1], "preferred_speeds": [-1]}}),
            "interventions[0].set_speed.preferred_speeds[0]: must be at least 0 and at most 100, not -1",
        ),
        (
            json!({"frame": 1, "close": "square"}),
            "interventions[0].close: `square` is a waiting area; exits, doors and entrances can open and close",
        ),
        (
            json!({"frame": 1, "release": "east"}),
            "interventions[0].release: `east` is an exit; exits, doors and entrances can open and close",
        ),
        (
            json!({"frame": 1, "set_capacity": {"exit": "square", "most_per_sec": 1}}),
            "interventions[0].set_capacity.exit: no exit is named `square`; there are east",
        ),
        (
            json!({"frame": 1, "set_zone": {"zone": "mud", "speed_factor": 0}}),
            "interventions[0].set_zone.speed_factor: must be at least 0.01 and at most 10, not 0",
        ),
        (
            json!({"frame": 1, "push": {"region": [[0, 0], [1, 1]], "for_secs": 1, "direction": [1, 0]}}),
            "interventions[0].push.direction: is for `acceleration`, which is not given",
        ),
    ] {
        let error = scenario(&hall(json!([given])), &[]).unwrap_err();
        assert!(error.contains(said), "{given}:\n{error}");
    }
}

#[test]
fn a_rate_that_is_set_again_and_again_lets_as_many_people_arrive() {
    // Independent of each other: the mean number and its standard deviation are those of one flow.
    let arrived = |seed: u64, again: bool| {
        let all = (1..60)
            .map(|k| json!({"at_secs": 10 * k, "set_rate": {"entrance": "in", "per_sec": 0.2}}));
        let document = json!({
            "seed": seed, "duration_secs": 600, "profile": "sph",
            "walkable_area": [[[[0, 0], [8, 0], [8, 6], [0, 6]]]],
            "exits": [{"name": "out", "line": [[8, 1], [8, 5]]}],
            "entrances": [{"name": "in", "line": [[0, 1], [0, 5]], "per_sec": 0.2, "arrivals": "poisson"}],
            "interventions": if again { all.collect() } else { Vec::new() },
            "time_step_secs": 0.05,
        });
        f64::from(Summary::of(&driven(&document)).agents)
    };
    let [once, again] = [false, true].map(|again| {
        let all = (1..=20).map(|seed| arrived(seed, again));
        all.collect::<Vec<f64>>()
    });
    // The same rate from other moments on gives the same arrivals, but for rounding.
    let same = once
        .iter()
        .zip(&again)
        .filter(|(a, b)| (*a - *b).abs() <= 1.0);
    assert!(same.count() == 20, "{once:?} {again:?}");
    let mean = again.iter().sum::<f64>() / 20.0;
    assert!((mean - 120.0).abs() < 10.0, "{mean}");
}
