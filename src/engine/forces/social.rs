//! Social force: avoidance of agents and walls (§5.3.1, Eqs. 18 and 19).

use crate::engine::frame::Frame;
use crate::engine::geometry::WallPart;
use crate::engine::math::{Vector, direction};
use crate::engine::neighbors::BLOCK;
use crate::engine::pairs::SocialLaw;

/// Parameters of Eqs. 18 and 19 and of the field of view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SocialForce {
    /// V₀.
    pub agent_strength: f64,
    /// σ, meters.
    pub agent_range: f64,
    /// T, seconds.
    pub anticipation_time: f64,
    /// U₀.
    pub wall_strength: f64,
    /// R, meters.
    pub wall_range: f64,
    /// Agents and walls farther away are ignored, meters.
    pub avoidance_radius: f64,
    /// Agents are ignored beyond the distance at which their force on an agent of mass 1 is certainly below this,
    /// m/s². 0 disables this cutoff.
    pub avoidance_tolerance: f64,
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
            avoidance_tolerance: 0.0,
        }
    }
}

/// Half the field of view: neighbors within this angle of the walking direction have full weight.
const FIELD_OF_VIEW: f64 = 100.0 / 180.0 * std::f64::consts::PI;
/// Weight of a neighbor outside the field of view.
const UNSEEN_WEIGHT: f64 = 0.5;

impl SocialForce {
    /// Eq. 18, summed over all agents in range and divided by the mass.
    pub fn from_agents(&self, frame: &Frame, i: usize) -> Vector {
        let mut coefficients = [0.0; BLOCK];
        coefficients[i % BLOCK] = 1.0 / frame.agents.mass[i];
        let mut accelerations = [Vector::zeros(); BLOCK];
        self.add_from_agents(frame, i / BLOCK, &coefficients, &mut accelerations);
        accelerations[i % BLOCK]
    }

    /// Adds Eq. 18, summed over all agents in range, times `coefficients`, to the accelerations of the agents of
    /// block `b`.
    pub fn add_from_agents(
        &self,
        frame: &Frame,
        b: usize,
        coefficients: &[f64; BLOCK],
        accelerations: &mut [Vector],
    ) {
        let law = self.law();
        let mut runs = Vec::new();
        for (agents, _) in frame.neighbors.near().block(b).clusters() {
            let own = agents.start % BLOCK..agents.start % BLOCK + agents.len();
            let coefficients = &coefficients[own.clone()];
            if coefficients.iter().all(|&coefficient| coefficient == 0.0) {
                continue;
            }
            let around = |radius, runs: &mut Vec<_>| {
                let positions = &frame.agents.position;
                let neighbors = frame.neighbors;
                neighbors.around_cluster(agents.clone(), positions, radius, runs);
            };
            around(self.avoidance_radius, &mut runs);
            if self.avoidance_tolerance > 0.0 {
                let radius = self.reach(frame.relative_speed(agents.clone(), &runs));
                if radius < self.avoidance_radius {
                    around(radius, &mut runs);
                }
            }
            frame
                .packed
                .add_social(&law, (agents, &runs), coefficients, &mut accelerations[own]);
        }
    }

    /// The distance in meters beyond which every force is below the tolerance, if no relative speed exceeds
    /// `relative_speed`, m/s.
    ///
    /// With S = T `relative_speed` and r = |r_ij|, |r_ij + s| differs from r by at most S. So b² ≥ r (r − S), and
    /// the force, V₀/σ e^(−b/σ) (√q + 1/√q)/2 with q = |r_ij + s|/r, is at most 1.25 V₀/σ e^(−b/σ) for S ≤ ¾ r.
    pub fn reach(&self, relative_speed: f64) -> f64 {
        let ratio = 1.25 * self.agent_strength / (self.agent_range * self.avoidance_tolerance);
        let b = self.agent_range * ratio.max(1.0).ln();
        let s = self.anticipation_time * relative_speed;
        let beyond = 0.5 * (s + (s * s + 4.0 * b * b).sqrt());
        beyond.max(s / 0.75).min(self.avoidance_radius)
    }

    /// Eq. 18 in the form used by sums over pairs.
    fn law(&self) -> SocialLaw {
        SocialLaw {
            strength: self.agent_strength / self.agent_range,
            range: self.agent_range,
            anticipation_time: self.anticipation_time,
            radius: self.avoidance_radius,
            field_of_view: FIELD_OF_VIEW.cos(),
            unseen_weight: UNSEEN_WEIGHT,
        }
    }

    /// Eq. 19, summed over the walls in range whose free side the agent is on, divided by the mass.
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
                // A corner belongs to two walls but counts once: for the wall that ends there.
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

    /// Eq. 19 for `away` = r_i − r_k*.
    pub fn wall_force(&self, away: Vector) -> Vector {
        let strength =
            self.wall_strength / self.wall_range * (-away.norm() / self.wall_range).exp();
        direction(away) * strength
    }
}

/// Full weight inside the field of view; an agent at rest sees in all directions.
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
    fn what_lies_behind_counts_half_and_a_standing_agent_sees_all_round() {
        let walking = FieldOfView::new(Vector::new(1.0, 0.0));
        let at = |degrees: f64| Vector::new(degrees.to_radians().cos(), degrees.to_radians().sin());
        assert_eq!(walking.weight(at(99.9)), 1.0);
        assert_eq!(walking.weight(at(-99.9) * 3.0), 1.0);
        assert_eq!(walking.weight(at(100.1)), 0.5);
        assert_eq!(FieldOfView::new(Vector::zeros()).weight(at(180.0)), 1.0);
    }
}
