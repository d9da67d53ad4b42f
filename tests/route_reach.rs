//! Destinations behind passages that are too narrow are out of reach, and no way is shorter than the straight line.

use nalgebra::Rotation2;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Destination, Floor, Goal, Routes};
use sandbox::engine::simulation::{Decision, Simulation};
use sandbox::scenario::floor_plan::FloorPlan;
use serde_json::{Value, json};

use crate::common::floors::Plan;
use crate::common::simulated::{scenario, start};

/// Routes narrower than this are closed, meters.
const WIDTH: f64 = 0.4;

#[test]
fn no_way_is_shorter_than_the_straight_line() {
    let checked = (0..500_u64).into_par_iter().map(|seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plan = Plan::random(&mut rng);
        let floor = Floor::new(&plan.areas(), WIDTH).unwrap();
        let goals: Vec<Vector> = (0..2).filter_map(|_| plan.free(&mut rng, 0.01)).collect();
        let places: Vec<_> = goals.iter().map(|&goal| vec![Goal::Point(goal)]).collect();
        let routes = Routes::new(floor, &places, Vec::new()).unwrap();
        let numbers: Vec<u16> = (0..places.len() as u16).collect();
        let mut closed = 0;
        for p in (0..20).filter_map(|_| plan.free(&mut rng, 1e-4)) {
            let lengths = routes.lengths(p, &numbers);
            let open: Vec<_> = numbers
                .iter()
                .map(|&k| routes.is_open(p, Destination::Place(k)))
                .collect();
            for (&k, &length) in numbers.iter().zip(&lengths) {
                let k = usize::from(k);
                let way = routes.way(p, Destination::Place(k as u16));
                let way = way.map_or(f64::INFINITY, |way| way.length);
                let straight = (goals[k] - p).norm();
                assert!(
                    way > straight - 1e-9,
                    "{way} m from {p} to {} in {plan:?}",
                    goals[k]
                );
                // Out of a niche from which no place can be reached, all routes count.
                let is_reached = open[k] || !open.contains(&true);
                let expected = if is_reached { way } else { f64::INFINITY };
                assert_eq!(length, expected, "from {p} to {} in {plan:?}", goals[k]);
                closed += usize::from(!is_reached);
            }
        }
        closed
    });
    let closed: usize = checked.sum();
    assert!(closed > 50, "{closed}");
}

#[test]
fn the_other_room_is_infinitely_far_behind_a_passage_that_is_too_narrow() {
    for seed in 0..300 {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let gap: f64 = rng.random_range(0.01..0.8);
        let thick = [0.01, 0.3, 2.0][rng.random_range(0..3)];
        let low = rng.random_range(0.5..8.0);
        let turn = Rotation2::new(rng.random_range(0.0..6.3));
        let (beyond, high) = (20.0 + thick, low + gap);
        let outline = [
            [0.0, 0.0],
            [20.0, 0.0],
            [20.0, low],
            [beyond, low],
            [beyond, 0.0],
            [40.0, 0.0],
            [40.0, 10.0],
            [beyond, 10.0],
            [beyond, high],
            [20.0, high],
            [20.0, 10.0],
            [0.0, 10.0],
        ];
        let turned = outline.map(|p| (turn * Vector::from(p)).into());
        let areas = FloorPlan::walkable(&[vec![turned.to_vec()]])
            .unwrap()
            .walkable;
        let ends = [Vector::new(1.0, 5.0), Vector::new(39.0, 5.0)].map(|p| turn * p);
        let places = ends.map(|end| vec![Goal::Point(end)]);
        let routes = Routes::new(Floor::new(&areas, WIDTH).unwrap(), &places, Vec::new()).unwrap();
        for _ in 0..20 {
            let x = rng.random_range(0.1..19.9);
            let p = turn * Vector::new(x, rng.random_range(0.1..9.9));
            let [near, far]: [f64; 2] = routes.lengths(p, &[0, 1]).try_into().unwrap();
            assert!(
                (near - (ends[0] - p).norm()).abs() < 1e-9,
                "{near} m from {p}"
            );
            match gap < WIDTH {
                true => assert_eq!(far, f64::INFINITY, "{gap} m: from {p}"),
                false => assert!(
                    far.is_finite() && far > (ends[1] - p).norm() - 1e-9,
                    "{far}"
                ),
            }
        }
    }
}

