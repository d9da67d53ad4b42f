//! Which agents stand in a queue, and where it ends.

use engine::simulation::Simulation;

/// An agent stands in a queue if it walks slower than this part of its preferred speed.
pub const SLOW: f64 = 0.5;
/// A queue ends where the next agent is farther behind than this along the way, meters.
pub const GAP: f64 = 3.0;
/// Time between two observations, seconds.
pub(super) const EVERY: f64 = 1.0;

/// Whether an agent walks slower than [`SLOW`] times the speed that it would like to walk at: on stairs, the speed
/// there, and on an escalator, with that of the belt.
pub(super) fn is_slow(simulation: &Simulation, agent: usize) -> bool {
    let (frame, scene) = (simulation.frame(), simulation.scene());
    let wished = frame.fields.preferred_velocity.get(agent);
    let pace = match wished.filter(|_| scene.levels.is_some()) {
        Some(wished) => wished.norm(),
        None => scene.pace(frame.agents, agent, frame.clock.time()),
    };
    frame.agents.velocity[agent].norm() < SLOW * pace
}

/// The number of agents at these ascending distances, from `start` up to the first gap.
pub(super) fn length(distances: impl Iterator<Item = f64>, start: f64) -> u32 {
    let mut before = start;
    let close = distances.take_while(|&left| {
        let is_near = left - before <= GAP;
        before = left;
        is_near
    });
    close.count() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_queue_begins_at_its_place_and_ends_at_the_first_gap() {
        let queue = |distances: &[f64], start| length(distances.iter().copied(), start);
        let all = [0.5, 1.0, 4.0, 7.0, 7.0 + GAP, 7.0 + 2.0 * GAP + 0.1, 20.0];
        assert_eq!(queue(&all, 0.0), 5);
        // No agent stands at the place.
        assert_eq!(queue(&[GAP + 0.1, GAP + 0.2], 0.0), 0);
        // Before a goal, the nearest agent is the first.
        assert_eq!(queue(&[8.0, 8.4, 12.0], 8.0), 2);
        assert_eq!(queue(&[], 0.0), 0);
    }
}
