//! Quickest routes: aisles and doors that are used, one-way doors, doors that close, and journeys that branch.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Destination, Rooms, WIDEST};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

use crate::common::floors::Plan;
use crate::common::simulated::{after, go_on, scenario, start};

/// Two rooms of 10 m × 20 m, joined by doors: (their middle, their width), m. People of the west leave in the east.
pub fn two_rooms(doors: &[(f64, f64)], people: u32) -> Value {
    let gaps = doors.iter().map(|&(y, width)| {
        let (low, high) = (y - width / 2.0, y + width / 2.0);
        json!([[[9.9, low], [10.3, low], [10.3, high], [9.9, high]]])
    });
    let rooms = [
        json!([[[0, 0], [10, 0], [10, 20], [0, 20]]]),
        json!([[[10.2, 0], [20, 0], [20, 20], [10.2, 20]]]),
    ];
    json!({
        "duration_secs": 200, "profile": "walk+sph", "route_choice": "quickest",
        "walkable_area": rooms.into_iter().chain(gaps).collect::<Vec<_>>(),
        "exits": [{"name": "end", "line": [[20, 0], [20, 20]]}],
        "crowds": [{"area": [[1, 1], [8, 1], [8, 19], [1, 19]], "number": people}],
        "stop": {"when_empty": true},
    })
}

/// Runs until all have left, and returns the time by which a part of the agents have left, and the number of changes of
/// mind per agent and second on their way.
fn emptied(document: &Value) -> (f64, f64) {
    let mut simulation = start(document, &[]);
    let people = simulation.frame().agents.len();
    let mut seconds = 0.0;
    let mut of_agent = vec![0; people];
    while simulation.outcome().arrivals.len() < people {
        let until = seconds_of(&simulation) + 0.5;
        go_on(&mut simulation, until);
        assert!(seconds_of(&simulation) < 250.0, "some agents do not leave");
        let agents = simulation.frame().agents;
        seconds += 0.5 * agents.count_present() as f64;
        for (&id, plan) in agents.id.iter().zip(&agents.plan) {
            of_agent[id as usize] = plan.map_or(of_agent[id as usize], |plan| plan.changes);
        }
    }
    let changes: u32 = of_agent.iter().sum();
    let at = &simulation.outcome().arrivals[(people * 95).div_ceil(100) - 1];
    (at.time, f64::from(changes) / seconds)
}

fn seconds_of(simulation: &Simulation) -> f64 {
    simulation.frame().clock.time()
}

/// The stadium, and the same with a choice between its aisles by hand.
fn stadiums() -> [Value; 2] {
    let by_time: Value = serde_json::from_str(include_str!("../scenarios/stadium.json")).unwrap();
    let mut by_hand = by_time.clone();
    let aisles = [("left", 0.0), ("middle", 7.2), ("right", 14.4)];
    let aisles =
        aisles.map(|(name, x)| json!({"name": name, "line": [[x, -0.3], [x + 1.2, -0.3]]}));
    by_hand["route_choice"] = json!("shortest");
    by_hand["waypoints"] = json!(aisles);
    by_hand["journeys"] =
        json!([{"name": "leave", "stages": [{"quickest": ["left", "middle", "right"]}, "exit"]}]);
    for block in by_hand["grids"].as_array_mut().unwrap() {
        block["journey"] = json!("leave");
    }
    [by_time, by_hand]
}

/// The mean over seeds of the time by which 95 % have left, and of the changes of mind.
fn mean_emptied(document: &Value, seeds: u64) -> (f64, f64) {
    let of = |seed| {
        let mut document = document.clone();
        document["seed"] = json!(seed);
        emptied(&document)
    };
    let all: Vec<(f64, f64)> = (1..=seeds).into_par_iter().map(of).collect();
    let (times, changes): (Vec<f64>, Vec<f64>) = all.into_iter().unzip();
    let mean = |values: Vec<f64>| values.iter().sum::<f64>() / seeds as f64;
    (mean(times), mean(changes))
}

#[test]
fn the_stadium_empties_nearly_as_fast_as_with_a_split_by_hand() {
    let [by_time, by_hand] = stadiums();
    let ((time, changes), (hand, _)) = (mean_emptied(&by_time, 5), mean_emptied(&by_hand, 5));
    assert!(time < 1.05 * hand, "{time} s, by hand {hand} s");
    assert!(changes < 1.0 / 3.0, "{changes} changes per second");
}

/// A hall whose people leave by two doors into an anteroom; each door has its ends.
fn hall(doors: [[f64; 2]; 2], crowd: &Value) -> Value {
    let doorways =
        doors.map(|[low, high]| json!([[[low, -0.3], [high, -0.3], [high, 0.1], [low, 0.1]]]));
    let rooms = [
        json!([[[0, 0], [30, 0], [30, 20], [0, 20]]]),
        json!([[[0, -6.2], [30, -6.2], [30, -0.2], [0, -0.2]]]),
    ];
    json!({
        "duration_secs": 300, "profile": "walk+sph", "route_choice": "quickest",
        "walkable_area": rooms.into_iter().chain(doorways).collect::<Vec<_>>(),
        "exits": [{"name": "end", "line": [[0, -6.2], [30, -6.2]]}],
        "crowds": [{"area": crowd, "number": 300}],
        "stop": {"when_empty": true},
    })
}

