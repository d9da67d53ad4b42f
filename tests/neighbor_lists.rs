//! Complete lists miss no neighbor with any integrator. Coarse lists miss some agents, but no wall.

use crate::common::{blend, block, rectangle, run, scene, vector};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::clock::Clock;
use sandbox::engine::kernel;
use sandbox::engine::neighbors::ListPolicy;
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::{Draft, Need};

/// Two blocks of people that run through each other.
fn streams(lists: ListPolicy, integrator: Integrator, time_step: f64) -> Simulation {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.neighbor_lists = lists;
    scene.integrator = integrator;
    scene.clock = Clock::new(time_step, Clock::nearest_coarse_every(time_step));
    for (corner, speed) in [(vector(0.0, 0.0), 1.8), (vector(9.0, 0.2), -1.8)] {
        let goal = corner + vector(99.0, 0.0) * speed;
        let crowd = block(corner, 12, 12, 0.7, goal);
        scene.agents.extend(crowd.into_iter().map(|agent| NewAgent {
            velocity: vector(speed, 0.0),
            ..agent
        }));
    }
    Simulation::new(scene).unwrap()
}

/// How often the density of an agent lacks neighbors, in all frames of three seconds, and the largest missing
/// density, P/m².
fn missing_density(mut simulation: Simulation) -> (usize, f64) {
    let (mut count, mut most) = (0, 0.0_f64);
    while simulation.frame().clock.time() < 3.0 {
        simulation.evaluate().unwrap();
        let frame = simulation.frame();
        let (agents, density) = (frame.agents, &frame.fields.density);
        for (&place, &found) in agents.position.iter().zip(density) {
            let bodies = agents.mass.iter().zip(&agents.position);
            let whole: f64 = bodies
                .map(|(m, r)| m * kernel::density((place - r).norm_squared(), 1.0))
                .sum();
            let missing = whole - found;
            assert!(missing > -1e-9, "an agent was counted twice");
            count += usize::from(missing > 1e-9);
            most = most.max(missing);
        }
        simulation.integrate().unwrap();
    }
    (count, most)
}

#[test]
fn complete_lists_have_all_neighbors_in_every_frame() {
    for integrator in Integrator::ALL {
        for time_step in [0.02, 0.08] {
            let (count, most) =
                missing_density(streams(ListPolicy::Complete, integrator, time_step));
            assert_eq!(count, 0, "{integrator:?} {time_step}: {most}");
        }
    }
}

#[test]
fn coarse_lists_miss_some_neighbors_near_the_support_radius() {
    let streams = streams(ListPolicy::Coarse, Integrator::SemiImplicit, 0.02);
    let (count, most) = missing_density(streams);
    // Few agents, because all agents of a cluster share their neighbors. In four frames, two people approach by
    // 0.29 m.
    let nearest = kernel::density(0.71 * 0.71, 1.0);
    assert!(count > 0 && most < nearest, "{count} {most}");
}

#[test]
fn coarse_lists_miss_no_wall_however_rarely_they_are_rebuilt() {
    let mut scene = Scene {
        neighbor_lists: ListPolicy::Coarse,
        clock: Clock::new(0.02, 100),
        ..scene(vec![rectangle([3.0, 3.01], [-9.0, 19.0])], blend("sph"))
    };
    scene.agents = block(vector(0.0, 0.0), 5, 10, 0.5, vector(9.0, 5.0));
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, 300);
    let positions = &simulation.frame().agents.position;
    assert!(positions.iter().all(|p| p.x < 3.0));
}

/// The second evaluation of the midpoint method is half a step ahead of the positions for which lists were checked.
#[test]
fn lists_for_the_midpoint_method_cover_half_a_step_ahead() {
    let finest = streams(ListPolicy::Complete, Integrator::Midpoint, 0.08);
    let ranges = finest.scene().ranges(finest.needs(), finest.frame().agents);
    let half_a_move = 0.5 * finest.scene().max_speed * 0.08;
    assert!(ranges.margin >= 0.5 * sandbox::engine::neighbors::SKIN + half_a_move);
}

/// Agents among round pillars, all of which are within reach of every agent.
fn pillars() -> String {
    let pillar = |k: usize| {
        let center = [2.0 * (k % 16) as f64, 2.0 * (k / 16) as f64];
        let corners = (0..40).map(|c| {
            let angle = f64::from(c) * std::f64::consts::TAU / 40.0;
            [center[0] + 0.3 * angle.cos(), center[1] + 0.3 * angle.sin()]
        });
        corners.collect::<Vec<_>>()
    };
    serde_json::json!({
        "parameters": {"support_radius": 100},
        "obstacles": (0..256).map(pillar).collect::<Vec<_>>(),
        "grids": [{"min": [1, 1], "max": [29, 29], "columns": 15, "rows": 15, "goal": [1, 1]}],
    })
    .to_string()
}

#[test]
fn the_memory_estimate_covers_lists_of_walls() {
    let text = pillars();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let (held, need) = pool.unwrap().install(|| {
        let mut need = Need::default();
        let held = allocation_counter::measure(|| {
            let draft = Draft::read(&text, "pillars", &[]).unwrap();
            let parsed = *draft.need();
            let scene = draft.scenario().unwrap().scene;
            need = parsed.with_lists(&scene);
            let mut simulation = Simulation::new(scene).unwrap();
            simulation.evaluate().unwrap();
        });
        (held.bytes_max, need)
    });
    assert_eq!(need.listed, 225 * 256 * 40, "every wall, for every agent");
    let estimate = need.bytes();
    assert!(
        (held..5 * held).contains(&estimate),
        "{held} {estimate} {need:?}"
    );
    let without = Need { listed: 0, ..need };
    assert!(estimate > without.bytes() + 4 * need.listed);
}
