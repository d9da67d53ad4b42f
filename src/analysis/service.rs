//! Levels of service (Fruin 1971, *Pedestrian planning and design*): how much room people have.
//!
//! The levels were made to plan walkways and queues of everyday traffic. They are not safety limits.

use serde::{Deserialize, Serialize};

use super::local::Local;

/// Square meters per square foot.
const SQUARE_FOOT: f64 = 0.09290304;
/// From this area per person on, square feet, a walkway has level A, B, C, D and E; below all of them F.
pub const WALKWAY: [f64; 5] = [35.0, 25.0, 15.0, 10.0, 5.0];
/// The same of queues.
pub const QUEUE: [f64; 5] = [13.0, 10.0, 7.0, 3.0, 2.0];
/// The names of the levels.
pub const LEVELS: [char; 6] = ['a', 'b', 'c', 'd', 'e', 'f'];

/// The number of samples of people at each level, A to F.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Levels {
    /// By the thresholds of walkways.
    pub walkway: [u64; 6],
    /// By the thresholds of queues.
    pub queue: [u64; 6],
}

/// The level of a density in P/m², from 0 for A to 5 for F, by `areas` per person in square feet.
pub fn level(density: f64, areas: &[f64; 5]) -> usize {
    let area = 1.0 / (density * SQUARE_FOOT);
    areas.iter().take_while(|&&least| area < least).count()
}

/// The highest densities of the levels A to E, P/m².
pub fn densities(areas: &[f64; 5]) -> [f64; 5] {
    areas.map(|area| 1.0 / (area * SQUARE_FOOT))
}

impl Levels {
    /// Adds the people at one time.
    pub fn add<'a>(&mut self, people: impl Iterator<Item = &'a Local>) {
        for person in people {
            self.walkway[level(person.density, &WALKWAY)] += 1;
            self.queue[level(person.density, &QUEUE)] += 1;
        }
    }

    /// The shares of the levels A to F, for walkways and for queues; `None` without people.
    pub fn shares(&self) -> Option<[[f64; 6]; 2]> {
        let total: u64 = self.walkway.iter().sum();
        let shares = |counts: &[u64; 6]| counts.map(|count| count as f64 / total as f64);
        (total > 0).then(|| [shares(&self.walkway), shares(&self.queue)])
    }
}
