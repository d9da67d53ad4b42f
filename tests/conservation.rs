//! Conservation laws of the forces between agents: momentum, angular momentum for central forces, and energy for
//! forces with a potential.

use crate::common::{blend_with, block, rectangle, run, scene, vector};
use sandbox::engine::agents::{Agents, NewAgent};
use sandbox::engine::clock::Clock;
use sandbox::engine::math::Vector;
use sandbox::engine::period::{Axis, Period};
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::Parameters;

/// A crowd without goal forces. The rest density is below the density of a lone agent, so that every pressure is
/// positive.
fn free(parameters: Parameters) -> Scene {
    let parameters = Parameters::of([
        ("goal_scale", 0.0),
        ("rest_density_min", 1.0),
        ("rest_density_max", 1.0),
    ])
    .unwrap()
    .or(&parameters);
    let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
    scene.max_speed = 100.0;
    scene.agents = moving(block(Vector::zeros(), 8, 8, 0.42, Vector::zeros()));
    scene
}

/// The same agents, each with another direction of motion.
fn moving(agents: Vec<NewAgent>) -> Vec<NewAgent> {
    let numbered = agents.into_iter().zip(0_u32..);
    numbered
        .map(|(agent, id)| {
            let angle = 2.399_963 * f64::from(id);
            NewAgent {
                velocity: vector(0.1 + angle.cos(), angle.sin()) * 0.5,
                ..agent
            }
        })
        .collect()
}

fn momentum(agents: &Agents) -> Vector {
    let parts = agents.mass.iter().zip(&agents.velocity);
    parts.map(|(&mass, v)| v * mass).sum()
}

fn angular_momentum(agents: &Agents) -> f64 {
    let bodies = agents.mass.iter().zip(&agents.position);
    let parts = bodies.zip(&agents.velocity);
    parts.map(|((mass, r), v)| mass * r.perp(v)).sum()
}

/// The value of `of` before and after `frames` frames with `integrator`.
fn before_and_after<T>(
    scene: &Scene,
    integrator: Integrator,
    frames: u64,
    of: impl Fn(&Agents) -> T,
) -> [T; 2] {
    let scene = Scene {
        integrator,
        ..scene.clone()
    };
    let mut simulation = Simulation::new(scene).unwrap();
    let before = of(simulation.frame().agents);
    run(&mut simulation, frames);
    [before, of(simulation.frame().agents)]
}

/// The same crowd, as wide as a period: its agents press on each other across the ends.
fn ring(parameters: Parameters) -> Scene {
    Scene {
        period: Some(Period {
            axis: Axis::X,
            from: -0.1,
            length: 8.0 * 0.42,
        }),
        ..free(parameters)
    }
}

#[test]
fn every_integrator_conserves_the_momentum_of_a_free_crowd() {
    for (k, mu, contact) in [
        (200.0, 0.0, 0.0),
        (0.0, 5.0, 0.0),
        (0.0, 0.0, 1000.0),
        (200.0, 5.0, 50.0),
    ] {
        let parameters = Parameters::of([
            ("gas_constant", k),
            ("viscosity", mu),
            ("agent_stiffness", contact),
        ])
        .unwrap();
        for scene in [free(parameters.clone()), ring(parameters)] {
            for integrator in Integrator::ALL {
                let [before, after] = before_and_after(&scene, integrator, 100, momentum);
                let change = (after - before).norm();
                assert!(before.norm() > 3.0, "{before:?}");
                // Rounding errors of 64 agents in 100 frames.
                assert!(
                    change < 1e-11,
                    "{integrator:?} {k} {mu} {contact}: {change}"
                );
            }
        }
    }
}

#[test]
fn semi_implicit_steps_conserve_angular_momentum_under_central_forces() {
    let crowd = |k, mu| {
        free(
            Parameters::of([
                ("gas_constant", k),
                ("viscosity", mu),
                ("agent_stiffness", 1000.0),
            ])
            .unwrap(),
        )
    };
    let change = |scene: &Scene, integrator| {
        let [before, after] = before_and_after(scene, integrator, 100, angular_momentum);
        (after - before).abs()
    };
    let central = crowd(200.0, 0.0);
    assert!(change(&central, Integrator::SemiImplicit) < 1e-10);
    assert!(change(&central, Integrator::ForwardEuler) > 0.1);
    // Viscosity acts along the velocity difference: it is not a central force.
    assert!(change(&crowd(200.0, 5.0), Integrator::SemiImplicit) > 0.1);
}

/// Soft discs in a closed room, which overlap slightly at the start.
fn billiard(time_step: f64) -> Scene {
    let parameters = Parameters::of([
        ("goal_scale", 0.0),
        ("gas_constant", 0.0),
        ("agent_stiffness", 200.0),
        ("wall_stiffness", 200.0),
    ])
    .unwrap();
    let (low, high) = (-1.0, 4.1);
    let walls = vec![
        rectangle([low, 0.0], [low, high]),
        rectangle([3.1, high], [low, high]),
        rectangle([0.0, 3.1], [low, 0.0]),
        rectangle([0.0, 3.1], [3.1, high]),
    ];
    let mut scene = scene(walls, blend_with("sph", &parameters));
    scene.max_speed = 100.0;
    scene.clock = Clock::new(time_step, Clock::nearest_coarse_every(time_step));
    scene.agents = moving(block(vector(0.2, 0.2), 7, 7, 0.45, Vector::zeros()));
    scene
}

/// The kinetic energy plus K/2 times the square of each overlap.
fn energy(simulation: &Simulation) -> f64 {
    let frame = simulation.frame();
    let agents = frame.agents;
    let overlap = |touching: f64, distance: f64| 100.0 * (touching - distance).max(0.0).powi(2);
    let mut energy = 0.0;
    for i in 0..agents.len() {
        let (r, radius) = (agents.position[i], agents.radius[i]);
        energy += 0.5 * agents.mass[i] * agents.velocity[i].norm_squared();
        for j in 0..i {
            energy += overlap(radius + agents.radius[j], (r - agents.position[j]).norm());
        }
        for wall in frame.walls.iter() {
            energy += overlap(radius, (r - wall.nearest_point(r).point).norm());
        }
    }
    energy
}

/// The relative difference between the mean energy in the last of 20 seconds and the initial energy.
fn drift(integrator: Integrator, time_step: f64) -> f64 {
    let scene = Scene {
        integrator,
        ..billiard(time_step)
    };
    let mut simulation = Simulation::new(scene).unwrap();
    let frames = |seconds: f64| (seconds / time_step).round() as u64;
    let start = energy(&simulation);
    run(&mut simulation, frames(19.0));
    let mut sum = 0.0;
    for _ in 0..frames(1.0) {
        simulation.step().unwrap();
        sum += energy(&simulation);
    }
    sum / frames(1.0) as f64 / start - 1.0
}

#[test]
fn only_symplectic_integrators_conserve_the_energy_of_contacts() {
    let [semi_implicit, forward, verlet, midpoint] =
        Integrator::ALL.map(|integrator| drift(integrator, 0.01));
    for symplectic in [semi_implicit, verlet] {
        assert!(symplectic.abs() < 0.03, "{symplectic}");
    }
    assert!(forward > 10.0, "{forward}");
    // The midpoint method amplifies oscillations by (ω Δt)⁴/8 per step: half the step gives an eighth of the drift.
    let halved = drift(Integrator::Midpoint, 0.005);
    assert!(
        midpoint > 0.1 && (4.0..16.0).contains(&(midpoint / halved)),
        "{midpoint} {halved}"
    );
}
