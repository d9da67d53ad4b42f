//! A crowd at one moment, as it is kept and drawn.

use serde::{Deserialize, Serialize};

use crate::simulation::Simulation;

/// Everybody at one moment, to the millimetre.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// When, seconds.
    pub time: f64,
    /// Positions, metres.
    pub x: Vec<f32>,
    /// Positions, metres.
    pub y: Vec<f32>,
    /// D_i, metres.
    pub radius: Vec<f32>,
    /// |v_i|, m/s.
    pub speed: Vec<f32>,
    /// ρ_i, P/m²; empty in a frame without densities.
    pub density: Vec<f32>,
}

impl Snapshot {
    /// The crowd of the current frame.
    pub fn of(simulation: &Simulation) -> Self {
        let frame = simulation.frame();
        let agents = frame.agents;
        let rounded = |value: f64| (1e3 * value).round() as f32 / 1e3;
        let all = |values: &[f64]| values.iter().map(|&v| rounded(v)).collect();
        Self {
            time: frame.clock.time(),
            x: agents.position.iter().map(|r| rounded(r.x)).collect(),
            y: agents.position.iter().map(|r| rounded(r.y)).collect(),
            radius: all(&agents.radius),
            speed: agents.velocity.iter().map(|v| rounded(v.norm())).collect(),
            density: all(&frame.fields.density),
        }
    }
}
