//! Time stepping, entries, pushes, arrivals and faults, through the public API.

use crate::common::{
    blend, blend_with, block, breakdown, person, rectangle, room, run, scene, state, vector,
};
use proptest::prelude::*;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::clock::Clock;
use sandbox::engine::density::SphParameters;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Integrator;
use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::scenario::catalog::{NAMES, Parameters};
use sandbox::scenario::measurements::{Measurement, Metrics};

/// One agent at rest, with a goal far to the right.
fn alone(integrator: Integrator, time_step: f64) -> Simulation {
    let mut scene = scene(Vec::new(), blend("sph"));
    scene.integrator = integrator;
    scene.clock = Clock::new(time_step, Clock::nearest_coarse_every(time_step));
    scene.agents = vec![person(Vector::zeros(), vector(1000.0, 0.0))];
    Simulation::new(scene).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(40) })]

    #[test]
    fn one_agent_follows_the_closed_form_of_its_integrator(frames in 1..200_u64) {
        // v_n = 1.4 (1 − q^n), q = 1 − Δt/τ; r sums the new velocities (semi-implicit) or the old ones (forward).
        let (dt, q) = (0.02, 0.96_f64);
        let n = frames as i32;
        let speed = 1.4 * (1.0 - q.powi(n));
        let new = 1.4 * dt * (f64::from(n) - q * (1.0 - q.powi(n)) / (1.0 - q));
        let old = 1.4 * dt * (f64::from(n) - (1.0 - q.powi(n)) / (1.0 - q));
        for (integrator, way) in [(Integrator::SemiImplicit, new), (Integrator::ForwardEuler, old)] {
            let mut simulation = alone(integrator, dt);
            run(&mut simulation, frames);
            let (r, v) = state(&simulation, 0);
            prop_assert!((r - vector(way, 0.0)).norm() < 1e-11);
            prop_assert!((v - vector(speed, 0.0)).norm() < 1e-12);
        }
    }
}

#[test]
fn no_agent_exceeds_the_maximum_speed() {
    let mut scene = scene(Vec::new(), blend("sf"));
    scene.agents = block(Vector::zeros(), 10, 10, 0.15, vector(50.0, 0.0));
    let mut simulation = Simulation::new(scene).unwrap();
    let mut fastest = 0.0_f64;
    for _ in 0..100 {
        let before: Vec<Vector> = (0..100).map(|id| state(&simulation, id).0).collect();
        simulation.step().unwrap();
        for id in 0..100 {
            let (r, v) = state(&simulation, id);
            fastest = fastest.max(v.norm());
            assert!(v.norm() <= 1.8 * (1.0 + 1e-15));
            assert!((r - before[id as usize]).norm() <= 0.036 + 1e-12);
        }
    }
    assert!(fastest > 1.799, "the clamp was at work");
}

#[test]
fn agents_that_start_in_an_obstacle_are_moved_out_and_reported() {
    let obstacles = vec![
        rectangle([0.0, 4.0], [0.0, 4.0]),
        rectangle([4.0, 8.0], [1.0, 3.0]),
    ];
    let mut scene = scene(obstacles, blend("sph"));
    let goal = vector(20.0, 2.0);
    scene.agents = vec![
        person(vector(-1.0, 2.0), goal),
        person(vector(1.0, 2.0), goal),
        person(vector(6.0, 2.9), goal),
    ];
    let simulation = Simulation::new(scene).unwrap();
    assert_eq!(simulation.outcome().displaced, [(1, 0), (2, 1)]);
    for (id, expected) in [(0, [-1.0, 2.0]), (1, [0.0, 2.0]), (2, [6.0, 3.0])] {
        assert!((state(&simulation, id).0 - Vector::from(expected)).norm() < 1e-5);
    }
}

#[test]
fn the_moving_average_starts_without_the_density_from_walls() {
    let mut scene = scene(vec![rectangle([-9.0, 9.0], [-1.0, 0.0])], blend("sph"));
    scene.agents = vec![
        person(vector(0.0, 0.4), vector(9.0, 9.0)),
        person(vector(0.5, 0.4), vector(9.0, 9.0)),
        NewAgent {
            mean_density: Some(2.0),
            ..person(vector(5.0, 0.4), vector(9.0, 9.0))
        },
    ];
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.evaluate().unwrap();
    for id in 0..3 {
        let agent = breakdown(&simulation, id);
        let before = if id == 2 {
            2.0
        } else {
            agent.density_from_agents
        };
        assert!(agent.density_from_walls > 0.05);
        let kernel: f64 = agent.walls.iter().map(|wall| wall.density).sum();
        assert!((agent.density_from_walls - kernel).abs() < 1e-12);
        assert!((agent.mean_density - (0.8 * before + 0.2 * agent.density)).abs() < 1e-12);
        assert_eq!(agent.rest_density, agent.mean_density.min(5.0));
    }
    let first = breakdown(&simulation, 0);
    simulation.integrate().unwrap();
    simulation.evaluate().unwrap();
    let second = breakdown(&simulation, 0);
    let expected = 0.8 * first.mean_density + 0.2 * second.density;
    assert!((second.mean_density - expected).abs() < 1e-12);
}

