//! SPH pressure (§3.3, §4.3, Eqs. 11 and 12, divided by the density as in Eq. 2).

use crate::frame::Frame;
use crate::kernel;
use crate::math::Vector;

/// Does the agent feel pressure? Not below its rest density (§5.2).
fn feels_pressure(frame: &Frame, i: usize) -> bool {
    frame.fields.density[i] >= frame.fields.rest_density[i]
}

/// Eq. 11, the agents' part, over ρ_i; a neighbour's negative pressure stays in the sum.
pub fn from_agents(frame: &Frame, i: usize, h: f64) -> Vector {
    if !feels_pressure(frame, i) {
        return Vector::zeros();
    }
    let fields = frame.fields;
    let p_i = fields.pressure[i];
    let sum = frame.near(i, h).fold(Vector::zeros(), |sum, (j, r_ij)| {
        let scale = fields.volume[j] * 0.5 * (p_i + fields.pressure[j]);
        sum + kernel::pressure_gradient(r_ij, h) * scale
    });
    -sum / fields.density[i]
}

/// Eq. 12 over all walls in reach, over ρ_i.
pub fn from_walls(frame: &Frame, i: usize) -> Vector {
    if !feels_pressure(frame, i) {
        return Vector::zeros();
    }
    let fields = frame.fields;
    fields.wall_gradient[i] * (-fields.pressure[i] / fields.density[i])
}
