//! Exits: agents leave where they cross the line, and a door lets out as many people wherever the line lies.

use proptest::prelude::*;
use rayon::prelude::*;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::runs::summary::Summary;
use sandbox::scenario::measurements::Left;
use serde_json::{Value, json};

use crate::common::bounded::config;
use crate::common::simulated::{after, driven, measured, scenario, start};

/// A room of 10 × 10 m with a door of this width in a wall of this thickness, and an exit `behind` meters behind the
/// door; `None`: on the edge of the plan, without a wall.
fn room(width: f64, wall: f64, behind: Option<f64>) -> Value {
    let (low, high) = (5.0 - 0.5 * width, 5.0 + 0.5 * width);
    let mut areas = vec![json!([[[0, 0], [10, 0], [10, 10], [0, 10]]])];
    let mut line = [[10.0, low], [10.0, high]];
    if let Some(behind) = behind {
        let x = 10.0 + wall;
        areas.push(json!([[[10, low], [x, low], [x, high], [10, high]]]));
        areas.push(json!([[[x, 0], [x + 14.0, 0], [x + 14.0, 10], [x, 10]]]));
        let (low, high) = ((low - behind).max(0.0), (high + behind).min(10.0));
        line = [[x + behind, low], [x + behind, high]];
    }
    json!({
        "walkable_area": areas,
        "exits": [{"name": "door", "line": line}],
        "crowds": [{"area": [[0, 0], [9.5, 0], [9.5, 10], [0, 10]], "number": 150}],
        "stop": {"when_empty": true},
    })
}

/// The mean flow through the door of the 21st to the 120th agent over seeds, and its standard error, P/s.
fn flow(room: &Value, profile: &str, seeds: u64) -> [f64; 2] {
    let door = room["walkable_area"][0][0][1][0].as_f64().unwrap() - 0.01;
    let flows = (1..=seeds).map(|seed| {
        let mut room = room.clone();
        room["seed"] = json!(seed);
        room["profile"] = json!(profile);
        room["duration_secs"] = json!(200);
        room["measurements"] =
            json!([{"line_flow": {"name": "door", "line": [[door, 0], [door, 10]]}}]);
        let times = measured(room).data["door"].clone();
        let time = |k: usize| times[k].as_f64().unwrap();
        100.0 / (time(119) - time(19))
    });
    let flows: Vec<f64> = flows.collect();
    let mean = flows.iter().sum::<f64>() / seeds as f64;
    let squares: f64 = flows.iter().map(|flow| (flow - mean).powi(2)).sum();
    [mean, (squares / ((seeds - 1) * seeds) as f64).sqrt()]
}

/// Doors of some widths in walls of some thicknesses, with the line of the exit in the door and up to 10 m behind it.
/// In the thinnest wall, the line may also lie on the edge of the plan: flows differ by less than 3 %, seeds apart.
#[test]
fn a_door_lets_out_as_many_people_wherever_the_line_of_the_exit_lies() {
    let doors = [
        ("walk+sph", 0.8, 0.05),
        ("walk+sph", 1.2, 1.0),
        ("walk+sph", 2.4, 0.3),
        ("sph", 1.2, 0.05),
        ("sf->sph", 1.0, 0.6),
    ];
    for (profile, width, wall) in doors {
        let edge = (wall < 0.1).then_some(None);
        let behind = [0.0, 0.5, 3.0, 10.0].map(Some);
        let lines: Vec<Option<f64>> = edge.into_iter().chain(behind).collect();
        let flows = lines.par_iter();
        let flows = flows.map(|&behind| flow(&room(width, wall, behind), profile, 6));
        let flows: Vec<[f64; 2]> = flows.collect();
        let mean = flows.iter().map(|[flow, _]| flow).sum::<f64>() / flows.len() as f64;
        for [flow, error] in &flows {
            assert!(
                (flow - mean).abs() < 0.03 * mean + 2.0 * error,
                "{profile}, {width} m in a wall of {wall} m: {flows:.2?} P/s"
            );
        }
    }
}

