//! Smoothing kernels (§5.2): the 2D versions of Müller's, for support radius h in meters.
//!
//! Each is zero at and beyond distance h.

use std::f64::consts::PI;

use crate::engine::math::Vector;

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

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ f(r) dr over [0, h] by the midpoint rule.
    fn radial(h: f64, f: impl Fn(f64) -> f64) -> f64 {
        let steps = 20_000;
        let dr = h / steps as f64;
        (0..steps).map(|i| f((i as f64 + 0.5) * dr) * dr).sum()
    }

    #[test]
    fn the_density_kernel_integrates_to_one() {
        for h in [0.5, 1.0, 2.0] {
            let integral = radial(h, |r| 2.0 * PI * r * density(r * r, h));
            assert!((integral - 1.0).abs() < 1e-8);
            assert!((density(0.0, h) - 4.0 / (PI * h * h)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_potential_of_the_pressure_kernel_integrates_to_one() {
        for h in [0.5, 1.0, 2.0] {
            let slope = |r: f64| pressure_gradient(Vector::new(r, 0.0), h).x;
            let integral = radial(h, |r| -PI * r * r * slope(r));
            assert!((integral - 1.0).abs() < 1e-8);
        }
    }

    #[test]
    fn the_viscosity_kernel_integrates_to_its_printed_constant() {
        let integral = radial(1.0, |r| 2.0 * PI * r * viscosity_laplacian(r, 1.0));
        assert!((integral - 120.0 / 29.0).abs() < 1e-8);
    }

    #[test]
    fn the_pressure_gradient_points_inwards_and_vanishes_at_the_centre_and_the_rim() {
        let r = Vector::new(0.3, -0.4);
        assert!(pressure_gradient(r, 1.0).dot(&r) < 0.0);
        assert_eq!(pressure_gradient(Vector::zeros(), 1.0), Vector::zeros());
        assert_eq!(
            pressure_gradient(Vector::new(1.0, 0.0), 1.0),
            Vector::zeros()
        );
        assert_eq!(density(1.0, 1.0), 0.0);
        assert_eq!(viscosity_laplacian(1.0, 1.0), 0.0);
    }
}
