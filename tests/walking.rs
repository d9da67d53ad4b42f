//! Walking laws: what slows agents because of the crowd ahead.

use crate::common::walking::{anticipating, crowd, looking, walking, with};
use crate::common::{blend_with, evaluated, person, run, scene, state, vector, walker};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::forces::drag::Drag;
use sandbox::engine::forces::walking::{DensityAhead, Headway};
use sandbox::engine::math::{Vector, direction, perpendicular};
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Override;
use sandbox::engine::scene::{Push, Region};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{Parameters, WalkingLawKind};

/// s_i^law of agent `i`, agent by agent, by the equations of the laws.
fn lowered(simulation: &Simulation, law: WalkingLawKind, i: usize) -> f64 {
    let frame = simulation.frame();
    let wish = frame.fields.preferred_velocity[i];
    let (heading, free) = (direction(wish), wish.norm());
    let others = (0..frame.agents.len()).filter(|&j| j != i).map(|j| {
        let d = frame.agents.position[j] - frame.agents.position[i];
        (j, d.dot(&heading), d.dot(&perpendicular(heading)))
    });
    let motion = |j: usize| {
        let relative = frame.agents.velocity[j] - frame.agents.velocity[i];
        let other = direction(frame.fields.preferred_velocity[j]);
        [relative.dot(&heading), other.dot(&heading)]
    };
    match law {
        WalkingLawKind::Headway => {
            let headway = anticipating();
            let range = headway.range(free);
            let distances = others.map(|(j, along, across)| {
                headway.distance_in_lane(range, [along, across], motion(j))
            });
            headway.speed(free, distances.fold(range, f64::min))
        }
        WalkingLawKind::DensityAhead => {
            let kernel = |(j, along, across)| {
                let counts = (1.0 + 4.0 * motion(j)[1].min(0.0)).max(0.0);
                frame.agents.mass[j] * counts * DensityAhead::kernel(along, across, 1.0)
            };
            DensityAhead::default().speed(free, others.map(kernel).sum())
        }
        WalkingLawKind::None | WalkingLawKind::Drag | WalkingLawKind::Headings => {
            unreachable!("{law:?} does not lower the preferred speed")
        }
    }
}

/// The largest error of the sums, relative to the preferred velocity over τ m.
fn largest_error(law: WalkingLawKind, precision: Precision) -> f64 {
    let mut largest = 0.0_f64;
    for seed in 0..10 {
        let mut scene = crowd(law, seed);
        scene.precision = precision;
        let simulation = evaluated(scene);
        let frame = simulation.frame();
        for (i, wish) in frame.fields.preferred_velocity.iter().enumerate() {
            let rate = 2.0 / frame.agents.mass[i];
            let lost = wish.norm() - lowered(&simulation, law, i);
            let found = walking(&simulation, frame.agents.id[i]);
            let error = (found + direction(*wish) * (lost * rate)).norm();
            if wish.norm() == 0.0 {
                assert_eq!(found, Vector::zeros());
            } else {
                largest = largest.max(error / (wish.norm() * rate));
            }
        }
    }
    largest
}

#[test]
fn vector_sums_equal_sums_agent_by_agent() {
    for law in looking() {
        let error = largest_error(law, Precision::Double);
        assert!(error < 1e-12, "{law:?}: {error:e}");
    }
}

#[test]
fn mixed_precision_changes_walking_by_less_than_a_hundred_thousandth() {
    for law in looking() {
        let error = largest_error(law, Precision::Mixed);
        assert!(error < 1e-5 && error > 0.0, "{law:?}: {error:e}");
    }
}

/// Agent 0 at the origin, on its way to the right, and others at rest.
fn among(law: WalkingLawKind, others: &[Vector], precision: Precision) -> Simulation {
    let mut scene = scene(vec![], blend_with("sph", &with(law)));
    scene.precision = precision;
    let own = person(Vector::zeros(), vector(100.0, 0.0));
    let others = others.iter().map(|&place| person(place, place));
    scene.agents = std::iter::once(own).chain(others).collect();
    evaluated(scene)
}

