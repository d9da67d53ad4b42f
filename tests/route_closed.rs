//! Routes beside passages that are too narrow: closed passages close nothing else, and routes lead around them.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::math::{Vector, direction, perpendicular};
use sandbox::engine::routes::{Destination, Floor, Goal, Routes};
use serde_json::{Value, json};

use crate::common::floors::Plan;
use crate::common::simulated::{after, scenario};
use crate::common::visibility::Sights;

/// Narrower passages are closed, meters.
const WIDTH: f64 = 0.4;
/// Half of the thickness of bodies that close passages, meters.
const THIN: f64 = 5e-5;

fn read(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// The length of the way of each agent of a document, meters.
fn lengths(document: &Value) -> Vec<f64> {
    let scene = scenario(document, &[]).unwrap().scene;
    let routes = scene.routes.as_ref().unwrap();
    let agents = scene.agents.iter();
    let length = agents.map(|agent| {
        let to = Destination::Goal(agent.goal);
        routes
            .open_way(agent.position, to)
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
fn an_agent_has_routes_whatever_others_see() {
    let mut slit = read(include_str!("data/slit.json"));
    let alone = lengths(&slit)[0];
    slit["agents"]
        .as_array_mut()
        .unwrap()
        .push(json!({"position": [3, 3], "goal": [7, 5]}));
    assert_eq!(lengths(&slit)[0], alone);
}

/// What is seen on the floor of a plan on which thin bodies stand in all passages that are too narrow.
fn closed(plan: &Plan) -> Sights {
    let mut plan = plan.clone();
    let passages = Sights::new(&plan.areas()).passages(WIDTH - 1e-6);
    for [a, b] in passages {
        let along = direction(b - a) * THIN;
        let aside = perpendicular(along);
        let (a, b) = (a - along, b + along);
        let ring = [a - aside, b - aside, b + aside, a + aside];
        plan.rings.push(ring.map(Into::into).to_vec());
    }
    Sights::new(&plan.areas())
}

#[test]
fn routes_beside_closed_passages_agree_with_brute_force() {
    let plans = std::env::var("WAY_PLANS").map_or(150, |cases| cases.parse().unwrap());
    let counts = (0..plans).into_par_iter().map(|seed: u64| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plan = match rng.random_range(0..4) {
            0 => Plan::random(&mut rng),
            _ => Plan::drawn(&mut rng),
        };
        let areas = plan.areas();
        let sights = closed(&plan);
        let floor = Floor::new(&areas, WIDTH).unwrap();
        let Some(goal) = plan.free(&mut rng, 0.02) else {
            return [0; 2];
        };
        let routes = Routes::new(floor, &[vec![Goal::Point(goal)]], Vec::new()).unwrap();
        let starts: Vec<Vector> = (0..8).filter_map(|_| plan.free(&mut rng, 1e-3)).collect();
        let mut counts = [0; 2];
        for (&p, expected) in starts.iter().zip(sights.lengths([goal; 2], &starts)) {
            let way = routes.open_way(p, Destination::Place(0));
            let found = way.map_or(f64::INFINITY, |way| way.length);
            let agrees = found == expected || (found - expected).abs() < 1e-3;
            assert!(
                agrees,
                "seed {seed}: {found} instead of {expected} m from {p} to {goal} in {plan:?}"
            );
            counts[usize::from(found.is_finite())] += 1;
        }
        counts
    });
    let add = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
    let [closed, open] = counts.reduce(|| [0; 2], add);
    println!("{closed} without way, {open} with");
    assert!(closed > 50 && open > 300, "{closed}, {open}");
}
