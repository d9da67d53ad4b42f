//! The social force between agents as Eq. 18 has it.

use sandbox::engine::forces::social::SocialForce;
use sandbox::engine::math::{Vector, direction};

/// V₀ e^(−b/σ): the potential whose negative gradient over r_ij is the force.
pub fn potential(social: &SocialForce, r_ij: Vector, v_ij: Vector) -> f64 {
    let s = v_ij * social.anticipation_time;
    let l = r_ij.norm() + (r_ij + s).norm();
    let b = 0.5 * (l * l - s.norm_squared()).max(0.0).sqrt();
    social.agent_strength * (-b / social.agent_range).exp()
}

/// Its negative gradient in closed form, without the field of view; zero where the ellipse degenerates.
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

/// How many times larger the relative error of [`force`] is than that of a number: on collision course b
/// is the root of a difference of nearly equal numbers.
pub fn condition(social: &SocialForce, r_ij: Vector, v_ij: Vector) -> f64 {
    let s = v_ij * social.anticipation_time;
    let l = r_ij.norm() + (r_ij + s).norm();
    l * l / (l * l - s.norm_squared()).max(0.0)
}

/// What agent i feels of j: 1 within 100° of where it walks and if it stands, ½ behind.
pub fn weight(v_i: Vector, r_ij: Vector) -> f64 {
    let cosine = -v_i.dot(&r_ij) / (v_i.norm() * r_ij.norm());
    if cosine < 100_f64.to_radians().cos() {
        0.5
    } else {
        1.0
    }
}
