//! A lone agent in a whole simulation arrives, and walks hardly farther than the shortest way.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::simulation::Simulation;
use sandbox::engine::ways::Destination;
use serde_json::json;

use crate::common::floors::Plan;
use crate::common::simulated::scenario;

/// An agent leaves within this distance of its goal, meters.
const WITHIN: f64 = 0.3;

/// How a lone agent walked.
#[derive(Debug)]
struct Walk {
    /// The length of the shortest way, meters.
    shortest: f64,
    /// The length walked, meters.
    walked: f64,
    arrived: bool,
}

/// Walks between two random points of a plan in which every gap is wider than 1 m.
fn walk(seed: u64, profile: &str) -> Option<Walk> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let plan = Plan::with_gaps(&mut rng, 10, 1.0);
    let [start, goal] = [plan.free(&mut rng, 0.4)?, plan.free(&mut rng, 0.4)?];
    let document = json!({
        "walkable_area": [plan.rings], "profile": profile, "population_seed": seed,
        "agents": [{"position": [start.x, start.y], "goal": [goal.x, goal.y], "remove_within": WITHIN}],
    });
    let scene = scenario(&document, &[]).unwrap().scene;
    let mut points = vec![start];
    let to = Destination::Goal(goal);
    let ways = scene.ways.as_ref().filter(|ways| ways.leads_to(to));
    points.extend(ways.map_or(vec![goal], |ways| ways.course(start, to)));
    let sides = points.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    let shortest = sides.sum::<f64>() - WITHIN;
    let mut simulation = Simulation::new(scene).unwrap();
    let (mut walked, mut last) = (0.0, start);
    while simulation.frame().clock.time() < 2.0 * shortest + 5.0 {
        simulation.step().unwrap();
        let Some(&p) = simulation.frame().agents.position.first() else {
            break;
        };
        walked += (p - last).norm();
        last = p;
    }
    let arrived = simulation.frame().agents.is_empty();
    Some(Walk {
        shortest,
        walked,
        arrived,
    })
}

#[test]
fn lone_agents_arrive_and_most_walk_at_most_a_twentieth_farther_than_the_shortest_way() {
    let walks = (0..200)
        .into_par_iter()
        .filter_map(|seed| Some((seed, walk(seed, "sph")?)));
    let walks: Vec<(u64, Walk)> = walks.filter(|(_, walk)| walk.shortest > 4.0).collect();
    assert!(walks.len() > 100, "{}", walks.len());
    for (seed, walk) in &walks {
        assert!(
            walk.arrived && walk.walked < 1.3 * walk.shortest,
            "seed {seed}: {walk:?}"
        );
    }
    // Agents with a wide clearance walk on wide arcs around corners.
    let near = walks
        .iter()
        .filter(|(_, walk)| walk.walked < 1.05 * walk.shortest);
    assert!(3 * near.count() > 2 * walks.len());
}