#[test]
fn flows_do_not_depend_on_the_length_of_coarse_steps() {
    let flows = [1, 5, 20].map(|every| {
        let mut room = room(1.2, 0.2, Some(0.0));
        room["coarse_every"] = json!(every);
        flow(&room, "sph", 4)[0]
    });
    let mean = flows.iter().sum::<f64>() / 3.0;
    let near = |flow: &f64| (flow / mean - 1.0).abs() < 0.03;
    assert!(flows.iter().all(near), "{flows:?} P/s");
}

/// The distance of a point from the line of the only exit of a scene, meters.
fn beyond(simulation: &Simulation, p: Vector) -> f64 {
    let [a, b] = simulation.scene().journeys.places[0].line().unwrap();
    let along = (b - a).normalize();
    along.perp(&(p - a)).abs()
}

proptest! {
    #![proptest_config(config(12))]

    /// In crowds with SPH, agents once left up to 0.27 m before the line, when they touched another one that crossed
    /// it.
    #[test]
    fn agents_leave_in_the_frame_in_which_they_cross_the_line(
        width in 0.8..3.0,
        wall in 0.05..0.8,
        behind in prop_oneof![Just(None), (0.0..2.0).prop_map(Some)],
        profile in prop::sample::select(vec!["sph", "walk+sph", "sf->sph", "sf+sph", "rvo"]),
        coarse_every in prop::sample::select(vec![1, 5, 20]),
        seed in 1..1000,
    ) {
        let mut room = room(width, wall, behind);
        room["profile"] = json!(profile);
        room["seed"] = json!(seed);
        room["coarse_every"] = json!(coarse_every);
        room["crowds"][0]["number"] = json!(60);
        let simulation = after(&room, &[], 25.0);
        let longest = 1.9 * simulation.frame().clock.time_step();
        let arrivals = &simulation.outcome().arrivals;
        // RVO with long coarse steps lets few people out of a narrow door.
        prop_assert!(arrivals.len() > 5, "{} have left", arrivals.len());
        for arrival in arrivals {
            let distance = beyond(&simulation, arrival.position);
            prop_assert!(distance < longest, "{} leaves {distance} m from the line", arrival.id);
        }
    }

    #[test]
    fn a_line_before_the_only_exit_is_passed_as_often_as_the_exit(
        width in 0.8..3.0,
        profile in prop::sample::select(vec!["sph", "walk+sph", "sf->sph", "rvo->sph"]),
        seed in 1..1000,
    ) {
        let mut room = room(width, 0.0, None);
        room["profile"] = json!(profile);
        room["seed"] = json!(seed);
        room["crowds"][0]["number"] = json!(60);
        room["duration_secs"] = json!(40);
        room["measurements"] = json!([{"line_flow": {"name": "near", "line": [[9.95, 0], [9.95, 10]]}}]);
        let run = driven(&room);
        let summary = Summary::of(&run);
        let passed = summary.data["near"].as_array().unwrap().len();
        // Who touches the line of the exit and meets somebody from the other side leaves before it.
        let arrivals = run.simulation.outcome().arrivals.iter();
        let early = arrivals.filter(|one| one.position.x <= 9.95).count();
        // Who has passed the line and stands before the exit when the run ends is on the way.
        let between = passed - summary.arrived.min(passed);
        prop_assert!(summary.arrived <= passed + early && between <= 2, "{} left, {passed} passed", summary.arrived);
    }
}

/// A hall of 12 × 6 m with an exit across its middle, and 20 agents on each side.
fn middle() -> Value {
    json!({
        "walkable_area": [[[[0, 0], [12, 0], [12, 6], [0, 6]]]],
        "exits": [{"name": "stairs", "line": [[6, 2], [6, 4]]}],
        "crowds": [
            {"area": [[1, 1], [5, 1], [5, 5], [1, 5]], "number": 20},
            {"area": [[7, 1], [11, 1], [11, 5], [7, 5]], "number": 20},
        ],
        "stop": {"when_empty": true},
        "duration_secs": 60,
    })
}

