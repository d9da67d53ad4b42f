//! Orders of convergence: how the error of each integrator falls with the time step.

use crate::common::{blend_with, person, run, scene, vector};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::clock::Clock;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::Parameters;

/// Simulated time, seconds.
const DURATION: f64 = 0.4;
/// The largest time step, seconds.
const STEP: f64 = 0.01;

/// 36 agents with pressure, goal forces and viscosity. No force switches on or off: no agent falls below its rest
/// density, reaches the maximum speed or begins to touch another.
fn smooth(parameters: &Parameters) -> Scene {
    let mut scene = scene(Vec::new(), blend_with("sph", parameters));
    scene.max_speed = 100.0;
    let places = (0..36).map(|k| (f64::from(k % 6), f64::from(k / 6)));
    scene.agents = places
        .map(|(x, y)| {
            // The rows are wavy, because a symmetry could hide an error.
            let bend = vector((3.0 * y).sin(), (2.0 * x).cos()) * 0.05;
            NewAgent {
                velocity: vector((1.7 * y).cos(), (1.3 * x).sin()) * 0.4,
                mass: Some(1.0 + 0.03 * x),
                ..person(vector(x, y) * 0.45 + bend, vector(40.0, 9.0 * y))
            }
        })
        .collect();
    scene
}

/// Pressure and viscosity at a fixed rest density below the density of a lone agent.
fn fixed() -> Parameters {
    Parameters::of([
        ("rest_density_min", 1.0),
        ("rest_density_max", 1.0),
        ("gas_constant", 20.0),
        ("viscosity", 2.0),
        ("agent_stiffness", 0.0),
    ])
    .unwrap()
}

/// The positions of all agents after [`DURATION`], sorted by id.
fn places(mut scene: Scene, integrator: Integrator, step: f64) -> Vec<Vector> {
    scene.integrator = integrator;
    scene.clock = Clock::new(step, Clock::nearest_coarse_every(step));
    let mut simulation = Simulation::new(scene).unwrap();
    run(&mut simulation, (DURATION / step).round() as u64);
    let agents = simulation.frame().agents;
    let mut places: Vec<_> = agents.id.iter().zip(&agents.position).collect();
    places.sort_by_key(|(id, _)| **id);
    places.into_iter().map(|(_, place)| *place).collect()
}

fn distance(a: &[Vector], b: &[Vector]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).norm_squared());
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}

/// Errors at four time steps, each half as long as the one before, and the orders between them. The reference is
/// the midpoint method with a time step of [`STEP`]/256.
fn orders(scene: &Scene, integrator: Integrator) -> (Vec<f64>, Vec<f64>) {
    let exact = places(scene.clone(), Integrator::Midpoint, STEP / 256.0);
    let errors: Vec<f64> = (0..4)
        .map(|halvings| {
            let step = STEP / f64::from(1 << halvings);
            distance(&places(scene.clone(), integrator, step), &exact)
        })
        .collect();
    let orders = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2());
    let orders = orders.collect();
    (errors, orders)
}

#[test]
fn on_smooth_motion_the_euler_methods_have_order_one_and_the_others_order_two() {
    let scene = smooth(&fixed());
    for integrator in Integrator::ALL {
        let expected = match integrator {
            Integrator::SemiImplicit | Integrator::ForwardEuler => 1.0,
            Integrator::VelocityVerlet | Integrator::Midpoint => 2.0,
        };
        for order in orders(&scene, integrator).1 {
            assert!((order - expected).abs() < 0.1, "{integrator:?}: {order}");
        }
    }
}

fn errors_and_orders(parameters: &Parameters, towards: Option<f64>) -> [(Vec<f64>, Vec<f64>); 4] {
    let mut scene = smooth(parameters);
    if let Some(towards) = towards {
        for agent in &mut scene.agents {
            agent.velocity = (vector(1.1, 1.1) - agent.position) * towards;
        }
    }
    Integrator::ALL.map(|integrator| orders(&scene, integrator))
}

/// The paper's rest density (§4.2), which follows the moving average.
fn dynamic() -> Parameters {
    Parameters::of([("rest_density_min", 0.0), ("rest_density_max", 50.0)])
        .unwrap()
        .or(&fixed())
}

#[test]
fn with_the_papers_moving_average_all_integrators_have_order_one_and_similar_errors() {
    // A contracting crowd is everywhere denser than its moving average, so that no pressure is switched off.
    let found = errors_and_orders(&dynamic(), Some(0.8));
    let semi_implicit = found[0].0[0];
    for (errors, orders) in found {
        assert!(orders.iter().all(|o| (o - 1.0).abs() < 0.1), "{orders:?}");
        assert!((0.5..2.0).contains(&(errors[0] / semi_implicit)));
    }
}

#[test]
fn the_pressure_switch_reduces_the_order_to_one_but_errors_stay_small() {
    let [semi_implicit, forward, verlet, midpoint] = errors_and_orders(&dynamic(), None);
    for (errors, orders) in [&verlet, &midpoint] {
        let mean = (errors[0] / errors[3]).log2() / 3.0;
        assert!((0.6..1.4).contains(&mean), "{orders:?}");
        assert!(errors[0] < 0.2 * semi_implicit.0[0], "{errors:?}");
        assert!(errors[0] < 0.4 * forward.0[0], "{errors:?}");
    }
}

#[test]
fn viscosity_alone_has_order_two_with_velocity_verlet() {
    let scene = smooth(
        &Parameters::of([("gas_constant", 0.0), ("viscosity", 10.0)])
            .unwrap()
            .or(&fixed()),
    );
    for order in orders(&scene, Integrator::VelocityVerlet).1 {
        assert!((order - 2.0).abs() < 0.1, "{order}");
    }
}
