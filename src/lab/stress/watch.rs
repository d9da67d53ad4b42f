//! Looks on while a crowd moves: everybody's whole path against the walls, and what was clipped.

use serde::{Deserialize, Serialize};

use super::fence::Fence;
use crate::engine::math::{Vector, are_finite, numbers_are_finite};
use crate::engine::simulation::Simulation;

/// Distances between people are looked at in every so many frames.
const CLOSEST_EVERY: u64 = 5;

/// What was seen of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Frames looked at.
    pub frames: u64,
    /// How many entered.
    pub entered: u32,
    /// How many reached their goal and left.
    pub arrived: usize,
    /// How often somebody was seen inside an obstacle or on a path through a wall.
    pub passed: u64,
    /// Was every position, velocity, acceleration and density finite?
    pub finite: bool,
    /// The highest speed, m/s.
    pub fastest: f64,
    /// Root mean square speed in the last frame, m/s.
    pub speed_at_end: f64,
    /// The least distance of two centres, in parts of the sum of their radii; at most 1.
    pub closest: f64,
    /// How many moves ended at a wall that they would have crossed.
    pub contained_moves: u64,
    /// How often a speed was cut to the highest allowed.
    pub clamped_speeds: u64,
    /// How many entered inside an obstacle and were put out.
    pub displaced: usize,
}

impl Default for Found {
    /// Nothing yet.
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

/// A bystander.
pub struct Watch {
    fence: Fence,
    /// Where everybody was last, by id; `None` for who has not been seen.
    last: Vec<Option<Vector>>,
    /// How many arrivals have been seen.
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

    /// Looks at an evaluated frame; to be called in every one.
    pub fn look(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let agents = frame.agents;
        self.last.resize(agents.entered() as usize, None);
        for (&id, &position) in agents.id.iter().zip(&agents.position) {
            self.follow(id, position);
        }
        // Who has left made a last move before.
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

    /// One agent's path since it was last seen.
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

    /// What was seen, after a last look at who stands inside an obstacle.
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

/// The mean of |v_i|² over everybody, m²/s²; zero where nobody is.
pub fn mean_square_speed(simulation: &Simulation) -> f64 {
    let velocities = &simulation.frame().agents.velocity;
    let sum: f64 = velocities.iter().map(|v| v.norm_squared()).sum();
    sum / velocities.len().max(1) as f64
}

/// The least distance of two centres, in parts of the sum of their radii; at most 1.
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