#[test]
fn lone_agents_and_agents_with_others_behind_or_beside_walk_freely() {
    let behind = vector(-0.4, 0.0);
    let out_of_view = [
        behind,
        vector(0.0, 1.0),
        vector(-0.01, -0.3),
        vector(1.2, 0.0),
    ];
    for precision in [Precision::Double, Precision::Mixed] {
        for law in looking().chain([WalkingLawKind::Drag]) {
            for others in [&[][..], &out_of_view[..]] {
                let simulation = among(law, others, precision);
                assert_eq!(walking(&simulation, 0), Vector::zeros(), "{law:?}");
            }
        }
        let lane = Headway::default().lane_half_width;
        let beside = [vector(0.5, 1.5 * lane), vector(0.6, -1.6 * lane)];
        let simulation = among(WalkingLawKind::Headway, &beside, precision);
        assert_eq!(walking(&simulation, 0), Vector::zeros());
    }
}

#[test]
fn agents_that_come_towards_do_not_count() {
    for law in looking() {
        let met = |heading: f64| {
            let mut scene = scene(vec![], blend_with("sph", &with(law)));
            let place = vector(0.6, 0.0);
            let goal = place + vector(heading.cos(), heading.sin()) * 50.0;
            scene.agents = vec![
                person(Vector::zeros(), vector(100.0, 0.0)),
                person(place, goal),
            ];
            walking(&evaluated(scene), 0).norm()
        };
        assert_eq!(met(std::f64::consts::PI), 0.0, "{law:?}");
        assert_eq!(met(2.0), 0.0);
        assert!(met(1.6) > 0.0 && met(1.6) < met(1.0));
        assert_eq!(met(0.0), met(1.0));
    }
}

#[test]
fn the_nearest_agent_in_the_lane_sets_the_speed() {
    let others = [vector(0.66, 0.1), vector(0.9, 0.0), vector(0.4, 0.7)];
    let simulation = among(WalkingLawKind::Headway, &others, Precision::Double);
    let headway = Headway::default();
    let speed = (others[0].norm() - headway.headway_length) / headway.headway_time;
    let expected = vector((speed - 1.4) / 0.5, 0.0);
    assert!((walking(&simulation, 0) - expected).norm() < 1e-13);
}

#[test]
fn speeds_do_not_jump_when_an_agent_enters_a_lane_or_falls_behind() {
    let headway = Headway::default();
    let range = headway.range(1.4);
    let speed = |along: f64, across: f64| {
        let distance = headway.distance_in_lane(range, [along, across], [0.0, 1.0]);
        headway.speed(1.4, distance.min(range))
    };
    let step = 1e-4;
    for k in 0..6000 {
        let across = -0.3 + step * f64::from(k);
        for along in [0.1, 0.4, 0.7] {
            assert!((speed(along, across + step) - speed(along, across)).abs() < 100.0 * step);
            assert!((speed(across + step, along) - speed(across, along)).abs() < 100.0 * step);
        }
    }
    assert_eq!(speed(0.0, 0.1), 1.4);
    assert_eq!(speed(0.5, 0.45), 1.4);
}

#[test]
fn the_kernel_ahead_integrates_to_one_in_any_uniform_crowd() {
    for h in [0.7, 1.0, 2.0] {
        let step = 0.01;
        let cells = (-200..200).map(|k| (f64::from(k) + 0.5) * step);
        let sum: f64 = cells
            .clone()
            .flat_map(|x| cells.clone().map(move |y| DensityAhead::kernel(x, y, h)))
            .sum();
        assert!((sum * step * step - 1.0).abs() < 1e-3, "{h}: {sum}");
    }
}

#[test]
fn weidmanns_speed_is_free_without_a_crowd_and_zero_in_a_jam() {
    let law = DensityAhead::default();
    assert_eq!(law.speed(1.34, 0.0), 1.34);
    assert_eq!(
        [5.4, 6.0, 1e9].map(|density| law.speed(1.34, density)),
        [0.0; 3]
    );
    assert!((law.speed(1.34, 2.0) - 0.606).abs() < 0.001);
}

