//! One walk over an agent's near neighbours for all forces that sum over them (Eqs. 7, 11, 22):
//! fetching a neighbour and its distance costs more than any one force.

use super::{contact, pressure, viscosity};
use crate::frame::Frame;
use crate::math::Vector;

/// Which sums a profile needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    /// Eq. 11.
    pub pressure: bool,
    /// Eq. 7.
    pub viscosity: bool,
    /// Eq. 22.
    pub contact: bool,
}

/// The sums over the neighbours of one agent, before they are scaled to accelerations; zero where
/// not wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSums {
    /// Σ_j m_j (p_i + p_j)/(2ρ_j) ∇W.
    pub pressure: Vector,
    /// ∇²v_i = Σ_j m_j (v_j − v_i)/ρ_j ∇²W.
    pub viscosity: Vector,
    /// Σ_j max(0, D_i + D_j − |r_ij|) r̂_ij, metres.
    pub contact: Vector,
}

impl Wanted {
    /// The sums for agent `i` of a frozen frame; `h` is the support radius.
    pub fn sums(self, frame: &Frame, i: usize, h: f64) -> PairSums {
        let (agents, fields) = (frame.agents, frame.fields);
        let (r_i, v_i, radius_i) = (agents.position[i], agents.velocity[i], agents.radius[i]);
        let [mut pressure, mut viscosity, mut contact] = [Vector::zeros(); 3];
        for &j in frame.neighbors.near(i) {
            let j = j as usize;
            let r_ij = r_i - agents.position[j];
            if self.pressure {
                let p_sum = fields.pressure[i] + fields.pressure[j];
                pressure += pressure::of_neighbor(r_ij, fields.volume[j], p_sum, h);
            }
            if self.viscosity {
                let dv = agents.velocity[j] - v_i;
                viscosity += viscosity::of_neighbor(r_ij, fields.volume[j], dv, h);
            }
            if self.contact {
                contact += contact::of_neighbor(r_ij, radius_i + agents.radius[j]);
            }
        }
        PairSums {
            pressure,
            viscosity,
            contact,
        }
    }
}
