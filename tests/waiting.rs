//! Waiting areas that overlap walls.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::journeys::{Kind, Status, WaitingArea};
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use serde_json::{Value, json};

use crate::common::simulated::{go_on, scenario};

/// Two people below a wall with a waiting area.
fn room(area: &Value) -> Value {
    json!({
        "walkable_area": [[[[0, 0], [8, 0], [8, 8], [0, 8]]]],
        "obstacles": [[[0, 4], [4, 4], [4, 4.1], [0, 4.1]]],
        "waiting_areas": [{"name": "pit", "area": area}],
        "journeys": [{"name": "guest", "stages": ["pit"]}],
        "crowds": [{"area": [[0.5, 0.5], [3, 0.5], [3, 3], [0.5, 3]], "number": 2, "journey": "guest"}],
    })
}

/// The rectangle from 2.7 m to `x` and from `y` to `y` + 2 m.
fn area(x: f64, y: f64) -> Value {
    json!([[2.7, y], [x, y], [x, y + 2.0], [2.7, y + 2.0]])
}

fn waiting(scene: &Scene) -> &WaitingArea {
    match &scene.journeys.places[0].kind {
        Kind::Waiting(waiting) => waiting,
        other => panic!("{other:?}"),
    }
}

fn notes(area: &Value) -> Vec<String> {
    scenario(&room(area), &[]).unwrap().notes
}

#[test]
fn everybody_arrives_in_the_free_part_of_an_area_that_overlaps_a_wall() {
    let cases: u64 = std::env::var("SANDBOX_CASES").map_or(30, |cases| cases.parse().unwrap());
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let places = (0..cases).map(|_| {
        (
            random.random_range(3.4..6.5),
            random.random_range(3.9..4.12),
        )
    });
    let known = [(3.7, 4.02), (3.7, 4.05), (4.02, 4.05), (5.0, 4.02)];
    for (x, y) in known.into_iter().chain(places) {
        for profile in ["walk+sph", "sph"] {
            let mut document = room(&area(x, y));
            document["profile"] = json!(profile);
            let place = format!("{x} {y} {profile}");
            let scenario =
                scenario(&document, &[]).unwrap_or_else(|error| panic!("{place}: {error}"));
            let mut simulation = Simulation::new(scenario.scene).unwrap();
            go_on(&mut simulation, 30.0);
            let (scene, agents) = (simulation.scene(), simulation.frame().agents);
            for (trip, p) in agents.trip.iter().zip(&agents.position) {
                let trip = trip.unwrap();
                let is_waiting = matches!(trip.status, Status::Waiting { .. });
                assert!(is_waiting, "{place}: one stands at {p:?}");
                let hold = trip.hold.unwrap();
                assert!((hold - p).norm() < 0.5, "{place}: {p:?}, not {hold:?}");
                assert!(scene.walls.obstacle_at(hold).is_none(), "{place}: {hold:?}");
                let is_inside = (2.7..x).contains(&hold.x) && (y..y + 2.0).contains(&hold.y);
                assert!(is_inside, "{place}: {hold:?}");
            }
        }
    }
}

#[test]
fn a_note_says_how_much_of_an_area_is_free() {
    assert_eq!(
        notes(&area(3.7, 4.05)),
        ["waiting_areas[0].area: 97.5 % of `pit` is free floor; agents wait there"]
    );
    let divided = notes(&area(3.7, 3.5));
    let start = "waiting_areas[0].area: walls divide the free floor of `pit` into 2 parts; agents wait in the largest, \
                 70.0 % of the area";
    assert!(divided[0].starts_with(start), "{divided:?}");
    assert_eq!(notes(&area(3.7, 4.099)), [""; 0]);
}

#[test]
fn areas_that_are_free_stay_as_they_are_drawn_and_areas_off_the_floor_are_refused() {
    let pillar = json!([[6, 6.5], [6.2, 6.5], [6.2, 6.7], [6, 6.7]]);
    // The last two have the pillar inside, and in a side.
    for area in [
        area(3.7, 4.1),
        area(8.0, 6.0),
        area(7.0, 5.0),
        area(7.0, 4.6),
    ] {
        let mut document = room(&area);
        document["obstacles"]
            .as_array_mut()
            .unwrap()
            .push(pillar.clone());
        let scene = scenario(&document, &[]).unwrap().scene;
        let given: Vec<[f64; 2]> = serde_json::from_value(area).unwrap();
        let given: Vec<Vector> = given.into_iter().map(Vector::from).collect();
        assert_eq!(waiting(&scene).area.points(), given);
    }
    for (area, floor) in [
        (area(3.7, 8.0), "outside"),
        (json!([[1, 4], [3, 4], [3, 4.1], [1, 4.1]]), "in a wall"),
    ] {
        let message = scenario(&room(&area), &[]).unwrap_err();
        let expected = "f.json: waiting_areas[0].area: lies in obstacles or outside of the walkable area; move it onto \
                        the floor";
        assert_eq!(message, expected, "{floor}");
    }
}
