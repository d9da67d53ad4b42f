//! Who stands outside of the line of a queue.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::standing::{EVERY, is_slow, length};
use engine::journeys::{Queue, Status};
use engine::math::Vector;
use engine::routes::nearest_on;
use engine::simulation::Simulation;

/// Agents that entered less than this ago have just started, seconds.
const STARTING: f64 = 3.0;

/// The agents outside of the line of a queue while it is full: agents that have joined it beyond its room, and slow
/// agents around it that have not.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Outside {
    /// The largest number at one time.
    pub agents: u32,
    /// The first time with this number, seconds.
    pub at_secs: f64,
    /// The number of agents that stood there at some time.
    pub people: u32,
    /// Their mean time there, seconds.
    pub mean_secs: f64,
    /// The longest time there, seconds.
    pub longest_secs: f64,
}

/// What was seen of the queues with lines, by the numbers of their places.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Lines(BTreeMap<u16, Seen>);

/// What was seen of a queue.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Seen {
    /// The largest number outside of its line, and the first time with it, seconds.
    most: (u32, f64),
    /// How often each agent was seen there, by id.
    times: BTreeMap<u32, u32>,
}

impl Lines {
    /// Observes the queue at place `number`. Returns the agents outside of its line.
    pub(super) fn observe(
        &mut self,
        simulation: &Simulation,
        number: u16,
        line: &Queue,
    ) -> Vec<usize> {
        let outside = outside(simulation, number, line);
        if outside.is_empty() {
            return outside;
        }
        let frame = simulation.frame();
        let seen = self.0.entry(number).or_default();
        if outside.len() as u32 > seen.most.0 {
            seen.most = (outside.len() as u32, frame.clock.time());
        }
        for &i in &outside {
            *seen.times.entry(frame.agents.id[i]).or_default() += 1;
        }
        outside
    }

    /// Who stood outside of the line of the queue at place `number`; `None` if nobody did.
    pub(super) fn outside(&self, number: u16) -> Option<Outside> {
        let seen = self.0.get(&number)?;
        let times = seen.times.values().map(|&count| f64::from(count) * EVERY);
        Some(Outside {
            agents: seen.most.0,
            at_secs: seen.most.1,
            people: seen.times.len() as u32,
            mean_secs: times.clone().sum::<f64>() / seen.times.len() as f64,
            longest_secs: times.fold(0.0, f64::max),
        })
    }
}

/// The agents outside of the line of the queue at place `number`, if it is full: those who have joined it beyond its
/// room, and slow ones who have not joined it, from the line up to the first gap.
fn outside(simulation: &Simulation, number: u16, line: &Queue) -> Vec<usize> {
    let frame = simulation.frame();
    let (agents, now) = (frame.agents, frame.clock.time());
    let mut joined: Vec<(u32, usize)> = Vec::new();
    let mut around: Vec<(f64, usize)> = Vec::new();
    for i in agents.present() {
        let trip = agents.trip.get(i).and_then(Option::as_ref);
        let Some(trip) = trip.filter(|trip| trip.place == number) else {
            continue;
        };
        let start = agents.walks_from.get(i).copied().unwrap_or(0.0);
        let has_started = now - start.max(trip.entered) >= STARTING;
        match trip.status {
            Status::Queued { ticket, .. } => joined.push((ticket, i)),
            Status::Walking if has_started && is_slow(simulation, i) => {
                around.push((distance(line, agents.position[i]), i));
            }
            _ => {}
        }
    }
    if joined.len() < line.room() as usize {
        return Vec::new();
    }
    joined.sort_unstable();
    around.sort_by(|(a, _), (b, _)| a.total_cmp(b)); // stable
    let count = length(around.iter().map(|&(distance, _)| distance), 0.0);
    let beyond = joined.iter().skip(line.room() as usize).map(|&(_, i)| i);
    let nearest = around[..count as usize].iter().map(|&(_, i)| i);
    beyond.chain(nearest).collect()
}

/// The distance from `p` to the line on which people stand, meters.
fn distance(line: &Queue, p: Vector) -> f64 {
    let end = line.spot(line.room() as usize);
    let points: Vec<Vector> = line.path.iter().copied().chain([end]).collect();
    let pairs = points.windows(2);
    let sides = pairs.map(|side| (nearest_on(p, side[0], side[1]) - p).norm());
    sides.fold(f64::INFINITY, f64::min)
}
