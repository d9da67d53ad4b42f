//! The linear theory of sound compared with the engine: a patch of a hexagonal lattice is displaced by a small
//! plane wave, which accelerates the agent in its middle.

use std::f64::consts::PI;

use crate::common::{acceleration, blend_with, evaluated, person, scene, vector};
use sandbox::analysis::sound;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::density::SphParameters;
use sandbox::engine::kernel;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Region;
use sandbox::scenario::catalog::Parameters;

/// The radius of the patch, meters. It includes the neighbors of the middle agent and their neighbors.
const PATCH: f64 = 2.6;

/// A uniform crowd of agents of mass 1 on a hexagonal lattice, with rows along the x axis: the linear theory without
/// the long-wave limit, because every sum is taken over the lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lattice {
    /// Distance between nearest neighbors, meters.
    spacing: f64,
    /// D_i + D_j, meters.
    reach: f64,
    /// k, ρ⁰max and h are read.
    sph: SphParameters,
    /// K^ag, 1/s².
    agent_stiffness: f64,
}

impl Lattice {
    /// r_ij of all neighbors within h of an agent.
    fn neighbors(&self) -> Vec<Vector> {
        let h = self.sph.support_radius;
        let most = (2.0 * h / self.spacing).ceil() as i32;
        let mut found = Vec::new();
        for row in -most..=most {
            for column in -most..=most {
                let x = self.spacing * (f64::from(column) + 0.5 * f64::from(row.rem_euclid(2)));
                let y = self.spacing * 0.75_f64.sqrt() * f64::from(row);
                let r = Vector::new(x, y);
                if (row, column) != (0, 0) && r.norm() < h {
                    found.push(r);
                }
            }
        }
        found
    }

    /// The SPH density at every agent (Eq. 9), P/m².
    fn density(&self) -> f64 {
        let h = self.sph.support_radius;
        let others = self.neighbors().into_iter();
        let others = others.map(|r| kernel::density(r.norm_squared(), h));
        kernel::density(0.0, h) + others.sum::<f64>()
    }

    /// ω² in 1/s² of a longitudinal wave along the x axis with wavenumber q in 1/m. Valid if the density is above
    /// ρ⁰max.
    fn frequency_squared(&self, q: f64) -> f64 {
        let (h, k) = (self.sph.support_radius, self.sph.gas_constant);
        let density = self.density();
        let pressure = self.sph.pressure(density, self.sph.rest_density_max);
        let volume = 1.0 / density;
        let (mut compression, mut gradient, mut curvature, mut contact) = (0.0, 0.0, 0.0, 0.0);
        for r in self.neighbors() {
            let (sine, rest) = ((q * r.x).sin(), 1.0 - (q * r.x).cos());
            compression += density_gradient(r, h).x * sine;
            gradient += kernel::pressure_gradient(r, h).x * sine;
            curvature += pressure_curvature(r, h) * rest;
            if r.norm() < self.reach {
                contact += sound::stiffness(r, self.reach) * rest;
            }
        }
        let both = volume * compression * gradient / density;
        let of_density = both * (k / 2.0 - pressure / density);
        let of_kernel = pressure * volume * curvature / density;
        of_density + of_kernel + self.agent_stiffness * contact
    }

    /// ω/q in m/s.
    fn speed(&self, q: f64) -> f64 {
        self.frequency_squared(q).max(0.0).sqrt() / q
    }
}

/// ∇W of Eq. 13, 1/m³.
fn density_gradient(r: Vector, h: f64) -> Vector {
    let rest = (h * h - r.norm_squared()).max(0.0);
    r * (-24.0 / (PI * h.powi(8)) * rest * rest)
}

/// ∂/∂x of the x component of Eq. 14, 1/m⁴.
fn pressure_curvature(r: Vector, h: f64) -> f64 {
    let distance = r.norm();
    let along = (r.x / distance).powi(2);
    let slope = kernel::pressure_gradient(r, h).dot(&r) / distance;
    let bend = 60.0 / (PI * h.powi(5)) * (h - distance).max(0.0);
    bend * along + slope / distance * (1.0 - along)
}

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
    let parameters = Parameters::of([
        ("gas_constant", lattice.sph.gas_constant),
        ("agent_stiffness", lattice.agent_stiffness),
    ])
    .unwrap();
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
