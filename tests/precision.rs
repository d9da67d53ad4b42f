//! Mixed precision compared with double precision, in the same states.

use crate::common;
use crate::common::{blend_with, room, scene, vector};
use proptest::prelude::*;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::kernel;
use sandbox::engine::math::{Vector, direction};
use sandbox::engine::pairs::{Precision, Real};
use sandbox::engine::profile::Term;
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::Parameters;

/// The largest allowed error of an acceleration, relative to the sum of the magnitudes of its terms.
const BOUND: f64 = 1e-5;

/// 300 people at random in a square with its lower left corner at `corner` and a side of 8 m × `stretch`. Some are
/// a millimeter apart. The square has walls only at the origin and without stretching.
fn crowd(corner: Vector, stretch: f64, seed: u64) -> Scene {
    let parameters = Parameters::of([("viscosity", 5.0)]).unwrap();
    let mut scene = scene(vec![room(8.0, 1.0)], blend_with("sph", &parameters));
    if corner != Vector::zeros() || stretch != 1.0 {
        scene.walls = Scene::default().walls;
    }
    scene.seed = seed;
    let mut runner =
        sandbox::engine::random::stream(seed, sandbox::engine::random::Purpose::Placement, 0, 0);
    let mut next = || rand::Rng::random_range(&mut runner, 0.0..1.0_f64);
    for k in 0..300 {
        let place = corner + vector(8.0 * next(), 8.0 * next()) * stretch;
        let near = scene.agents.last().filter(|_| k % 10 == 9);
        let position = near.map_or(place, |other: &NewAgent| {
            other.position + vector(0.5 + next(), 0.5 + next()) * 1e-3
        });
        scene.agents.push(NewAgent {
            velocity: vector(next() - 0.5, next() - 0.5) * 3.0,
            mean_density: Some(8.0 * next()),
            ..NewAgent::at(position, corner + vector(9.0, 4.0), 0)
        });
    }
    scene
}

fn evaluated(mut scene: Scene, precision: Precision) -> Simulation {
    scene.precision = precision;
    common::evaluated(scene)
}

/// Σ_j |a_ij| over all forces between agents, pair by pair, plus the magnitudes of the goal and wall terms.
fn magnitude(simulation: &Simulation, i: usize) -> f64 {
    let frame = simulation.frame();
    let (agents, fields) = (frame.agents, frame.fields);
    let volume = |j: usize| agents.mass[j] / fields.density[j];
    let pairs = frame.near(i, 1.0).map(|(j, r_ij)| {
        let p = 0.5 * (fields.pressure[i].abs() + fields.pressure[j].abs());
        let pressure = volume(j) * p * kernel::pressure_gradient(r_ij, 1.0).norm();
        let dv = (agents.velocity[j] - agents.velocity[i]).norm();
        let viscosity = 5.0 * volume(j) * dv * kernel::viscosity_laplacian(r_ij.norm(), 1.0);
        let overlap = (agents.radius[i] + agents.radius[j] - r_ij.norm()).max(0.0);
        let contact = (direction(r_ij) * overlap).norm() * 50.0 / agents.mass[i];
        (pressure + viscosity) / fields.density[i] + contact
    });
    let share = common::breakdown(simulation, agents.id[i]).profiles[0]
        .accelerations
        .clone();
    let others = [
        share.get(Term::Goal),
        share.get(Term::PressureWalls),
        share.get(Term::ContactWalls),
    ];
    let others = others.map(|term| term.map_or(0.0, |term| term.norm()));
    pairs.sum::<f64>() + others.iter().sum::<f64>()
}

fn largest_error(scene: &Scene) -> f64 {
    let double = evaluated(scene.clone(), Precision::Double);
    let mixed = evaluated(scene.clone(), Precision::Mixed);
    assert_eq!(double.frame().agents.id, mixed.frame().agents.id);
    let error = |i: usize| {
        let acceleration = |s: &Simulation| s.frame().fields.acceleration[i];
        let difference = (acceleration(&double) - acceleration(&mixed)).norm();
        difference / magnitude(&double, i)
    };
    (0..double.frame().agents.len())
        .map(error)
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn mixed_precision_stays_within_its_bound(seed in 0_u64..1_000_000) {
        let error = largest_error(&crowd(Vector::zeros(), 1.0, seed));
        prop_assert!(error < BOUND, "{error:e}");
    }

    #[test]
    fn the_bound_holds_far_from_the_origin_and_for_sparse_crowds(
        x in -1e6..1e6_f64,
        y in -1e6..1e6_f64,
        stretch in 0.3..1000.0_f64,
    ) {
        let error = largest_error(&crowd(vector(x, y), stretch, 1));
        prop_assert!(error < BOUND, "{error:e} at ({x}, {y})");
    }
}

proptest! {
    #[test]
    fn coordinates_of_many_points_are_those_of_each(
        points in prop::collection::vec(prop::array::uniform2(-1.0..1.0_f64), 1..40),
        exponent in -3.0..12.0_f64,
        extent in 1.0..100.0_f64,
    ) {
        // Beyond some 10⁶ m, coordinates leave the range of the fast conversion.
        let points: Vec<_> = points.iter().map(|&[x, y]| vector(x, y) * exponent.exp2().powi(3)).collect();
        let per_meter = f64::from(1_u32 << 31) / extent;
        let (mut x, mut y) = (vec![0; points.len()], vec![0; points.len()]);
        f32::coordinates(&points, per_meter, [&mut x, &mut y]);
        let each = |number: fn(&Vector) -> f64| {
            let numbers = points.iter().map(number);
            numbers.map(|meters| f32::coordinate(meters, per_meter)).collect::<Vec<i32>>()
        };
        prop_assert_eq!(x, each(|p| p.x));
        prop_assert_eq!(y, each(|p| p.y));
    }
}

#[test]
fn mixed_precision_differs_from_double() {
    let error = largest_error(&crowd(Vector::zeros(), 1.0, 3));
    assert!(error > 1e-9, "{error:e}");
}