#[test]
fn unequal_and_distant_doors_are_used_as_well_as_with_the_best_of_18_splits() {
    let (unequal, all) = (
        [[6.0, 7.0], [23.0, 25.0]],
        json!([[5, 5], [25, 5], [25, 18], [5, 18]]),
    );
    let (distant, near) = (
        [[1.5, 2.5], [27.5, 28.5]],
        json!([[0.5, 2], [12, 2], [12, 18], [0.5, 18]]),
    );
    for (doors, crowd) in [(unequal, all), (distant, near)] {
        let document = hall(doors, &crowd);
        let mut split = document.clone();
        split["route_choice"] = json!("shortest");
        let line = |[low, high]: [f64; 2]| [[low, -0.1], [high, -0.1]];
        let waypoints = [("a", doors[0]), ("b", doors[1])];
        split["waypoints"] =
            json!(waypoints.map(|(name, door)| json!({"name": name, "line": line(door)})));
        split["crowds"][0]["journey"] = json!("leave");
        let times = (1..19).into_par_iter().map(|part| {
            let mut split = split.clone();
            let stage = json!({"shares": {"a": part, "b": 19 - part}});
            split["journeys"] = json!([{"name": "leave", "stages": [stage, "end"]}]);
            emptied(&split).0
        });
        let best = times.reduce(|| f64::INFINITY, f64::min);
        let (time, _) = emptied(&document);
        assert!(time < 1.05 * best, "{time} s, with the best split {best} s");
    }
}

#[test]
fn a_breakdown_shows_the_routes_that_an_agent_compares() {
    let mut simulation = after(&stadiums()[0], &[], 6.0);
    simulation.evaluate().unwrap();
    let mut seen = 0;
    for i in simulation.frame().agents.present() {
        let breakdown = Breakdown::of(&simulation, i).unwrap();
        let Some(choice) = breakdown.route_choice.as_ref() else {
            continue;
        };
        seen += 1;
        for way in &choice.routes {
            let waiting = way
                .flow_per_sec
                .map_or(0.0, |flow| f64::from(way.ahead) / flow);
            let walking = way.length / 1.4;
            let through = way.through_secs.unwrap();
            // The people ahead pass at the flow, but not before they have walked there (`routes_by_time.rs`).
            assert!(through > walking.max(waiting) - 1e-9, "{way:?}");
            assert!(through < walking + waiting + 1e-9, "{way:?}");
            assert!(way.total_secs.unwrap() >= through, "{way:?}");
        }
        let times = choice.routes.iter().map(|way| way.total_secs.unwrap());
        let times: Vec<f64> = times.collect();
        assert!(times.is_sorted(), "{choice:?}");
        assert!(breakdown.to_string().contains("quickest route: "));
    }
    assert!(seen > 300);
}

#[test]
fn without_times_a_breakdown_says_that_an_agent_takes_the_shortest_way() {
    let mut document = two_rooms(&[(4.0, 1.0)], 60);
    document["route_choice"] = json!("shortest");
    document["doors"] = json!([{"name": "door", "line": [[10.1, 3.5], [10.1, 4.5]]}]);
    let mut simulation = after(&document, &[], 3.0);
    simulation.evaluate().unwrap();
    let agents: Vec<usize> = simulation.frame().agents.present().collect();
    let mut seen = 0;
    for i in agents {
        let breakdown = Breakdown::of(&simulation, i).unwrap();
        let Some(choice) = &breakdown.route_choice else {
            continue;
        };
        seen += 1;
        assert!(!choice.by_time);
        assert!(
            choice
                .routes
                .iter()
                .all(|way| way.flow_per_sec.is_none() && way.total_secs.is_none())
        );
        let said = breakdown.to_string();
        assert!(
            !said.contains("time: ") && !said.contains("ahead at"),
            "{said}"
        );
        assert!(said.contains("routes out of the room: "), "{said}");
    }
    assert!(seen > 0);
}

