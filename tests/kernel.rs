//! The kernels: their integrals, and their values at the center and at the rim.

use std::f64::consts::PI;

use sandbox::engine::kernel::{density, pressure_gradient, viscosity_laplacian};
use sandbox::engine::math::Vector;

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
