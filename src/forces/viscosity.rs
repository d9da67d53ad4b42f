//! SPH viscosity (§3.3, Eq. 7, times μ and divided by the density as in Eq. 2).

use super::pairs::PairSums;
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
    /// μ ∇²v_i / ρ_i.
    pub fn acceleration(&self, frame: &Frame, i: usize, sums: &PairSums) -> Vector {
        sums.viscosity * (self.coefficient / frame.fields.density[i])
    }
}

/// Eq. 7, one neighbour: `volume` m_j/ρ_j, `dv` v_j − v_i.
#[inline]
pub fn of_neighbor(r_ij: Vector, volume: f64, dv: Vector, h: f64) -> Vector {
    dv * (volume * kernel::viscosity_laplacian(r_ij.norm(), h))
}
