//! From the inside, a room in an infinite solid is equivalent to one with walls of any thickness.

use crate::common;
use crate::common::{blend, blend_with, block, person, rectangle, run, scene, vector, walker};
use proptest::prelude::*;
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::geometry::{Area, Polygon, Ring, Walls};
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{NAMES, Parameters};

fn ring(points: &[[f64; 2]]) -> Ring {
    Ring::new(points.iter().map(|&p| Vector::from(p)).collect()).unwrap()
}

/// A room with a niche and a pillar.
fn floor() -> Area {
    let outline = [
        [0.0, 0.0],
        [6.0, 0.0],
        [6.0, 5.0],
        [3.5, 5.0],
        [3.2, 4.0],
        [0.0, 5.0],
    ];
    let pillar = [[2.0, 2.0], [2.8, 2.1], [2.5, 2.9]];
    Area {
        exterior: ring(&outline),
        holes: vec![ring(&pillar)],
    }
}

fn enclosed() -> Vec<Polygon> {
    vec![Polygon::enclosing(vec![floor()]).unwrap()]
}

/// The same room with walls at least `thickness` meters thick, and the pillar as an obstacle of its own.
fn walled(thickness: f64) -> Vec<Polygon> {
    let (low, high) = (-thickness, 6.0 + thickness);
    let around = [[low, low], [high, low], [high, high], [low, high]];
    let Area { exterior, holes } = floor();
    let walls = Area {
        exterior: ring(&around),
        holes: vec![exterior],
    };
    let pillar = Polygon::new(holes[0].points().to_vec()).unwrap();
    vec![Polygon::filling(walls).unwrap(), pillar]
}

/// Walking people all over the room.
fn crowd() -> Vec<sandbox::engine::agents::NewAgent> {
    let room = Walls::new(enclosed());
    block(vector(0.05, 0.08), 13, 11, 0.45, vector(5.5, 4.5))
        .into_iter()
        .filter(|agent| room.obstacle_at(agent.position).is_none())
        .enumerate()
        .map(|(k, agent)| {
            walker(
                agent.position,
                vector((k as f64).sin(), (k as f64).cos()),
                agent.goal,
            )
        })
        .collect()
}

#[test]
fn density_and_forces_do_not_depend_on_the_wall_thickness() {
    for method in [
        WallMethod::Representative,
        WallMethod::Exact,
        WallMethod::Union,
    ] {
        for name in NAMES {
            let simulations = [enclosed(), walled(0.5), walled(50.0)].map(|obstacles| {
                let mut scene = scene(obstacles, blend(name));
                scene.wall_method = method;
                scene.agents = crowd();
                let mut simulation = common::evaluated(scene);
                assert!(simulation.outcome().displaced.is_empty());
                simulation.evaluate().unwrap();
                simulation
            });
            let [enclosed, thin, thick] = &simulations;
            let count = enclosed.frame().agents.len();
            assert!(count > 100, "{count}");
            for other in [thin, thick] {
                for id in 0..count as u32 {
                    let [own, its] = [enclosed, other].map(|s| common::breakdown(s, id));
                    assert!(
                        (own.density - its.density).abs() <= 1e-12 * its.density,
                        "{name} {id}"
                    );
                    assert!((own.pressure - its.pressure).abs() <= 1e-9 * its.pressure.max(1.0));
                    let difference =
                        common::acceleration(enclosed, id) - common::acceleration(other, id);
                    let size = common::acceleration(other, id).norm();
                    assert!(
                        difference.norm() <= 1e-9 * size.max(1.0),
                        "{name} {method:?} {id}"
                    );
                    assert_eq!(own.walls.len(), its.walls.len());
                }
            }
        }
    }
}

