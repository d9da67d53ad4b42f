//! Any obstacles with any people among them: no panics, no long waits, bounded memory, and the properties of walls
//! hold.
//!
//! 20,000 cases; more with `BAD_INPUT_TIMES=10 cargo test …`; see `scenario_robustness.rs`.

use crate::common::bounded::cases;
use crate::common::reading;
use crate::common::wall_checks;
use proptest::prelude::*;
use proptest::sample::select;
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::geometry::Walls;
use sandbox::engine::math::Vector;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

/// Coordinates with which edges touch or are collinear, exactly or nearly.
fn coordinate() -> impl Strategy<Value = f64> + Clone {
    prop_oneof![
        4 => (-4..=4_i32).prop_map(f64::from),
        2 => -5.0..5.0,
        1 => (-4..=4_i32, select(vec![1e-16, -1e-12, 1e-9, -1e-6, 1e-3]))
            .prop_map(|(x, off)| f64::from(x) + off),
        1 => select(vec![1e6, -1e6, 999_999.999, 1e-300, 5e-324]),
    ]
}

fn point() -> impl Strategy<Value = [f64; 2]> + Clone {
    [coordinate(), coordinate()]
}

/// A star-shaped polygon around a point, which never intersects itself.
fn star() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let size = select(vec![1e-7, 1e-3, 1.0, 10.0, 1e5]);
    let corners = prop::collection::vec(0.01..1.0, 3..40);
    (point(), size, corners).prop_map(|([x, y], size, radii)| {
        let turn = std::f64::consts::TAU / radii.len() as f64;
        let [x, y] = [x, y].map(|c| c.clamp(-8e5, 8e5));
        let corner = |(k, r): (usize, f64)| {
            let (sine, cosine) = (turn * k as f64).sin_cos();
            [x + size * r * cosine, y + size * r * sine]
        };
        radii.into_iter().enumerate().map(corner).collect()
    })
}

fn obstacles() -> impl Strategy<Value = Vec<Vec<[f64; 2]>>> {
    let any_list = prop::collection::vec(point(), 0..7);
    let [x, y] = [coordinate(), coordinate()];
    let rectangle = (x, y, point()).prop_map(|(x, y, [z, w])| vec![[x, y], [z, y], [z, w], [x, w]]);
    prop::collection::vec(prop_oneof![any_list, rectangle, star()], 0..6)
}

fn vectors(points: Vec<[f64; 2]>) -> Vec<Vector> {
    points.into_iter().map(Vector::from).collect()
}

#[test]
fn the_properties_of_walls_hold_for_any_obstacles() {
    let radius = || select(vec![0.01, 1.0, 5.0]);
    let asked = || prop::collection::vec((point(), point(), radius()), 1..4);
    cases(
        10_000,
        || (obstacles(), asked()),
        |(lists, asked)| {
            let walls = Walls::new(wall_checks::obstacles(
                lists.into_iter().map(vectors).collect(),
            ));
            for (p, goal, radius) in asked {
                wall_checks::check(&walls, p.into(), goal.into(), radius);
            }
            // If all walls cross each other, there are as many corners as pairs of walls.
            (1 << 20) + 400 * walls.len() as u64 + 100 * (walls.len() as u64).pow(2)
        },
    );
}

/// Any agent that a file can describe, including coincident agents, agents in walls and huge bodies.
fn agent() -> impl Strategy<Value = Value> {
    let radius = select(vec![0.01, 0.24, 1.0, 10.0, 1e308]);
    let mass = select(vec![1e-6, 1.0, 1e6]);
    let speed = select(vec![0.0, 1.0, -70.0, 70.0]);
    let profile = select(vec!["sf", "rvo", "sph", "sf->sph", "rvo->sph"]);
    let body = prop::option::weighted(0.5, (radius, mass));
    (point(), point(), body, [speed.clone(), speed], profile).prop_map(
        |(position, goal, body, velocity, profile)| {
            let mut agent = json!({"position": position, "goal": goal, "velocity": velocity});
            agent["profile"] = json!(profile);
            if let Some((radius, mass)) = body {
                agent["radius"] = json!(radius);
                agent["mass"] = json!(mass);
            }
            agent
        },
    )
}

