//! SPH pressure (§3.3, §4.3, Eqs. 11 and 12, divided by the density as in Eq. 2).

use std::ops::Range;

use crate::engine::frame::Frame;
use crate::engine::math::Vector;

/// Adds the coefficient of the sum over agents in Eq. 11, times `weight`, for each of `agents`: 1/ρ_i, or zero below
/// its rest density, where an agent feels no pressure (§5.2). Negative pressures of neighbors stay in the sum.
pub fn add_coefficients(
    frame: &Frame,
    agents: Range<usize>,
    weight: f64,
    coefficients: &mut [f64],
) {
    let density = &frame.fields.density[agents.clone()];
    let rest_density = &frame.fields.rest_density[agents];
    for ((sum, &density), &rest_density) in coefficients.iter_mut().zip(density).zip(rest_density) {
        *sum += coefficient(density, rest_density) * weight;
    }
}

fn coefficient(density: f64, rest_density: f64) -> f64 {
    let felt = if density >= rest_density { 1.0 } else { 0.0 };
    felt / density
}

/// Eq. 12, summed over all walls in reach and divided by ρ_i.
pub fn from_walls(frame: &Frame, i: usize) -> Vector {
    let fields = frame.fields;
    let coefficient = coefficient(fields.density[i], fields.rest_density[i]);
    fields.wall_gradient[i] * (-fields.pressure[i] * coefficient)
}
