//! SPH viscosity (§3.3, Eq. 7, times μ and divided by the density as in Eq. 2).
//!
//! Plain form: `viscosity_by_agent` and `laplacian` in `examples/paper.rs`.

use std::f64::consts::PI;
use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::forces::rates::Rates;
use crate::frame::Frame;
use crate::limits::STRONGEST;
use crate::pairs::prelude::*;
use crate::pairs::{Columns, Lanes, Real, Simd, add_quotients, lanes_from, load, splat};

/// The viscosity force of one profile.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Viscosity {
    /// μ (Eq. 2), 1/s: the viscosity. Higher: neighbors move together, and a crowd calms down sooner after a push;
    /// 0: none. Above about 40 the paper's time step is too long.
    #[serde(rename = "viscosity")]
    #[schemars(range(min = 0, max = STRONGEST))]
    pub coefficient: f64,
}

impl Viscosity {
    /// The drag by neighbors.
    pub fn rates(&self) -> Rates {
        Rates {
            viscosity: self.coefficient,
            ..Rates::default()
        }
    }

    /// Adds the coefficient μ/ρ_i of the sum in Eq. 7, times `weight`, for each of `agents`.
    pub fn add_coefficients(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        weight: f64,
        coefficients: &mut [f64],
    ) {
        let density = &frame.fields.density[agents];
        add_quotients(self.coefficient * weight, density, coefficients);
    }
}

/// Eq. 7 for eight agents i: Σ_j m_j (v_j − v_i)/ρ_j ∇²W, times a coefficient.
pub struct FromAgents<R: Real, S: Simd> {
    /// The coefficient times Eq. 15, without 1 − r/h.
    drag: Lanes<R, S>,
    velocity: [Lanes<R, S>; 2],
    change: [Lanes<R, S>; 2],
}

impl<R: Real, S: Simd> FromAgents<R, S> {
    /// The sum for the agents from `start` on, with their coefficients.
    #[inline(always)]
    pub fn new(simd: S, columns: &Columns<R>, start: usize, coefficients: &[f64]) -> Self {
        let bodies = &columns.bodies;
        let per_h = load(simd, &bodies.per_support, start);
        let drag = lanes_from::<R, S>(simd, coefficients) * (per_h * per_h * per_h) * per_h;
        Self {
            drag: drag * splat::<R, S>(simd, 360.0 / (29.0 * PI)),
            velocity: [
                load(simd, &bodies.velocity_x, start),
                load(simd, &bodies.velocity_y, start),
            ],
            change: [splat::<R, S>(simd, 0.0); 2],
        }
    }

    /// Adds an agent j with velocity `v_j`; `weight` is m_j/ρ_j (1 − r/h).
    #[inline(always)]
    pub fn add(&mut self, weight: Lanes<R, S>, v_j: [Lanes<R, S>; 2]) {
        self.change[0] = weight.mul_add_precise(v_j[0] - self.velocity[0], self.change[0]);
        self.change[1] = weight.mul_add_precise(v_j[1] - self.velocity[1], self.change[1]);
    }

    /// `others` plus the sum.
    #[inline(always)]
    pub fn added_to(self, [x, y]: [Lanes<R, S>; 2]) -> [Lanes<R, S>; 2] {
        let [change_x, change_y] = self.change;
        [
            self.drag.mul_add_precise(change_x, x),
            self.drag.mul_add_precise(change_y, y),
        ]
    }
}
