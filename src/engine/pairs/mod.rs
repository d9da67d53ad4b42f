//! Sums over pairs of agents, for eight agents i at a time, in the SIMD vectors that the processor has. The only
//! module that names fearless_simd.
//!
//! A dense scene spends nearly all of its time here. Agents that are close together (see
//! [`Clusters`](crate::neighbors::Clusters)) share their neighbors, so the sums of eight agents are computed
//! together, from data packed in [`Columns`]. Each summand over listed neighbors is a [`PairSum`], defined with its
//! equation in [`density`](crate::density) (Eq. 9), [`near`](crate::forces::near) (Eqs. 7, 11 and 22),
//! [`virial`](crate::forces::virial) and [`walking`](crate::forces::walking);
//! [`social`](crate::forces::social) has a loop of its own (Eq. 18). Each agent is included in its own sums: it
//! adds to its own density, but exerts no force on itself.

mod columns;
mod real;
mod sums;
mod vectors;

pub use columns::{Bodies, Columns, Reach};
pub use fearless_simd::{Simd, dispatch, f32x8, f64x8, mask32x8, mask64x8, prelude, u8x64, u32x8};
pub use real::{LANES, Lanes, Mask, Real};
pub use sums::{
    PairSum, add_pairs, add_quotients, coordinates, first_lanes, lanes_from, load, seen_from,
    splat, spread, store,
};
pub use vectors::{VARIABLE, Vectors, level};

use crate::agents::Agents;
use crate::math::Vector;

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

/// The crowd, packed for sums over pairs.
#[derive(Debug, Clone)]
pub enum Packed {
    /// In [`Precision::Double`].
    Double(Columns<f64>),
    /// In [`Precision::Mixed`].
    Mixed(Columns<f32>),
}

/// Evaluates `$body` with `$columns` bound to the columns of either precision.
macro_rules! each {
    ($packed:expr, $columns:ident => $body:expr) => {
        match $packed {
            $crate::pairs::Packed::Double($columns) => $body,
            $crate::pairs::Packed::Mixed($columns) => $body,
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
        each!(self, columns => columns.bodies.x.is_empty())
    }

    /// Removes all agents.
    pub fn clear(&mut self) {
        each!(self, columns => columns.bodies.x.clear());
    }

    /// Packs the bodies of all agents. Coordinates may wrap with a period of twice `extent` meters (see
    /// [`Clusters::extent`](crate::neighbors::Clusters::extent)).
    pub fn take_bodies(
        &mut self,
        agents: &Agents,
        extent: f64,
        way: Vector,
        reach: impl Fn(usize) -> Reach + Sync,
    ) {
        match self {
            Self::Double(columns) => columns.take_bodies(agents, 1.0, way, reach),
            Self::Mixed(columns) => {
                let unit = extent / f64::from(1_u32 << 31);
                columns.take_bodies(agents, unit, way, reach);
            }
        }
    }

    /// Packs the directions of preferred velocities, one per agent.
    pub fn take_headings(&mut self, wishes: &[Vector]) {
        each!(self, columns => columns.bodies.take_headings(wishes));
    }

    /// Packs the positions and velocities of all agents.
    pub fn take_motions(&mut self, agents: &Agents) {
        each!(self, columns => columns.bodies.take_motions(agents));
    }
}
