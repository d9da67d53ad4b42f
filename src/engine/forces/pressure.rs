//! SPH pressure (§3.3, §4.3, Eqs. 11 and 12, divided by the density as in Eq. 2).
//!
//! Plain form: `pressure_by_agent`, `pressure_by_wall` and `gradient` in `examples/paper.rs`.

use std::f64::consts::PI;
use std::ops::Range;

use crate::density::SphParameters;
use crate::forces::rates::Rates;
use crate::frame::Frame;
use crate::math::Vector;
use crate::pairs::prelude::*;
use crate::pairs::{Columns, Lanes, Real, Simd, dispatch, lanes_from, level, load, splat};

/// Eq. 11 for eight agents i: −Σ_j m_j (p_i + p_j)/(2ρ_j) ∇W, times a coefficient.
pub struct FromAgents<R: Real, S: Simd> {
    /// The coefficient times half of Eq. 14, without its direction and (1 − r/h)², and with the opposite sign.
    push: Lanes<R, S>,
    push_p_i: Lanes<R, S>,
}

impl<R: Real, S: Simd> FromAgents<R, S> {
    /// The sum for the agents from `start` on, with their coefficients.
    #[inline(always)]
    pub fn new(simd: S, columns: &Columns<R>, start: usize, coefficients: &[f64]) -> Self {
        let per_h = load(simd, &columns.bodies.per_support, start);
        let push = lanes_from::<R, S>(simd, coefficients) * (per_h * per_h * per_h);
        let push = push * splat::<R, S>(simd, 15.0 / PI);
        Self {
            push,
            push_p_i: push * load(simd, &columns.pressure, start),
        }
    }

    /// The force along r_ij of an agent j with pressure `p_j`. `rest` is 1 − r/h, and `weight` is m_j/ρ_j times it.
    #[inline(always)]
    pub fn along(&self, weight: Lanes<R, S>, rest: Lanes<R, S>, p_j: Lanes<R, S>) -> Lanes<R, S> {
        let both = self.push.mul_add_precise(p_j, self.push_p_i);
        weight * rest * both
    }
}

/// Adds the coefficient of the sum over agents in Eq. 11, times `weight`, for each of `agents`. Negative pressures of
/// neighbors stay in the sum.
pub fn add_coefficients(
    frame: &Frame,
    agents: Range<usize>,
    weight: f64,
    coefficients: &mut [f64],
) {
    let density = &frame.fields.density[agents.clone()];
    let rest_density = &frame.fields.rest_density[agents];
    dispatch!(level(), _simd => add(weight, (density, rest_density), coefficients));
}

#[inline(always)]
fn add(weight: f64, (density, rest_density): (&[f64], &[f64]), coefficients: &mut [f64]) {
    for ((sum, &density), &rest_density) in coefficients.iter_mut().zip(density).zip(rest_density) {
        *sum += coefficient(density, rest_density) * weight;
    }
}

/// 1/ρ_i, or zero below the rest density, where an agent feels no pressure (§5.2).
#[inline]
fn coefficient(density: f64, rest_density: f64) -> f64 {
    let felt = if density >= rest_density { 1.0 } else { 0.0 };
    felt / density
}

/// c/h of waves of pressure, with the speed of sound c = √(k/2) (`analysis/sound.rs`).
pub fn rates(sph: &SphParameters) -> Rates {
    Rates {
        pressure: (sph.gas_constant / 2.0).sqrt() / sph.support_radius,
        ..Rates::default()
    }
}

/// Eq. 12, divided by ρ_i, for walls with `gradient` = ∫ ∇W over their hidden regions P_k.
pub fn from_walls(frame: &Frame, i: usize, gradient: Vector) -> Vector {
    let fields = frame.fields;
    let coefficient = coefficient(fields.density[i], fields.rest_density[i]);
    gradient * (-fields.pressure[i] * coefficient)
}
