//! Forks and saved runs: they go on to the same bits as the original, also with new goals from outside.

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::forces::push::PushForce;
use sandbox::engine::journeys::ChangeKind;
use sandbox::engine::math::Vector;
use sandbox::engine::profile::Override;
use sandbox::engine::scene::{Action, Push, Region};
use sandbox::engine::simulation::Fault;
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::drive::{Observer, Run};
use sandbox::scenario::Scenario;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;

use crate::common::busy::hall;
use crate::common::simulated::scenario;

/// Programs of actions for each scene: 12, times `BAD_INPUT_TIMES` if that is set; ten thousand were run once.
fn programs() -> std::ops::Range<u64> {
    let times = std::env::var("BAD_INPUT_TIMES").map_or(1, |times| times.parse().unwrap());
    0..12 * times
}

/// Scenes of all kinds of stages, with a door that closes, people who arrive, and the profiles for real people and of
/// the paper.
fn scenes() -> [Value; 6] {
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
        json!({
            "walkable_area": [[[[0, 0], [20, 0], [20, 10], [0, 10]], [[12, 0.1], [12.3, 0.1], [12.3, 4], [12, 4]],
                               [[12, 6], [12.3, 6], [12.3, 9.9], [12, 9.9]]]],
            "profile": "steer+sph", "route_choice": "quickest",
            "doors": [{"name": "middle", "line": [[12.15, 4], [12.15, 6]]}],
            "exits": [{"name": "east", "line": [[20, 4], [20, 6]]}, {"name": "west", "line": [[0, 7], [0, 9]]}],
            "zones": [{"name": "stairs", "area": [[6, 0], [9, 0], [9, 10], [6, 10]], "speed_factor": 0.5}],
            "grids": [grid(json!({}))],
            "entrances": [{"name": "top", "line": [[8, 10], [10, 10]], "per_sec": 2, "arrivals": "poisson"}],
            "measurements": [{"egress": {}}, {"exposure": {}}],
        }),
        json!({
            "walkable_area": [[[[0, 0], [12, 0], [12, 10], [0, 10]], [[5, 0.1], [5.3, 0.1], [5.3, 4], [5, 4]]]],
            "profile": "sph", "goal": [1, 1],
            "grids": [{"min": [1, 5], "max": [4, 9], "columns": 4, "rows": 5, "remove_within": 0.3}],
            "measurements": [{"evacuated": {}}],
        }),
    ]
}

fn begun(document: &Value) -> Run {
    let mut scenario = scenario(document, &[]).unwrap();
    scenario.duration_secs = 60.0;
    let mut run = Run::new(scenario).unwrap();
    show(&mut run);
    run
}

/// Evaluates and measures the current frame.
fn show(run: &mut Run) {
    run.simulation.evaluate().unwrap();
    run.measure();
}

/// Steps and actions of all kinds by chance.
fn followed(run: &mut Run, seed: u64) {
    let mut chance = ChaCha8Rng::seed_from_u64(seed);
    let mut added = Vec::new();
    for _ in 0..5 {
        for _ in 0..chance.random_range(1..40) {
            run.simulation.integrate().unwrap();
            show(run);
            check_people(run);
            for id in added.drain(..) {
                assert!(run.simulation.present(id).is_ok(), "agent {id} was added");
            }
        }
        for _ in 0..chance.random_range(1..4) {
            let action = action(run, &mut chance);
            // A goal in an obstacle, or a scene without zones: nothing is done.
            if let Ok(done) = run.intervene(action) {
                added.extend(done.ids);
            }
        }
    }
}

/// An action of any kind, possible or not.
fn action(run: &Run, chance: &mut ChaCha8Rng) -> Action {
    let ids = &run.simulation.frame().agents.id;
    let some: Vec<u32> = ids.choose_multiple(chance, 3).copied().collect();
    let scene = run.simulation.scene();
    let mut point =
        |y: f64| Vector::new(chance.random_range(0.3..11.7), chance.random_range(0.3..y));
    let (goal, places) = (point(1.7), [(); 4].map(|()| point(9.7)));
    match chance.random_range(0..12) {
        0 => Action::Goals(some.into_iter().map(|id| (id, goal)).collect()),
        1 => {
            let goals = some.into_iter().zip(places);
            Action::Goals(goals.collect())
        }
        2 => Action::Add(places.map(|place| NewAgent::at(place, goal, 0)).to_vec()),
        3 => Action::Remove(some),
        4 => Action::Journey {
            agents: some,
            journey: 0,
        },
        5 => {
            let speeds = some.into_iter().map(|id| (id, f64::from(id % 7) * 0.4));
            Action::Speeds(speeds.collect())
        }
        6 => {
            let push = Push {
                name: "shove".to_owned(),
                at: 0.0,
                lasting: chance.random_range(0.0..2.0),
                region: Region {
                    min: Vector::zeros(),
                    max: goal,
                },
                change: Override {
                    goal_scale: Some(3.0),
                    ignore_contact: false,
                    ignore_sph: chance.random(),
                },
            };
            let force = PushForce {
                push: 0,
                at: 0.0,
                direction: Vector::y(),
                curve: vec![[0.0, 1.0], [1.0, 2.0]],
            };
            Action::Push(push, chance.random::<bool>().then_some(force))
        }
        7 | 8 => Action::Place {
            place: chance.random_range(0..=scene.journeys.places.len() as u16),
            change: *[ChangeKind::Open, ChangeKind::Close, ChangeKind::Release]
                .choose(chance)
                .unwrap(),
        },
        9 => Action::Entrance {
            entrance: 0,
            open: chance.random(),
        },
        10 => match chance.random() {
            true => Action::Rate {
                entrance: 0,
                per_sec: chance.random_range(0.0..4.0),
            },
            false => Action::Capacity {
                exit: 0,
                most_per_sec: chance
                    .random::<bool>()
                    .then(|| chance.random_range(0.5..3.0)),
            },
        },
        _ => Action::Zone {
            zone: 0,
            speed_factor: chance.random_range(0.1..2.0),
        },
    }
}

