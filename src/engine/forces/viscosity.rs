//! SPH viscosity (§3.3, Eq. 7, times μ and divided by the density as in Eq. 2).

use std::ops::Range;

use crate::engine::frame::Frame;

/// The viscosity force of one profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viscosity {
    /// μ, greater than 0.
    pub coefficient: f64,
}

impl Viscosity {
    /// Adds the coefficient μ/ρ_i of the sum in Eq. 7, times `weight`, for each of `agents`.
    pub fn add_coefficients(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        weight: f64,
        coefficients: &mut [f64],
    ) {
        let density = &frame.fields.density[agents];
        for (sum, &density) in coefficients.iter_mut().zip(density) {
            *sum += self.coefficient * weight / density;
        }
    }
}
