//! Social forces between agents (Eq. 18): sums over crowds compared with the equation, pair by pair.

use crate::common;
use crate::common::social::{condition, force, potential, weight};
use crate::common::{blend, blend_with, rectangle, scene, vector, walker};
use proptest::prelude::*;
use rand::Rng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::forces::social::SocialForce;
use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::profile::Term;
use sandbox::engine::random::{Purpose, stream};
use sandbox::engine::scene::{Group, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::Parameters;

/// The largest allowed error of a sum of social forces in mixed precision, relative to the sum of their magnitudes.
const BOUND: f64 = 1e-5;

fn random(seed: u64) -> impl FnMut() -> f64 {
    let mut rng = stream(seed, Purpose::Placement, 0, 0);
    move || rng.random_range(-1.0..1.0)
}

/// Eq. 18 for agent `i` of an evaluated frame, pair by pair: accelerations and their rounding errors.
fn pair_forces(simulation: &Simulation, i: usize) -> Vec<(Vector, f64)> {
    pair_forces_with(&SocialForce::default(), simulation, i)
}

/// The same with other parameters.
fn pair_forces_with(social: &SocialForce, simulation: &Simulation, i: usize) -> Vec<(Vector, f64)> {
    let agents = simulation.frame().agents;
    // Coordinates in mixed precision are rounded down to this unit, which turns the direction between close agents.
    let unit = match simulation.scene().precision {
        Precision::Mixed => simulation.frame().neighbors.extent() / f64::from(1_u32 << 31),
        Precision::Double => 0.0,
    };
    let others = (0..agents.len()).filter(|&j| j != i);
    let pairs = others.filter_map(|j| {
        let r_ij = agents.position[i] - agents.position[j];
        let v_ij = agents.velocity[i] - agents.velocity[j];
        let near = r_ij.norm() < social.avoidance_radius;
        let share = weight(agents.velocity[i], r_ij) / agents.mass[i];
        near.then(|| {
            let force = force(social, r_ij, v_ij) * share;
            let rounding = 2.0_f64.sqrt() * unit / r_ij.norm();
            let noise = 4.0 * f64::EPSILON * condition(social, r_ij, v_ij) + rounding;
            // The bound does not hold for agents that come within 5 cm of the other's place, where the relative
            // error of |r_ij + T v_ij| is about 10⁻⁵.
            let ahead = r_ij + v_ij * social.anticipation_time;
            let noise = if ahead.norm() < 0.05 { 1.0 } else { noise };
            (force, force.norm() * noise)
        })
    });
    pairs.collect()
}

/// The sum as computed by the engine.
fn engine_sum(simulation: &Simulation, i: usize) -> Vector {
    let frame = simulation.frame();
    let breakdown = common::breakdown(simulation, frame.agents.id[i]);
    let terms = breakdown.profiles[0].accelerations.clone();
    terms.get(Term::SocialAgents).unwrap()
}

/// 300 people at random in a square of `side` meters centered at `corner`, at up to 1.7 m/s.
fn crowd(corner: Vector, side: f64, seed: u64, parameters: &Parameters) -> Scene {
    let mut scene = scene(vec![], blend_with("sf", parameters));
    let mut next = random(seed);
    for _ in 0..300 {
        let position = corner + vector(next(), next()) * (0.5 * side);
        let velocity = vector(next(), next()) * 1.2;
        scene.agents.push(NewAgent {
            velocity,
            ..NewAgent::at(position, corner, 0)
        });
    }
    scene
}

/// The largest error of any agent, relative to the sum of the magnitudes of its pairs.
fn largest_error(scene: Scene) -> f64 {
    let simulation = common::evaluated(scene);
    let error = |i: usize| {
        let pairs = pair_forces(&simulation, i);
        let magnitude: f64 = pairs.iter().map(|(pair, _)| pair.norm()).sum();
        let noise: f64 = pairs.iter().map(|(_, noise)| noise).sum();
        let sum: Vector = pairs.iter().map(|(pair, _)| pair).sum();
        let difference = (engine_sum(&simulation, i) - sum).norm() - noise;
        if difference > 0.0 {
            difference / magnitude
        } else {
            0.0
        }
    };
    (0..simulation.frame().agents.len())
        .map(error)
        .fold(0.0, f64::max)
}

#[test]
fn the_force_is_the_gradient_of_its_potential() {
    let social = SocialForce::default();
    let step = 1e-6;
    for k in 0..200 {
        let angle = f64::from(k) * 0.7;
        let r_ij = vector(angle.cos(), angle.sin()) * (0.3 + 0.02 * f64::from(k % 50));
        let v_ij = vector((1.3 * angle).sin(), (0.4 * angle).cos()) * 1.5;
        let slope = |along: Vector| {
            (potential(&social, r_ij + along * step, v_ij)
                - potential(&social, r_ij - along * step, v_ij))
                / (2.0 * step)
        };
        let expected = -Vector::new(slope(Vector::x()), slope(Vector::y()));
        let force = force(&social, r_ij, v_ij);
        assert!((force - expected).norm() < 1e-7 * (1.0 + expected.norm()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn sums_over_crowds_agree_with_the_equation(
        seed in 0_u64..1_000_000,
        side in 3.0..60.0_f64,
        x in -1e4..1e4_f64,
    ) {
        let error = largest_error(crowd(vector(x, -x), side, seed, &Parameters::default()));
        prop_assert!(error < 1e-10, "{error:e}");
    }

    #[test]
    fn mixed_precision_stays_within_its_bound(
        seed in 0_u64..1_000_000,
        magnitude in 0.7..3.5_f64,
        x in -1e6..1e6_f64,
    ) {
        let side = 10_f64.powf(magnitude);
        let mut scene = crowd(vector(x, -x), side, seed, &Parameters::default());
        scene.precision = Precision::Mixed;
        let error = largest_error(scene);
        prop_assert!(error < BOUND, "{error:e}");
    }

    #[test]
    fn only_forces_below_the_tolerance_are_left_out(
        seed in 0_u64..1_000_000,
        side in 10.0..30.0_f64,
        slowness in 1.0..50.0_f64,
    ) {
        let tolerance = 1e-3;
        let parameters = Parameters::of([("avoidance_tolerance", tolerance)]).unwrap();
        let mut scene = crowd(vector(0.0, 0.0), side, seed, &parameters);
        for agent in &mut scene.agents {
            agent.velocity /= slowness;
        }
        let simulation = common::evaluated(scene);
        for i in 0..300 {
            let mass = simulation.frame().agents.mass[i];
            let pairs = pair_forces(&simulation, i);
            let sum: Vector = pairs.iter().map(|(pair, _)| pair).sum();
            let noise: f64 = pairs.iter().map(|(_, noise)| noise).sum();
            let sizes = pairs.iter().map(|(pair, _)| pair.norm());
            let small: f64 = sizes.filter(|a| a * mass < tolerance).sum();
            let allowed = small + noise + 1e-12 * sum.norm();
            let left_out = (engine_sum(&simulation, i) - sum).norm();
            prop_assert!(left_out <= allowed, "{left_out:e} of {allowed:e}");
        }
    }
}

#[test]
fn long_anticipation_times_agree_with_the_equation() {
    for anticipation_time in [20.0, 100.0, 1000.0] {
        let parameters = Parameters::of([("anticipation_time", anticipation_time)]).unwrap();
        let social = SocialForce {
            anticipation_time,
            ..SocialForce::default()
        };
        for precision in [Precision::Double, Precision::Mixed] {
            let mut scene = crowd(vector(0.0, 0.0), 10.0, 4, &parameters);
            scene.precision = precision;
            let simulation = common::evaluated(scene);
            for i in 0..300 {
                let pairs = pair_forces_with(&social, &simulation, i);
                let sum: Vector = pairs.iter().map(|(pair, _)| pair).sum();
                let magnitude: f64 = pairs.iter().map(|(pair, _)| pair.norm()).sum();
                let noise: f64 = pairs.iter().map(|(_, noise)| noise).sum();
                let error = (engine_sum(&simulation, i) - sum).norm();
                assert!(
                    error <= 1e-4 * magnitude + noise,
                    "{error:e} of {magnitude:e}"
                );
            }
        }
    }
}

#[test]
fn a_tolerance_omits_forces_and_mixed_precision_differs_from_double() {
    let still = |tolerance| {
        let parameters = Parameters::of([("avoidance_tolerance", tolerance)]).unwrap();
        let mut scene = crowd(vector(0.0, 0.0), 15.0, 3, &parameters);
        for agent in &mut scene.agents {
            agent.velocity = Vector::zeros();
        }
        largest_error(scene)
    };
    assert!(still(0.0) < 1e-12);
    assert!(still(1e-3) > 1e-7);
    let mut scene = crowd(vector(0.0, 0.0), 15.0, 3, &Parameters::default());
    scene.precision = Precision::Mixed;
    assert!(largest_error(scene) > 1e-9);
}

#[test]
fn an_exact_head_on_course_gives_no_force_and_a_nearly_exact_one_gives_the_limit() {
    let pair = |aside: f64| {
        let mut scene = scene(vec![], blend("sf"));
        scene.agents = vec![
            walker(vector(0.0, 0.0), vector(1.0, 0.0), vector(9.0, 0.0)),
            walker(vector(2.0, aside), vector(-1.0, 0.0), vector(-9.0, 0.0)),
        ];
        engine_sum(&common::evaluated(scene), 0)
    };
    // r_ij and r_ij + s are opposite: b = 0, where the potential has an edge and no gradient.
    assert_eq!(pair(0.0), Vector::zeros());
    // Next to the edge, |d| = |a| = 2: the force is V₀/σ (2 + 2)/(2 · 2), sideways.
    for aside in [1e-9, 1e-6] {
        let [left, right] = [pair(aside), pair(-aside)];
        assert!((left - vector(0.0, -7.0)).norm() < 1e-4, "{left}");
        assert!((left + right).norm() < 1e-4);
    }
}

#[test]
fn coincident_agents_exert_no_force() {
    for velocity in [vector(0.0, 0.0), vector(1.0, 0.0)] {
        let mut scene = scene(vec![], blend("sf"));
        scene.agents = vec![
            walker(vector(0.0, 0.0), vector(0.0, 0.0), vector(9.0, 0.0)),
            walker(vector(0.0, 0.0), velocity, vector(9.0, 0.0)),
        ];
        assert_eq!(engine_sum(&common::evaluated(scene), 0), Vector::zeros());
    }
}

#[test]
fn each_group_uses_its_own_parameters() {
    let strong = Parameters::of([("agent_strength", 4.2)]).unwrap();
    let mut scene = scene(vec![], blend("sf"));
    let group = scene.add_group(Group::new("strong", blend_with("sf", &strong)));
    scene.agents = vec![
        walker(vector(0.0, 0.0), vector(0.0, 0.0), vector(9.0, 0.0)),
        NewAgent {
            group,
            ..walker(vector(1.0, 0.0), vector(0.0, 0.0), vector(9.0, 0.0))
        },
    ];
    let simulation = common::evaluated(scene);
    let agents = simulation.frame().agents;
    let [plain, strong] = [0, 1].map(|id| engine_sum(&simulation, agents.index_of(id).unwrap()));
    assert!(plain.norm() > 0.1 && (strong + plain * 2.0).norm() < 1e-12);
}

#[test]
fn the_wall_force_is_the_gradient_of_its_potential() {
    let social = SocialForce::default();
    let potential = |d: f64| social.wall_strength * (-d / social.wall_range).exp();
    for d in [0.05, 0.24, 1.0] {
        let slope = (potential(d + 1e-6) - potential(d - 1e-6)) / 2e-6;
        let force = social.wall_force(Vector::new(0.0, d));
        assert!((force - Vector::new(0.0, -slope)).norm() < 1e-7);
    }
}

/// Eq. 19 for a straight wall below an agent that walks at an angle to the direction of the wall, in degrees.
fn wall_weight(degrees: f64, speed: f64) -> f64 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let social = SocialForce::default();
    let wall = rectangle([-9.0, 9.0], [-1.0, 0.0]);
    let mut scene = scene(vec![wall], blend("sf"));
    let velocity = vector(sine, -cosine) * speed;
    scene.agents = vec![walker(vector(0.0, 1.0), velocity, vector(9.0, 9.0))];
    let simulation = common::evaluated(scene);
    let found = social.from_walls(&simulation.frame(), 0);
    found.norm() / social.wall_force(vector(0.0, 1.0)).norm()
}

#[test]
fn what_lies_behind_counts_half_and_a_standing_agent_sees_all_round() {
    for (degrees, speed, weight) in [
        (99.9, 1.0, 1.0),
        (-99.9, 0.3, 1.0),
        (100.1, 1.0, 0.5),
        (180.0, 0.0, 1.0),
    ] {
        assert!((wall_weight(degrees, speed) - weight).abs() < 1e-12);
    }
}

#[test]
fn the_bound_of_mixed_precision_includes_the_rounding_of_close_agents() {
    // Two of these agents are 0.11 mm apart.
    let x = 795_004.170_186_147_7;
    let side = 10_f64.powf(1.054_399_549_870_986_8);
    let mut scene = crowd(vector(x, -x), side, 617_826, &Parameters::default());
    scene.precision = Precision::Mixed;
    let error = largest_error(scene);
    assert!(error < BOUND, "{error:e}");
}
