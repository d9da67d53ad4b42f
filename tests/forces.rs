//! Symmetries and conservation laws of the forces, on evaluated frames.

use std::sync::Arc;

use crate::common::{
    acceleration, blend, blend_with, breakdown, evaluated, person, polygon, room, scene, vector,
    walker,
};
use proptest::prelude::*;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::forces::own::Force;
use sandbox::engine::forces::rates::{Extremes, Rates};
use sandbox::engine::frame::Frame;
use sandbox::engine::geometry::Polygon;
use sandbox::engine::math::Vector;
use sandbox::engine::profile::Term;
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{NAMES, Parameters};

/// A motion of the plane: a rotation, perhaps after a reflection, and a translation.
#[derive(Debug, Clone, Copy)]
struct Motion {
    angle: f64,
    mirrored: bool,
    shift: Vector,
}

impl Motion {
    fn turn(&self, v: Vector) -> Vector {
        let v = if self.mirrored { vector(v.x, -v.y) } else { v };
        let (sine, cosine) = self.angle.sin_cos();
        vector(cosine * v.x - sine * v.y, sine * v.x + cosine * v.y)
    }

    fn place(&self, p: Vector) -> Vector {
        self.turn(p) + self.shift
    }

    fn polygon(&self, polygon: &Polygon) -> Polygon {
        let points = polygon.points().iter().map(|&p| self.place(p));
        Polygon::new(points.collect()).unwrap()
    }

    fn agent(&self, agent: &NewAgent) -> NewAgent {
        NewAgent {
            position: self.place(agent.position),
            velocity: self.turn(agent.velocity),
            goal: self.place(agent.goal),
            ..*agent
        }
    }
}

/// A low-discrepancy sequence in [0, 1), for crowds without a pattern.
fn spread(k: u32, of: u32) -> f64 {
    (f64::from(k + 1) * [0.754_877_666_2, 0.569_840_290_9, 0.819_172_513_3][of as usize]).fract()
}

/// `count` people with different bodies and velocities in the square [0, side]².
fn crowd(count: u32, side: f64) -> Vec<NewAgent> {
    (0..count)
        .map(|k| {
            let heading = 40.0 * spread(k, 2);
            NewAgent {
                velocity: vector(heading.cos(), heading.sin()) * spread(k, 0),
                radius: Some(0.215 + 0.05 * spread(k, 2)),
                mass: Some(0.8 + 0.4 * spread(k, 1)),
                mean_density: Some(1.0 + 4.0 * spread(k, 2)),
                ..NewAgent::at(
                    vector(spread(k, 0), spread(k, 1)) * side,
                    vector(9.0, 4.0),
                    0,
                )
            }
        })
        .collect()
}

fn sum_of(simulation: &Simulation, term: Term) -> Vector {
    let ids = 0..simulation.frame().agents.len() as u32;
    ids.map(|id| breakdown(simulation, id))
        .map(|agent| agent.profiles[0].accelerations.get(term).unwrap() * agent.mass)
        .sum()
}

