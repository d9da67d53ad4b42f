//! Forks and saved runs: they go on to the same bits as the original, also with new goals from outside.

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::drive::Run;
use serde_json::{Value, json};
use std::path::Path;

use crate::common::simulated::scenario;

/// Programs of new goals for each scene; ten thousand were run once.
const PROGRAMS: u64 = 12;

/// Scenes of all kinds of stages, with a door that closes, people who arrive, and the profiles for real people and of
/// the paper.
fn scenes() -> [Value; 4] {
    let grid = |more: Value| {
        let mut grid = json!({"min": [1, 2], "max": [6, 8], "columns": 4, "rows": 5});
        grid.as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        grid
    };
    let hall = json!([[[[0, 0], [20, 0], [20, 10], [0, 10]]]]);
    let exits = json!([{"name": "east", "line": [[20, 4], [20, 6]]}]);
    [
        json!({
            "walkable_area": hall, "exits": exits, "profile": "steer+sph",
            "queues": [{"name": "till", "path": [[16, 8], [9, 8], [9, 2]], "service_secs": 2}],
            "journeys": [{"name": "buy", "stages": ["till", "east"]}],
            "grids": [grid(json!({"journey": "buy"}))],
            "measurements": [{"egress": {}}, {"exposure": {}}],
        }),
        json!({
            "walkable_area": hall, "exits": exits,
            "waiting_areas": [{"name": "platform", "area": [[9, 2], [12, 2], [12, 8], [9, 8]], "for_secs": 4}],
            "journeys": [{"name": "ride", "stages": ["platform", "east"]}],
            "grids": [grid(json!({"journey": "ride"}))],
            "events": [{"at_secs": 2, "close": "east"}, {"at_secs": 5, "open": "east"}],
            "entrances": [{"name": "west", "line": [[0, 4], [0, 6]], "per_sec": 2, "number": 12, "journey": "ride"}],
            "measurements": [{"egress": {}}],
        }),
        json!({
            "walkable_area": [[[[0, 0], [12, 0], [12, 10], [10, 10], [10, 2], [0, 2]]]],
            "goal": [11, 9], "profile": "walk+sph",
            "grids": [{"min": [1, 0.5], "max": [8, 1.5], "columns": 9, "rows": 2}],
            "measurements": [{"evacuated": {}}],
        }),
        json!({
            "walkable_area": hall, "profile": "legs+sph", "goal": [18, 5],
            "obstacles": [[[12, 3], [13, 3], [13, 7], [12, 7]]],
            "grids": [grid(json!({}))],
            "events": [{"at_secs": 1, "name": "push", "region": [[0, 0], [5, 10]], "for_secs": 1, "goal_scale": 3}],
            "measurements": [{"density": {"at_secs": 3, "region": [[0, 0], [20, 10]]}}],
        }),
    ]
}

fn begun(document: &Value) -> Run {
    let mut scenario = scenario(document, &[]).unwrap();
    scenario.duration_secs = 60.0;
    let floor = scenario.floor().unwrap();
    let mut run = Run::new(scenario).unwrap();
    if run.simulation.scene().routes.is_none()
        && let Some(floor) = floor
    {
        run.simulation.add_routes(floor);
    }
    show(&mut run);
    run
}

/// Evaluates and measures the current frame.
fn show(run: &mut Run) {
    run.simulation.evaluate().unwrap();
    run.measure();
}

/// Steps and new goals by chance.
fn followed(run: &mut Run, seed: u64) {
    let mut chance = ChaCha8Rng::seed_from_u64(seed);
    for _ in 0..5 {
        for _ in 0..chance.random_range(1..40) {
            run.simulation.integrate().unwrap();
            show(run);
        }
        let ids = &run.simulation.frame().agents.id;
        let some: Vec<u32> = ids.choose_multiple(&mut chance, 3).copied().collect();
        let goal = Vector::new(
            chance.random_range(0.5..11.5),
            chance.random_range(0.5..1.5),
        );
        let new: Vec<(u32, Vector)> = some.into_iter().map(|id| (id, goal)).collect();
        // A goal in an obstacle, or people who walk in a direction: nothing is done.
        let _ = run.simulation.set_goals(&new);
    }
}

fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

/// The digest and all measured values.
fn outcome(run: &Run) -> (String, Vec<String>) {
    (run.simulation.digest(), run.metrics.seen())
}

#[test]
fn forks_and_saved_runs_go_on_to_the_same_bits() {
    for (k, document) in scenes().iter().enumerate() {
        for seed in 0..PROGRAMS {
            let mut run = begun(document);
            followed(&mut run, seed);
            let mut fork = run.fork().unwrap();
            let saved = Checkpoint::of(&run.scenario, &run.simulation, &run.metrics);
            let saved = Checkpoint::parse(&saved.bytes().unwrap(), Path::new("saved")).unwrap();
            let again = saved.scenario(&[]).unwrap();
            let mut resumed = saved.resume(again).unwrap();
            show(&mut resumed);
            assert_eq!(
                outcome(&resumed),
                outcome(&run),
                "scene {k}, program {seed}"
            );
            followed(&mut run, seed + 1000);
            on_threads(2, || followed(&mut fork, seed + 1000));
            on_threads(3, || followed(&mut resumed, seed + 1000));
            assert_eq!(
                outcome(&fork),
                outcome(&run),
                "scene {k}, program {seed}: fork"
            );
            assert_eq!(
                outcome(&resumed),
                outcome(&run),
                "scene {k}, program {seed}: resumed"
            );
        }
    }
}

#[test]
fn a_fork_shares_what_cannot_change_and_nothing_else() {
    let document = &scenes()[2];
    let mut run = begun(document);
    let mut fork = run.fork().unwrap();
    assert!(std::ptr::eq(
        run.simulation.scene(),
        fork.simulation.scene()
    ));
    let before = outcome(&run);
    // A goal behind the corner takes a path map of its own.
    fork.simulation
        .set_goals(&[(0, Vector::new(10.5, 6.0))])
        .unwrap();
    assert!(!std::ptr::eq(
        run.simulation.scene(),
        fork.simulation.scene()
    ));
    followed(&mut fork, 1);
    assert_eq!(outcome(&run), before);
    let mut other = begun(document);
    followed(&mut run, 2);
    followed(&mut other, 2);
    assert_eq!(outcome(&run), outcome(&other));
}

#[test]
fn a_new_goal_acts_from_the_next_frame_on() {
    let mut run = begun(&scenes()[2]);
    let goal = Vector::new(1.0, 1.0);
    let goal_of = |run: &Run| {
        let agents = run.simulation.frame().agents;
        agents.goal[agents.index_of(5).unwrap()]
    };
    let old = goal_of(&run);
    run.simulation.set_goals(&[(5, goal)]).unwrap();
    assert_eq!(goal_of(&run), old);
    // The frame of now stays as it is, also if it is computed again.
    run.simulation.evaluate_with_density().unwrap();
    assert_eq!(goal_of(&run), old);
    run.simulation.integrate().unwrap();
    run.simulation.evaluate().unwrap();
    assert_eq!(goal_of(&run), goal);
}
