//! Who is reported as stuck, against the headway that follows from the trajectory and an own search for routes.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::runs::drive::Run;
use sandbox::scenario::Scenario;
use sandbox::scenario::catalog::names;
use sandbox::scenario::measurements::Watched;
use serde_json::{Value, json};

use crate::common::floors::Plan;
use crate::common::visibility::Sights;

/// The time of walking that is looked at, seconds.
const SECS: usize = 20;
/// The way by which an agent must come nearer in this time, meters.
const HEADWAY: f64 = 1.0;
/// Lengths of routes differ by rounding, meters.
const ROUNDING: f64 = 1e-4;

/// Runs a document for `secs` seconds. Returns the run and, for every second, the ids and positions of its agents.
fn followed(document: &Value, secs: usize) -> (Run, Vec<Vec<(u32, Vector)>>) {
    let scenario = Scenario::parse(&document.to_string(), "f.json", &[]).unwrap();
    let mut run = Run::new(scenario).unwrap();
    let mut seen = Vec::new();
    loop {
        run.simulation.evaluate().unwrap();
        run.measure();
        let frame = run.simulation.frame();
        let clock = frame.clock;
        if clock.frame() == clock.frame_at(seen.len() as f64) {
            let agents = frame.agents;
            let ids = agents.id.iter().copied();
            seen.push(ids.zip(agents.position.iter().copied()).collect());
        }
        if seen.len() > secs {
            return (run, seen);
        }
        run.simulation.integrate().unwrap();
    }
}

/// The ids of the reported agents.
fn reported(run: &Run) -> Vec<u32> {
    run.metrics.stuck_ids(&run.simulation)
}

/// How much nearer each agent of the last second is to `goal` than it was [`SECS`] seconds before, meters.
fn headways(plan: &Plan, goal: Vector, seen: &[Vec<(u32, Vector)>]) -> Vec<(u32, f64)> {
    let sights = Sights::new(&plan.areas());
    let last = seen.len() - 1;
    let agents = seen[last].iter().filter_map(|&(id, now)| {
        let before = seen[last - SECS].iter().find(|(other, _)| *other == id)?;
        let lengths = sights.lengths([goal, goal], &[before.1, now]);
        Some((id, lengths[0] - lengths[1]))
    });
    agents.collect()
}

/// A crowd on a random floor whose gaps all are passable.
fn crowd(plan: &Plan, profile: &str, rng: &mut ChaCha8Rng) -> Option<(Value, Vector)> {
    let goal = plan.free(rng, 0.6)?;
    let mut places: Vec<Vector> = Vec::new();
    for _ in 0..200 {
        let place = plan.free(rng, 0.3)?;
        let is_clear = places.iter().all(|other| (place - other).norm() > 0.5);
        if is_clear && (place - goal).norm() > 1.0 && places.len() < 60 {
            places.push(place);
        }
    }
    let agents = places.iter().map(|p| json!({"position": [p.x, p.y]}));
    let speeds = [0.02, 0.06, 1.34];
    let agents = agents.enumerate().map(|(k, mut agent)| {
        agent["goal"] = json!([goal.x, goal.y]);
        agent["remove_within"] = json!(0.3);
        // Some hardly walk.
        agent["preferred_speed"] = json!(speeds[if k % 10 < 2 { k % 10 } else { 2 }]);
        agent
    });
    let document = json!({
        "profile": profile,
        "walkable_area": [plan.rings],
        "duration_secs": 1000,
        "min_passage_width": 0.05,
        "agents": agents.collect::<Vec<_>>(),
    });
    Some((document, goal))
}

#[test]
fn the_report_names_all_agents_without_headway_on_random_floors_and_no_others() {
    let cases: u64 = std::env::var("SANDBOX_CASES").map_or(16, |cases| cases.parse().unwrap());
    let (mut stuck, mut walking) = (0, 0);
    for case in 0..cases {
        let mut rng = ChaCha8Rng::seed_from_u64(case);
        let profiles = names();
        let profile = profiles[case as usize % profiles.len()];
        let plan = Plan::with_gaps(&mut rng, 8, 0.1);
        let Some((document, goal)) = crowd(&plan, profile, &mut rng) else {
            continue;
        };
        let refused = Scenario::parse(&document.to_string(), "f.json", &[]).err();
        if let Some(refused) = refused {
            // The walls of this floor leave a gap that is narrower than bodies with turned shoulders.
            assert!(refused.to_string().contains("is wide enough"), "{refused}");
            continue;
        }
        let (run, seen) = followed(&document, rng.random_range(25..60));
        let reported = reported(&run);
        for (id, headway) in headways(&plan, goal, &seen) {
            let slow = document["agents"][id as usize]["preferred_speed"].as_f64();
            let needed = HEADWAY.min(0.5 * SECS as f64 * slow.unwrap());
            if (headway - needed).abs() < ROUNDING {
                continue;
            }
            let is_stuck = headway < needed;
            assert_eq!(
                reported.contains(&id),
                is_stuck,
                "case {case}, {profile}: agent {id} made {headway} m of {needed} m"
            );
            stuck += usize::from(is_stuck);
            walking += usize::from(!is_stuck);
        }
    }
    assert!(
        stuck as u64 > cases && walking as u64 > cases,
        "{stuck}, {walking}"
    );
}

/// The least gap of floors on which a crowd of agents with arching bodies flows, meters.
const WIDE_GAP: f64 = 1.2;

#[test]
fn agents_who_choose_headings_arrive_on_random_floors_and_pass_no_wall() {
    let cases: u64 = std::env::var("SANDBOX_CASES").map_or(20, |cases| cases.parse().unwrap());
    let mut arrived = 0;
    for case in 0..cases {
        let mut rng = ChaCha8Rng::seed_from_u64(case);
        let plan = Plan::with_gaps(&mut rng, 8, WIDE_GAP);
        let Some((mut document, _)) = crowd(&plan, "steer+sph", &mut rng) else {
            continue;
        };
        for agent in document["agents"].as_array_mut().unwrap() {
            agent["preferred_speed"] = json!(1.34);
        }
        let scenario = Scenario::parse(&document.to_string(), "f.json", &[]).unwrap();
        let mut run = Run::new(scenario).unwrap();
        let mut watched = Watched::default();
        let people = document["agents"].as_array().unwrap().len();
        let simulation = &mut run.simulation;
        while !simulation.frame().agents.is_empty() {
            simulation.evaluate().unwrap();
            watched.observe(simulation);
            simulation.integrate().unwrap();
            let frame = simulation.frame();
            assert!(
                frame.clock.time() < 120.0,
                "case {case}: {} of {people} are left behind",
                frame.agents.len()
            );
        }
        assert_eq!(watched.agents_through_walls(simulation), 0, "case {case}");
        arrived += people as u64;
    }
    assert!(arrived > 5 * cases, "{arrived}");
}
