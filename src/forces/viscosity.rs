//! SPH viscosity (§3.3, Eq. 7, times μ and divided by the density as in Eq. 2).

use crate::frame::Frame;
use crate::math::Vector;
use crate::pairs::PairSums;

/// The viscosity force of one profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// μ, greater than 0.
    pub coefficient: f64,
}

impl Viscosity {
    /// μ ∇²v_i / ρ_i, Eq. 7.
    pub fn acceleration(&self, frame: &Frame, i: usize, sums: &PairSums) -> Vector {
        sums.viscosity * (self.coefficient / frame.fields.density[i])
    }
}
