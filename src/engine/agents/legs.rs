//! The legs of agents.

use super::Agents;
use crate::engine::math::Vector;

impl Agents {
    /// Puts legs at rest under the bodies of agents that have none yet.
    pub fn stand(&mut self) {
        let lack = self.legs.len()..self.len();
        self.legs_velocity.resize(self.len(), Vector::zeros());
        self.legs.extend_from_slice(&self.position[lack]);
    }

    /// ℓ_i, from the legs to the body, meters; zero without legs.
    pub fn lean(&self, i: usize) -> Vector {
        let legs = self.legs.get(i);
        legs.map_or(Vector::zeros(), |legs| self.position[i] - legs)
    }
}