#[test]
fn equal_doors_are_used_alike_and_wide_doors_more() {
    // The part of the people that take the northern door, over five seeds.
    let northern = |doors: &[(f64, f64)]| {
        let counts = (1..=5).into_par_iter().map(|seed| {
            let mut document = two_rooms(doors, 160);
            document["seed"] = json!(seed);
            let mut simulation = start(&document, &[]);
            let mut north = std::collections::BTreeSet::new();
            for tenth in 1..600 {
                go_on(&mut simulation, f64::from(tenth) / 10.0);
                let agents = simulation.frame().agents;
                for (&id, p) in agents.id.iter().zip(&agents.position) {
                    if (10.0..10.6).contains(&p.x) && p.y > 10.0 {
                        north.insert(id);
                    }
                }
            }
            north.len()
        });
        counts.sum::<usize>() as f64 / 800.0
    };
    let alike = northern(&[(5.0, 1.0), (15.0, 1.0)]);
    // Three standard deviations of 800 fair coins are 0.053.
    assert!(
        (alike - 0.5).abs() < 0.053,
        "{alike} take the northern of two equal doors"
    );
    let wide = northern(&[(5.0, 0.9), (15.0, 2.7)]);
    assert!(
        (wide - 0.75).abs() < 0.1,
        "{wide} take the door that is three times as wide"
    );
}

#[test]
fn without_a_crowd_the_quickest_way_is_the_shortest_to_the_last_bit() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for _ in 0..10 {
        let doors = [
            (5.0, rng.random_range(0.8..3.0)),
            (15.0, rng.random_range(0.8..3.0)),
        ];
        let mut document = two_rooms(&doors, 1);
        document["seed"] = json!(rng.random_range(0..1000));
        let quickest = after(&document, &[], 15.0);
        document["route_choice"] = json!("shortest");
        assert_eq!(after(&document, &[], 15.0).digest(), quickest.digest());
    }
}

#[test]
fn runs_have_the_same_bits_on_any_number_of_threads_and_when_they_are_resumed() {
    let [document, _] = stadiums();
    let mut digests = Vec::new();
    for threads in 1..=3 {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        digests.push(pool.install(|| {
            let first = after(&document, &[], 8.3);
            let scene = scenario(&document, &[]).unwrap().scene;
            let mut second = Simulation::resumed(scene, first.state()).unwrap();
            go_on(&mut second, 16.0);
            second.digest()
        }));
    }
    digests.push(after(&document, &[], 16.0).digest());
    assert!(
        digests.windows(2).all(|pair| pair[0] == pair[1]),
        "{digests:?}"
    );
}

#[test]
fn rooms_lead_to_all_goals_that_routes_lead_to() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    for _ in 0..60 {
        let plan = Plan::random(&mut rng);
        let areas = plan.areas();
        let width = rng.random_range(0.0..1.0);
        let Ok(floor) = sandbox::engine::routes::Floor::new(&areas, width) else {
            continue;
        };
        let middles = || (0..floor.mesh.triangles().len() as u32).map(|t| floor.mesh.middle(t));
        let goal: Vector = middles()
            .nth(rng.random_range(0..middles().count()))
            .unwrap();
        let goals = [vec![sandbox::engine::routes::Goal::Point(goal)]];
        let rooms = Rooms::new((&areas, None), [width, WIDEST], &[], &goals).unwrap();
        let routes = sandbox::engine::routes::Routes::new(floor.clone(), &goals, vec![]).unwrap();
        for p in middles() {
            let way = routes.open_way(p, Destination::Place(0));
            let by_rooms = rooms.length(p, 0);
            assert_eq!(
                way.is_some(),
                by_rooms.is_finite(),
                "{plan:?}: from {p} to {goal}"
            );
            // A way over the middles of openings lacks at most half of each opening that it crosses.
            let lacks: f64 = rooms
                .openings()
                .iter()
                .map(|opening| opening.width() / 2.0)
                .sum();
            if let Some(way) = way {
                assert!(
                    by_rooms >= way.length - lacks - 1e-6,
                    "{plan:?}: from {p} to {goal}"
                );
            }
        }
    }
}

#[test]
fn some_of_a_journey_leave_at_an_exit_before_its_last_stage() {
    let document = json!({
        "seed": 4, "walkable_area": [[[[0, 0], [30, 0], [30, 10], [0, 10]]]],
        "exits": [{"name": "side", "line": [[10, 0], [14, 0]]}, {"name": "end", "line": [[30, 2], [30, 8]]}],
        "waypoints": [{"name": "gate", "line": [[16, 0], [16, 10]]}],
        "journeys": [{"name": "j", "stages": [{"shares": {"side": 1, "gate": 3}}, "end"]}],
        "grids": [{"min": [1, 1], "max": [9, 9], "columns": 10, "rows": 10, "journey": "j"}],
    });
    let simulation = after(&document, &[], 60.0);
    let passed: Vec<u32> = simulation
        .progress()
        .places
        .iter()
        .map(|place| place.passed)
        .collect();
    assert_eq!(passed[0] + passed[1], 100);
    assert_eq!(passed[1], passed[2]);
    // Five standard deviations.
    assert!((4..=46).contains(&passed[0]), "{passed:?}");
    let mut all = document;
    all["journeys"][0]["stages"][0] = json!({"shares": {"side": 1}});
    let error = Scenario::parse(&all.to_string(), "f.json", &[])
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("stages[0]") && error.contains("last stage"),
        "{error}"
    );
}
