//! Crowds of people with legs.

use sandbox::engine::agents::NewAgent;
use sandbox::engine::scene::Scene;
use sandbox::scenario::catalog::Parameters;

use crate::common::{blend_with, scene};

/// People who stand on legs; nothing else acts on them but their own friction λ.
pub fn alone(friction: f64) -> Parameters {
    Parameters::of([
        ("gas_constant", 0.0),
        ("agent_stiffness", 0.0),
        ("wall_stiffness", 0.0),
        ("goal_scale", friction),
        ("relaxation_time", 1.0),
    ])
    .unwrap()
    .with("legs", true)
    .unwrap()
}

/// A crowd that wants to stand still.
pub fn standing(parameters: Parameters, agents: Vec<NewAgent>) -> Scene {
    let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
    scene.preferred_speed = 0.0;
    scene.max_speed = 100.0;
    scene.agents = agents;
    scene
}
