//! What is worked out for eight pairs of agents at a time: density (Eq. 9), pressure (Eq. 11), viscosity
//! (Eq. 7) and contact (Eq. 22) of near ones, social forces (Eq. 18) and whom RVO may meet of those
//! farther away. The only place that names
//! fearless_simd.
//!
//! Nearly all of the time of a dense scene goes here. Agents who stand together (see
//! [`Clusters`](crate::engine::neighbors::Clusters)) share their neighbours, so the sums of eight are taken at
//! a time, in whatever vectors the processor has. An agent is in its own sums, where it adds what it
//! should: its own density, and no force.

mod columns;
mod kernels;
mod meeting;
mod real;
mod social;
mod vectors;

pub use columns::{Columns, Motion};
pub use meeting::{MovingDisc, Rings};
pub use real::{LANES, Real};
pub use social::SocialLaw;
pub use vectors::Vectors;

use std::ops::Range;

use crate::engine::agents::Agents;
use crate::engine::math::Vector;
use crate::engine::neighbors::{BLOCK, ClusterBlock};

/// The numbers in which sums over pairs are taken; everything else is double.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// All in double precision.
    Double,
    /// Distances from fixed-point coordinates, exact to some 10⁻⁹ m, products and sums in single
    /// precision: an acceleration is off by at most 10⁻⁵ of the magnitudes that it is a sum of, as long
    /// as agents are half a millimetre apart and, for social forces, nobody comes within 5 cm of the
    /// other's place in T seconds.
    #[default]
    Mixed,
}

/// What the sums over the near neighbours of the agents of a block are multiplied with to make
/// accelerations; 0 where an agent feels nothing of the kind.
#[derive(Debug, Clone, PartialEq)]
pub struct PairCoefficients {
    /// Of −Σ_j m_j (p_i + p_j)/(2ρ_j) ∇W, Eq. 11: 1/ρ_i.
    pub pressure: [f64; BLOCK],
    /// Of Σ_j m_j (v_j − v_i)/ρ_j ∇²W, Eq. 7: μ/ρ_i.
    pub viscosity: [f64; BLOCK],
    /// Of Σ_j max(0, D_i + D_j − |r_ij|) r̂_ij, Eq. 22: K^ag/m_i.
    pub contact: [f64; BLOCK],
}

impl Default for PairCoefficients {
    fn default() -> Self {
        Self {
            pressure: [0.0; BLOCK],
            viscosity: [0.0; BLOCK],
            contact: [0.0; BLOCK],
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

/// Which sums some profile of a scene reads; the others are not taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Wanted {
    /// Eq. 11.
    pub pressure: bool,
    /// Eq. 7.
    pub viscosity: bool,
    /// Eq. 22.
    pub contact: bool,
}

impl Wanted {
    /// Is any?
    pub fn any(self) -> bool {
        self.pressure || self.viscosity || self.contact
    }

    /// What either wants.
    pub fn with(self, other: Self) -> Self {
        Self {
            pressure: self.pressure || other.pressure,
            viscosity: self.viscosity || other.viscosity,
            contact: self.contact || other.contact,
        }
    }
}

/// `$columns => $body` for whichever columns there are.
macro_rules! each {
    ($packed:expr, $columns:ident => $body:expr) => {
        match $packed {
            $crate::engine::pairs::Packed::Double($columns) => $body,
            $crate::engine::pairs::Packed::Mixed($columns) => $body,
        }
    };
}

pub(crate) use each;

impl Default for Packed {
    fn default() -> Self {
        Self::new(Precision::default())
    }
}

impl Packed {
    /// Nobody yet.
    pub fn new(precision: Precision) -> Self {
        match precision {
            Precision::Double => Self::Double(Columns::default()),
            Precision::Mixed => Self::Mixed(Columns::default()),
        }
    }

    /// Nobody has been packed.
    pub fn is_empty(&self) -> bool {
        each!(self, columns => columns.is_empty())
    }

    /// Forgets everybody.
    pub fn clear(&mut self) {
        each!(self, columns => *columns = Columns::default());
    }

    /// Packs everybody's body; coordinates may wrap at twice `extent` metres (see
    /// [`Clusters::extent`](crate::engine::neighbors::Clusters::extent)), and `support` is the h of an agent in
    /// metres.
    pub fn take_bodies(&mut self, agents: &Agents, extent: f64, support: impl Fn(usize) -> f64) {
        match self {
            Self::Double(columns) => columns.take_bodies(agents, 1.0, support),
            Self::Mixed(columns) => {
                columns.take_bodies(agents, extent / f64::from(1_u32 << 31), support);
            }
        }
    }

    /// What the agents near each agent of a block do to it, m/s².
    pub fn accelerations(
        &self,
        block: &ClusterBlock,
        coefficients: &PairCoefficients,
        wanted: Wanted,
        out: &mut [Vector],
    ) {
        each!(self, columns => columns.accelerations(block, coefficients, wanted, out));
    }

    /// Adds the social forces on `agents`, of one cluster, times their coefficients, m/s²; `runs` have
    /// everybody in reach, and some who are not.
    pub fn add_social(
        &self,
        law: &SocialLaw,
        (agents, runs): (Range<usize>, &[Range<u32>]),
        coefficients: &[f64],
        out: &mut [Vector],
    ) {
        each!(self, columns => columns.add_social(law, (agents, runs), coefficients, out));
    }
}
