//! Results are bit-identical with any number of threads, and with or without observers.

use crate::common;
use crate::common::{bits, blend, block, polygon, room, scene, vector};
use sandbox::engine::clock::Clock;
use sandbox::engine::neighbors::{MANY, SKIN};
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Override;
use sandbox::engine::scene::{Goal, Push, Region, Scene, Source};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::NAMES;

/// A crowd in a small room with an exit, a source that adds a row every second, and a push. The crowd is large
/// enough for eight threads.
fn busy_room(profile: &str) -> Scene {
    let mut scene = scene(vec![room(12.0, 1.2)], blend(profile));
    scene.seed = 5;
    scene.precision = Precision::Mixed;
    scene.groups[0].removal_radius = Some(0.5);
    let exit = vector(13.5, 6.0);
    // Dense enough that both profiles of a blend have weight.
    scene.agents = block(vector(0.4, 0.4), 28, 22, 0.42, exit);
    scene.sources = vec![Source {
        name: "late".to_owned(),
        grid: sandbox::engine::placement::Grid {
            min: vector(0.3, 10.0),
            max: vector(11.0, 11.5),
            columns: 12,
            rows: 1,
            jitter: 0.3,
        },
        group: 0,
        goal: Goal::Point(exit),
        start: 0.5,
        every: 1.0,
        times: Some(2),
    }];
    scene.pushes = vec![Push {
        name: "push".to_owned(),
        at: 0.6,
        lasting: 0.5,
        region: Region {
            min: vector(2.0, 2.0),
            max: vector(8.0, 8.0),
        },
        change: Override {
            goal_scale: Some(3.0),
            ignore_contact: true,
            ignore_sph: true,
        },
    }];
    scene
}

fn simulated(scene: Scene, threads: usize, frames: u32) -> Simulation {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let mut simulation = Simulation::new(scene).unwrap();
        for _ in 0..frames {
            simulation.step().unwrap();
        }
        simulation
    })
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    for profile in NAMES {
        assert_same_bits(profile, Precision::Mixed);
    }
    assert_same_bits("sph", Precision::Double);
}

fn assert_same_bits(profile: &str, precision: Precision) {
    let mut scene = busy_room(profile);
    scene.precision = precision;
    let one = simulated(scene.clone(), 1, 60);
    assert!(one.frame().agents.len() > 512);
    for threads in [2, 3, 8] {
        let many = simulated(scene.clone(), threads, 60);
        assert!(bits(&one) == bits(&many), "{profile} on {threads} threads");
        assert_eq!(one.outcome(), many.outcome());
        assert_eq!(one.events(), many.events());
    }
}

/// A crowd whose lists follow it: it walks along a wall, faster on its left side.
fn large_crowd() -> Scene {
    let wall = polygon(&[[-5.0, -2.0], [200.0, -2.0], [200.0, -1.0], [-5.0, -1.0]]);
    let mut scene = scene(vec![wall], blend("sph"));
    scene.clock = Clock::new(0.02, 1);
    scene.agents = block(
        vector(0.0, 0.0),
        200,
        MANY as u32 / 200 + 1,
        0.45,
        vector(0.0, 0.0),
    );
    for agent in &mut scene.agents {
        agent.goal = agent.position + vector(100.0, 3.0);
        agent.preferred_speed = Some(1.2 + 0.003 * agent.position.y);
    }
    scene
}

