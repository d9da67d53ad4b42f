//! Smoothing kernels (§5.2): the 2D versions of Müller's, for support radius h in meters.
//!
//! Each is zero at and beyond distance h.
//!
//! Plain form: `kernel`, `gradient` and `laplacian` in `examples/paper.rs`.

use std::f64::consts::PI;

use crate::math::Vector;

/// W, Eq. 13, in 1/m², for a squared distance in m². Integrates to 1 over the plane.
pub fn density(distance_squared: f64, h: f64) -> f64 {
    let rest = h * h - distance_squared;
    if rest > 0.0 {
        4.0 / (PI * h.powi(8)) * rest * rest * rest
    } else {
        0.0
    }
}

/// ∇W, Eq. 14, in 1/m³, for r in meters. Its radial potential integrates to 1 over the plane.
/// Zero at r = 0, where the direction is undefined.
pub fn pressure_gradient(r: Vector, h: f64) -> Vector {
    let distance = r.norm();
    let rest = h - distance;
    if rest > 0.0 && distance > 0.0 {
        r * (-30.0 / (PI * h.powi(5)) * rest * rest / distance)
    } else {
        Vector::zeros()
    }
}

/// ∇²W, Eq. 15, in 1/m⁴, for a distance in meters. Its integral over the plane is 120/29.
pub fn viscosity_laplacian(distance: f64, h: f64) -> f64 {
    360.0 / (29.0 * PI * h.powi(5)) * (h - distance).max(0.0)
}
