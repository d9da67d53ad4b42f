//! Contact between discs, and of discs with walls (§5.4, Eqs. 22 and 23).

use std::ops::Range;

use crate::engine::frame::Frame;
use crate::engine::math::Vector;

/// A center this near to a wall stands on it, meters: the rounding of coordinates up to 10⁶ m, which
/// would otherwise decide where the wall pushes.
const ON_THE_WALL: f64 = 1e-9;

/// Stiffnesses of one profile; `None` where that contact is switched off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// K^ag.
    pub agent_stiffness: Option<f64>,
    /// K^obs.
    pub wall_stiffness: Option<f64>,
}

/// Adds what each of `agents` multiplies the sum of Eq. 22 over all agents in contact with: `stiffness`
/// over the mass.
pub fn add_coefficients(
    frame: &Frame,
    agents: Range<usize>,
    stiffness: f64,
    coefficients: &mut [f64],
) {
    for (sum, &mass) in coefficients.iter_mut().zip(&frame.agents.mass[agents]) {
        *sum += stiffness / mass;
    }
}

/// Eq. 23 over every edge of `walls` that overlaps the disc, both faces, a corner once for each of its
/// edges, over the mass; a center on a wall is pushed along the outward normal.
pub fn from_walls(frame: &Frame, i: usize, walls: &[u32], stiffness: f64) -> Vector {
    let agents = frame.agents;
    let (r_i, radius) = (agents.position[i], agents.radius[i]);
    let mut force = Vector::zeros();
    for &k in walls {
        let wall = frame.walls.wall(k);
        let away = r_i - wall.nearest_point(r_i).point;
        let distance = away.norm();
        if distance < radius {
            let push = if distance > ON_THE_WALL {
                away / distance
            } else {
                wall.normal
            };
            force += push * (radius - distance);
        }
    }
    force * (stiffness / agents.mass[i])
}
