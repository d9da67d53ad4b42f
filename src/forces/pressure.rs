//! SPH pressure (§3.3, §4.3, Eqs. 11 and 12, divided by the density as in Eq. 2).

use super::pairs::PairSums;
use crate::frame::Frame;
use crate::kernel;
use crate::math::Vector;

/// Does the agent feel pressure? Not below its rest density (§5.2).
pub fn is_felt(frame: &Frame, i: usize) -> bool {
    frame.fields.density[i] >= frame.fields.rest_density[i]
}

/// Eq. 11, one neighbour: `volume` m_j/ρ_j, `p_sum` p_i + p_j; a negative pressure stays in.
#[inline]
pub fn of_neighbor(r_ij: Vector, volume: f64, p_sum: f64, h: f64) -> Vector {
    kernel::pressure_gradient(r_ij, h) * (0.5 * volume * p_sum)
}

/// Eq. 11, the agents' part, over ρ_i.
pub fn from_agents(frame: &Frame, i: usize, sums: &PairSums) -> Vector {
    -sums.pressure / frame.fields.density[i]
}

/// Eq. 12 over all walls in reach, over ρ_i.
pub fn from_walls(frame: &Frame, i: usize) -> Vector {
    if !is_felt(frame, i) {
        return Vector::zeros();
    }
    let fields = frame.fields;
    fields.wall_gradient[i] * (-fields.pressure[i] / fields.density[i])
}
