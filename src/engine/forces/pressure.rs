//! SPH pressure (§3.3, §4.3, Eqs. 11 and 12, divided by the density as in Eq. 2).

use std::ops::Range;

use crate::engine::frame::Frame;
use crate::engine::math::Vector;

/// Adds what each of `agents` multiplies the sum over agents of Eq. 11 with, times `weight`: 1/ρ_i, and
/// zero where it feels no pressure, below its rest density (§5.2). A neighbor's negative pressure
/// stays in the sum.
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

/// Eq. 12 over all walls in reach, over ρ_i.
pub fn from_walls(frame: &Frame, i: usize) -> Vector {
    let fields = frame.fields;
    let coefficient = coefficient(fields.density[i], fields.rest_density[i]);
    fields.wall_gradient[i] * (-fields.pressure[i] * coefficient)
}
