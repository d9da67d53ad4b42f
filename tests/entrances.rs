//! Entrances: agents come in on time where there is room, and wait where there is none.

use crate::common::{bits, go_to, on_threads};
use sandbox::engine::agents::Agents;
use sandbox::engine::entrance::{Arrivals, Entrance, Flow};
use sandbox::engine::geometry::Walls;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

const FLOW: Flow = Flow {
    first: 0,
    waited: 0.0,
    per_sec: 2.5,
    from: 10.0,
    until: 610.0,
    number: None,
};

fn times(arrivals: &Arrivals, seed: u64) -> Vec<f64> {
    let mut times = Vec::new();
    while let Some(time) = arrivals.time(times.len() as u32, times.last().copied(), seed, 0) {
        times.push(time);
    }
    times
}

#[test]
fn constant_arrivals_come_at_equal_intervals() {
    let all = times(&Arrivals::Constant(FLOW), 3);
    assert_eq!(all.len(), 1500);
    let expected = (0..1500).map(|k| 10.0 + 0.4 * f64::from(k));
    assert!(all.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9));
    let few = times(
        &Arrivals::Constant(Flow {
            number: Some(7),
            ..FLOW
        }),
        3,
    );
    assert_eq!(few, all[..7]);
    let given = vec![0.5, 0.5, 3.0];
    assert_eq!(times(&Arrivals::At(given.clone()), 3), given);
}

#[test]
fn poisson_arrivals_have_exponential_gaps_and_the_right_rate() {
    let long = Flow {
        until: 4010.0,
        ..FLOW
    };
    let all = times(&Arrivals::Poisson(long), 3);
    let count = all.len() as f64;
    assert!((count - 10_000.0).abs() < 3.0 * 100.0, "{count}");
    assert!(all.is_sorted() && all[0] > 10.0 && all[all.len() - 1] < 4010.0);
    let starts = std::iter::once(&10.0).chain(&all);
    let mut gaps: Vec<f64> = starts.zip(&all).map(|(a, b)| b - a).collect();
    gaps.sort_by(f64::total_cmp);
    let off = gaps.iter().enumerate().map(|(k, gap)| {
        let expected = 1.0 - (-2.5 * gap).exp();
        (expected - k as f64 / count).abs()
    });
    let off = off.fold(0.0, f64::max) * count.sqrt();
    assert!(off < 1.628, "{off}"); // Kolmogorov-Smirnov, p = 0.01
}

#[test]
fn the_free_parts_of_a_line_are_those_found_by_sampling() {
    let pillar = crate::common::rectangle([4.0, 5.0], [-1.0, 1.0]);
    let near = crate::common::rectangle([7.0, 8.0], [0.1, 1.0]);
    let walls = Walls::new(vec![pillar, near]);
    let entrance = Entrance {
        name: String::new(),
        line: [Vector::new(0.0, -0.5), Vector::new(12.0, 0.5)],
        group: 0,
        goal: Vector::zeros(),
        arrivals: Arrivals::At(Vec::new()),
    };
    let others = [
        (Vector::new(1.0, 0.0), 0.3),
        (Vector::new(10.0, 0.2), 0.25),
        (Vector::new(10.3, 0.2), 0.2),
    ];
    let radius = 0.24;
    let free = entrance.free(radius, &walls, others.into_iter());
    assert!(free.len() >= 4, "{free:?}");
    let length = (entrance.line[1] - entrance.line[0]).norm();
    for k in 0..10_000 {
        let along = length * (f64::from(k) + 0.5) / 10_000.0;
        let p = entrance.at(along);
        let clear = others
            .iter()
            .all(|(center, other)| (center - p).norm() > radius + other);
        let distance = |k: u32| (walls.wall(k).nearest_point(p).point - p).norm();
        let clear = clear && (0..8).all(|k| distance(k) > radius) && walls.obstacle_at(p).is_none();
        let found = free.iter().any(|[from, to]| (*from..=*to).contains(&along));
        assert_eq!(found, clear, "{along}");
    }
}

/// A corridor 3 m wide with an entrance at its left end and, if it is `closed`, a wall across it.
fn corridor(entrance: Value, closed: bool) -> Value {
    let wall = json!([[8, -1], [9, -1], [9, 4], [8, 4]]);
    json!({
        "seed": 2, "goal": [28, 1.5], "duration_secs": 60, "navigation": "straight",
        "walkable_area": [[[[0, 0], [30, 0], [30, 3], [0, 3]]]],
        "obstacles": if closed { json!([wall]) } else { json!([]) },
        "entrances": [entrance]
    })
}

fn scene(document: &Value) -> Scene {
    Scenario::parse(&document.to_string(), "f", &[])
        .unwrap()
        .scene
}

fn line(keys: Value) -> Value {
    let mut entrance = json!({"name": "door", "line": [[0.5, 0], [0.5, 3]], "remove_within": 1});
    entrance
        .as_object_mut()
        .unwrap()
        .extend(keys.as_object().unwrap().clone());
    entrance
}

/// The largest overlap of two bodies among those that entered since there were `before`, meters.
fn overlap(agents: &Agents, before: u32) -> f64 {
    let mut deepest = f64::NEG_INFINITY;
    for i in (0..agents.len()).filter(|&i| agents.id[i] >= before) {
        for j in (0..agents.len()).filter(|&j| j != i) {
            let distance = (agents.position[i] - agents.position[j]).norm();
            deepest = deepest.max(agents.radius[i] + agents.radius[j] - distance);
        }
    }
    deepest
}

