//! Watches a moving crowd: checks the path of every agent against the walls, and counts clamped values.

use serde::{Deserialize, Serialize};

use super::fence::Fence;
use crate::engine::math::{Vector, are_finite, numbers_are_finite};
use crate::engine::simulation::Simulation;

/// Distances between agents are checked every this many frames.
const CLOSEST_EVERY: u64 = 5;

/// The findings of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Number of watched frames.
    pub frames: u64,
    /// Number of agents that entered.
    pub entered: u32,
    /// Number of agents that reached their goal and left.
    pub arrived: usize,
    /// Number of times that an agent was inside an obstacle or on a path through a wall.
    pub passed: u64,
    /// Was every position, velocity, acceleration and density finite?
    pub finite: bool,
    /// The highest speed, m/s.
    pub fastest: f64,
    /// Root mean square speed in the last frame, m/s.
    pub speed_at_end: f64,
    /// The smallest distance between two centers, relative to the sum of their radii; at most 1.
    pub closest: f64,
    /// Number of moves that were stopped at a wall.
    pub contained_moves: u64,
    /// Number of speeds that were clamped to the maximum.
    pub clamped_speeds: u64,
    /// Number of agents that entered inside an obstacle and were moved out of it.
    pub displaced: usize,
}

impl Default for Found {
    /// The findings before the first frame.
    fn default() -> Self {
        Self {
            frames: 0,
            entered: 0,
            arrived: 0,
            passed: 0,
            finite: true,
            fastest: 0.0,
            speed_at_end: 0.0,
            closest: 1.0,
            contained_moves: 0,
            clamped_speeds: 0,
            displaced: 0,
        }
    }
}

/// An independent observer of a run.
pub struct Watch {
    fence: Fence,
    /// The last known position of each agent, by id; `None` before the agent's first frame.
    last: Vec<Option<Vector>>,
    /// Number of arrivals that were processed.
    arrivals: usize,
    found: Found,
}

impl Watch {
    /// Begins to watch.
    pub fn new(simulation: &Simulation) -> Self {
        Self {
            fence: Fence::new(&simulation.scene().walls),
            last: Vec::new(),
            arrivals: 0,
            found: Found::default(),
        }
    }

    /// Observes an evaluated frame; must be called in every frame.
    pub fn look(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let agents = frame.agents;
        self.last.resize(agents.entered() as usize, None);
        for (&id, &position) in agents.id.iter().zip(&agents.position) {
            self.follow(id, position);
        }
        // Agents that have left made one more move before.
        for arrival in &simulation.outcome().arrivals[self.arrivals..] {
            let before = self.last[arrival.id as usize];
            if before.is_some_and(|before| self.fence.is_crossed(before, arrival.position)) {
                self.found.passed += 1;
            }
        }
        self.arrivals = simulation.outcome().arrivals.len();
        let vectors = [
            &agents.position,
            &agents.velocity,
            &frame.fields.acceleration,
        ];
        self.found.finite &= vectors.into_iter().all(|v| are_finite(v));
        self.found.finite &= numbers_are_finite(&frame.fields.density);
        let squares = agents.velocity.iter().map(|v| v.norm_squared());
        self.found.fastest = self.found.fastest.max(squares.fold(0.0, f64::max).sqrt());
        if self.found.frames.is_multiple_of(CLOSEST_EVERY) {
            self.found.closest = self.found.closest.min(closest(simulation));
        }
        self.found.frames += 1;
        self.note_outcome(simulation);
    }

    /// Checks the path of one agent since its last known position.
    fn follow(&mut self, id: u32, position: Vector) {
        let before = self.last[id as usize].replace(position);
        let passed = match before {
            None => self.fence.encloses(position),
            Some(before) if before == position => false,
            Some(before) => self.fence.is_crossed(before, position),
        };
        self.found.passed += u64::from(passed);
    }

    fn note_outcome(&mut self, simulation: &Simulation) {
        let outcome = simulation.outcome();
        self.found.entered = simulation.frame().agents.entered();
        self.found.arrived = outcome.arrivals.len();
        self.found.contained_moves = outcome.contained_moves;
        self.found.clamped_speeds = outcome.clamped_speeds;
        self.found.displaced = outcome.displaced.len();
    }

    /// The findings, with a last check for agents inside obstacles.
    pub fn found(&self, simulation: &Simulation) -> Found {
        let positions = simulation.frame().agents.position.iter();
        let inside = positions.filter(|&&p| self.fence.encloses(p)).count();
        Found {
            speed_at_end: mean_square_speed(simulation).sqrt(),
            passed: self.found.passed + inside as u64,
            ..self.found
        }
    }
}

/// The mean of |v_i|² over all agents, m²/s²; zero without agents.
pub fn mean_square_speed(simulation: &Simulation) -> f64 {
    let velocities = &simulation.frame().agents.velocity;
    let sum: f64 = velocities.iter().map(|v| v.norm_squared()).sum();
    sum / velocities.len().max(1) as f64
}

/// The smallest distance between two centers, relative to the sum of their radii; at most 1.
pub fn closest(simulation: &Simulation) -> f64 {
    let frame = simulation.frame();
    let agents = frame.agents;
    let widest = agents.radius.iter().copied().fold(0.0, f64::max);
    let mut least: f64 = 1.0;
    if frame.neighbors.near().is_empty() {
        return least;
    }
    for i in 0..agents.len() {
        for (j, r_ij) in frame.near(i, agents.radius[i] + widest) {
            least = least.min(r_ij.norm() / (agents.radius[i] + agents.radius[j]));
        }
    }
    least
}
