//! What every run observes beside its measurements: the highest density, and the longest queues.

use serde::{Deserialize, Serialize};

use super::is_due;
use super::stuck::{Aim, Headway};
use crate::engine::journeys::Kind;
use crate::engine::simulation::Simulation;

/// An agent stands in a queue if it walks slower than this part of its preferred speed.
pub const SLOW: f64 = 0.5;
/// A queue ends where the next agent is farther behind than this along the way, meters.
pub const GAP: f64 = 3.0;
/// The fewest agents in a queue.
const FEWEST: u32 = 2;
/// Time between two observations of the queues, seconds.
const EVERY: f64 = 1.0;

/// The highest density of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HighestDensity {
    /// The SPH density at an agent, P/m².
    pub density_per_m2: f64,
    /// When, seconds.
    pub at_secs: f64,
    /// The position of the agent, meters.
    pub at: [f64; 2],
    /// Its id.
    pub agent: u32,
}

/// The longest queue before a place or a goal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LongestQueue {
    /// The name of the place, or the position of the goal.
    pub before: String,
    /// The largest number of agents at one time.
    pub agents: u32,
    /// The first time with this number, seconds.
    pub at_secs: f64,
}

/// The longest queue so far before one aim.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Queue {
    aim: Aim,
    agents: u32,
    at_secs: f64,
}

/// The highest density and the longest queues so far.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Overview {
    highest: Option<HighestDensity>,
    queues: Vec<Queue>,
}

impl Overview {
    /// Observes an evaluated frame with the headways of its agents, by id: densities in coarse frames, if forces need
    /// them, and queues once per second.
    pub fn observe(&mut self, headways: &[Option<Headway>], simulation: &Simulation) {
        if simulation.needs().density && simulation.frame().clock.is_coarse() {
            self.observe_density(simulation);
        }
        if is_due(simulation, [0.0, f64::INFINITY], EVERY) {
            self.observe_queues(headways, simulation);
        }
    }

    /// The highest density; `None` if no force needs densities.
    pub fn highest(&self) -> Option<HighestDensity> {
        self.highest
    }

    /// The longest queue before each place and goal, the longest one first.
    pub fn longest(&self, simulation: &Simulation) -> Vec<LongestQueue> {
        let places = &simulation.scene().journeys.places;
        let name = |aim: Aim| match aim {
            Aim::Place(place) => places[usize::from(place)].name.clone(),
            Aim::Goal(goal) => format!("({}, {})", goal.x, goal.y),
            Aim::Direction(_) => String::new(),
        };
        let mut queues: Vec<&Queue> = self.queues.iter().collect();
        queues.sort_by_key(|queue| std::cmp::Reverse(queue.agents)); // stable
        let longest = queues.into_iter().map(|queue| LongestQueue {
            before: name(queue.aim),
            agents: queue.agents,
            at_secs: queue.at_secs,
        });
        longest.collect()
    }

    fn observe_density(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let densities = &frame.fields.density;
        let mut most = self.highest.map_or(0.0, |highest| highest.density_per_m2);
        let mut found = None;
        // A frame of a damaged checkpoint may have no densities.
        let known = frame.agents.present().filter(|&i| i < densities.len());
        for i in known {
            if densities[i] > most {
                (most, found) = (densities[i], Some(i));
            }
        }
        if let Some(i) = found {
            self.highest = Some(HighestDensity {
                density_per_m2: most,
                at_secs: frame.clock.time(),
                at: frame.agents.position[i].into(),
                agent: frame.agents.id[i],
            });
        }
    }

    fn observe_queues(&mut self, headways: &[Option<Headway>], simulation: &Simulation) {
        let (frame, scene) = (simulation.frame(), simulation.scene());
        let (agents, now) = (frame.agents, frame.clock.time());
        // The aims of slow agents, each with its distances.
        let mut slow: Vec<(Aim, f64)> = Vec::new();
        for i in agents.present() {
            let headway = headways.get(agents.id[i] as usize).and_then(Option::as_ref);
            if let Some(way) = headway.and_then(Headway::way)
                && agents.velocity[i].norm() < SLOW * scene.pace(agents, i, now)
            {
                slow.push(way);
            }
        }
        slow.sort_by(|(aim, left), (other, way)| aim.order(other).then(left.total_cmp(way)));
        for line in slow.chunk_by(|(aim, _), (other, _)| aim == other) {
            let (aim, first) = line[0];
            // A place is the door; a goal may lie far behind it.
            let start = match aim {
                Aim::Place(_) => 0.0,
                _ => first,
            };
            let distances = line.iter().map(|&(_, left)| left);
            self.notice(aim, length(distances, start), now);
        }
        let places = scene
            .journeys
            .places
            .iter()
            .zip(&simulation.progress().places);
        for (k, (place, state)) in places.enumerate() {
            if matches!(place.kind, Kind::Queue(_)) {
                self.notice(Aim::Place(k as u16), state.longest, now);
            }
        }
    }

    fn notice(&mut self, aim: Aim, agents: u32, at_secs: f64) {
        if agents < FEWEST {
            return;
        }
        let queue = Queue {
            aim,
            agents,
            at_secs,
        };
        match self.queues.iter_mut().find(|queue| queue.aim == aim) {
            Some(longest) if longest.agents < agents => *longest = queue,
            Some(_) => {}
            None => self.queues.push(queue),
        }
    }
}

/// The number of agents at these ascending distances, from `start` up to the first gap.
fn length(distances: impl Iterator<Item = f64>, start: f64) -> u32 {
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
        // Nobody stands at the place.
        assert_eq!(queue(&[GAP + 0.1, GAP + 0.2], 0.0), 0);
        // Before a goal, the nearest agent is the first.
        assert_eq!(queue(&[8.0, 8.4, 12.0], 8.0), 2);
        assert_eq!(queue(&[], 0.0), 0);
    }
}