/// Two people whose rest densities lag behind, so that both have a positive pressure.
fn pressing_pair(distance: f64, angle: f64, masses: [f64; 2], means: [f64; 2]) -> Scene {
    let parameters = Parameters::of([("viscosity", 5.0)]).unwrap();
    let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
    let places = [Vector::zeros(), vector(angle.cos(), angle.sin()) * distance];
    scene.agents = (0..2)
        .map(|k| NewAgent {
            mass: Some(masses[k]),
            mean_density: Some(means[k]),
            velocity: vector(0.3 - k as f64, 0.7 * k as f64),
            ..person(places[k], vector(9.0, 9.0))
        })
        .collect();
    scene
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forces_between_two_agents_conserve_momentum(
        distance in 0.001..0.999_f64,
        angle in 0.0..6.3_f64,
        masses in [0.5..2.0_f64, 0.5..2.0_f64],
        means in [0.0..0.6_f64, 0.0..0.6_f64],
    ) {
        let simulation = evaluated(pressing_pair(distance, angle, masses, means));
        let [first, second] = [0, 1].map(|id| breakdown(&simulation, id));
        prop_assert!(first.pressure >= 0.0 && second.pressure >= 0.0);
        let terms = [Term::PressureAgents, Term::Viscosity, Term::ContactAgents];
        for (k, term) in terms.into_iter().enumerate() {
            let [a, b] = [&first, &second].map(|agent| {
                agent.profiles[0].accelerations.get(term).unwrap() * agent.mass
            });
            prop_assert!((a + b).norm() <= 1e-12 * (1.0 + a.norm()), "{a:?} {b:?}");
            prop_assert!(k == 1 || a.dot(&vector(angle.cos(), angle.sin())) <= 0.0, "they repel");
        }
    }

    #[test]
    fn no_term_between_agents_depends_on_a_common_velocity(x in -3.0..3.0_f64, y in -3.0..3.0_f64) {
        let at_rest = pressing_crowd(Vector::zeros());
        let moving = pressing_crowd(vector(x, y));
        for id in 0..12 {
            let [a, b] = [&at_rest, &moving].map(|s| breakdown(s, id).profiles[0].accelerations.clone());
            prop_assert_eq!(a.get(Term::PressureAgents), b.get(Term::PressureAgents));
            prop_assert_eq!(a.get(Term::ContactAgents), b.get(Term::ContactAgents));
            let difference = a.get(Term::Viscosity).unwrap() - b.get(Term::Viscosity).unwrap();
            prop_assert!(difference.norm() < 1e-11);
        }
    }

    #[test]
    fn accelerations_follow_rotations_reflections_and_translations(
        angle in 0.0..6.3_f64,
        mirrored: bool,
        x in -300.0..300.0_f64,
        y in -300.0..300.0_f64,
        profile in proptest::sample::select(vec!["sf", "sph", "sf+sph", "sf->sph"]),
        wall_method in proptest::sample::select(
            vec![WallMethod::Representative, WallMethod::Exact, WallMethod::Union]
        ),
    ) {
        let motion = Motion { angle, mirrored, shift: vector(x, y) };
        let obstacles = [room(3.0, 0.8), polygon(&[[1.0, 1.0], [1.6, 1.2], [1.1, 1.7]])];
        let parameters = Parameters::of([("viscosity", 5.0)]).unwrap();
        let agents: Vec<NewAgent> = crowd(40, 3.0)
            .into_iter()
            .filter(|agent| obstacles.iter().all(|o| !o.contains(agent.position)))
            .collect();
        let evaluated = |motion: Motion| {
            let obstacles = obstacles.iter().map(|o| motion.polygon(o)).collect();
            let mut scene = scene(obstacles, blend_with(profile, &parameters));
            scene.wall_method = wall_method;
            scene.agents = agents.iter().map(|agent| motion.agent(agent)).collect();
            evaluated(scene)
        };
        let still = evaluated(Motion { angle: 0.0, mirrored: false, shift: Vector::zeros() });
        let moved = evaluated(motion);
        for id in 0..agents.len() as u32 {
            let expected = motion.turn(acceleration(&still, id));
            let found = acceleration(&moved, id);
            prop_assert!(
                (found - expected).norm() < 1e-8 * (1.0 + expected.norm()),
                "agent {id}: {found:?} {expected:?}"
            );
        }
    }
}

/// Twelve people close together, all with a positive pressure; `common` is added to every velocity.
fn pressing_crowd(common: Vector) -> Simulation {
    let parameters = Parameters::of([("viscosity", 5.0)]).unwrap();
    let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
    scene.agents = crowd(12, 1.5);
    for agent in &mut scene.agents {
        agent.mean_density = Some(0.0);
        agent.velocity += common;
    }
    evaluated(scene)
}

#[test]
fn forces_in_a_pressing_crowd_conserve_momentum() {
    let simulation = pressing_crowd(Vector::zeros());
    let fields = simulation.frame().fields;
    assert!(fields.pressure.iter().all(|&p| p > 0.0));
    assert!(sum_of(&simulation, Term::PressureAgents).norm() < 1e-10);
    assert!(sum_of(&simulation, Term::Viscosity).norm() < 1e-10);
    assert!(sum_of(&simulation, Term::ContactAgents).norm() < 1e-10);
}

