//! Integrals of the kernels over hidden regions by quadrature, independent of the engine.

use std::f64::consts::PI;

use sandbox::engine::boundary::WallShare;
use sandbox::engine::geometry::{Wall, Walls};
use sandbox::engine::kernel;
use sandbox::engine::math::Vector;

use super::vector;

/// Area, ∫ W and ∫ ∇W over a region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Integrals {
    pub area: f64,
    pub kernel: f64,
    pub gradient: Vector,
}

impl Integrals {
    pub fn none() -> Self {
        Self {
            area: 0.0,
            kernel: 0.0,
            gradient: Vector::zeros(),
        }
    }

    /// Adds a small piece of `weight` m² at `offset` = x − r_i.
    pub fn add(&mut self, offset: Vector, weight: f64, h: f64) {
        self.area += weight;
        self.kernel += weight * kernel::density(offset.norm_squared(), h);
        self.gradient += kernel::pressure_gradient(-offset, h) * weight;
    }

    pub fn of(shares: &[WallShare]) -> Self {
        shares.iter().fold(Self::none(), |sum, share| Self {
            area: sum.area + share.hidden_area,
            kernel: sum.kernel + share.kernel,
            gradient: sum.gradient + share.gradient,
        })
    }

    pub fn difference(&self, other: &Self) -> f64 {
        (self.area - other.area)
            .abs()
            .max((self.kernel - other.kernel).abs())
            .max((self.gradient - other.gradient).norm())
    }
}

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
                sum.add(w * lambda, area, h);
            }
        }
    }
    sum
}

/// The distance along a ray in `direction` at which it hits the wall `a`–`b` from its free side.
fn hit(a: Vector, b: Vector, direction: Vector) -> Option<f64> {
    let turn = cross(direction, b - a);
    let (along, fraction) = (cross(a, b - a) / turn, cross(a, direction) / turn);
    let free_side = cross(b - a, a) >= 0.0;
    (free_side && along >= 0.0 && (0.0..=1.0).contains(&fraction)).then_some(along)
}

/// The union of the regions hidden by all walls, ray by ray from the first wall to the rim.
pub fn shadow(walls: &Walls, r_i: Vector, h: f64) -> Integrals {
    let segments: Vec<(Vector, Vector)> =
        walls.iter().map(|w| (w.start - r_i, w.end - r_i)).collect();
    let mut corners: Vec<Vector> = segments.iter().map(|s| s.0).collect();
    for &(a, b) in &segments {
        corners.extend(circle_cuts(a, b, h).iter().map(|u| a + (b - a) * *u));
        for &(c, d) in &segments {
            let u = cross(c - a, d - c) / cross(b - a, d - c);
            corners.extend((0.0..=1.0).contains(&u).then(|| a + (b - a) * u));
        }
        let way = b - a;
        corners.push(a - way * (a.dot(&way) / way.norm_squared()));
    }
    let mut angles: Vec<f64> = corners.iter().map(|p| p.y.atan2(p.x)).collect();
    angles.extend([-PI, PI]);
    angles.sort_by(f64::total_cmp);
    let rule = gauss();
    let mut sum = Integrals::none();
    for gap in angles.windows(2) {
        const PANELS: i32 = 24;
        let panel = (gap[1] - gap[0]) / f64::from(PANELS);
        for k in 0..PANELS {
            for &(x, weight) in &rule {
                let angle = gap[0] + (f64::from(k) + x) * panel;
                let ray = vector(angle.cos(), angle.sin());
                let hits = segments.iter().filter_map(|&(a, b)| hit(a, b, ray));
                let Some(from) = hits.reduce(f64::min).filter(|&r| r < h) else {
                    continue;
                };
                for &(y, radial) in &rule {
                    let r = from + y * (h - from);
                    sum.add(ray * r, weight * panel * radial * (h - from) * r, h);
                }
            }
        }
    }
    sum
}
