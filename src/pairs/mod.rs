//! Sums over pairs of near agents: density (Eq. 9), pressure (Eq. 11), viscosity (Eq. 7) and contact
//! (Eq. 22). The only place that names fearless_simd.
//!
//! Nearly all of the time of a dense scene goes here. Neighbours are neighbours in memory too (see
//! [`Chunks`]), so they are read eight at a time, in whatever vectors the processor has; lanes are
//! eight everywhere, and the bits the same. An agent is in its own sums, where it adds what it should:
//! its own density, and no force.

mod columns;
mod kernels;
mod real;

pub use columns::Columns;
pub use real::{LANES, Real};

use std::ops::Range;

use fearless_simd::{Level, dispatch};

use crate::agents::Agents;
use crate::math::Vector;
use crate::neighbors::Chunks;

/// The numbers in which sums over pairs are taken; everything else is double.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// All in double precision.
    Double,
    /// Distances from fixed-point coordinates, exact to some 10⁻⁹ m, products and sums in single
    /// precision: an acceleration is off by at most 10⁻⁵ of the magnitudes that it is a sum of, as long
    /// as agents are half a millimetre apart.
    #[default]
    Mixed,
}

/// Sums over the near neighbours of one agent, before they are scaled to accelerations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSums {
    /// Eq. 11: Σ_j m_j (p_i + p_j)/(2ρ_j) ∇W.
    pub pressure: Vector,
    /// Eq. 7: ∇²v_i = Σ_j m_j (v_j − v_i)/ρ_j ∇²W.
    pub viscosity: Vector,
    /// Eq. 22 over K^ag: Σ_j max(0, D_i + D_j − |r_ij|) r̂_ij, metres.
    pub contact: Vector,
}

impl Default for PairSums {
    fn default() -> Self {
        Self {
            pressure: Vector::zeros(),
            viscosity: Vector::zeros(),
            contact: Vector::zeros(),
        }
    }
}

/// The crowd as sums over pairs read it.
#[derive(Debug, Clone)]
pub enum Packed {
    /// [`Precision::Double`].
    Double(Columns<f64>),
    /// [`Precision::Mixed`].
    Mixed(Columns<f32>),
}

/// `$columns => $body` for whichever columns there are.
macro_rules! each {
    ($packed:expr, $columns:ident => $body:expr) => {
        match $packed {
            Packed::Double($columns) => $body,
            Packed::Mixed($columns) => $body,
        }
    };
}

impl Packed {
    /// Nobody yet.
    pub fn new(precision: Precision) -> Self {
        match precision {
            Precision::Double => Self::Double(Columns::default()),
            Precision::Mixed => Self::Mixed(Columns::default()),
        }
    }

    /// Packs everybody's body and motion; who is in one list is less than `extent` metres apart.
    pub fn take_bodies(&mut self, agents: &Agents, extent: f64) {
        match self {
            Self::Double(columns) => columns.take_bodies(agents, 1.0),
            Self::Mixed(columns) => columns.take_bodies(agents, extent / f64::from(1_u32 << 31)),
        }
    }

    /// Packs m_j/ρ_j and p_j, from m, ρ in P/m² and p.
    pub fn take_pressures(&mut self, mass: &[f64], density: &[f64], pressure: &[f64]) {
        each!(self, columns => columns.take_pressures(mass, density, pressure));
    }

    /// Eq. 9 without walls: Σ_j m_j W(r_ij) with j = i, P/m², for each agent of
    /// a block, with h in metres for each.
    pub fn densities(&self, chunks: &Chunks, block: (Range<usize>, &[f64]), out: &mut [f64]) {
        each!(self, columns => dispatch!(
            Level::new(),
            simd => kernels::densities(simd, columns, chunks, block, out)
        ));
    }

    /// The sums for each agent of a block, with h in metres for each.
    pub fn forces(&self, chunks: &Chunks, block: (Range<usize>, &[f64]), out: &mut [PairSums]) {
        each!(self, columns => dispatch!(
            Level::new(),
            simd => kernels::forces(simd, columns, chunks, block, out)
        ));
    }
}
