//! Which pairs social forces with a tolerance leave out.

use crate::common;
use crate::common::social::{force, weight};
use crate::common::{blend_with, scene, vector, walker};
use rand::Rng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::forces::social::SocialForce;
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Term;
use sandbox::engine::random::{Purpose, stream};
use sandbox::scenario::catalog::Parameters;

const TOLERANCE: f64 = 1e-3;

fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut rng = stream(seed, Purpose::Placement, 0, 0);
    move || rng.random_range(-1.0..1.0)
}

/// Social forces with the tolerance.
fn tolerant() -> Parameters {
    Parameters::of([("avoidance_tolerance", TOLERANCE)]).unwrap()
}

/// The acceleration of each agent by social forces with these parameters, as computed by the engine.
fn accelerations(
    agents: &[NewAgent],
    parameters: &Parameters,
    precision: Precision,
) -> Vec<Vector> {
    let mut scene = scene(vec![], blend_with("sf", parameters));
    scene.precision = precision;
    scene.agents = agents.to_vec();
    let simulation = common::evaluated(scene);
    let ids = 0..agents.len() as u32;
    let breakdowns = ids.map(|id| common::breakdown(&simulation, id));
    let terms = breakdowns.map(|breakdown| breakdown.profiles[0].accelerations.clone());
    terms
        .map(|terms| terms.get(Term::SocialAgents).unwrap())
        .collect()
}

#[test]
fn pairs_that_are_left_out_have_forces_below_the_tolerance() {
    let social = SocialForce::default();
    for (precision, error) in [(Precision::Double, 1e-9), (Precision::Mixed, 1e-3)] {
        let (mut left_out, mut small) = (0, 0);
        let mut next = random(8);
        for k in 0..3000 {
            // Every third pair is fast, so that |r_ij + T v_ij| is much longer than |r_ij|.
            let speed = if k % 3 == 0 { 8.0 } else { 1.5 };
            let r = vector(next(), next()) * 4.0;
            let [v_i, v_j] = [(); 2].map(|()| vector(next(), next()) * speed);
            let goal = vector(9.0, 0.0);
            let agents = [walker(r, v_i, goal), walker(vector(0.0, 0.0), v_j, goal)];
            let found = accelerations(&agents, &tolerant(), precision)[0];
            let exact = force(&social, r, v_i - v_j);
            if r.norm() > social.avoidance_radius {
                assert_eq!(found, Vector::zeros());
                continue;
            }
            small += u32::from(exact.norm() < 0.1 * TOLERANCE);
            if found == Vector::zeros() {
                left_out += 1;
                assert!(exact.norm() <= TOLERANCE, "{precision:?} {r} {v_i} {v_j}");
            } else {
                let difference = (found - exact * weight(v_i, r)).norm();
                assert!(difference <= error * (1.0 + exact.norm()), "{difference:e}");
            }
        }
        assert!(left_out > 1000 && f64::from(left_out) > 0.8 * f64::from(small));
    }
}

/// Agents that look one minute ahead: squares of |r_ij + T v_ij| are beyond single precision.
#[test]
fn far_anticipation_leaves_out_no_pair_above_the_tolerance() {
    for avoidance_radius in [5.0, 50.0] {
        let parameters = Parameters::of([
            ("anticipation_time", 60.0),
            ("avoidance_radius", avoidance_radius),
        ])
        .unwrap()
        .or(&tolerant());
        let social = SocialForce {
            anticipation_time: 60.0,
            avoidance_radius,
            ..SocialForce::default()
        };
        let mut next = random(10);
        let mut strong = 0;
        for _ in 0..2000 {
            let r = vector(next(), next()) * (0.7 * avoidance_radius);
            // Toward each other, nearly: such pairs act over the longest distances.
            let turn = vector(-r.y, r.x) * (0.1 * next());
            let v = -(r + turn).normalize() * (1.5 + next());
            let goal = vector(9.0, 0.0);
            let agents = [
                walker(r, v * 0.5, goal),
                walker(vector(0.0, 0.0), -v * 0.5, goal),
            ];
            let exact = force(&social, r, v).norm();
            let found = accelerations(&agents, &parameters, Precision::Mixed)[0];
            strong += u32::from(exact > TOLERANCE);
            assert!(
                found != Vector::zeros() || exact <= TOLERANCE,
                "{r} {v} {exact}"
            );
        }
        assert!(strong > 1000, "{strong}");
    }
}

#[test]
fn which_pairs_are_left_out_depends_on_no_other_agents() {
    let mut next = random(9);
    let crowd: Vec<NewAgent> = (0..200)
        .map(|_| {
            let place = vector(next(), next()) * 5.0;
            walker(place, vector(next(), next()) * 1.5, vector(9.0, 0.0))
        })
        .collect();
    for precision in [Precision::Double, Precision::Mixed] {
        let together = accelerations(&crowd, &tolerant(), precision);
        for i in (0..crowd.len()).step_by(40) {
            let others = (0..crowd.len()).filter(|&j| j != i);
            let pairs = others.map(|j| [crowd[i], crowd[j]]);
            let alone: Vec<Vector> = pairs
                .map(|pair| accelerations(&pair, &tolerant(), precision)[0])
                .collect();
            let sum: Vector = alone.iter().sum();
            let size: f64 = alone.iter().map(|pair| pair.norm()).sum();
            let rounding = match precision {
                Precision::Double => 1e-12,
                Precision::Mixed => 1e-5,
            };
            let difference = (together[i] - sum).norm();
            assert!(difference <= rounding * size, "{difference:e} of {size:e}");
        }
    }
}
