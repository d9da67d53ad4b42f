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
    /// Adds what each of `agents` multiplies the sum of Eq. 7 with, times `weight`: μ/ρ_i.
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
