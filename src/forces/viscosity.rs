//! SPH viscosity (§3.3, Eq. 7, times μ and divided by the density as in Eq. 2).

use crate::frame::Frame;
use crate::kernel;
use crate::math::Vector;

/// The viscosity force of one profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// μ, greater than 0.
    pub coefficient: f64,
}

impl Viscosity {
    /// μ ∇²v_i / ρ_i, Eq. 7.
    pub fn acceleration(&self, frame: &Frame, i: usize, h: f64) -> Vector {
        let (fields, agents) = (frame.fields, frame.agents);
        let v_i = agents.velocity[i];
        let laplacian = frame.near(i, h).fold(Vector::zeros(), |sum, (j, r_ij)| {
            let weight = kernel::viscosity_laplacian(r_ij.norm(), h) * fields.volume[j];
            sum + (agents.velocity[j] - v_i) * weight
        });
        laplacian * (self.coefficient / fields.density[i])
    }
}
