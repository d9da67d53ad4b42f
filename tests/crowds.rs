//! Crowds: agents placed at random or on a lattice, without overlap.

use crate::common::on_threads;
use sandbox::engine::agents::{NewAgent, radius_of};
use sandbox::engine::math::Vector;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

fn parse(document: &Value) -> Result<Scenario, String> {
    Scenario::parse(&document.to_string(), "f", &[]).map_err(|error| error.to_string())
}

/// An L-shaped floor with a pillar and, in its corner, a grid of agents.
fn floor(crowds: Value) -> Value {
    json!({
        "goal": [5, 5], "navigation": "straight", "seed": 3,
        "walkable_area": [[[[0, 0], [20, 0], [20, 10], [10, 10], [10, 20], [0, 20]]]],
        "obstacles": [[[4, 4], [6, 4], [6, 6], [4, 6]]],
        "grids": [{"min": [0.5, 0.5], "max": [3, 3], "columns": 4, "rows": 4}],
        "crowds": crowds
    })
}

const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [21.0, -1.0], [21.0, 21.0], [-1.0, 21.0]];

fn radius(agent: &NewAgent, id: usize) -> f64 {
    agent.radius.unwrap_or_else(|| radius_of(3, id as u32))
}

/// The smallest gaps between bodies and between bodies and walls, meters. Only agents from number `first` on count.
fn gaps(scenario: &Scenario, first: usize) -> [f64; 2] {
    let scene = &scenario.scene;
    let mut gaps = [f64::INFINITY; 2];
    for (i, a) in scene.agents.iter().enumerate().skip(first) {
        assert_eq!(scene.walls.obstacle_at(a.position), None);
        for (j, b) in scene.agents.iter().enumerate().take(i) {
            let gap = (a.position - b.position).norm() - radius(a, i) - radius(b, j);
            gaps[0] = gaps[0].min(gap);
        }
        for wall in scene.walls.iter() {
            let away = (wall.nearest_point(a.position).point - a.position).norm();
            gaps[1] = gaps[1].min(away - radius(a, i));
        }
    }
    gaps
}

/// The grid in which bodies are looked up had cells of size 0, and was made coarser without end.
#[test]
fn a_crowd_of_less_than_half_an_agent_is_empty() {
    for spacing in ["random", "grid"] {
        let area = [[7, 7], [8, 7], [8, 8]];
        let mut document = floor(json!([{"area": area, "density": 0.9, "spacing": spacing}]));
        document["grids"] = json!([]);
        assert_eq!(parse(&document).unwrap().scene.agents.len(), 0);
    }
}

#[test]
fn bodies_overlap_neither_each_other_nor_walls() {
    for spacing in ["random", "grid"] {
        for number in [1, 100, 500] {
            let crowd = json!([{"area": SQUARE, "number": number, "spacing": spacing}]);
            let scenario = parse(&floor(crowd)).unwrap();
            assert_eq!(scenario.scene.agents.len(), 16 + number);
            let [between, walls] = gaps(&scenario, 16);
            assert!(
                between >= 0.0 && walls >= 0.0,
                "{spacing} {number}: {between} {walls}"
            );
        }
    }
}

#[test]
fn a_density_counts_the_free_area() {
    // The floor of 300 m² without the pillar of 4 m².
    let crowd = json!([{"area": SQUARE, "density": 0.5}]);
    let scenario = parse(&floor(crowd)).unwrap();
    assert_eq!(scenario.scene.agents.len(), 16 + 148);
    assert!(scenario.entering >= 164);
}

#[test]
fn nobody_starts_on_the_floor_behind_an_exit() {
    let mut document = floor(json!([{"area": [[0, 0], [20, 0], [20, 10], [0, 10]], "density": 1}]));
    document["walkable_area"] = json!([[[[0, 0], [10, 0], [10, 10], [0, 10]]]]);
    document["exits"] = json!([{"name": "door", "line": [[10, 4], [10, 6]]}]);
    document["navigation"] = json!("paths");
    document.as_object_mut().unwrap().remove("goal");
    let scenario = parse(&document).unwrap();
    // 100 m² without the pillar, and the grid.
    assert_eq!(scenario.scene.agents.len(), 96 + 16);
    let beyond = |agent: &&NewAgent| agent.position.x > 10.0;
    assert_eq!(scenario.scene.agents.iter().filter(beyond).count(), 0);
}

