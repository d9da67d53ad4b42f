//! The social force between agents, directly from Eq. 18.

use sandbox::engine::forces::social::SocialForce;
use sandbox::engine::math::{Vector, direction};

/// V₀ e^(−b/σ): the potential whose negative gradient with respect to r_ij is the force.
pub fn potential(social: &SocialForce, r_ij: Vector, v_ij: Vector) -> f64 {
    let s = v_ij * social.anticipation_time;
    let l = r_ij.norm() + (r_ij + s).norm();
    let b = 0.5 * (l * l - s.norm_squared()).max(0.0).sqrt();
    social.agent_strength * (-b / social.agent_range).exp()
}

/// The negative gradient of [`potential`] in closed form, without the field of view; zero where the ellipse
/// degenerates.
pub fn force(social: &SocialForce, r_ij: Vector, v_ij: Vector) -> Vector {
    let s = v_ij * social.anticipation_time;
    let ahead = r_ij + s;
    let l = r_ij.norm() + ahead.norm();
    let twice_b_squared = l * l - s.norm_squared();
    if twice_b_squared <= 0.0 {
        return Vector::zeros();
    }
    let b = 0.5 * twice_b_squared.sqrt();
    let steepness = social.agent_strength / social.agent_range;
    let size = steepness * (-b / social.agent_range).exp() * l / (4.0 * b);
    (direction(r_ij) + direction(ahead)) * size
}

/// The condition number of [`force`]: on a collision course, b is the root of a difference of nearly equal numbers.
pub fn condition(social: &SocialForce, r_ij: Vector, v_ij: Vector) -> f64 {
    let s = v_ij * social.anticipation_time;
    let l = r_ij.norm() + (r_ij + s).norm();
    l * l / (l * l - s.norm_squared()).max(0.0)
}

/// The weight of agent j for agent i: 1 within 100° of the direction of motion or if i stands still, else ½.
pub fn weight(v_i: Vector, r_ij: Vector) -> f64 {
    let cosine = -v_i.dot(&r_ij) / (v_i.norm() * r_ij.norm());
    if cosine < 100_f64.to_radians().cos() {
        0.5
    } else {
        1.0
    }
}
