//! Models of one's own for a whole crowd.

use std::sync::Arc;

use crate::common::{blend, breakdown, person, rectangle, scene};
use sandbox::engine::forces::model::{Gives, Model, OwnModel};
use sandbox::engine::forces::rates::{Extremes, Rates};
use sandbox::engine::frame::Frame;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::engine::stability;

/// The same vector for all, a spring between agents within a meter, or nothing.
#[derive(Debug)]
enum Own {
    Wind(Vector),
    Spring(f64),
    Broken,
}

impl Model for Own {
    fn name(&self) -> &str {
        "own"
    }

    fn reach(&self) -> f64 {
        1.0
    }

    fn rates(&self, _: &Extremes) -> Rates {
        let everywhere = match self {
            Self::Spring(stiffness) => 2.0 * stiffness,
            _ => 0.0,
        };
        Rates {
            everywhere,
            ..Rates::default()
        }
    }

    fn vectors(&self, frame: &Frame) -> Result<Vec<Vector>, String> {
        let all = 0..frame.agents.len();
        match self {
            Self::Wind(wind) => Ok(vec![*wind; frame.agents.len()]),
            Self::Spring(stiffness) => {
                let pushed = |i| frame.near(i, 1.0).map(|(_, r)| r * *stiffness).sum();
                Ok(all.map(pushed).collect())
            }
            Self::Broken => Err("it is broken".to_owned()),
        }
    }
}

fn with(own: Own, gives: Gives) -> Scene {
    let mut scene = scene(vec![rectangle([5.0, 6.0], [-1.0, 1.0])], blend("sph"));
    let people = [[0.0, 0.0], [0.7, 0.1], [3.0, 2.0]];
    let goal = Vector::new(20.0, 0.0);
    scene.agents = people.map(|p| person(p.into(), goal)).to_vec();
    scene.set_model(OwnModel {
        model: Arc::new(own),
        gives,
        coarse: false,
    });
    scene
}

fn evaluated(scene: Scene) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    simulation.request_density_until(u64::MAX);
    simulation.evaluate().unwrap();
    simulation
}

#[test]
fn accelerations_join_those_of_the_profiles() {
    let wind = Vector::new(0.0, 0.3);
    let still = evaluated(with(Own::Wind(Vector::zeros()), Gives::Accelerations));
    let windy = evaluated(with(Own::Wind(wind), Gives::Accelerations));
    for (with, without) in windy
        .frame()
        .fields
        .acceleration
        .iter()
        .zip(&still.frame().fields.acceleration)
    {
        assert!((with - without - wind).norm() < 1e-12);
    }
    let found = breakdown(&windy, 1);
    assert_eq!(found.own_forces[0].acceleration, [0.0, 0.3]);
    assert!((found.weighted_sum() - Vector::from(found.acceleration)).norm() < 1e-9);
}

#[test]
fn accelerations_replace_those_of_the_profiles() {
    let simulation = evaluated(with(Own::Spring(40.0), Gives::AllAccelerations));
    let accelerations = &simulation.frame().fields.acceleration;
    let (agents, r) = (simulation.frame().agents, Vector::new(-0.7, -0.1));
    let of = |id| accelerations[agents.index_of(id).unwrap()];
    assert!((of(0) - r * 40.0).norm() < 1e-12 && (of(1) + r * 40.0).norm() < 1e-12);
    assert_eq!(of(2), Vector::zeros());
    let found = breakdown(&simulation, 0);
    assert!(found.profiles.is_empty());
    assert!((found.weighted_sum() - of(0)).norm() < 1e-12);
    // Only what the model needs is computed, and only its stiffness limits the step.
    let scene = with(Own::Spring(40.0), Gives::AllAccelerations);
    assert!(!scene.needs().density && scene.needs().reach == 1.0);
    let [soft, stiff] = [40.0, 4e4].map(|k| with(Own::Spring(k), Gives::AllAccelerations));
    let [soft, stiff] = [soft, stiff].map(|scene| stability::time_step(&scene).unwrap());
    assert!(stiff < 0.1 * soft, "{soft} {stiff}");
}

#[test]
fn velocities_take_the_place_of_those_toward_goals() {
    let wanted = Vector::new(-0.4, 0.2);
    let mut simulation = evaluated(with(Own::Wind(wanted), Gives::Velocities));
    let fields = simulation.frame().fields;
    assert!(fields.preferred_velocity.iter().all(|&v| v == wanted));
    assert!(breakdown(&simulation, 1).own_forces.is_empty());
    while simulation.frame().clock.time() < 3.0 {
        simulation.step().unwrap();
    }
    let agents = simulation.frame().agents;
    let lone = agents.index_of(2).unwrap();
    assert!((agents.velocity[lone] - wanted).norm() < 0.02);
}

#[test]
fn a_model_without_vectors_is_a_fault() {
    let mut simulation = Simulation::new(with(Own::Broken, Gives::Accelerations)).unwrap();
    let fault = simulation.evaluate().map(drop).unwrap_err();
    assert!(matches!(fault, Fault::Model { .. }));
    assert_eq!(fault.to_string(), "the model own: it is broken");
    let nan = Own::Wind(Vector::new(f64::NAN, 0.0));
    let mut simulation = Simulation::new(with(nan, Gives::Velocities)).unwrap();
    let fault = simulation.evaluate().map(drop).unwrap_err().to_string();
    assert_eq!(fault, "the model own: (NaN, 0) for agent 0 is not finite");
}

#[test]
fn another_model_takes_the_place_of_the_first() {
    let mut scene = with(Own::Wind(Vector::x()), Gives::Accelerations);
    scene.set_model(OwnModel {
        model: Arc::new(Own::Wind(Vector::y())),
        gives: Gives::AllAccelerations,
        coarse: true,
    });
    assert_eq!(scene.own_forces.len(), 1);
    let simulation = evaluated(scene);
    let accelerations = &simulation.frame().fields.acceleration;
    assert!(accelerations.iter().all(|&a| a == Vector::y()));
}