#[test]
fn two_crowds_that_meet_at_one_exit_get_out() {
    for profile in ["sph", "walk+sph", "sf->sph", "rvo", "rvo->sph"] {
        let mut hall = middle();
        hall["profile"] = json!(profile);
        let summary = measured(hall);
        assert_eq!(
            summary.arrived, 40,
            "{profile}: {} remain",
            summary.remaining
        );
    }
}

#[test]
fn bodies_that_walk_on_behind_an_exit_count_nowhere() {
    let mut simulation = start(&room(1.2, 0.2, Some(0.0)), &[]);
    let mut most = 0;
    for _ in 0..1500 {
        let frame = simulation.evaluate().unwrap();
        let agents = frame.agents;
        let (all, present) = (agents.len(), agents.count_present());
        most = most.max(all - present);
        let left = simulation.outcome().arrivals.len();
        assert_eq!(left + present, 150);
        assert_eq!(Left::of(&simulation, None).finished as usize, left);
        let agents = simulation.frame().agents;
        for arrival in &simulation.outcome().arrivals {
            assert_eq!(agents.index_of(arrival.id), None);
        }
        for i in agents.present() {
            assert!(
                agents.position[i].x < 10.2 + 0.04,
                "agent {} is outside",
                agents.id[i]
            );
        }
        simulation.integrate().unwrap();
    }
    assert!(most > 3, "{most} bodies walk on at once");
}

/// Two rooms a distance apart, with an exit of the first on its edge between them.
fn rooms(apart: f64) -> Value {
    let x = 10.0 + apart;
    json!({
        "walkable_area": [
            [[[0, 0], [10, 0], [10, 10], [0, 10]]],
            [[[x, 0], [x + 10.0, 0], [x + 10.0, 10], [x, 10]]],
        ],
        "exits": [{"name": "east", "line": [[10, 4], [10, 6]]}],
        "crowds": [
            {"name": "free", "area": [[2, 2], [8, 2], [8, 8], [2, 8]], "number": 10},
            {"name": "locked in", "area": [[x + 2.0, 2], [x + 8.0, 2], [x + 8.0, 8], [x + 2.0, 8]], "number": 10},
        ],
        "stop": {"when_empty": true},
    })
}

#[test]
fn no_way_leads_from_another_room_through_the_wall_behind_an_exit() {
    for apart in [0.7, 1.0, 2.0, 2.9, 3.1, 5.0, 7.0, 7.3] {
        let refused = scenario(&rooms(apart), &[]).err().unwrap();
        assert!(refused.contains("no way leads"), "{apart} m: {refused}");
    }
    let mut alone = rooms(1.0);
    alone["crowds"].as_array_mut().unwrap().truncate(1);
    assert_eq!(after(&alone, &[], 60.0).outcome().arrivals.len(), 10);
}