#[test]
fn agents_below_their_rest_density_feel_no_pressure_and_press_less_on_others() {
    let pair = |means: [f64; 2]| evaluated(pressing_pair(0.6, 0.0, [1.0, 1.0], means));
    let pressed = |simulation: &Simulation, id| {
        breakdown(simulation, id).profiles[0]
            .accelerations
            .get(Term::PressureAgents)
            .unwrap()
    };
    let lopsided = pair([0.0, 5.0]);
    assert!(breakdown(&lopsided, 1).pressure < 0.0);
    assert_eq!(pressed(&lopsided, 1), Vector::zeros());
    // A negative pressure of a neighbor stays in the sum: −Σ m_j (p_i + p_j) / (2ρ_j) ∇W.
    let [a, b] = [0, 1].map(|id| breakdown(&lopsided, id));
    let slope = -30.0 / std::f64::consts::PI * 0.16;
    let expected = slope * (a.pressure + b.pressure) / (2.0 * b.density) / a.density;
    assert!((pressed(&lopsided, 0).x - expected).abs() < 1e-11);
    assert!(pressed(&lopsided, 0).x > pressed(&pair([0.0, 0.0]), 0).x);
}

#[test]
fn a_lone_agent_feels_only_its_goal_force() {
    for name in NAMES.iter().filter(|name| !name.contains("rvo")) {
        let mut scene = scene(vec![room(40.0, 0.8)], blend(name));
        scene.agents = vec![NewAgent {
            mass: Some(1.25),
            mean_density: None,
            ..walker(vector(20.0, 20.0), vector(0.5, -0.25), vector(20.0, 30.0))
        }];
        let simulation = evaluated(scene);
        let expected = vector(0.0 - 0.5, 1.4 + 0.25) / 0.5 / 1.25;
        assert!(
            (acceleration(&simulation, 0) - expected).norm() < 1e-14,
            "{name}"
        );
        let alone = 1.25 * 4.0 / std::f64::consts::PI;
        let density = simulation.frame().fields.density[0];
        assert!((density - alone).abs() < 1e-14, "{name}");
    }
}

#[test]
fn coincident_agents_have_finite_accelerations() {
    for name in NAMES {
        let mut scene = scene(Vec::new(), blend(name));
        scene.agents = vec![person(vector(1.0, 2.0), vector(9.0, 2.0)); 3];
        let simulation = evaluated(scene);
        for id in 0..3 {
            let found = acceleration(&simulation, id);
            assert!(sandbox::engine::math::is_finite(found), "{name}");
            assert!(found.y.abs() < 40.0, "{name}");
        }
    }
}

#[test]
fn pressure_viscosity_and_contact_are_zero_at_their_ranges() {
    let at = |distance: f64| {
        let simulation = evaluated(pressing_pair(distance, 0.0, [1.0, 1.0], [0.0, 0.0]));
        breakdown(&simulation, 0).profiles[0].accelerations.clone()
    };
    let [inside, outside] = [at(0.999_999), at(1.0)];
    assert!(
        inside.get(Term::Viscosity).unwrap().norm() > 0.0
            && inside.get(Term::PressureAgents).unwrap().norm() > 0.0
    );
    assert_eq!(outside.get(Term::Viscosity), Some(Vector::zeros()));
    assert_eq!(outside.get(Term::PressureAgents), Some(Vector::zeros()));
    assert!(at(0.479_999).get(Term::ContactAgents).unwrap().norm() > 0.0);
    assert_eq!(at(0.48).get(Term::ContactAgents), Some(Vector::zeros()));
}

