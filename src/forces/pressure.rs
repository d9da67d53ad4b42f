//! SPH pressure (§3.3, §4.3, Eqs. 11 and 12, divided by the density as in Eq. 2).

use crate::frame::Frame;
use crate::math::Vector;
use crate::pairs::PairSums;

/// Does the agent feel pressure? Not below its rest density (§5.2).
fn is_felt(frame: &Frame, i: usize) -> bool {
    frame.fields.density[i] >= frame.fields.rest_density[i]
}

/// Eq. 11, the agents' part, over ρ_i; a neighbour's negative pressure stays in the sum.
pub fn from_agents(frame: &Frame, i: usize, sums: &PairSums) -> Vector {
    if !is_felt(frame, i) {
        return Vector::zeros();
    }
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
