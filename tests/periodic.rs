//! Periodic scenes: what happens at the ends of the period is what happens anywhere.

use crate::common::ring::{corridor, parsed, people};
use crate::common::{bits, blend, evaluated, go_to, person, run, scene, vector};
use sandbox::engine::agents::{Agents, NewAgent};
use sandbox::engine::math::Vector;
use sandbox::engine::neighbors::{ListPolicy, Neighbors, Ranges, SKIN};
use sandbox::engine::period::{Axis, Period};
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{NAMES, WalkingLawKind};
use serde_json::json;

fn along_x(from: f64, length: f64) -> Period {
    Period {
        axis: Axis::X,
        from,
        length,
    }
}

/// A ring of people without walls, who walk along the axis.
fn ring(profile: &str) -> Scene {
    let mut scene = scene(Vec::new(), blend(profile));
    scene.period = Some(along_x(2.0, 12.0));
    scene.groups[0].direction = Some(Vector::x());
    scene.agents = people(150, vector(12.0, 4.0));
    scene
}

#[test]
fn images_lie_in_the_period() {
    let period = along_x(-0.3, 0.7);
    for x in [
        -0.3,
        0.4,
        0.399_999,
        -0.3 - 1e-18,
        1e6,
        -1e6,
        -0.300_000_000_1,
    ] {
        let (image, laps) = period.wrapped(vector(x, 5.0));
        assert!(period.contains(image), "{x} {image}");
        assert!((image + period.way(laps) - vector(x, 5.0)).norm() < 1e-9);
        assert_eq!(period.wrapped(image), (image, 0));
    }
}

#[test]
fn the_density_of_a_lattice_is_the_same_everywhere() {
    for axis in [Axis::X, Axis::Y] {
        let mut scene = scene(Vec::new(), blend("sph"));
        let (from, length) = (-3.0, 8.0);
        scene.groups[0].direction = Some(Vector::x());
        scene.period = Some(Period { axis, from, length });
        let at = |k: u32| match axis {
            Axis::X => vector(0.5 * f64::from(k % 16), 0.5 * f64::from(k / 16)),
            Axis::Y => vector(0.5 * f64::from(k / 16), 0.5 * f64::from(k % 16)),
        };
        scene.agents = (0..96).map(|k| person(at(k), Vector::zeros())).collect();
        let simulation = evaluated(scene);
        let frame = simulation.frame();
        for row in 0..6 {
            let ids = 16 * row..16 * (row + 1);
            let densities = ids.map(|id| {
                let i = frame.agents.index_of(id).unwrap();
                (frame.fields.density[i], frame.fields.acceleration[i])
            });
            let all: Vec<_> = densities.collect();
            for (density, acceleration) in &all {
                assert!((density - all[0].0).abs() < 1e-13, "{all:?}");
                assert!((acceleration - all[0].1).norm() < 1e-10, "{all:?}");
            }
        }
    }
}

#[test]
fn forces_are_those_in_the_middle_of_three_crowds() {
    let lawless = NAMES.map(|profile| (profile, WalkingLawKind::None));
    let lawful = WalkingLawKind::laws().map(|law| ("sph", law));
    for (profile, law) in lawless.into_iter().chain(lawful) {
        for axis in ["x", "y"] {
            let [one, three] = [true, false].map(|periodic| {
                let mut document = corridor(profile, axis, periodic);
                document["parameters"]["walking_law"] = json!(law);
                evaluated(parsed(&document).scene)
            });
            let (one, three) = (one.frame(), three.frame());
            for id in 0..70 {
                let [i, j] = [one, three].map(|frame| frame.agents.index_of(id).unwrap());
                let difference = (one.fields.density[i] - three.fields.density[j]).abs();
                assert!(difference < 1e-12, "{profile} {axis} {id}: {difference}");
                let [a, b] = [one.fields.acceleration[i], three.fields.acceleration[j]];
                let difference = (a - b).norm() / (1.0 + b.norm());
                assert!(difference < 1e-12, "{profile} {axis} {id}: {a} {b}");
            }
        }
    }
}

#[test]
fn mixed_precision_sees_the_same_forces_across_the_ends() {
    for profile in ["sph", "sf"] {
        let mut document = corridor(profile, "x", true);
        let double = evaluated(parsed(&document).scene);
        document["precision"] = json!("mixed");
        let mixed = evaluated(parsed(&document).scene);
        let [double, mixed] =
            [double.frame(), mixed.frame()].map(|frame| &frame.fields.acceleration);
        for (a, b) in double.iter().zip(mixed) {
            assert!(
                (a - b).norm() < 1e-3 * (1.0 + a.norm()),
                "{profile}: {a} {b}"
            );
        }
    }
}

