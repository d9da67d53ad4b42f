//! Crowds with walking laws.

use rand::Rng;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::forces::walking::Headway;
use sandbox::engine::math::Vector;
use sandbox::engine::profile::Term;
use sandbox::engine::random::{Purpose, stream};
use sandbox::engine::scene::Scene;
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::catalog::{Parameters, WalkingLawKind};
use serde_json::json;

use super::{blend_with, breakdown, scene, vector};

/// The laws that look ahead and choose no heading: they lower the preferred speed.
pub fn looking() -> impl Iterator<Item = WalkingLawKind> {
    WalkingLawKind::laws().filter(|law| match law {
        WalkingLawKind::Headway | WalkingLawKind::DensityAhead => true,
        WalkingLawKind::None | WalkingLawKind::Drag | WalkingLawKind::Headings => false,
    })
}

pub fn with(law: WalkingLawKind) -> Parameters {
    Parameters::default()
        .with("walking_law", json!(law))
        .unwrap()
}

/// A headway law with anticipation.
pub fn anticipating() -> Headway {
    Headway {
        headway_anticipation: 0.4,
        ..Headway::default()
    }
}

/// 300 people in a square of 10 m, with goals in all directions and preferred speeds up to 3 m/s.
pub fn crowd(law: WalkingLawKind, seed: u64) -> Scene {
    let mut rng = stream(seed, Purpose::Placement, 0, 0);
    let mut random = move |size: f64| rng.random_range(-size..size);
    let parameters =
        Parameters::of([("headway_anticipation", anticipating().headway_anticipation)])
            .unwrap()
            .or(&with(law));
    let mut scene = scene(vec![], blend_with("sph", &parameters));
    for k in 0..300 {
        let position = vector(random(5.0), random(5.0));
        scene.agents.push(NewAgent {
            preferred_speed: Some(1.5 + random(1.5)),
            velocity: vector(random(1.0), random(1.0)),
            // Some are where they want to be.
            ..NewAgent::at(
                position,
                [position, vector(random(50.0), random(50.0))][(k % 10).min(1)],
                0,
            )
        });
    }
    scene
}

pub fn walking(simulation: &Simulation, id: u32) -> Vector {
    let terms = breakdown(simulation, id).profiles[0].accelerations.clone();
    let drag = terms.own.iter().find(|(name, _)| name == "drag");
    let drag = drag.map(|(_, acceleration)| *acceleration);
    terms.get(Term::Walking).or(drag).unwrap()
}