#[test]
fn lists_that_follow_a_large_crowd_change_only_the_rounding() {
    let frames = 60;
    let one = simulated(large_crowd(), 1, frames);
    // All have walked much farther than half the margin, but lists were made a few times only.
    let mut watched = Simulation::new(large_crowd()).unwrap();
    let mut sorts = 0;
    for _ in 0..frames {
        watched.evaluate().unwrap();
        let frame = watched.frame();
        sorts += u32::from(frame.neighbors.sorted_at() == frame.agents.position);
        watched.integrate().unwrap();
    }
    let walked = one.frame().agents.velocity.iter().map(|v| v.norm());
    let way = walked.fold(0.0, f64::max) * 0.02 * f64::from(frames);
    // Without following: a sort for each half of the margin that somebody walks.
    let others = (way / (0.5 * SKIN)) as u32;
    assert!(
        2 <= sorts && sorts < 2 * others / 3,
        "{sorts} sorts instead of {others}"
    );
    assert!(bits(&one) == bits(&simulated(large_crowd(), 3, frames)));
    let mut begun = simulated(large_crowd(), 2, frames / 2);
    begun = Simulation::resumed(large_crowd(), begun.state()).unwrap();
    common::run(&mut begun, u64::from(frames / 2));
    assert!(bits(&one) == bits(&begun));
    let most = differences_from_lists_made_anew(watched, large_crowd());
    assert!(most.density < 1e-12 && most.acceleration < 1e-9, "{most:?}");
    assert!(most.compared > MANY / 2, "{most:?}");
}

/// The largest differences between results with lists that follow and with lists made anew.
#[derive(Debug, Default)]
struct Differences {
    density: f64,
    acceleration: f64,
    /// The number of accelerations that were compared.
    compared: usize,
}

/// Compares the results of the next frame after a sort with those of lists made anew for the same state. Accelerations
/// of agents with a neighbor at a pressure next to 0 are left out: rounding decides its sign.
fn differences_from_lists_made_anew(mut watched: Simulation, scene: Scene) -> Differences {
    let mut sorted = false;
    while !sorted {
        watched.evaluate().unwrap();
        let frame = watched.frame();
        sorted = frame.neighbors.sorted_at() == frame.agents.position;
        watched.integrate().unwrap();
    }
    let mut anew = Simulation::resumed(scene, watched.state().without_lists()).unwrap();
    for simulation in [&mut watched, &mut anew] {
        simulation.evaluate().unwrap();
    }
    let (followed, anew) = (watched.frame(), anew.frame());
    assert!(followed.neighbors.sorted_at() != followed.agents.position);
    assert!(anew.neighbors.sorted_at() == anew.agents.position);
    let (own, other) = (followed.fields, anew.fields);
    let mut most = Differences::default();
    for (i, id) in followed.agents.id.iter().enumerate() {
        let j = anew.agents.index_of(*id).unwrap();
        most.density = most.density.max((own.density[i] - other.density[j]).abs());
        let near = followed.neighbors.near().near(i);
        let pressures = near.map(|(k, _)| own.pressure[k].abs());
        if pressures.fold(f64::INFINITY, f64::min) > 1e-9 {
            most.compared += 1;
            let difference = (own.acceleration[i] - other.acceleration[j]).norm();
            most.acceleration = most.acceleration.max(difference);
        }
    }
    most
}

/// Two streams of a large crowd that meet, on which lists follow with each kind of walking.
#[test]
fn lists_that_follow_serve_walking_social_forces_and_avoidance() {
    for profile in ["steer+sph", "walk+sph", "sf->sph", "rvo->sph"] {
        let streams = || {
            let mut scene = large_crowd();
            scene.groups[0].blend = blend(profile);
            for agent in &mut scene.agents {
                if agent.position.x > 45.0 {
                    agent.goal = agent.position - vector(100.0, 3.0);
                }
            }
            scene
        };
        let watched = simulated(streams(), 2, 20);
        let most = differences_from_lists_made_anew(watched, streams());
        assert!(
            most.density < 1e-12 && most.acceleration < 1e-9,
            "{profile}: {most:?}"
        );
        assert!(most.compared > MANY / 3, "{profile}: {most:?}");
    }
}

#[test]
fn another_seed_gives_other_results() {
    let mut other = busy_room("sph");
    other.seed = 6;
    let mut other = Simulation::new(other).unwrap();
    common::run(&mut other, 10);
    assert!(bits(&other) != bits(&simulated(busy_room("sph"), 1, 10)));
}

