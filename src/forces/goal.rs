//! The goal force (§5.3.1, Eq. 17) and the preferred velocity.

use crate::frame::Frame;
use crate::math::{Vector, direction};

/// Parameters of Eq. 17.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GoalForce {
    /// K^goal.
    pub goal_scale: f64,
    /// τ, seconds.
    pub relaxation_time: f64,
}

impl Default for GoalForce {
    fn default() -> Self {
        Self {
            goal_scale: 1.0,
            relaxation_time: 0.5,
        }
    }
}

impl GoalForce {
    /// Eq. 17 over the mass.
    pub fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        let change = frame.fields.preferred_velocity[i] - frame.agents.velocity[i];
        change * (self.goal_scale / self.relaxation_time / frame.agents.mass[i])
    }
}

/// v^pref: `preferred_speed` (m/s) straight towards the goal, zero at the goal.
pub fn preferred_velocity(position: Vector, goal: Vector, preferred_speed: f64) -> Vector {
    direction(goal - position) * preferred_speed
}
