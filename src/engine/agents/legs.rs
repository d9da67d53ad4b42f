//! The legs of agents.

use super::Agents;
use crate::math::Vector;

impl Agents {
    /// Puts legs under the bodies of agents that have none yet, at `time`, seconds. Agents enter upright: the legs of
    /// those that walk are as fast as the body, and those of agents that still wait are at rest.
    pub fn stand(&mut self, time: f64) {
        let lack = self.legs.len()..self.len();
        self.legs.extend_from_slice(&self.position[lack.clone()]);
        let velocities = lack.map(|i| match self.walks_from.get(i) {
            Some(&from) if time < from => Vector::zeros(),
            _ => self.velocity[i],
        });
        self.legs_velocity.extend(velocities);
    }

    /// ℓ_i, from the legs to the body, meters; zero without legs.
    pub fn lean(&self, i: usize) -> Vector {
        let legs = self.legs.get(i);
        legs.map_or(Vector::zeros(), |legs| self.position[i] - legs)
    }
}