#[test]
fn a_single_file_keeps_the_distance_of_its_speed() {
    let parameters = Parameters::of([
        ("headway_time", 0.8),
        ("agent_stiffness", 0.0),
        ("gas_constant", 0.0),
    ])
    .unwrap()
    .or(&with(WalkingLawKind::Headway));
    for speed in [0.2, 0.5] {
        let mut scene = scene(vec![], blend_with("sph", &parameters));
        scene.max_speed_ratio = None;
        scene.agents = (0..8)
            .map(|k| NewAgent {
                preferred_speed: Some(if k == 0 { speed } else { 1.4 }),
                ..person(vector(-0.75 * f64::from(k), 0.0), vector(1000.0, 0.0))
            })
            .collect();
        let mut simulation = Simulation::new(scene).unwrap();
        run(&mut simulation, 5000);
        for id in 1..8 {
            let (ahead, _) = state(&simulation, id - 1);
            let (own, velocity) = state(&simulation, id);
            let distance = (ahead - own).norm();
            assert!((velocity.x - speed).abs() < 1e-6, "{id}: {velocity}");
            assert!(
                (velocity.x - (distance - 0.3) / 0.8).abs() < 1e-6,
                "{id}: {distance}"
            );
        }
    }
}

#[test]
fn turned_and_mirrored_crowds_lose_the_same_speeds() {
    for law in looking() {
        let original = evaluated(crowd(law, 4));
        for map in [perpendicular, |v: Vector| vector(v.x, -v.y)] {
            let mut scene = crowd(law, 4);
            for agent in &mut scene.agents {
                agent.position = map(agent.position);
                agent.velocity = map(agent.velocity);
                agent.goal = map(agent.goal);
            }
            let mapped = evaluated(scene);
            for id in 0..300 {
                let difference = walking(&mapped, id) - map(walking(&original, id));
                assert!(difference.norm() < 1e-12, "{law:?}, {id}: {difference}");
            }
        }
    }
}

#[test]
fn a_push_strengthens_the_law_like_the_goal_force() {
    let others = [vector(0.66, 0.1)];
    let calm = walking(
        &among(WalkingLawKind::Headway, &others, Precision::Double),
        0,
    );
    let mut scene = among(WalkingLawKind::Headway, &others, Precision::Double)
        .scene()
        .clone();
    scene.agents = vec![
        person(Vector::zeros(), vector(100.0, 0.0)),
        person(others[0], others[0]),
    ];
    scene.pushes = vec![Push {
        name: "push".to_owned(),
        at: 0.0,
        lasting: 1.0,
        region: Region {
            min: vector(-9.0, -9.0),
            max: vector(9.0, 9.0),
        },
        change: Override {
            goal_scale: Some(3.0),
            ignore_contact: false,
            ignore_sph: false,
        },
    }];
    let pushed = walking(&evaluated(scene), 0);
    assert!((pushed - calm * 3.0).norm() < 1e-12);
}

#[test]
fn drag_has_the_terminal_speed_of_its_equation() {
    let parameters = Parameters::of([("drag_from_density", 0.5)])
        .unwrap()
        .or(&with(WalkingLawKind::Drag));
    let mut scene = scene(vec![], blend_with("sph", &parameters));
    let goal = vector(1000.0, 0.0);
    scene.agents = vec![walker(Vector::zeros(), vector(1.0, 0.0), goal)];
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 1500);
    let own_density = 4.0 / std::f64::consts::PI;
    let drag = Drag {
        drag_from_density: 0.5,
        ..Drag::default()
    };
    let expected = 1.4 / (1.0 + drag.rate(own_density) * 0.5);
    let (_, velocity) = state(&simulation, 0);
    assert!((velocity.x - expected).abs() < 1e-9, "{velocity}");
}
