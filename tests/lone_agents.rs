//! A lone agent in a whole simulation arrives, touches no wall, and walks hardly farther than the shortest way.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::routes::Destination;
use sandbox::engine::simulation::Simulation;
use serde_json::json;

use crate::common::floors::Plan;
use crate::common::plans::margin;
use crate::common::simulated::{after, scenario};

/// An agent leaves within this distance of its goal, meters.
const WITHIN: f64 = 0.3;
/// Gaps of the plans are wider than this, meters.
const GAP: f64 = 1.0;

/// The largest distance that an agent keeps from corners, meters.
const WIDEST: f64 = 0.87;

/// How a lone agent walked.
#[derive(Debug)]
struct Walk {
    seed: u64,
    /// The length of the shortest way, meters.
    shortest: f64,
    /// The sum of the angles by which it bends, radians.
    bend: f64,
    /// The length walked, meters.
    walked: f64,
    /// The least distance of its body from a wall; below 0 if they overlap, meters.
    nearest: f64,
    arrived: bool,
}

impl Walk {
    /// The length of the way with arcs of the widest clearance around all corners, meters.
    fn around(&self) -> f64 {
        self.shortest + WIDEST * self.bend
    }
}

/// Walks between two random points of a plan, enlarged by `scale`; goals are farther than `goal_gap` meters from walls.
fn walk(seed: u64, profile: &str, scale: f64, goal_gap: f64) -> Option<Walk> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut plan = Plan::with_gaps(&mut rng, 10, GAP / scale);
    plan.rings
        .iter_mut()
        .flatten()
        .flatten()
        .for_each(|x| *x *= scale);
    let [start, goal] = [plan.free(&mut rng, 0.4)?, plan.free(&mut rng, goal_gap)?];
    let document = json!({
        "walkable_area": [plan.rings], "profile": profile, "population_seed": seed,
        "agents": [{"position": [start.x, start.y], "goal": [goal.x, goal.y], "remove_within": WITHIN}],
    });
    let scene = scenario(&document, &[]).unwrap().scene;
    let mut points = vec![start];
    let to = Destination::Goal(goal);
    let routes = scene.routes.as_ref().filter(|routes| routes.leads_to(to));
    points.extend(routes.map_or(vec![goal], |routes| routes.course(start, to)));
    let sides: Vec<_> = points.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let shortest = sides.iter().map(|side| side.norm()).sum::<f64>() - WITHIN;
    let bend = sides.windows(2).map(|pair| pair[0].angle(&pair[1])).sum();
    let mut simulation = Simulation::new(scene).unwrap();
    let (mut walked, mut last, mut nearest) = (0.0, start, f64::INFINITY);
    while simulation.frame().clock.time() < 2.0 * shortest + 5.0 {
        simulation.step().unwrap();
        let agents = simulation.frame().agents;
        let Some(&p) = agents.position.first() else {
            break;
        };
        walked += (p - last).norm();
        last = p;
        nearest = nearest.min(margin(&plan.rings, p) - agents.radius[0]);
    }
    let arrived = simulation.frame().agents.is_empty();
    Some(Walk {
        seed,
        shortest,
        bend,
        walked,
        nearest,
        arrived,
    })
}

/// The walks of a profile over 4 m or more. The plans are enlarged by `scale`; goals are farther than `goal_gap` meters
/// from walls.
fn walks(profile: &str, scale: f64, goal_gap: f64) -> Vec<Walk> {
    let walks = (0..200).into_par_iter();
    let walks = walks.filter_map(|seed| walk(seed, profile, scale, goal_gap));
    let walks: Vec<Walk> = walks.filter(|walk| walk.shortest > 4.0).collect();
    assert!(walks.len() > 100, "{}", walks.len());
    walks
}

#[test]
fn lone_agents_walk_through_buildings_without_touching_walls_and_hardly_farther_than_the_shortest_way()
 {
    // RVO hesitates before walls, also before those behind a goal.
    for (profile, goal_gap, most) in [("sph", 0.4, 1.07), ("sf", 0.4, 1.07), ("rvo", 1.2, 1.15)] {
        let walks = walks(profile, 3.0, goal_gap);
        for walk in &walks {
            let seed = walk.seed;
            assert!(walk.arrived, "{profile}, seed {seed}: {walk:?}");
            // An agent whose goal is in sight from the start walks straight.
            let is_clear = walk.bend <= 0.0 || walk.nearest >= 0.0;
            assert!(is_clear, "{profile}, seed {seed}: {walk:?}");
            let is_short = walk.walked <= most * walk.around();
            assert!(is_short, "{profile}, seed {seed}: {walk:?}");
        }
        let near = walks.iter();
        let near = near.filter(|walk| walk.walked <= 1.05 * walk.shortest);
        let (near, all) = (near.count(), walks.len());
        assert!(20 * near > 17 * all, "{profile}: {near} of {all}");
    }
}

#[test]
fn lone_agents_pass_gaps_of_a_meter_and_hardly_touch_a_wall() {
    for (profile, goal_gap) in [("sph", 0.4), ("rvo", 1.2)] {
        for walk in walks(profile, 1.0, goal_gap) {
            let seed = walk.seed;
            let is_clear = walk.bend <= 0.0 || walk.nearest >= -0.02;
            let is_short = walk.walked < 1.3 * walk.around();
            // RVO hesitates: a few are late.
            let is_good = (walk.arrived || profile == "rvo") && is_clear && is_short;
            assert!(is_good, "{profile}, seed {seed}: {walk:?}");
        }
    }
}

#[test]
fn a_person_who_avoids_by_rvo_leaves_by_a_narrow_door_from_the_side() {
    // The floor behind an exit was as wide as the door: RVO stopped in front of that dead end for ever.
    for (x, width) in [(9.2, 0.7), (9.6, 0.8), (9.6, 0.9)] {
        let document = json!({
            "walkable_area": [[[[0, 0], [10, 0], [10, 8], [0, 8]]]], "profile": "rvo->sph",
            "exits": [{"name": "door", "line": [[10, 1], [10, 1.0 + width]]}],
            "agents": [{"position": [x, 7], "radius": 0.26}],
        });
        let simulation = after(&document, &[], 20.0);
        assert_eq!(
            simulation.outcome().arrivals.len(),
            1,
            "from x = {x} by {width} m"
        );
    }
}
