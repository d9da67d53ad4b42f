//! Drag: a friction that grows with the density.
//!
//! In the gas-kinetic theory of D. Helbing, A fluid-dynamic model for the movement of pedestrians, Complex Systems 6
//! (1992), agents lose speed by evading each other, at a rate that is proportional to their density. So
//! a_i = −γ(ρ_i) v_i with γ = γ₀ max(0, ρ_i − ρ_start). With the goal force of Eq. 17 an agent of mass 1 walks at
//! s_i/(1 + γ τ/K^goal).

use crate::engine::frame::Frame;
use crate::engine::math::Vector;

/// Parameters of the drag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    /// γ₀, m²/s.
    pub drag_per_density: f64,
    /// ρ_start, P/m²: below this density there is no drag. The density of a lone agent is that of its own mass, up to
    /// 1.55 P/m².
    pub drag_from_density: f64,
}

impl Default for Drag {
    fn default() -> Self {
        Self {
            drag_per_density: 4.0,
            drag_from_density: 1.6,
        }
    }
}

impl Drag {
    /// γ, 1/s, at this density, P/m².
    pub fn rate(&self, density: f64) -> f64 {
        self.drag_per_density * (density - self.drag_from_density).max(0.0)
    }

    /// −γ v of agent `i`, m/s².
    pub fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        frame.agents.velocity[i] * -self.rate(frame.fields.density[i])
    }
}