/// A room with an exit of this width, and another room that lies a distance behind it and reaches over the side of the
/// floor behind the exit by a share of the width; 0: they are flush. Everything is turned.
fn rooms_aside(width: f64, behind: f64, over: f64, is_above: bool, angle: f64) -> Value {
    let (x, low, high) = (10.0 + behind, 4.0, 4.0 + width);
    let (y, top) = match is_above {
        true => (high - over * width, high + 5.0),
        false => (low - 5.0, low + over * width),
    };
    let (sin, cos) = angle.sin_cos();
    let turned = |[x, y]: [f64; 2]| json!([x * cos - y * sin, x * sin + y * cos]);
    let rectangle = |[x0, y0]: [f64; 2], [x1, y1]: [f64; 2]| {
        json!([[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(turned))
    };
    let line = [[10.0, low], [10.0, high]].map(turned);
    let inside = rectangle(
        [x + 0.3, y.max(high + 0.3).min(top - 1.0)],
        [x + 2.0, top - 0.3],
    );
    let below = rectangle([x + 0.3, y + 0.3], [x + 2.0, low - 0.3]);
    json!({
        "walkable_area": [[rectangle([0.0, 0.0], [10.0, 12.0])], [rectangle([x, y], [x + 4.0, top])]],
        "exits": [{"name": "east", "line": line}],
        "crowds": [{"area": if is_above { inside } else { below }, "number": 2}],
    })
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn no_way_leads_from_a_room_beside_the_floor_behind_an_exit(
        width in 1.0..6.0, behind in prop_oneof![0.65..3.0, 3.0..6.0],
        over in prop_oneof![Just(0.0), 0.0..0.08], is_above: bool, angle in prop_oneof![Just(0.0), -3.0..3.0],
    ) {
        let rooms = rooms_aside(width, behind, over, is_above, angle);
        let refused = scenario(&rooms, &[]).err().unwrap_or_default();
        prop_assert!(refused.contains("no way leads"), "{refused}");
    }
}

/// A room around a corner, whose wall begins at the end of an exit: no agent walks through this wall to the exit.
#[test]
fn people_beside_the_floor_behind_an_exit_go_around_the_corner() {
    let leg = json!({
        "profile": "steer+sph",
        "walkable_area": [[[[0, 0], [10, 0], [10, 4], [16, 4], [16, 8], [0, 8]]]],
        "exits": [{"name": "out", "line": [[10, 1], [10, 4]]}],
        "crowds": [{"area": [[12, 5], [15.5, 5], [15.5, 7.5], [12, 7.5]], "number": 20}],
        "duration_secs": 60,
    });
    let mut simulation = start(&leg, &[]);
    for _ in 0..1500 {
        simulation.evaluate().unwrap();
        let agents = &simulation.frame().agents;
        for i in agents.present() {
            let p = agents.position[i];
            assert!(p.x < 10.1 || p.y > 3.95, "{p}: behind the exit");
        }
        simulation.integrate().unwrap();
    }
    assert_eq!(simulation.outcome().arrivals.len(), 20);
}

#[test]
fn people_before_a_closed_exit_move_as_fast_as_their_velocities_say_and_get_no_farther_than_it() {
    let closed = json!({
        "walkable_area": [[[[0, 0], [10, 0], [10, 10], [0, 10]]]],
        "exits": [{"name": "door", "line": [[10, 4.4], [10, 5.6]], "closed_secs": [[0, 1000]]}],
        "crowds": [{"area": [[4, 0.5], [9.5, 0.5], [9.5, 9.5], [4, 9.5]], "number": 90}]
    });
    for profile in ["profile=sph", "profile=steer+sph"] {
        let mut simulation = after(&closed, &[profile], 15.0);
        let step = simulation.frame().clock.time_step();
        // By the numbers of the agents, which are those of the list here.
        let places = |simulation: &Simulation| {
            let agents = simulation.frame().agents;
            let mut all = vec![(Vector::zeros(), 0.0); agents.len()];
            for (i, &id) in agents.id.iter().enumerate() {
                all[id as usize] = (agents.position[i], agents.velocity[i].norm() * step);
            }
            all
        };
        let mut before = places(&simulation);
        let mut routes = vec![[0.0; 2]; before.len()];
        for _ in 0..100 {
            simulation.step().unwrap();
            let now = places(&simulation);
            for (way, (from, to)) in routes.iter_mut().zip(before.iter().zip(&now)) {
                assert!(to.0.x <= 10.0, "{profile}: beyond the exit, at {:?}", to.0);
                *way = [way[0] + (to.0 - from.0).norm(), way[1] + to.1];
            }
            before = now;
        }
        for [walked, expected] in routes {
            assert!(
                expected < walked + 0.1,
                "{profile}: {walked} of {expected} m"
            );
        }
    }
}