#[test]
fn any_people_among_any_obstacles_move_or_are_refused() {
    let method = || select(vec!["representative", "exact", "union"]);
    let integrators = [
        "semi-implicit",
        "forward-euler",
        "velocity-verlet",
        "midpoint",
    ];
    let integrator = || select(integrators.to_vec());
    let people = || prop::collection::vec(agent(), 0..20);
    let step = || select(vec![1e-6, 0.02, 1.0]);
    let input = || (obstacles(), people(), method(), integrator(), step());
    cases(
        10_000,
        input,
        |(mut lists, agents, method, integrator, step)| {
            // Because of one invalid polygon, the others would not be tested.
            lists
                .retain(|points| !wall_checks::obstacles(vec![vectors(points.clone())]).is_empty());
            let document = json!({
                "obstacles": lists, "agents": agents, "wall_method": method, "integrator": integrator,
                "time_step_secs": step, "parameters": {"candidates": 20}, "max_speed": 100,
            });
            let text = document.to_string();
            let people = reading::read(&text, &[]);
            (1 << 20) + 150 * text.len() as u64 + 2_000 * people + 8 * people.pow(2)
        },
    );
}

#[test]
fn at_the_corner_of_a_wall_at_most_a_quarter_of_the_disc_is_hidden() {
    // Found by fuzzing: the distance of this corner from one of its walls is −0, and that wall hid 1.5 discs.
    let corner = Vector::new(-10.0, -6.875);
    let points = vec![
        Vector::new(9.125, -7.9375),
        corner,
        Vector::new(-4.0, 3.3125),
    ];
    let walls = Walls::new(wall_checks::obstacles(vec![points]));
    let (all, h) = ([0, 1, 2], 0.01);
    let quarter = 0.25 * std::f64::consts::PI * h * h;
    for method in [
        WallMethod::Representative,
        WallMethod::Exact,
        WallMethod::Union,
    ] {
        method.shares(&walls, &all, corner, h, |share| {
            assert!(
                share.hidden_area <= quarter * (1.0 + 1e-9),
                "{method:?}: {share:?}"
            );
        });
    }
    wall_checks::check(&walls, corner, Vector::new(0.0, 0.0), h);
}

#[test]
fn on_a_wall_that_another_crosses_at_most_one_disc_is_hidden() {
    // Found by fuzzing: at distance 0, every part of the wall counted as the whole wall.
    let [wedge, bar] = [
        [
            [0.5, 0.5],
            [-9.0, -10.0],
            [-4.8125, -2.6875],
            [-5.0, -4.8125],
        ],
        [
            [-6.0, -2.6875],
            [-5.0, 0.5],
            [3.375, 3.375],
            [3.375, -2.6875],
        ],
    ];
    let walls = Walls::new(wall_checks::obstacles(
        [wedge, bar].map(|points| vectors(points.to_vec())).to_vec(),
    ));
    for h in [0.01, 1.0, 5.0] {
        wall_checks::check(&walls, Vector::new(-4.75, -2.6875), Vector::zeros(), h);
    }
}

fn zigzag(corners: usize) -> Vec<[f64; 2]> {
    let upper = (0..corners / 2).map(|k| [k as f64, (k % 2) as f64 * 5_000.0]);
    let lower = (0..corners / 2)
        .rev()
        .map(|k| [k as f64, (k % 2) as f64 * 5_000.0 - 0.5]);
    upper.chain(lower).collect()
}

#[test]
fn obstacles_with_too_many_corners_are_refused() {
    let message = |obstacles: Vec<Vec<[f64; 2]>>| {
        let text = json!({"obstacles": obstacles}).to_string();
        Scenario::parse(&text, "f.json", &[])
            .err()
            .map(|error| error.to_string())
    };
    assert_eq!(message(vec![zigzag(4_000)]), None);
    assert_eq!(
        message(vec![zigzag(20_002)]).unwrap(),
        "f.json: obstacles[0]: 20002 corners; at most 20000 are allowed: split it into several"
    );
    assert_eq!(
        message(vec![vec![[0.0, 0.0]; 20_000]; 51]).unwrap(),
        "f.json: obstacles: 1020000 corners in total; at most 1000000 are allowed: leave out unimportant corners"
    );
    let dense = (0..1_500).map(|k| f64::from(k) * std::f64::consts::TAU / 1_500.0);
    let dense = dense
        .map(|t| [5.5 + 0.4 * t.cos(), 5.5 + 0.4 * t.sin()])
        .collect();
    assert_eq!(
        message(vec![dense]).unwrap(),
        "f.json: obstacles[0]: 1500 corners of obstacles in the square meter from (5, 5) to (6, 6); at most \
         1000 are allowed: leave out unimportant corners"
    );
}
