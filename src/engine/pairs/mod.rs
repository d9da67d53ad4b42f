//! Quantities computed for eight pairs of agents at a time: density (Eq. 9), pressure (Eq. 11), viscosity (Eq. 7)
//! and contact (Eq. 22) between near agents; social forces (Eq. 18) and possible RVO collisions between agents
//! farther apart. The only module that names fearless_simd.
//!
//! A dense scene spends nearly all of its time here. Agents that are close together (see
//! [`Clusters`](crate::engine::neighbors::Clusters)) share their neighbors, so the sums of eight agents are computed
//! together, in the SIMD vectors that the processor has. Each agent is included in its own sums: it adds its own
//! share to the density, and no force.

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

/// The precision of sums over pairs; everything else is in double precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// Double precision throughout.
    Double,
    /// Distances from fixed-point coordinates, exact to about 10⁻⁹ m; products and sums in single precision. The
    /// error of an acceleration is at most 10⁻⁵ of the sum of the magnitudes of its terms, as long as agents are at
    /// least half a millimeter apart. For social forces, also |r_ij + T v_ij| must be at least 5 cm.
    #[default]
    Mixed,
}

/// Factors that turn the sums over the near neighbors of a block's agents into accelerations; 0 for an agent that
/// does not feel the force.
#[derive(Debug, Clone, PartialEq)]
pub struct PairCoefficients {
    /// Factor of −Σ_j m_j (p_i + p_j)/(2ρ_j) ∇W, Eq. 11: 1/ρ_i.
    pub pressure: [f64; BLOCK],
    /// Factor of Σ_j m_j (v_j − v_i)/ρ_j ∇²W, Eq. 7: μ/ρ_i.
    pub viscosity: [f64; BLOCK],
    /// Factor of Σ_j max(0, D_i + D_j − |r_ij|) r̂_ij, Eq. 22: K^ag/m_i.
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

/// The crowd, packed for sums over pairs.
#[derive(Debug, Clone)]
pub enum Packed {
    /// In [`Precision::Double`].
    Double(Columns<f64>),
    /// In [`Precision::Mixed`].
    Mixed(Columns<f32>),
}

/// The sums that the profiles of a scene read; other sums may be skipped.
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
    /// Whether any sum is wanted.
    pub fn any(self) -> bool {
        self.pressure || self.viscosity || self.contact
    }

    /// The sums that either wants.
    pub fn with(self, other: Self) -> Self {
        Self {
            pressure: self.pressure || other.pressure,
            viscosity: self.viscosity || other.viscosity,
            contact: self.contact || other.contact,
        }
    }
}

/// Evaluates `$body` with `$columns` bound to the columns of either precision.
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
    /// An empty crowd.
    pub fn new(precision: Precision) -> Self {
        match precision {
            Precision::Double => Self::Double(Columns::default()),
            Precision::Mixed => Self::Mixed(Columns::default()),
        }
    }

    /// Whether no agents are packed.
    pub fn is_empty(&self) -> bool {
        each!(self, columns => columns.is_empty())
    }

    /// Removes all agents.
    pub fn clear(&mut self) {
        each!(self, columns => *columns = Columns::default());
    }

    /// Packs the bodies of all agents. Coordinates may wrap with a period of twice `extent` meters (see
    /// [`Clusters::extent`](crate::engine::neighbors::Clusters::extent)); `support` returns the h of an agent in
    /// meters.
    pub fn take_bodies(&mut self, agents: &Agents, extent: f64, support: impl Fn(usize) -> f64) {
        match self {
            Self::Double(columns) => columns.take_bodies(agents, 1.0, support),
            Self::Mixed(columns) => {
                columns.take_bodies(agents, extent / f64::from(1_u32 << 31), support);
            }
        }
    }

    /// The accelerations of a block's agents by their near neighbors, m/s².
    pub fn accelerations(
        &self,
        block: &ClusterBlock,
        coefficients: &PairCoefficients,
        wanted: Wanted,
        out: &mut [Vector],
    ) {
        each!(self, columns => columns.accelerations(block, coefficients, wanted, out));
    }

    /// Adds the social forces on `agents`, which are one cluster, times their coefficients, m/s². `runs` contain all
    /// agents in reach, and some out of reach.
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