#[test]
fn a_non_finite_state_is_reported_with_frame_agent_and_quantity() {
    let broken = |name: &str, agent: NewAgent| {
        let mut scene = scene(vec![room(9.0, 1.0)], blend(name));
        scene.agents = vec![person(vector(3.0, 3.0), vector(10.0, 4.5)), agent];
        let mut simulation = Simulation::new(scene).unwrap();
        simulation.step().unwrap_err()
    };
    let healthy = person(vector(5.0, 5.0), vector(10.0, 4.5));
    for name in NAMES {
        for bad in [f64::NAN, f64::INFINITY] {
            let cases = [
                (
                    "position",
                    NewAgent {
                        position: vector(bad, 5.0),
                        ..healthy
                    },
                ),
                (
                    "velocity",
                    NewAgent {
                        velocity: vector(0.0, -bad),
                        ..healthy
                    },
                ),
            ];
            for (expected, agent) in cases {
                let Fault::NotFinite {
                    frame,
                    agent,
                    quantity,
                    ..
                } = broken(name, agent)
                else {
                    panic!("another fault");
                };
                assert_eq!((frame, agent, quantity), (0, 1, expected), "{name} {bad}");
            }
        }
    }
}

#[test]
fn a_run_that_blows_up_stops_before_any_agent_moves() {
    let parameters = Parameters::of([("gas_constant", 1e308)]).unwrap();
    let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
    scene.agents = block(Vector::zeros(), 6, 6, 0.3, vector(9.0, 0.0));
    let mut simulation = Simulation::new(scene).unwrap();
    let before = (0..36).map(|id| state(&simulation, id)).collect::<Vec<_>>();
    let fault = simulation.step().unwrap_err();
    let Fault::NotFinite {
        frame,
        time,
        quantity,
        ..
    } = &fault
    else {
        panic!("another fault");
    };
    assert_eq!((*frame, *time, *quantity), (0, 0.0, "acceleration"));
    assert!(fault.to_string().contains("frame 0"), "{fault}");
    assert_eq!(
        before,
        (0..36).map(|id| state(&simulation, id)).collect::<Vec<_>>()
    );
}

#[test]
fn a_hundred_people_leave_a_room_and_every_density_is_positive() {
    let mut scene = scene(vec![room(10.0, 0.8)], blend("sph"));
    scene.groups[0].removal_radius = Some(0.5);
    scene.agents = block(vector(0.5, 0.5), 10, 10, 1.0, vector(12.0, 5.0));
    let mut simulation = Simulation::new(scene).unwrap();
    while !simulation.frame().agents.is_empty() && simulation.frame().clock.time() < 120.0 {
        simulation.evaluate().unwrap();
        let fields = simulation.frame().fields;
        assert!(
            fields
                .density
                .iter()
                .all(|&density| density > 0.0 && density < 15.0)
        );
        simulation.integrate().unwrap();
    }
    let arrivals = &simulation.outcome().arrivals;
    assert_eq!(arrivals.len(), 100);
    assert!(arrivals.windows(2).all(|pair| pair[0].time <= pair[1].time));
    assert_eq!(simulation.outcome().contained.count, 0);
}

/// The measurement of a flow until a time in seconds.
fn flow_until(secs: f64) -> Vec<Measurement> {
    let measurement = serde_json::json!({ "flow_until": { "until_secs": secs } });
    vec![serde_json::from_value(measurement).unwrap()]
}

#[test]
fn a_flow_until_a_time_has_a_value_at_any_time_step() {
    for time_step in [0.02, 0.0169, 0.03, 0.007] {
        let mut scene = alone(Integrator::SemiImplicit, time_step).scene().clone();
        scene.agents = vec![person(Vector::zeros(), vector(1.0, 0.0))];
        scene.groups[0].removal_radius = Some(0.5);
        scene.groups[0].counted = true;
        let mut simulation = Simulation::new(scene).unwrap();
        let metrics = Metrics::new(&flow_until(2.0), &mut simulation);
        let due = simulation.frame().clock.frame_at(2.0);
        run(&mut simulation, due - 1);
        assert_eq!(metrics.results(&simulation)[0].value, None);
        run(&mut simulation, 1);
        let flow = metrics.results(&simulation)[0].value.unwrap();
        assert!((flow - 0.5).abs() < 0.01, "{time_step} s: {flow}");
        // A time shorter than half a step is due in the first frame.
        let metrics = Metrics::new(&flow_until(1e-3), &mut simulation);
        assert_eq!(metrics.results(&simulation)[0].value, Some(0.0));
    }
}

#[test]
fn a_frame_that_has_not_been_evaluated_has_no_fields() {
    let mut simulation = alone(Integrator::SemiImplicit, 0.02);
    assert!(simulation.frame().fields.acceleration.is_empty());
    let accelerations = simulation.evaluate().unwrap().fields.acceleration.len();
    assert_eq!(accelerations, 1);
    simulation.integrate().unwrap();
    let frame = simulation.frame();
    assert!(frame.fields.acceleration.is_empty() && frame.fields.density.is_empty());
    assert_eq!(frame.agents.len(), 1);
}

#[test]
fn the_moving_average_forgets_at_the_rate_of_its_averaging_time() {
    let sph = SphParameters::default();
    let after = (0..5).fold(0.0, |mean, _| sph.averaged(mean, 1.0, 0.02));
    assert!((after - (1.0 - 0.8_f64.powi(5))).abs() < 1e-15);
    assert_eq!(sph.averaged(7.0, 3.0, 0.5), 3.0);
}

#[test]
fn the_rest_density_is_clamped_and_the_pressure_changes_sign_there() {
    let sph = SphParameters::default();
    assert_eq!(sph.rest_density(7.0), 5.0);
    assert_eq!(sph.rest_density(-1.0), 0.0);
    assert_eq!(sph.pressure(4.0, 5.0), -200.0);
    assert_eq!(sph.pressure(5.5, 5.0), 100.0);
}
