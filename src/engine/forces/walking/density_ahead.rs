//! The law of the density ahead: agents walk slower the denser the crowd before them.
//!
//! The speed is that of U. Weidmann, Transporttechnik der Fussgänger (1993): s = s₀ (1 − e^(−γ (1/ρ − 1/ρ_jam))), with
//! γ = 1.913 and ρ_jam = 5.4 P/m². The density is that of the half disc ahead. An agent that leaves a crowd has free
//! space before it and walks freely, at the same ρ_i (Eq. 9) at which an agent in the crowd hardly moves.
//!
//! ρ^ahead = Σ_j m_j K(a, r), K = 315/(32 h³) max(0, a) (1 − r²/h²)³, with the distance a along the line ahead and r =
//! |r_ij| < h. K integrates to 1 over the half disc. It is zero at the agent's own place, so a sum without the agent
//! itself is not too low, as a half of Eq. 9 would be by the agent's own 4/(π h²) = 1.27 P/m². It is zero beside the
//! agent, so the speed does not jump when the agent turns. Walls add nothing: at most half of the view of an agent at a
//! wall is empty, and its density is lower by that fraction. Agents that want to walk against agent i count max(0, 1 +
//! 4 ê_i·ê_j), and not at all if they come straight towards it (see [`headway`](super::headway)).

use libm::exp;
use std::f64::consts::LN_2;
use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Walkers;
use super::headway::AGAINST;
use crate::forces::rates::{Extremes, Rates};
use crate::limits::HIGHEST_DENSITY;
use crate::neighbors::Run;
use crate::pairs::prelude::*;
use crate::pairs::{Bodies, Lanes, PairSum, Real, Simd, add_pairs, load, splat, spread};

/// Parameters of the law of the density ahead.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct DensityAhead {
    /// The jam density (`density-ahead`), P/m²: agents stand before a crowd of this density. Higher: faster crowds.
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY))]
    pub jam_density: f64,
    /// Weidmann's γ (`density-ahead`), P/m²: how soon agents slow down. Higher: faster at all densities below the jam.
    #[schemars(range(min = 0.01, max = HIGHEST_DENSITY))]
    pub slowing_density: f64,
}

impl Default for DensityAhead {
    fn default() -> Self {
        Self {
            jam_density: 5.4,
            slowing_density: 1.913,
        }
    }
}

/// The integral of a (1 − r²/h²)³ over the half disc is h³ over this.
const NORM: f64 = 315.0 / 32.0;

impl DensityAhead {
    /// s^law, m/s: the speed of an agent with preferred speed `free`, m/s, at this density ahead, P/m².
    pub fn speed(&self, free: f64, density: f64) -> f64 {
        let gap = 1.0 / density - 1.0 / self.jam_density;
        let share = 1.0 - exp(-self.slowing_density * gap);
        free * share.max(0.0)
    }

    /// K, 1/m², of an agent at a distance of `along` meters along the line ahead and `across` meters beside it.
    pub fn kernel(along: f64, across: f64, h: f64) -> f64 {
        let rest = 1.0 - (along * along + across * across) / (h * h);
        NORM / (h * h * h) * along.max(0.0) * rest.max(0.0).powi(3)
    }

    /// |∇ρ^ahead| is at most ρ times the integral of |∂K/∂a|, about 4/h. ρ |ds/dρ| = s₀ γ/ρ e^(−γ (1/ρ − 1/ρ_jam)) is
    /// largest at ρ = γ, or at ρ_jam if that is lower.
    pub(super) fn rates(&self, of: &Extremes) -> Rates {
        let ratio = self.slowing_density / self.jam_density;
        let most = if ratio < 1.0 { exp(ratio - 1.0) } else { ratio };
        Rates {
            steepness: of.speed * most * 4.0 / of.sph.support_radius,
            ..Rates::default()
        }
    }

    /// s_i − s_i^law, m/s. `runs` contain all agents in view, and some out of view.
    #[inline(always)]
    pub(super) fn lost_speeds<R: Real, S: Simd>(
        &self,
        simd: S,
        bodies: &Bodies<R>,
        walkers: &Walkers<R, S>,
        runs: &[Run],
    ) -> Lanes<R, S> {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let per_h: Lanes<R, S> = load(simd, &bodies.per_support, walkers.start);
        let per_h_squared = per_h * per_h;
        let mut sum = Ahead {
            columns: [&bodies.mass, &bodies.heading_x, &bodies.heading_y],
            backwards: walkers.backwards,
            scale: per_h_squared * splat::<R, S>(simd, -bodies.unit * bodies.unit),
            sum: zero,
        };
        add_pairs(simd, bodies, (walkers.start, runs), &mut sum);
        let norm = splat::<R, S>(simd, NORM * bodies.unit);
        let density = sum.sum * per_h_squared * per_h * norm;
        // −γ (1/ρ − 1/ρ_jam)/ln 2, at most 0.
        let jammed = splat::<R, S>(simd, self.slowing_density / self.jam_density / LN_2);
        let slowing = splat::<R, S>(simd, self.slowing_density / LN_2);
        let power = (jammed - slowing / density).min(zero);
        // Without agents ahead the share is 1, to the last bit.
        let share = one - R::exp2(simd, power);
        walkers.speed - walkers.speed * share
    }
}

/// ρ^ahead for eight agents i.
struct Ahead<'a, R: Real, S: Simd> {
    /// m_j and ê_j of all agents.
    columns: [&'a [R]; 3],
    /// −ê_i.
    backwards: [Lanes<R, S>; 2],
    /// −(meters per coordinate unit)²/h².
    scale: Lanes<R, S>,
    /// The sum without the factor 315/(32 h³), in coordinate units.
    sum: Lanes<R, S>,
}

impl<'a, R: Real, S: Simd> PairSum<R, S> for Ahead<'a, R, S> {
    type Run = [&'a [R]; 3];

    #[inline(always)]
    fn run(&self, run: Range<usize>) -> [&'a [R]; 3] {
        self.columns.map(|column| &column[run.clone()])
    }

    #[inline(always)]
    fn add(
        &mut self,
        simd: S,
        [dx, dy]: [Lanes<R, S>; 2],
        [mass, heading_x, heading_y]: [&'a [R]; 3],
        j: usize,
    ) {
        let (zero, one) = (splat::<R, S>(simd, 0.0), splat::<R, S>(simd, 1.0));
        let along = dy
            .mul_add_precise(self.backwards[1], dx * self.backwards[0])
            .max(zero);
        let squared = dy.mul_add_precise(dy, dx * dx);
        let rest = squared.mul_add_precise(self.scale, one).max(zero);
        let [x, y] = self.backwards;
        let e_x = spread::<R, S>(simd, heading_x[j]);
        let e_y = spread::<R, S>(simd, heading_y[j]);
        let against = e_y.mul_add_precise(y, e_x * x).max(zero);
        let counts = against
            .mul_add_precise(splat::<R, S>(simd, -AGAINST), one)
            .max(zero);
        let weighted = spread::<R, S>(simd, mass[j]) * along * rest * counts;
        self.sum = weighted.mul_add_precise(rest * rest, self.sum);
    }
}
