//! Contact between discs, and of discs with walls (§5.4, Eqs. 22 and 23).

use crate::frame::Frame;
use crate::math::Vector;
use crate::pairs::PairSums;

/// A centre this near to a wall stands on it, metres: the rounding of coordinates up to 10⁶ m, which
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

/// Eq. 22 over all agents in contact, over the mass.
pub fn from_agents(frame: &Frame, i: usize, stiffness: f64, sums: &PairSums) -> Vector {
    sums.contact * (stiffness / frame.agents.mass[i])
}

/// Eq. 23 over every edge that overlaps the disc, both faces, a corner once for each of its edges,
/// over the mass; a centre on a wall is pushed along the outward normal.
pub fn from_walls(frame: &Frame, i: usize, stiffness: f64) -> Vector {
    let agents = frame.agents;
    let (r_i, radius) = (agents.position[i], agents.radius[i]);
    let mut force = Vector::zeros();
    for &k in frame.neighbors.near_walls(i) {
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
