//! Walls in SPH (§4.3): contributions of the hidden regions P_k to density and pressure.
//!
//! Plain form of the paper's method: `density_by_wall` and `pressure_by_wall` in `examples/paper.rs`.

use libm::{asinh, atan2};
use std::f64::consts::PI;

use crate::geometry::{HiddenRegion, Walls, visible_parts};
use crate::kernel;
use crate::math::{Vector, direction};

/// How kernels are integrated over the hidden regions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WallMethod {
    /// The paper's method: the area of P_k times the kernel at one representative point (Eqs. 10 and 12).
    #[default]
    Representative,
    /// Exact integrals over each P_k. Areas hidden by several walls count several times.
    Exact,
    /// Exact integrals over the union of all P_k. Each part is assigned to the nearest wall that hides it, so that
    /// no area counts twice.
    Union,
}

/// The contribution of one wall to one agent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallShare {
    /// The wall.
    pub wall: u32,
    /// a(P_k) in m².
    pub hidden_area: f64,
    /// r_k^o, meters; `None` for exact integrals.
    pub representative_point: Option<Vector>,
    /// ∫ W over P_k, dimensionless. Times ρ_i⁰ it is the density from the wall (Eq. 10).
    pub kernel: f64,
    /// ∫ ∇W over P_k in 1/m. Times −p_i it is the pressure force of the wall (Eq. 12).
    pub gradient: Vector,
}

impl WallShare {
    /// The sum over two parts of the same wall.
    fn with(self, other: &Self) -> Self {
        Self {
            hidden_area: self.hidden_area + other.hidden_area,
            kernel: self.kernel + other.kernel,
            gradient: self.gradient + other.gradient,
            ..self
        }
    }
}

impl WallMethod {
    /// Passes `take` the shares of all `candidates` that hide part of the kernel of an agent at `r_i`, in the order
    /// of `candidates`.
    pub fn shares(
        self,
        walls: &Walls,
        candidates: &[u32],
        r_i: Vector,
        h: f64,
        mut take: impl FnMut(WallShare),
    ) {
        let hidden = candidates
            .iter()
            .filter_map(|&k| Some((k, HiddenRegion::behind(walls.wall(k), r_i, h)?)));
        match self {
            Self::Representative => {
                hidden.for_each(|(k, region)| take(representative(k, &region, r_i)));
            }
            Self::Exact => hidden.for_each(|(k, region)| take(exact(k, &region))),
            Self::Union => {
                let (ks, regions): (Vec<u32>, Vec<HiddenRegion>) = hidden.unzip();
                let mut shares: Vec<Option<WallShare>> = vec![None; ks.len()];
                for (index, part) in visible_parts(&regions) {
                    let share = exact(ks[index], &part);
                    let sum = shares[index].map_or(share, |seen| seen.with(&share));
                    shares[index] = Some(sum);
                }
                shares.into_iter().flatten().for_each(take);
            }
        }
    }

    /// The sum of the kernels of all [`shares`](Self::shares), without their gradients, which take most of the time.
    pub fn hidden_kernel(self, walls: &Walls, candidates: &[u32], r_i: Vector, h: f64) -> f64 {
        let behind = |&k: &u32| HiddenRegion::behind(walls.wall(k), r_i, h);
        let mut hidden = candidates.iter().filter_map(behind);
        let mut sum = 0.0;
        match self {
            Self::Representative => {
                self.shares(walls, candidates, r_i, h, |share| sum += share.kernel);
            }
            Self::Exact => hidden.for_each(|region| sum += exact_kernel(&region)),
            Self::Union => match [hidden.next(), hidden.next()] {
                [Some(first), Some(second)] => {
                    let regions: Vec<_> = [first, second].into_iter().chain(hidden).collect();
                    let mut kernels = vec![0.0; regions.len()];
                    for (index, part) in visible_parts(&regions) {
                        kernels[index] += exact_kernel(&part);
                    }
                    kernels.iter().for_each(|kernel| sum += kernel);
                }
                [only, _] => sum = only.as_ref().map_or(0.0, exact_kernel),
            },
        }
        sum
    }
}

/// Eqs. 10 and 12: P_k is replaced by the point halfway between r_k* and the rim of the kernel.
fn representative(k: u32, region: &HiddenRegion, r_i: Vector) -> WallShare {
    let h = region.support_radius;
    let to_nearest = region.to_nearest();
    let distance = to_nearest.norm();
    let ray = if distance > 0.0 {
        direction(to_nearest)
    } else {
        region.towards
    };
    let offset = ray * (0.5 * (distance + h));
    let hidden_area = region.area();
    WallShare {
        wall: k,
        hidden_area,
        representative_point: Some(r_i + offset),
        kernel: hidden_area * kernel::density(offset.norm_squared(), h),
        gradient: kernel::pressure_gradient(-offset, h) * hidden_area,
    }
}

fn exact(k: u32, region: &HiddenRegion) -> WallShare {
    let [from, to] = [region.from, region.to].map(|s| Antiderivatives::at(region, s));
    let h = region.support_radius;
    WallShare {
        wall: k,
        hidden_area: region.area(),
        representative_point: None,
        kernel: (to.kernel - from.kernel) / (2.0 * PI),
        gradient: (region.towards * (to.towards - from.towards)
            + region.along * (to.along - from.along))
            * (5.0 / (2.0 * PI * h)),
    }
}

/// ∫ W over a region, as in [`exact`].
fn exact_kernel(region: &HiddenRegion) -> f64 {
    let h = region.support_radius;
    let at = |along: f64| kernel_antiderivative(region.distance / h, along / h);
    (at(region.to) - at(region.from)) / (2.0 * PI)
}

/// The antiderivative of the kernel; see [`Antiderivatives`].
fn kernel_antiderivative(q: f64, s: f64) -> f64 {
    let (q2, s2) = (q * q, s * s);
    atan2(s, q) - 4.0 * q * s + 6.0 * q * s * (q2 + s2 / 3.0)
        - 4.0 * q * s * (q2 * q2 + 2.0 * q2 * s2 / 3.0 + s2 * s2 / 5.0)
        + q * s * (q2 * q2 * q2 + q2 * q2 * s2 + 0.6 * q2 * s2 * s2 + s2 * s2 * s2 / 7.0)
}

/// Antiderivatives over the angle t in closed form, at one end of the wall.
///
/// The radial integrals ∫ W r dr and ∫ |∇W| r dr from the wall to the rim are polynomials in the distance R of
/// the wall point, in units of h. With R = q / cos t, q = d/h, s the position along the wall over h, and
/// A = asinh(s/q), their integrals over t are the expressions below.
struct Antiderivatives {
    kernel: f64,
    towards: f64,
    along: f64,
}

impl Antiderivatives {
    fn at(region: &HiddenRegion, along: f64) -> Self {
        let q = region.distance / region.support_radius;
        let s = along / region.support_radius;
        let (q2, s2) = (q * q, s * s);
        let r2 = q2 + s2;
        let r = r2.sqrt();
        // q² A and q⁴ A vanish with q.
        let q2a = if q2 > 0.0 { q2 * asinh(s / q) } else { 0.0 };
        // cos t and sin t. At q = s = 0 the direction is arbitrary: its weight is 0.
        let (cosine, sine) = if r > 0.0 { (q / r, s / r) } else { (1.0, 0.0) };
        Self {
            kernel: kernel_antiderivative(q, s),
            towards: sine - 6.0 * q2a + 8.0 * q2 * s - 1.5 * q2 * s * r - 1.5 * q2 * q2a,
            along: -cosine - 6.0 * q * r + 4.0 * q * r2 - q * r2 * r,
        }
    }
}