#[test]
fn a_pressing_crowd_stays_inside_and_agents_at_their_goal_are_removed() {
    let parameters = Parameters::of([("goal_scale", 10.0)]).unwrap();
    for profile in ["sph", "sf"] {
        let mut scene = scene(enclosed(), blend_with(profile, &parameters));
        scene.agents = crowd();
        for (k, agent) in scene.agents.iter_mut().enumerate() {
            let angle = k as f64;
            agent.goal = agent.position + vector(angle.cos(), angle.sin()) * 100.0;
        }
        let people = scene.agents.len();
        let mut simulation = Simulation::new(scene).unwrap();
        let room = Walls::new(enclosed());
        for _ in 0..40 {
            run(&mut simulation, 25);
            let agents = simulation.frame().agents;
            assert_eq!(agents.len(), people);
            let inside = |p: &Vector| room.obstacle_at(*p).is_none();
            assert!(agents.position.iter().all(inside), "{profile}");
        }
    }
    let mut scene = scene(enclosed(), blend("sph"));
    scene.groups[0].removal_radius = Some(0.8);
    scene.agents = crowd();
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 3000);
    assert_eq!(simulation.frame().agents.len(), 0);
}

#[test]
fn agents_that_start_outside_are_moved_to_the_nearest_free_point() {
    let starts = [
        [-40.0, -30.0],
        [3.0, -0.5],
        [9.0, 9.0],
        [2.4, 2.4],
        [-1.0, 2.0],
    ];
    let floor = floor();
    let mut scene = scene(enclosed(), blend("sph"));
    scene.agents = starts.map(|p| person(p.into(), vector(5.5, 4.5))).to_vec();
    let simulation = Simulation::new(scene).unwrap();
    let displaced = &simulation.outcome().displaced;
    assert_eq!(displaced.len(), starts.len());
    for (id, &start) in starts.iter().enumerate() {
        let (place, _) = common::state(&simulation, id as u32);
        assert!(floor.contains(place), "{start:?} to {place}");
        let walls = Walls::new(enclosed());
        let nearest = walls
            .iter()
            .map(|wall| (wall.nearest_point(start.into()).point - Vector::from(start)).norm())
            .fold(f64::INFINITY, f64::min);
        let way = (place - Vector::from(start)).norm();
        assert!(
            (way - nearest).abs() < 1e-5,
            "{start:?} to {place}: {way}, not {nearest}"
        );
    }
}

#[test]
fn no_agent_passes_the_wall_between_two_rooms() {
    let room = |x: f64| Area {
        exterior: ring(&[[x, 0.0], [x + 3.0, 0.0], [x + 3.0, 3.0], [x, 3.0]]),
        holes: vec![],
    };
    let rooms = Polygon::enclosing(vec![room(0.0), room(3.01)]).unwrap();
    let mut scene = scene(vec![rooms], blend("sph"));
    scene.agents = block(vector(0.3, 0.3), 7, 7, 0.4, vector(30.0, 1.5));
    scene
        .agents
        .extend(block(vector(3.4, 0.3), 7, 7, 0.4, vector(-30.0, 1.5)));
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 500);
    let agents = simulation.frame().agents;
    for (p, &id) in agents.position.iter().zip(&agents.id) {
        assert!(if id < 49 { p.x < 3.0 } else { p.x > 3.01 }, "{id} at {p}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    #[test]
    fn nearest_free_points_are_free_and_no_free_point_is_nearer(x in -9.0..15.0_f64, y in -9.0..15.0_f64) {
        let with_a_body_on_the_wall = [enclosed(), vec![rectangle([5.0, 7.0], [-1.0, 1.0])]].concat();
        for obstacles in [enclosed(), with_a_body_on_the_wall] {
            let walls = Walls::new(obstacles);
            let p = vector(x, y);
            if walls.obstacle_at(p).is_some() {
                let free = walls.free_point_near(p).unwrap();
                prop_assert!(walls.obstacle_at(free).is_none());
                // No point of the floor on a fine grid is nearer.
                let grid = (0..=120).flat_map(|i| (0..=100).map(move |j| (i, j)));
                let nearest = grid
                    .map(|(i, j)| vector(0.05 * f64::from(i), 0.05 * f64::from(j)))
                    .filter(|&q| walls.obstacle_at(q).is_none())
                    .map(|q| (q - p).norm())
                    .fold(f64::INFINITY, f64::min);
                prop_assert!((free - p).norm() <= nearest + 1e-5);
            }
        }
    }
}
