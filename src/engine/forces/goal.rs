//! The goal force (§5.3.1, Eq. 17) and the preferred velocity.
//!
//! Plain form: `goal_force` and `preferred_velocity` in `examples/paper.rs`.

use std::ops::Range;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::forces::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::limits::STRONGEST;
use crate::math::{Vector, direction};
use crate::neighbors::BLOCK;
use crate::pairs::{dispatch, level};

/// Parameters of Eq. 17.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct GoalForce {
    /// K^goal (Eq. 17): the strength of the goal force. Higher: agents push harder toward their goals. Above about 40
    /// the paper's time step is too long.
    #[schemars(range(min = 0, max = STRONGEST))]
    pub goal_scale: f64,
    /// τ (Eq. 17), seconds: the time in which the goal force corrects the velocity. Longer: agents respond more slowly
    /// and push less. Below about 0.013 s the paper's time step is too long.
    #[schemars(range(min = 1e-6, max = 1e6))]
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
    /// K^goal/τ, 1/s.
    pub fn rate(&self) -> f64 {
        self.goal_scale / self.relaxation_time
    }

    /// The friction of the goal force.
    pub fn rates(&self, of: &Extremes) -> Rates {
        Rates {
            correction: self.rate() / of.mass,
            ..Rates::default()
        }
    }

    /// Eq. 17, divided by the mass, for each of `agents`, which are of one block.
    #[inline]
    pub fn accelerations(
        &self,
        frame: &Frame,
        agents: Range<usize>,
        mut take: impl FnMut(usize, Vector),
    ) {
        let rate = self.rate();
        let preferred = &frame.fields.preferred_velocity[agents.clone()];
        let velocity = &frame.agents.velocity[agents.clone()];
        let mass = &frame.agents.mass[agents.clone()];
        let mut all = [Vector::zeros(); BLOCK];
        let all = &mut all[..mass.len()];
        dispatch!(level(), _simd => accelerate(rate, (preferred, velocity, mass), all));
        for (i, &acceleration) in agents.zip(&*all) {
            take(i, acceleration);
        }
    }
}

#[inline(always)]
fn accelerate(
    rate: f64,
    (preferred, velocity, mass): (&[Vector], &[Vector], &[f64]),
    all: &mut [Vector],
) {
    let agents = preferred.iter().zip(velocity).zip(mass);
    for (acceleration, ((wish, v), m)) in all.iter_mut().zip(agents) {
        *acceleration = (wish - v) * (rate / m);
    }
}

/// v^pref: `preferred_speed` (m/s) straight toward the goal, zero at the goal.
#[inline]
pub fn preferred_velocity(position: Vector, goal: Vector, preferred_speed: f64) -> Vector {
    direction(goal - position) * preferred_speed
}
