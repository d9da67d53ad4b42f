//! The people in a picture, from any source.

use std::collections::{BTreeMap, VecDeque};

use crate::drawing::Drawing;
use engine::math::Vector;
use engine::simulation::Simulation;

/// Moves above this speed, m/s, are jumps: to the other end of a period, or to another person with the same id.
const FASTEST: f64 = 12.0;
/// The shortest time between two positions; shorter times are clamped to it, seconds.
const SHORTEST: f64 = 0.1;

/// The people at one moment, one entry per person.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Crowd {
    /// Seconds.
    pub time: f64,
    /// Unique numbers.
    pub id: Vec<i64>,
    /// Meters.
    pub position: Vec<Vector>,
    /// Radii, meters.
    pub radius: Vec<f64>,
    /// Masses, 1 = an average person.
    pub mass: Vec<f64>,
    /// m/s; `None` if unknown.
    pub velocity: Vec<Option<Vector>>,
}

impl Crowd {
    /// The agents that are present in the current frame of a simulation, in its order, where they are drawn.
    pub fn of(simulation: &Simulation, drawing: Option<&Drawing>) -> Self {
        let frame = simulation.frame();
        let agents = frame.agents;
        let place = |p| drawing.map_or(p, |drawing| drawing.place(p));
        let numbers = |values: &[f64]| agents.present().map(|i| values[i]).collect();
        Self {
            time: frame.clock.time(),
            id: agents.present().map(|i| i64::from(agents.id[i])).collect(),
            position: agents
                .present()
                .map(|i| place(agents.position[i]))
                .collect(),
            radius: numbers(&agents.radius),
            mass: numbers(&agents.mass),
            velocity: agents.present().map(|i| Some(agents.velocity[i])).collect(),
        }
    }

    /// The number of people.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// Whether there are no people.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }
}

/// The paths of the last seconds.
#[derive(Debug, Clone, Default)]
pub struct Trails {
    /// Their length, seconds.
    pub secs: f64,
    places: BTreeMap<i64, VecDeque<(f64, Vector)>>,
}

impl Trails {
    /// The length of paths, seconds.
    pub fn new(secs: f64) -> Self {
        Self {
            secs,
            places: BTreeMap::new(),
        }
    }

    /// Adds the positions of a later moment, and forgets people that have left.
    pub fn add(&mut self, crowd: &Crowd) {
        let mut before = std::mem::take(&mut self.places);
        for (id, &position) in crowd.id.iter().zip(&crowd.position) {
            let mut places = before.remove(id).unwrap_or_default();
            places.push_back((crowd.time, position));
            let begin = crowd.time - self.secs - 1e-9;
            while places.front().is_some_and(|&(time, _)| time < begin) {
                places.pop_front();
            }
            self.places.insert(*id, places);
        }
    }

    /// The paths, each as lines through positions.
    pub fn lines(&self) -> impl Iterator<Item = Vec<Vector>> {
        self.places.values().flat_map(|places| {
            let mut lines = vec![Vec::new()];
            let mut last: Option<(f64, Vector)> = None;
            for &(time, place) in places {
                let jumps = last.is_some_and(|(before, from)| {
                    (place - from).norm() > FASTEST * (time - before).max(SHORTEST)
                });
                if jumps {
                    lines.push(Vec::new());
                }
                if let Some(line) = lines.last_mut() {
                    line.push(place);
                }
                last = Some((time, place));
            }
            lines.retain(|line| line.len() > 1);
            lines
        })
    }
}