/// A hall with exits at both ends; between a crowd and the exit `east` a wall with a passage of `gap` meters.
fn hall(gap: f64, stage: Option<Value>) -> Value {
    let mut hall = json!({
        "walkable_area": [[[[0, 0], [40, 0], [40, 10], [0, 10]]]],
        "obstacles": [[[30, 0], [30.5, 0], [30.5, 4.9], [30, 4.9]],
                      [[30, 4.9 + gap], [30.5, 4.9 + gap], [30.5, 10], [30, 10]]],
        "exits": [{"name": "west", "line": [[0, 4], [0, 6]]}, {"name": "east", "line": [[40, 4], [40, 6]]},
                  {"name": "south-east", "line": [[35, 0], [37, 0]]}],
        "crowds": [{"area": [[21, 1], [29, 1], [29, 9], [21, 9]], "number": 30}]
    });
    if let Some(stage) = stage {
        hall["journeys"] = json!([{"name": "out", "stages": [stage]}]);
        hall["crowds"][0]["journey"] = json!("out");
    }
    hall
}

fn decisions(simulation: &Simulation) -> Vec<Decision> {
    (0..simulation.frame().agents.len())
        .filter_map(|i| simulation.decision(i))
        .collect()
}

#[test]
fn agents_choose_no_exit_behind_a_passage_that_is_too_narrow() {
    let all = ["west", "east", "south-east"];
    for stage in [
        None,
        Some(json!({"nearest": all})),
        Some(json!({"quickest": all})),
    ] {
        let closed = hall(0.2, stage.clone());
        let mut simulation = start(&closed, &[]);
        simulation.step().unwrap();
        let decisions = decisions(&simulation);
        assert_eq!(decisions.len(), 30);
        for Decision {
            place, prospects, ..
        } in &decisions
        {
            assert_eq!(*place, 0, "{stage:?}");
            let lengths: Vec<f64> = prospects.iter().map(|prospect| prospect.length).collect();
            assert!(
                lengths[0].is_finite() && lengths[1..] == [f64::INFINITY; 2],
                "{lengths:?}"
            );
        }
        let notes = scenario(&closed, &[]).unwrap().notes;
        for (note, name) in notes.iter().zip(["east", "south-east"]) {
            let said = format!(
                "no agent can choose `{name}`: every way there has a passage narrower than"
            );
            assert!(note.starts_with(&said), "{note}");
        }
        assert_eq!(notes.len(), 2);
        let open = hall(0.55, stage);
        assert!(scenario(&open, &[]).unwrap().notes.is_empty());
    }
}

#[test]
fn agents_wait_for_the_exit_that_they_can_reach_while_it_is_closed() {
    let mut closed = hall(0.2, None);
    closed["events"] = json!([{"at_secs": 0, "close": "west"}]);
    let mut simulation = start(&closed, &[]);
    simulation.step().unwrap();
    assert!(
        decisions(&simulation)
            .iter()
            .all(|decision| decision.place == 0)
    );
}

#[test]
fn a_choice_between_exits_that_cannot_be_reached_is_refused_as_a_single_one_is() {
    let both = json!(["east", "south-east"]);
    for stage in [
        json!("east"),
        json!({"nearest": both}),
        json!({"quickest": both}),
    ] {
        let error = scenario(&hall(0.2, Some(stage)), &[]).unwrap_err();
        assert!(
            error.contains("to `east`: every way there has a passage narrower than"),
            "{error}"
        );
    }
}

#[test]
fn places_that_agents_never_choose_need_no_way_onward() {
    let mut rooms = hall(0.0, None);
    rooms["waypoints"] = json!([{"name": "here", "at": [10, 5]}, {"name": "there", "at": [35, 5]}]);
    rooms["journeys"] =
        json!([{"name": "out", "stages": [{"nearest": ["here", "there"]}, "west"]}]);
    rooms["crowds"][0]["journey"] = json!("out");
    let notes = scenario(&rooms, &[]).unwrap().notes;
    let closed = notes.iter().filter(|note| note.contains("walls close"));
    let closed: Vec<&String> = closed.collect();
    assert_eq!(closed.len(), 1, "{notes:?}");
    assert!(
        closed[0].contains("`there`: walls close it off"),
        "{notes:?}"
    );
}
