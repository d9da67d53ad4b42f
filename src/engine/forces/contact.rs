//! Contact between discs, and of discs with walls (§5.4, Eqs. 22 and 23).

use std::ops::Range;

use crate::engine::frame::Frame;
use crate::engine::math::Vector;

/// Distance in meters below which a center is taken to lie on a wall. Coordinates up to 10⁶ m round by less;
/// without it, rounding would decide the direction of the push.
const ON_THE_WALL: f64 = 1e-9;

/// Stiffnesses of one profile; `None` disables that contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// K^ag.
    pub agent_stiffness: Option<f64>,
    /// K^obs.
    pub wall_stiffness: Option<f64>,
}

/// Adds the coefficient of the sum in Eq. 22, `stiffness` divided by the mass, for each of `agents`.
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

/// Eq. 23, summed over all of `walls` that overlap the disc and divided by the mass. Both faces of a wall push,
/// and a corner counts once for each of its edges. An agent whose center is on a wall is pushed along the
/// outward normal.
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