#[test]
fn agents_enter_on_time_and_the_run_ends_when_all_have_left() {
    let entrance = line(json!({"per_sec": 1.5, "from_secs": 1, "number": 12}));
    let mut simulation = Simulation::new(scene(&corridor(entrance, false))).unwrap();
    let mut entered = Vec::new();
    while simulation.expects_agents() || !simulation.frame().agents.is_empty() {
        simulation.evaluate().unwrap();
        let frame = simulation.frame();
        for _ in entered.len()..frame.agents.entered() as usize {
            entered.push(frame.clock.time());
        }
        simulation.integrate().unwrap();
        assert!(simulation.frame().clock.time() < 60.0);
    }
    assert_eq!(simulation.outcome().arrivals.len(), 12);
    for (k, time) in entered.into_iter().enumerate() {
        let late = time - (1.0 + k as f64 / 1.5);
        assert!((-1e-9..0.1).contains(&late), "{k}: {late}");
    }
}

#[test]
fn without_room_agents_wait_and_none_are_lost_or_overlap() {
    let entrance = line(json!({"per_sec": 20, "arrivals": "poisson", "until_secs": 20}));
    let mut simulation = Simulation::new(scene(&corridor(entrance, true))).unwrap();
    let (mut before, mut largest) = (0, (0, 0));
    for _ in 0..1500 {
        simulation.evaluate().unwrap();
        let frame = simulation.frame();
        let now = frame.agents.entered();
        let backlog = simulation.backlogs().next().unwrap();
        if frame.clock.is_coarse() {
            assert!(
                overlap(frame.agents, before) <= 0.0,
                "{}",
                frame.clock.time()
            );
        }
        if backlog.waiting > largest.0 {
            largest = (backlog.waiting, frame.clock.frame());
        }
        before = now;
        simulation.integrate().unwrap();
    }
    let backlog = simulation.backlogs().next().unwrap();
    assert_eq!(
        (backlog.name, backlog.largest, backlog.largest_frame),
        ("door", largest.0, largest.1)
    );
    assert!(backlog.waiting > 100, "{backlog:?}");
    assert!(simulation.expects_agents());
    // All that arrived are in the corridor or wait.
    let scene = simulation.scene();
    let arrived = times(&scene.entrances[0].arrivals, scene.seed).len() as u32;
    assert_eq!(
        arrived,
        simulation.frame().agents.entered() + backlog.waiting
    );
    assert_eq!(simulation.outcome().displaced, []);
}

#[test]
fn a_run_resumes_bit_identically_while_agents_wait() {
    let traits = json!({"per_sec": 8, "arrivals": "poisson", "preferred_speed": {"uniform": [0.8, 1.6]},
                        "premovement_secs": {"exponential": 2}});
    let scene = scene(&corridor(line(traits), true));
    let mut whole = Simulation::new(scene.clone()).unwrap();
    let mut resumed = whole.clone();
    on_threads(1, || go_to(&mut whole, 600));
    let mut waited = false;
    for stop in [0, 4, 101, 350, 352, 500] {
        go_to(&mut resumed, stop);
        waited |= resumed.backlogs().any(|backlog| backlog.waiting > 0);
        let written = postcard::to_stdvec(&resumed.state()).unwrap();
        let state = postcard::from_bytes(&written).unwrap();
        resumed = Simulation::resumed(scene.clone(), state).unwrap();
    }
    assert!(waited);
    on_threads(2, || go_to(&mut resumed, 600));
    assert!(bits(&whole) == bits(&resumed));
    let backlogs = |of: &Simulation| format!("{:?}", of.backlogs().collect::<Vec<_>>());
    assert_eq!(backlogs(&whole), backlogs(&resumed));
}

#[test]
fn arrivals_do_not_depend_on_behavior_or_on_other_entrances() {
    let poisson = line(json!({"per_sec": 1, "arrivals": "poisson", "number": 20}));
    let mut two = corridor(poisson.clone(), false);
    two["behavior_seed"] = 99.into();
    two["entrances"] = json!([poisson, {"line": [[2, 0], [2, 3]], "at_secs": [100]}]);
    let [one, two] = [corridor(poisson, false), two].map(|document| {
        let mut simulation = Simulation::new(scene(&document)).unwrap();
        go_to(&mut simulation, 1000);
        bits(&simulation)
    });
    assert!(!one.is_empty() && one == two);
}

#[test]
fn the_number_of_agents_is_bounded_before_the_run() {
    for (keys, expected) in [
        (json!({"per_sec": 2}), 121..=122),
        (json!({"per_sec": 2, "until_secs": 10}), 20..=21),
        (json!({"per_sec": 2, "number": 5}), 5..=5),
        (json!({"per_sec": 2, "from_secs": 70}), 0..=0),
        (json!({"at_secs": [1, 2, 70]}), 2..=2),
        (json!({"per_sec": 2, "arrivals": "poisson"}), 150..=260),
    ] {
        let text = corridor(line(keys.clone()), false).to_string();
        let scenario = Scenario::parse(&text, "f", &[]).unwrap();
        assert!(
            expected.contains(&scenario.entering),
            "{keys}: {}",
            scenario.entering
        );
    }
}

#[test]
fn agents_beyond_the_ends_of_the_line_take_no_room_from_it() {
    let entrance = Entrance {
        name: "door".to_owned(),
        line: [[0.0, 0.0].into(), [2.0, 0.0].into()],
        group: 0,
        goal: [10.0, 0.0].into(),
        arrivals: Arrivals::At(vec![0.0]),
    };
    let others = [-9.0, -5.0, 4.0, 8.0].map(|x| ([x, 0.0].into(), 0.25));
    let walls = Walls::new(Vec::new());
    let free = entrance.free(0.25, &walls, others.into_iter());
    assert_eq!(free, [[0.0, 2.0]]);
}
