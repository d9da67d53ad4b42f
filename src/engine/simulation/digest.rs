//! A hash of the state, to test whether two runs are identical to the last bit.

use sha2::{Digest, Sha256};

use super::Simulation;
use crate::math::Vector;

impl Simulation {
    /// SHA-256, as 64 hexadecimal digits, of the frame number, of the id, position, velocity, states that forces keep,
    /// mean density and laps of all agents in the order of their ids, and of all arrivals. It does not depend on the
    /// order in memory, on the number of threads, or on requests by observers: the mean density ρ̂ is included only if
    /// the scene needs it ([`Needs::density`](crate::scene::Needs::density)).
    pub fn digest(&self) -> String {
        let has_mean_density = self.fixed.scene.needs().density;
        let mut hasher = Sha256::new();
        hasher.update(self.crowd.clock.frame().to_le_bytes());
        let agents = &self.crowd.agents;
        let mut order: Vec<usize> = (0..agents.len()).collect();
        order.sort_unstable_by_key(|&i| agents.id[i]);
        for i in order {
            hasher.update(agents.id[i].to_le_bytes());
            add(&mut hasher, agents.position[i]);
            add(&mut hasher, agents.velocity[i]);
            for value in agents
                .states
                .iter()
                .filter_map(|states| states.of(i))
                .flatten()
            {
                hasher.update(value.to_bits().to_le_bytes());
            }
            if has_mean_density {
                hasher.update(agents.mean_density[i].to_bits().to_le_bytes());
            }
            if let Some(laps) = agents.laps.get(i) {
                hasher.update(laps.to_le_bytes());
            }
        }
        for arrival in &self.crowd.outcome.arrivals {
            hasher.update(arrival.id.to_le_bytes());
            hasher.update(arrival.time.to_bits().to_le_bytes());
            add(&mut hasher, arrival.position);
        }
        let digits = hasher.finalize();
        digits.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

fn add(hasher: &mut Sha256, v: Vector) {
    hasher.update(v.x.to_bits().to_le_bytes());
    hasher.update(v.y.to_bits().to_le_bytes());
}