#[test]
fn lists_hold_all_agents_across_the_ends() {
    for (count, length, width) in [(300, 6.0, 4.0), (40, 300.0, 300.0), (2, 3.0, 0.3)] {
        for axis in [Axis::X, Axis::Y] {
            let extent = match axis {
                Axis::X => vector(length, width),
                Axis::Y => vector(width, length),
            };
            let period = Period {
                axis,
                from: 0.0,
                length,
            };
            let mut agents = Agents::default();
            for new in people(count, extent) {
                agents.enter(new, 1);
            }
            let ranges = Ranges {
                support: 1.0,
                drift: 0.5 * SKIN,
                margin: 0.5 * SKIN,
                period: Some(period),
                ..Ranges::default()
            };
            let mut neighbors = Neighbors::default();
            neighbors.sort(&mut agents, ranges);
            neighbors.list_agents();
            for i in 0..agents.len() {
                let r_i = agents.position[i];
                let near = |found: &mut dyn Iterator<Item = (usize, i32)>, reach: f64| {
                    let offset = |(j, laps)| agents.position[j] + period.way(laps) - r_i;
                    let mut found: Vec<_> = found.filter(|&at| offset(at).norm() < reach).collect();
                    found.sort_unstable();
                    found
                };
                let all = || (0..agents.len()).flat_map(|j| [-1, 0, 1].map(|laps| (j, laps)));
                let listed = near(&mut neighbors.near().near(i), 1.0 + SKIN);
                assert_eq!(listed, near(&mut all(), 1.0 + SKIN));
                let runs = neighbors.around(i, &agents.position, 1.5);
                let seen = runs.flat_map(|run| run.indices().map(move |j| (j, run.laps)));
                assert_eq!(near(&mut { seen }, 1.5), near(&mut all(), 1.5));
            }
        }
    }
}

#[test]
fn moving_everything_along_the_axis_changes_nothing() {
    for profile in ["sph", "sf", "sf->sph"] {
        let velocities = |shift: f64| {
            let mut scene = ring(profile);
            for agent in &mut scene.agents {
                agent.position.x += shift;
            }
            let mut simulation = Simulation::new(scene).unwrap();
            run(&mut simulation, 60);
            let agents = simulation.frame().agents;
            let of = |id| agents.velocity[agents.index_of(id).unwrap()];
            (0..150).map(of).collect::<Vec<_>>()
        };
        let still = velocities(0.0);
        for (a, b) in still.iter().zip(velocities(7.3)) {
            assert!((a - b).norm() < 1e-7, "{profile}: {a} {b}");
        }
    }
}

#[test]
fn agents_go_round_and_keep_their_ids() {
    for integrator in Integrator::ALL {
        for (heading, lists) in [(1.0, ListPolicy::Complete), (-1.0, ListPolicy::Coarse)] {
            let mut scene = scene(Vec::new(), blend("sph"));
            scene.integrator = integrator;
            scene.neighbor_lists = lists;
            scene.period = Some(along_x(0.0, 3.0));
            scene.groups[0].direction = Some(Vector::x() * heading);
            scene.agents = vec![NewAgent {
                velocity: vector(1.4 * heading, 0.0),
                ..person(vector(1.0, 0.0), Vector::zeros())
            }];
            let period = scene.period.unwrap();
            let mut simulation = Simulation::new(scene).unwrap();
            for _ in 0..500 {
                simulation.step().unwrap();
                simulation.evaluate().unwrap();
                assert!(period.contains(simulation.frame().agents.position[0]));
            }
            let agents = simulation.frame().agents;
            let walked = 1.4 * simulation.frame().clock.time() * heading;
            let unwrapped = agents.position[0] + period.way(agents.laps[0]);
            assert_eq!(agents.id, [0]);
            assert!((unwrapped.x - 1.0 - walked).abs() < 1e-9, "{unwrapped}");
            assert!(agents.laps[0].abs() > 1);
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits_and_a_resumed_run_too() {
    for profile in ["sph", "rvo", "sf->sph"] {
        let on = |threads: usize, stop: u64| {
            let pool = rayon::ThreadPoolBuilder::new();
            pool.num_threads(threads).build().unwrap().install(|| {
                let mut simulation = Simulation::new(ring(profile)).unwrap();
                go_to(&mut simulation, stop);
                let state = simulation.state();
                let mut simulation = Simulation::resumed(ring(profile), state).unwrap();
                go_to(&mut simulation, 60);
                (simulation.digest(), bits(&simulation))
            })
        };
        let first = on(1, 60);
        for (threads, stop) in [(2, 60), (1, 13), (2, 38)] {
            assert_eq!(on(threads, stop), first, "{profile}");
        }
    }
}

#[test]
fn a_uniform_flow_has_the_preferred_speed_at_any_density() {
    // Equal neighbors on all sides cancel: only the goal force is left.
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.period = Some(along_x(0.0, 4.0));
    scene.groups[0].direction = Some(Vector::x());
    let at = |k: u32| vector(0.5 * f64::from(k), 0.0);
    scene.agents = (0..8).map(|k| person(at(k), Vector::zeros())).collect();
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 500);
    for velocity in &simulation.frame().agents.velocity {
        assert!((velocity - vector(1.4, 0.0)).norm() < 1e-3, "{velocity}");
    }
}
