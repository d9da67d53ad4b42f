//! Agents stay in their room as long as they move by less than their free distance, on random floors with slits and
//! niches.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Rooms, WIDEST};
use sandbox::engine::simulation::Simulation;
use serde_json::{Value, json};

use crate::common::floors::Plan;
use crate::common::simulated::{go_on, scenario, start};
use crate::common::visibility::Sights;

/// Narrower passages are closed, meters.
const WIDTH: f64 = 0.4;
/// The number of straight parts of a walk.
const PARTS: usize = 4;

/// A vector in a random direction, and shorter than `most` meters.
fn within(rng: &mut ChaCha8Rng, most: f64) -> Vector {
    let (sine, cosine) = rng.random_range(0.0..TAU).sin_cos();
    Vector::new(cosine, sine) * rng.random_range(0.0..most)
}

/// Points near the closed sides of triangles and anywhere on the floor.
fn places(rng: &mut ChaCha8Rng, plan: &Plan, rooms: &Rooms) -> Vec<Vector> {
    let mesh = &rooms.floor.mesh;
    let sides = (0..mesh.triangles().len() as u32).flat_map(|t| (0..3).map(move |k| (t, k)));
    let closed = sides.filter(|&(t, k)| mesh.triangle(t).closed[k].is_some());
    let near = closed.map(|(t, k)| {
        let corners = mesh.corners(t);
        0.5 * (corners[k] + corners[(k + 1) % 3]) + within(rng, 1.5)
    });
    let mut places: Vec<Vector> = near.filter(|&p| plan.is_free(p, 1e-3)).collect();
    places.extend((0..10).filter_map(|_| plan.free(rng, 1e-3)));
    places
}

#[test]
fn agents_that_move_by_less_than_their_free_distance_stay_in_their_room() {
    let counts = (0..400_u64).into_par_iter().map(|seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plan = match seed % 2 {
            0 => Plan::random(&mut rng),
            _ => Plan::drawn(&mut rng),
        };
        let areas = plan.areas();
        let sights = Sights::new(&areas);
        let rooms = Rooms::new((&areas, None), [WIDTH, WIDEST], &[], &[]).unwrap();
        let room = |p: Vector| rooms.floor.locate(p).map(|t| rooms.room(t));
        let mut counts = [0; 2];
        for p in places(&mut rng, &plan, &rooms) {
            let Some(t) = rooms.floor.locate(p) else {
                continue;
            };
            let free = rooms.free_distance(t, p);
            // A walk may bend around the end of a wall.
            let mut from = p;
            for _ in 0..PARTS {
                let to = p + within(&mut rng, free);
                if !sights.sees(from, to) || sights.is_close_call(from, to) {
                    continue;
                }
                assert_eq!(
                    room(to),
                    room(p),
                    "seed {seed}: from {p} over {from} to {to}, {free} m are free in {plan:?}"
                );
                from = to;
                counts[usize::from(free < 1.0)] += 1;
            }
        }
        counts
    });
    let add = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
    let [far, near] = counts.reduce(|| [0; 2], add);
    assert!(far > 5000 && near > 5000, "{far}, {near}");
}

/// The same simulation with agent `id` at another place.
fn moved(simulation: &Simulation, document: &Value, id: u32, to: Vector) -> Simulation {
    let agent = simulation.frame().agents.index_of(id).unwrap();
    let mut state = serde_json::to_value(simulation.state()).unwrap();
    state["agents"]["position"][agent] = json!([to.x, to.y]);
    state["crowd_changed"] = json!(true);
    let scene = scenario(document, &[]).unwrap().scene;
    Simulation::resumed(scene, serde_json::from_value(state).unwrap()).unwrap()
}

/// Such agents had no aim until they chose again, up to 5 s later.
#[test]
fn an_agent_on_a_detour_that_is_pushed_into_a_niche_walks_out_at_once() {
    let block = |x: [f64; 2], y: [f64; 2]| {
        json!([[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]])
    };
    let document = json!({
        "duration_secs": 60, "profile": "walk+sph", "route_choice": "quickest", "min_passage_width": WIDTH,
        "walkable_area": [
            block([0.0, 10.0], [0.0, 10.0]), block([10.2, 20.0], [0.0, 10.0]),
            block([9.9, 10.3], [1.0, 2.2]), block([9.9, 10.3], [7.0, 8.2]),
            // The niche, and the gap before it.
            block([4.0, 4.8], [10.1, 10.9]), block([4.25, 4.55], [9.9, 10.2]),
        ],
        "exits": [{"name": "end", "line": [[20, 0], [20, 10]]}],
        "crowds": [{"area": [[1, 1], [9, 1], [9, 9], [1, 9]], "number": 60}],
    });
    let mut simulation = start(&document, &[]);
    go_on(&mut simulation, 2.0);
    let (before, niche) = (Vector::new(4.4, 9.6), Vector::new(4.4, 10.4));
    let agents = simulation.frame().agents;
    let on_detour = agents.present().filter(|&i| {
        let plan = agents.plan[i].unwrap();
        plan.detours && plan.toward.is_some() && agents.position[i].x < 9.0
    });
    let away = |&i: &usize| (agents.position[i] - before).norm();
    let agent = on_detour
        .min_by(|a, b| away(a).total_cmp(&away(b)))
        .unwrap();
    let id = agents.id[agent];
    let mut simulation = moved(&simulation, &document, id, before);
    go_on(&mut simulation, 2.2);
    let plan = |simulation: &Simulation| {
        let agents = simulation.frame().agents;
        agents.plan[agents.index_of(id).unwrap()].unwrap()
    };
    let planned = plan(&simulation);
    assert!(planned.detours && planned.decides_at > simulation.frame().clock.frame_at(2.5));
    let mut simulation = moved(&simulation, &document, id, niche);
    go_on(&mut simulation, 2.4);
    let (plan, agents) = (plan(&simulation), simulation.frame().agents);
    let rooms = simulation.scene().rooms().unwrap();
    let inside = rooms.floor.locate(niche).unwrap();
    assert_eq!(rooms.room(plan.located.triangle()), rooms.room(inside));
    assert!(rooms.sides_in(rooms.room(inside)).is_empty());
    let aim = agents.aim[agents.index_of(id).unwrap()];
    assert!(aim.y < 10.1, "{aim}");
}