/// The bits of all agents without the mean density, which is only computed on request.
fn motion(simulation: &Simulation) -> Vec<(u32, [u64; 4])> {
    let all = bits(simulation).into_iter();
    all.map(|(id, [x, y, u, v, _])| (id, [x, y, u, v]))
        .collect()
}

#[test]
fn requesting_densities_changes_neither_the_motion_nor_the_digest() {
    for profile in NAMES {
        for (asked_at, until) in [(0, 1), (0, 200), (3, 40), (31, 33), (40, 200)] {
            let mut plain = Simulation::new(busy_room(profile)).unwrap();
            let mut watched = Simulation::new(busy_room(profile)).unwrap();
            for frame in 0..60 {
                if frame == asked_at {
                    watched.request_density_until(until);
                }
                plain.step().unwrap();
                watched.step().unwrap();
            }
            let same = motion(&plain) == motion(&watched);
            assert!(same, "{profile}, asked at {asked_at} until {until}");
            assert_eq!(plain.digest(), watched.digest(), "{profile}");
        }
    }
}

#[test]
fn evaluating_a_frame_twice_changes_nothing() {
    let mut once = Simulation::new(busy_room("rvo->sph")).unwrap();
    let mut often = Simulation::new(busy_room("rvo->sph")).unwrap();
    for _ in 0..30 {
        once.step().unwrap();
        often.evaluate().unwrap();
        often.evaluate().unwrap();
        often.integrate().unwrap();
    }
    assert!(bits(&once) == bits(&often));
}

#[test]
fn densities_requested_between_coarse_frames_include_all_neighbors() {
    for asked_at in 0..6 {
        let mut scene = busy_room("sf");
        scene.precision = Precision::Double;
        let mut simulation = Simulation::new(scene).unwrap();
        common::run(&mut simulation, asked_at);
        simulation.request_density_until(asked_at + 1);
        simulation.evaluate().unwrap();
        let frame = simulation.frame();
        for i in (0..frame.agents.len()).step_by(7) {
            let all = 0..frame.agents.len();
            let expected: f64 = all
                .map(|j| {
                    let r_ij = frame.agents.position[i] - frame.agents.position[j];
                    frame.agents.mass[j]
                        * sandbox::engine::kernel::density(r_ij.norm_squared(), 1.0)
                })
                .sum();
            let found = frame.fields.density[i] - frame.fields.density_from_walls[i];
            assert!(
                (found - expected).abs() < 1e-9,
                "asked at {asked_at}: {found} {expected}"
            );
        }
    }
}

#[test]
fn population_and_behavior_have_separate_seeds() {
    let run = |population: u64, behavior: u64, frames: u32| {
        let mut scene = busy_room("rvo->sph");
        scene.seed = population;
        scene.behavior_seed = Some(behavior);
        simulated(scene, 2, frames)
    };
    let bodies = |simulation: &Simulation| {
        let agents = simulation.frame().agents;
        let mut bodies: Vec<(u32, u64)> = agents
            .id
            .iter()
            .copied()
            .zip(agents.radius.iter().map(|r| r.to_bits()))
            .collect();
        bodies.sort_unstable();
        bodies
    };
    let (one, other) = (run(5, 1, 20), run(5, 2, 20));
    assert_eq!(bodies(&one), bodies(&other));
    assert_ne!(one.digest(), other.digest());
    assert_ne!(bodies(&one), bodies(&run(6, 1, 20)));
    // Without its own seed, behavior uses that of the population.
    let mut same = busy_room("rvo->sph");
    same.behavior_seed = None;
    assert_eq!(simulated(same, 2, 20).digest(), run(5, 5, 20).digest());
}

#[test]
fn the_digest_depends_on_the_state_and_not_on_the_threads() {
    let digest = |threads, frames| simulated(busy_room("sf->sph"), threads, frames).digest();
    let one = digest(1, 40);
    assert_eq!(one.len(), 64);
    assert_eq!(one, digest(3, 40));
    assert_ne!(one, digest(1, 41));
}