#[test]
fn few_agents_are_spread_evenly() {
    let crowd = json!([{"area": [[0, 10], [10, 10], [10, 20], [0, 20]], "number": 100}]);
    let scenario = parse(&floor(crowd)).unwrap();
    let places: Vec<Vector> = scenario.scene.agents[16..]
        .iter()
        .map(|a| a.position)
        .collect();
    let nearest = |p: &Vector| {
        let others = places.iter().filter(|&other| other != p);
        others.map(|q| (p - q).norm()).fold(f64::INFINITY, f64::min)
    };
    let closest = places.iter().map(nearest).fold(f64::INFINITY, f64::min);
    assert!(closest > 0.6, "{closest}"); // 1 m² per agent; at random it would be about 0.05 m
    for quarter in [[0.0, 10.0], [5.0, 10.0], [0.0, 15.0], [5.0, 15.0]] {
        let inside = |p: &&Vector| {
            (0.0..5.0).contains(&(p.x - quarter[0])) && (0.0..5.0).contains(&(p.y - quarter[1]))
        };
        let count = places.iter().filter(inside).count();
        assert!((20..=30).contains(&count), "{count}");
    }
}

#[test]
fn holes_of_an_area_stay_empty() {
    let area = json!([
        [[0, 10], [10, 10], [10, 20], [0, 20]],
        [[2, 12], [8, 12], [8, 18], [2, 18]]
    ]);
    let scenario = parse(&floor(json!([{"area": area, "number": 80}]))).unwrap();
    let is_in_hole = |p: Vector| (2.0..8.0).contains(&p.x) && (12.0..18.0).contains(&p.y);
    assert!(!scenario.scene.agents.iter().any(|a| is_in_hole(a.position)));
}

#[test]
fn places_depend_on_the_population_seed_alone() {
    let crowd = |seed: u64, behavior: u64| {
        let mut floor = floor(json!([{"area": SQUARE, "number": 300}]));
        floor["population_seed"] = seed.into();
        floor["behavior_seed"] = behavior.into();
        floor
    };
    let agents =
        |threads, document: &Value| on_threads(threads, || parse(document).unwrap().scene.agents);
    let one = agents(1, &crowd(4, 1));
    assert_eq!(one, agents(2, &crowd(4, 2)));
    assert_ne!(one, agents(1, &crowd(5, 1)));
}

#[test]
fn a_crowd_that_is_added_moves_no_earlier_agent() {
    let first = json!({"area": SQUARE, "number": 200, "radius": {"uniform": [0.18, 0.3]}});
    let second = json!({"area": SQUARE, "number": 150, "spacing": "grid"});
    let alone = parse(&floor(json!([first]))).unwrap();
    let both = parse(&floor(json!([first, second]))).unwrap();
    assert_eq!(alone.scene.agents[..], both.scene.agents[..216]);
    assert_eq!(both.scene.agents.len(), 366);
    let [between, walls] = gaps(&both, 16);
    assert!(between >= 0.0 && walls >= 0.0);
}

#[test]
fn what_does_not_fit_is_refused_with_the_number_that_fits() {
    for spacing in ["random", "grid"] {
        let crowd = |number: usize| {
            let area = [[0, 10], [10, 10], [10, 20], [0, 20]];
            floor(json!([{"area": area, "number": number, "spacing": spacing, "radius": 0.25}]))
        };
        let said = parse(&crowd(900)).unwrap_err();
        let number = said
            .split("about ")
            .nth(1)
            .unwrap()
            .split(' ')
            .next()
            .unwrap();
        let number: usize = number.parse().unwrap();
        assert!(
            said.starts_with("f: crowds[0]: 900 agents do not fit"),
            "{said}"
        );
        assert!(said.contains(" in the 100.0 m² of floor "), "{said}");
        // Random places cover 0.547 of an area, a triangular lattice 0.907; none are nearer to a wall than a radius.
        let most = 0.25 * 0.25 * std::f64::consts::PI * number as f64 / (9.5 * 9.5);
        let expected = if spacing == "random" {
            0.53..0.63
        } else {
            0.83..0.98
        };
        assert!(expected.contains(&most), "{spacing} {number}: {most}");
        let scenario = parse(&crowd(number)).unwrap();
        assert_eq!(scenario.scene.agents.len(), 16 + number);
    }
}

#[test]
fn too_many_agents_are_refused_before_they_are_placed() {
    let said = parse(&floor(json!([{"area": SQUARE, "number": 20_000_000}]))).unwrap_err();
    assert!(
        said.starts_with("f: crowds[0]: too many: with these, 20000016 agents enter"),
        "{said}"
    );
}
