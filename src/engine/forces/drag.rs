//! Drag: a friction that grows with the density.
//!
//! In the gas-kinetic theory of D. Helbing, A fluid-dynamic model for the movement of pedestrians, Complex Systems 6
//! (1992), agents lose speed by evading each other, at a rate that is proportional to their density. So
//! a_i = −γ(ρ_i) v_i with γ = γ₀ max(0, ρ_i − ρ_start). With the goal force of Eq. 17 an agent of mass 1 walks at
//! s_i/(1 + γ τ/K^goal).

use std::any::Any;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::own::Force;
use super::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::limits::{HIGHEST_DENSITY, STRONGEST};
use crate::math::Vector;

/// Parameters of the drag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Drag {
    /// γ₀ (`drag`), m²/s: the friction per density above `drag_from_density`. Higher: slower crowds.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub drag_per_density: f64,
    /// The density (`drag`), P/m², at which the friction begins. Below 1.55 it slows lone agents, too, whose density is
    /// that of their own mass.
    #[schemars(range(min = 0, max = HIGHEST_DENSITY))]
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

/// The highest density of a crowd relative to ρ⁰max: beyond, pressure drives it apart.
const CROWDED: f64 = 2.0;

impl Drag {
    /// γ, 1/s, at this density, P/m².
    pub fn rate(&self, density: f64) -> f64 {
        self.drag_per_density * (density - self.drag_from_density).max(0.0)
    }
}

impl Force for Drag {
    fn name(&self) -> &str {
        "drag"
    }

    fn needs_density(&self) -> bool {
        true
    }

    /// γ in the densest crowds.
    fn rates(&self, of: &Extremes) -> Rates {
        Rates {
            friction: self.rate(CROWDED * of.sph.rest_density_max),
            ..Rates::default()
        }
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        frame.agents.velocity[i] * -self.rate(frame.fields.density[i])
    }

    fn equals(&self, other: &dyn Force) -> bool {
        (other as &dyn Any).downcast_ref() == Some(self)
    }
}
