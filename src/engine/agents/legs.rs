//! The legs of agents.

use super::Agents;
use crate::engine::math::Vector;

impl Agents {
    /// Puts legs under the bodies of agents that have none yet, with the velocity of the body: agents enter upright.
    pub fn stand(&mut self) {
        let lack = self.legs.len()..self.len();
        self.legs.extend_from_slice(&self.position[lack.clone()]);
        self.legs_velocity.extend_from_slice(&self.velocity[lack]);
    }

    /// ℓ_i, from the legs to the body, meters; zero without legs.
    pub fn lean(&self, i: usize) -> Vector {
        let legs = self.legs.get(i);
        legs.map_or(Vector::zeros(), |legs| self.position[i] - legs)
    }
}