/// Nobody is off the floor, counted twice or lost.
fn check_people(run: &Run) {
    let simulation = &run.simulation;
    let agents = simulation.frame().agents;
    let ids: BTreeSet<u32> = agents.id.iter().copied().collect();
    assert_eq!(ids.len(), agents.len());
    let outcome = simulation.outcome();
    let gone = outcome.arrivals.len() + outcome.removed.len();
    assert_eq!(agents.count_present() + gone, agents.entered() as usize);
    let walls = &simulation.scene().walls;
    for i in agents.present() {
        let p = agents.position[i];
        assert!(
            walls.obstacle_at(p).is_none(),
            "agent {} at {p}",
            agents.id[i]
        );
    }
}

/// A run of the scenario that a run has become, to its end.
fn replayed(run: &Run) -> Run {
    let text = run.played().to_string();
    let mut again = Run::new(Scenario::parse(&text, "played.json", &[]).unwrap()).unwrap();
    let mut nobody: [Box<dyn Observer<Fault>>; 0] = [];
    again.drive(&mut nobody, || false).unwrap();
    again
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
fn all_kinds_of_actions_are_done_in_these_programs() {
    let mut done = BTreeSet::new();
    for document in &scenes() {
        for seed in programs() {
            let mut run = begun(document);
            followed(&mut run, seed);
            let played = run.played();
            let interventions = played["interventions"].as_array();
            for one in interventions.into_iter().flatten() {
                let keys = one.as_object().unwrap().keys();
                done.extend(keys.cloned());
            }
        }
    }
    let all = [
        "add",
        "close",
        "frame",
        "open",
        "push",
        "release",
        "remove",
        "set_capacity",
        "set_goal",
        "set_journey",
        "set_rate",
        "set_speed",
        "set_zone",
    ];
    assert_eq!(done, all.map(str::to_owned).into());
}

/// A run, its fork and what was saved of it, on one to three threads, and a run of its scenario end in the same state.
fn check_copies(document: &Value, seed: u64, told: &str) {
    let mut run = begun(document);
    followed(&mut run, seed);
    let mut fork = run.fork().unwrap();
    let saved = Checkpoint::of(&run.scenario, &run.simulation, &run.metrics);
    let saved = Checkpoint::parse(&saved.bytes().unwrap(), Path::new("saved")).unwrap();
    let again = saved.scenario(&[]).unwrap();
    let mut resumed = saved.resume(again).unwrap();
    show(&mut resumed);
    assert_eq!(outcome(&resumed), outcome(&run), "{told}");
    followed(&mut run, seed + 1000);
    on_threads(2, || followed(&mut fork, seed + 1000));
    on_threads(3, || followed(&mut resumed, seed + 1000));
    assert_eq!(outcome(&fork), outcome(&run), "{told}: fork");
    assert_eq!(outcome(&resumed), outcome(&run), "{told}: resumed");
    let again = on_threads(1 + seed as usize % 3, || replayed(&run));
    let [again, run] = [&again, &run].map(|run| run.simulation.digest());
    assert_eq!(again, run, "{told}: by file");
}

#[test]
fn forks_and_saved_runs_go_on_to_the_same_bits() {
    for (k, document) in scenes().iter().enumerate() {
        for seed in programs() {
            check_copies(document, seed, &format!("scene {k}, program {seed}"));
        }
    }
}

#[test]
fn so_do_those_of_random_scenes() {
    for seed in programs() {
        let mut chance = ChaCha8Rng::seed_from_u64(seed);
        let mut document = hall(&mut chance, 50);
        if chance.random() {
            document["profile"] = json!("steer+sph");
        }
        check_copies(&document, seed, &format!("hall {seed}"));
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
    let goal = Action::Goals(vec![(0, Vector::new(10.5, 6.0))]);
    fork.intervene(goal).unwrap();
    fork.simulation.step().unwrap();
    show(&mut fork);
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
    run.intervene(Action::Goals(vec![(5, goal)])).unwrap();
    assert_eq!(goal_of(&run), old);
    // The frame of now stays as it is, also if it is computed again.
    run.simulation.evaluate_with_density().unwrap();
    assert_eq!(goal_of(&run), old);
    run.simulation.integrate().unwrap();
    run.simulation.evaluate().unwrap();
    assert_eq!(goal_of(&run), goal);
}