#[test]
fn a_corner_counts_twice_in_contact_and_once_in_the_social_force() {
    let corner = vector(2.0, 2.0);
    let obstacle = polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
    let away = vector(0.6, 0.8) * 0.2;
    let mut scene = scene(vec![obstacle], blend("sf"));
    scene.agents = vec![person(corner + away, vector(9.0, 9.0))];
    let terms = breakdown(&evaluated(scene), 0).profiles[0]
        .accelerations
        .clone();
    let social = vector(0.6, 0.8) * (2.1 / 0.1 * (-2.0_f64).exp());
    assert!((terms.get(Term::SocialWalls).unwrap() - social).norm() < 1e-11);
    let contact = vector(0.6, 0.8) * (2.0 * 1000.0 * 0.04);
    assert!((terms.get(Term::ContactWalls).unwrap() - contact).norm() < 1e-9);
}

#[test]
fn contact_acts_from_both_faces_of_a_wall_and_the_social_force_from_one() {
    let thin = polygon(&[[-3.0, 0.0], [3.0, 0.0], [3.0, 0.01], [-3.0, 0.01]]);
    let mut scene = scene(vec![thin], blend("sf"));
    scene.agents = vec![person(vector(0.0, 0.11), vector(0.0, 9.0))];
    let terms = breakdown(&evaluated(scene), 0).profiles[0]
        .accelerations
        .clone();
    let expected = 1000.0 * ((0.24 - 0.1) + (0.24 - 0.11));
    assert!((terms.get(Term::ContactWalls).unwrap().y - expected).abs() < 1e-9);
    let social = 2.1 / 0.1 * (-1.0_f64).exp();
    assert!((terms.get(Term::SocialWalls).unwrap().y - social).abs() < 1e-9);
}

#[test]
fn a_wall_pushes_an_agent_on_it_along_its_outward_normal() {
    for k in 0..400 {
        let (sine, cosine) = (0.0157 * f64::from(k)).sin_cos();
        let start = vector(0.3, 0.7);
        let along = vector(cosine, sine);
        let outward = vector(sine, -cosine);
        let triangle = vec![
            start,
            start + along * 4.0,
            start + along * 2.0 - outward * 4.0,
        ];
        let place = start + along * (1.0 + 0.005 * f64::from(k));
        let mut scene = scene(vec![Polygon::new(triangle).unwrap()], blend("sph"));
        scene.agents = vec![person(place, place)];
        let terms = breakdown(&evaluated(scene), 0).profiles[0]
            .accelerations
            .clone();
        let push = terms.get(Term::ContactWalls).unwrap();
        assert!(
            (push - outward * 200.0 * 0.24).norm() < 1e-3,
            "{k}: {push:?}"
        );
    }
}

/// A wind along y that grows with the density, if asked.
#[derive(Debug)]
struct Wind {
    reads_density: bool,
}

impl Force for Wind {
    fn name(&self) -> &str {
        "wind"
    }

    fn rates(&self, _: &Extremes) -> Rates {
        Rates::default()
    }

    fn needs_density(&self) -> bool {
        self.reads_density
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        let density = if self.reads_density {
            frame.fields.density[i]
        } else {
            1.0
        };
        vector(0.0, 0.25 * density)
    }
}

#[test]
fn a_force_from_outside_the_crate_adds_its_acceleration_in_every_profile() {
    for name in NAMES {
        for reads_density in [false, true] {
            let mut still = scene(vec![room(8.0, 1.0)], blend(name));
            still.agents = vec![
                person(vector(3.0, 3.0), vector(9.0, 4.0)),
                person(vector(3.4, 3.0), vector(9.0, 4.0)),
            ];
            let mut windy = still.clone();
            windy.own_forces.push(Arc::new(Wind { reads_density }));
            assert!(windy.needs().density || !reads_density);
            let (still, windy) = (evaluated(still), evaluated(windy));
            for id in 0..2 {
                let wind = breakdown(&windy, id).own_forces[0].acceleration;
                assert_eq!(wind[0], 0.0);
                assert!(wind[1] > 0.2, "{name}: {wind:?}");
                let added = acceleration(&windy, id) - acceleration(&still, id);
                assert!(
                    (added - Vector::from(wind)).norm() < 1e-12,
                    "{name}: {added}"
                );
                let breakdown = breakdown(&windy, id);
                let sum = breakdown.weighted_sum();
                assert!(
                    (sum - Vector::from(breakdown.acceleration)).norm() < 1e-9,
                    "{name}"
                );
            }
        }
    }
}
