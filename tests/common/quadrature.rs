//! Integrals of the kernels over the region behind one wall by quadrature, independent of the engine.

use std::f64::consts::PI;

use crate::common::wall_integrals::Integrals;
use sandbox::engine::geometry::Wall;
use sandbox::engine::math::Vector;

/// Nodes and weights of Gauss–Legendre quadrature on [0, 1].
fn gauss() -> Vec<(f64, f64)> {
    const N: i32 = 10;
    (0..N)
        .map(|k| {
            let mut x = (PI * (f64::from(k) + 0.75) / (f64::from(N) + 0.5)).cos();
            let mut slope = 0.0;
            for _ in 0..50 {
                let (mut p, mut before) = (x, 1.0);
                for n in 2..=N {
                    let n = f64::from(n);
                    (p, before) = (((2.0 * n - 1.0) * x * p - (n - 1.0) * before) / n, p);
                }
                slope = f64::from(N) * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Where the line through `a` and `b` enters and leaves the circle of radius `h`, as fractions of the segment.
fn circle_cuts(a: Vector, b: Vector, h: f64) -> Vec<f64> {
    let way = b - a;
    let (p, q) = (
        a.dot(&way) / way.norm_squared(),
        (a.norm_squared() - h * h) / way.norm_squared(),
    );
    let root = p * p - q;
    if root <= 0.0 {
        return Vec::new();
    }
    vec![-p - root.sqrt(), -p + root.sqrt()]
}

/// The region behind one wall, integrated along the rays through its points w(u): x = λ w, 1 ≤ λ ≤ h/|w|,
/// dx = λ |w × w′| dλ du. No angles are involved.
pub fn swept(wall: &Wall, r_i: Vector, h: f64) -> Integrals {
    let (a, b) = (wall.start - r_i, wall.end - r_i);
    let mut sum = Integrals::none();
    if cross(b - a, a) < 0.0 {
        return sum; // the agent stands behind the wall
    }
    let foot = (-a.dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
    let mut cuts = vec![0.0, 1.0, foot];
    cuts.extend(circle_cuts(a, b, h));
    // Panels shrink toward the foot of the perpendicular, where the rays turn fastest.
    for k in 0..40 {
        let step = 0.6_f64.powi(k);
        cuts.extend([foot - step, foot + step]);
    }
    cuts.retain(|u| (0.0..=1.0).contains(u));
    cuts.sort_by(f64::total_cmp);
    let rule = gauss();
    for panel in cuts.windows(2) {
        for &(x, weight) in &rule {
            let w = a + (b - a) * (panel[0] + x * (panel[1] - panel[0]));
            let reach = h / w.norm() - 1.0;
            if reach <= 0.0 {
                continue;
            }
            let du = weight * (panel[1] - panel[0]);
            for &(y, radial) in &rule {
                let lambda = 1.0 + y * reach;
                let area = du * radial * reach * lambda * cross(w, b - a).abs();
                sum = sum + Integrals::of_piece(w * lambda, area, h);
            }
        }
    }
    sum
}
