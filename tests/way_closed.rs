//! Ways beside passages that are too narrow: closed passages close nothing else, and ways lead around them.

use sandbox::engine::math::Vector;
use sandbox::engine::ways::Destination;
use serde_json::{Value, json};

use crate::common::simulated::{after, scenario};

fn read(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// The length of the way of each agent of a document, meters.
fn lengths(document: &Value) -> Vec<f64> {
    let scene = scenario(document, &[]).unwrap().scene;
    let ways = scene.ways.as_ref().unwrap();
    let agents = scene.agents.iter();
    let length = agents.map(|agent| {
        let to = Destination::Goal(agent.goal);
        ways.open_way(agent.position, to)
            .map_or(f64::INFINITY, |way| way.length)
    });
    length.collect()
}

#[test]
fn a_step_beside_a_door_does_not_close_the_door() {
    let [x, y] = lengths(&read(include_str!("data/door_step.json")))[..] else {
        panic!("two agents");
    };
    let straight = |a: [f64; 2], b: [f64; 2]| (Vector::from(b) - Vector::from(a)).norm();
    // Around the jamb, the end of the other wall beside it, and on to the goal.
    let rest = straight([6.0, 4.0], [2.0, 2.0]);
    let first = straight([9.0, 4.5], [2.0, 2.0]);
    assert!(y >= first - 1e-9 && y < first + 1.0, "{y}");
    let jamb = straight([9.0, 8.0], [6.2, 5.0]);
    assert!(x >= jamb + rest && x < jamb + rest + 1.5, "{x}");
}

#[test]
fn a_notch_is_no_reason_to_go_around_the_other_side() {
    let found = lengths(&read(include_str!("data/notch.json")));
    assert!(found.iter().all(|length| *length < 5.1), "{found:?}");
}

#[test]
fn agents_take_the_door_beside_a_slit_through_which_they_see_their_goal() {
    let end = after(&read(include_str!("data/slit.json")), &[], 30.0);
    assert_eq!(end.frame().agents.len(), 0);
}

#[test]
fn agents_pushed_behind_a_wall_walk_around_it() {
    let pushed = read(include_str!("data/pushed_out_of_sight.json"));
    let end = after(&pushed, &[], 60.0);
    assert_eq!(end.frame().agents.len(), 0);
}

#[test]
fn an_agent_has_ways_whatever_others_see() {
    let mut slit = read(include_str!("data/slit.json"));
    let alone = lengths(&slit)[0];
    slit["agents"]
        .as_array_mut()
        .unwrap()
        .push(json!({"position": [3, 3], "goal": [7, 5]}));
    assert_eq!(lengths(&slit)[0], alone);
}
