//! The linear theory of sound compared with the engine: a patch of a hexagonal lattice is displaced by a small
//! plane wave, which accelerates the agent in its middle.

use crate::common::{acceleration, blend_with, evaluated, person, scene, vector};
use sandbox::analysis::sound::{self, Lattice};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::density::SphParameters;
use sandbox::engine::scene::Region;
use sandbox::scenario::catalog::Parameters;

/// The radius of the patch, meters. It includes the neighbors of the middle agent and their neighbors.
const PATCH: f64 = 2.6;

fn lattice(spacing: f64, gas_constant: f64, agent_stiffness: f64) -> Lattice {
    Lattice {
        spacing,
        reach: 0.48,
        sph: SphParameters {
            gas_constant,
            ..SphParameters::default()
        },
        agent_stiffness,
    }
}

/// The patch, with its middle agent first, displaced by `amplitude` · cos(q x) along x; ρ⁰ has its maximum value.
fn displaced(lattice: &Lattice, q: f64, amplitude: f64) -> Vec<NewAgent> {
    let rows = (PATCH / lattice.spacing).ceil() as i32 + 1;
    let cells = (-rows..=rows).flat_map(|row| (-2 * rows..=2 * rows).map(move |c| (row, c)));
    let place = |(row, column): (i32, i32)| {
        let x = f64::from(column) + 0.5 * f64::from(row.rem_euclid(2));
        vector(x, 0.75_f64.sqrt() * f64::from(row)) * lattice.spacing
    };
    let mut places: Vec<_> = cells.map(place).filter(|r| r.norm() < PATCH).collect();
    places.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let moved = places
        .into_iter()
        .map(|r| r + vector(amplitude * (q * r.x).cos(), 0.0));
    moved
        .map(|r| NewAgent {
            mean_density: Some(100.0),
            ..person(r, r)
        })
        .collect()
}

/// ω² from the engine: −∂a/∂u of the middle agent.
fn frequency_squared(lattice: &Lattice, q: f64) -> f64 {
    let parameters = Parameters {
        gas_constant: Some(lattice.sph.gas_constant),
        agent_stiffness: Some(lattice.agent_stiffness),
        ..Parameters::default()
    };
    let at = |amplitude: f64| {
        let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
        scene.agents = displaced(lattice, q, amplitude);
        acceleration(&evaluated(scene), 0).x
    };
    let step = 1e-6;
    -(at(step) - at(-step)) / (2.0 * step)
}

#[test]
fn the_lattice_sums_agree_with_the_linearized_engine() {
    for (gas_constant, agent_stiffness) in [(50.0, 0.0), (200.0, 50.0), (800.0, 1000.0)] {
        let lattice = lattice(0.465, gas_constant, agent_stiffness);
        for q in [0.3, 1.0, 3.0] {
            let (theory, engine) = (lattice.frequency_squared(q), frequency_squared(&lattice, q));
            assert!(
                (engine / theory - 1.0).abs() < 1e-4,
                "k = {gas_constant}, q = {q}: {engine} for {theory}"
            );
        }
    }
}

#[test]
fn long_waves_have_the_theoretical_speed_with_and_without_contacts() {
    let (apart, touching) = (lattice(0.465, 200.0, 0.0), lattice(0.465, 200.0, 50.0));
    let q = 0.3;
    let engine = frequency_squared(&apart, q).sqrt() / q;
    assert!(
        (engine / sound::speed_of_fluid(200.0) - 1.0).abs() < 0.05,
        "{engine}"
    );
    let engine = frequency_squared(&touching, q).sqrt() / q;
    let modulus = sound::touching_modulus(0.465);
    let theory = sound::speed_with_contacts(200.0, 50.0, modulus);
    assert!(
        (engine / theory - 1.0).abs() < 0.05,
        "{engine} for {theory}"
    );
}

#[test]
fn the_measured_modulus_of_a_lattice_agrees_with_the_theory() {
    let lattice = lattice(0.4799, 200.0, 50.0);
    let mut scene = scene(Vec::new(), blend_with("sph", &Parameters::default()));
    scene.agents = displaced(&lattice, 0.0, 0.0);
    let simulation = evaluated(scene);
    let inside = Region {
        min: vector(-1.0, -1.0),
        max: vector(1.0, 1.0),
    };
    let contacts = sound::contacts(&simulation, &inside).unwrap();
    assert_eq!(contacts.per_agent, 6.0);
    assert!((contacts.modulus / sound::touching_modulus(0.48) - 1.0).abs() < 1e-3);
}

#[test]
fn contacts_of_large_discs_count_too() {
    let mut scene = scene(Vec::new(), blend_with("sph", &Parameters::default()));
    let wide = |x: f64| NewAgent {
        radius: Some(3.0),
        ..person(vector(x, 0.0), vector(x, 0.0))
    };
    scene.agents = vec![wide(0.0), wide(5.5)];
    let simulation = evaluated(scene);
    let everywhere = Region {
        min: vector(-1.0, -1.0),
        max: vector(9.0, 1.0),
    };
    let found = sound::contacts(&simulation, &everywhere).unwrap();
    assert_eq!(found.per_agent, 1.0);
}

/// A lattice with the paper's parameters whose discs touch within `reach` meters.
fn apart(spacing: f64, reach: f64) -> Lattice {
    Lattice {
        reach,
        ..lattice(spacing, SphParameters::default().gas_constant, 50.0)
    }
}

#[test]
fn long_waves_in_a_fine_lattice_run_at_the_root_of_half_k() {
    // With many neighbors the sums approach integrals, and the base pressure cancels.
    let fine = apart(0.1, 0.0);
    assert!((fine.speed(0.01) / sound::speed_of_fluid(200.0) - 1.0).abs() < 0.003);
}

#[test]
fn at_five_per_square_meter_the_lattice_is_close_to_the_continuum() {
    let spacing = (2.0 / (5.2 * 3.0_f64.sqrt())).sqrt();
    let speed = apart(spacing, 0.0).speed(0.1);
    assert!(
        (speed / sound::speed_of_fluid(200.0) - 1.0).abs() < 0.07,
        "{speed}"
    );
}

#[test]
fn touching_discs_add_their_springs() {
    let (free, touching) = (apart(0.48, 0.0), apart(0.48, 0.48 + 1e-9));
    let q = 0.01;
    let added = (touching.frequency_squared(q) - free.frequency_squared(q)) / (q * q);
    assert!((added - 50.0 * sound::touching_modulus(0.48)).abs() < 1e-3);
}
