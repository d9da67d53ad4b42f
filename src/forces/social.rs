//! Social force: avoidance of agents and walls (§5.3.1, Eqs. 18 and 19).

use crate::frame::Frame;
use crate::geometry::WallPart;
use crate::math::{Vector, direction};

/// Parameters of Eqs. 18 and 19 and of the field of view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SocialForce {
    /// V₀.
    pub agent_strength: f64,
    /// σ, metres.
    pub agent_range: f64,
    /// T, seconds.
    pub anticipation_time: f64,
    /// U₀.
    pub wall_strength: f64,
    /// R, metres.
    pub wall_range: f64,
    /// Nobody farther away counts, metres.
    pub avoidance_radius: f64,
}

impl Default for SocialForce {
    fn default() -> Self {
        Self {
            agent_strength: 2.1,
            agent_range: 0.3,
            anticipation_time: 2.0,
            wall_strength: 2.1,
            wall_range: 0.1,
            avoidance_radius: 5.0,
        }
    }
}

/// Half the field of view: within this angle of the walking direction a neighbour counts fully.
const FIELD_OF_VIEW: f64 = 100.0 / 180.0 * std::f64::consts::PI;
/// What a neighbour outside the field of view counts.
const UNSEEN_WEIGHT: f64 = 0.5;

impl SocialForce {
    /// Eq. 18 over all agents in range, over the mass.
    pub fn from_agents(&self, frame: &Frame, i: usize) -> Vector {
        let v_i = frame.agents.velocity[i];
        let seen = FieldOfView::new(v_i);
        let force: Vector = frame
            .around(i, self.avoidance_radius)
            .map(|(j, r_ij)| {
                self.agent_force(r_ij, v_i - frame.agents.velocity[j]) * seen.weight(-r_ij)
            })
            .sum();
        force / frame.agents.mass[i]
    }

    /// Eq. 19 over the walls in range on whose free side the agent stands, over the mass.
    pub fn from_walls(&self, frame: &Frame, i: usize) -> Vector {
        let r_i = frame.agents.position[i];
        let seen = FieldOfView::new(frame.agents.velocity[i]);
        let force: Vector = frame
            .neighbors
            .far_walls(i)
            .iter()
            .filter_map(|&k| {
                let wall = frame.walls.wall(k);
                if !wall.faces(r_i) {
                    return None;
                }
                let nearest = wall.nearest_point(r_i);
                // A corner belongs to two walls and counts once: with the one that ends there.
                let before = frame.walls.wall(wall.previous);
                if nearest.part == WallPart::Start
                    && before.faces(r_i)
                    && before.nearest_point(r_i).part == WallPart::End
                {
                    return None;
                }
                let away = r_i - nearest.point;
                let in_range = away.norm() < self.avoidance_radius;
                in_range.then(|| self.wall_force(away) * seen.weight(-away))
            })
            .sum();
        force / frame.agents.mass[i]
    }

    /// V₀ e^(−b/σ): the potential whose negative gradient over r_ij is Eq. 18.
    pub fn agent_potential(&self, r_ij: Vector, v_ij: Vector) -> f64 {
        let s = v_ij * self.anticipation_time;
        let l = r_ij.norm() + (r_ij + s).norm();
        let b = 0.5 * (l * l - s.norm_squared()).max(0.0).sqrt();
        self.agent_strength * (-b / self.agent_range).exp()
    }

    /// Eq. 18 in closed form; zero where the ellipse degenerates (L² ≤ |s|²).
    pub fn agent_force(&self, r_ij: Vector, v_ij: Vector) -> Vector {
        let s = v_ij * self.anticipation_time;
        let ahead = r_ij + s;
        let l = r_ij.norm() + ahead.norm();
        let twice_b_squared = l * l - s.norm_squared();
        if twice_b_squared <= 0.0 {
            return Vector::zeros();
        }
        let b = 0.5 * twice_b_squared.sqrt();
        let strength =
            self.agent_strength / self.agent_range * (-b / self.agent_range).exp() * l / (4.0 * b);
        (direction(r_ij) + direction(ahead)) * strength
    }

    /// Eq. 19 for `away` = r_i − r_k*.
    pub fn wall_force(&self, away: Vector) -> Vector {
        let strength =
            self.wall_strength / self.wall_range * (-away.norm() / self.wall_range).exp();
        direction(away) * strength
    }
}

/// Full weight for what lies ahead; a standing agent sees all round.
struct FieldOfView {
    heading: Vector,
}

impl FieldOfView {
    fn new(velocity: Vector) -> Self {
        Self {
            heading: direction(velocity),
        }
    }

    fn weight(&self, towards: Vector) -> f64 {
        let ahead = self.heading.dot(&towards) >= FIELD_OF_VIEW.cos() * towards.norm();
        if ahead || self.heading == Vector::zeros() {
            1.0
        } else {
            UNSEEN_WEIGHT
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_agent_force_is_the_gradient_of_its_potential() {
        let social = SocialForce::default();
        let step = 1e-6;
        for k in 0..200 {
            let angle = f64::from(k) * 0.7;
            let r_ij = Vector::new(angle.cos(), angle.sin()) * (0.3 + 0.02 * f64::from(k % 50));
            let v_ij = Vector::new((1.3 * angle).sin(), (0.4 * angle).cos()) * 1.5;
            let slope = |along: Vector| {
                (social.agent_potential(r_ij + along * step, v_ij)
                    - social.agent_potential(r_ij - along * step, v_ij))
                    / (2.0 * step)
            };
            let expected = -Vector::new(slope(Vector::x()), slope(Vector::y()));
            let force = social.agent_force(r_ij, v_ij);
            assert!((force - expected).norm() < 1e-7 * (1.0 + expected.norm()));
        }
    }

    #[test]
    fn the_wall_force_is_the_gradient_of_its_potential() {
        let social = SocialForce::default();
        let potential = |d: f64| social.wall_strength * (-d / social.wall_range).exp();
        for d in [0.05, 0.24, 1.0] {
            let slope = (potential(d + 1e-6) - potential(d - 1e-6)) / 2e-6;
            let force = social.wall_force(Vector::new(0.0, d));
            assert!((force - Vector::new(0.0, -slope)).norm() < 1e-7);
        }
    }

    #[test]
    fn a_degenerate_ellipse_gives_no_force() {
        let social = SocialForce::default();
        let force = social.agent_force(Vector::zeros(), Vector::new(1.0, 0.0));
        assert_eq!(force, Vector::zeros());
        let passing = social.agent_force(Vector::new(-1.0, 0.0), Vector::new(1.0, 0.0));
        assert!(crate::math::is_finite(passing));
    }

    #[test]
    fn what_lies_behind_counts_half_and_a_standing_agent_sees_all_round() {
        let walking = FieldOfView::new(Vector::new(1.0, 0.0));
        let at = |degrees: f64| Vector::new(degrees.to_radians().cos(), degrees.to_radians().sin());
        assert_eq!(walking.weight(at(99.9)), 1.0);
        assert_eq!(walking.weight(at(-99.9) * 3.0), 1.0);
        assert_eq!(walking.weight(at(100.1)), 0.5);
        assert_eq!(FieldOfView::new(Vector::zeros()).weight(at(180.0)), 1.0);
    }
}
