//! Entrances: lines through which agents come in, at random or regular times and where there is room. Scheduled agents:
//! agents that each have a time and a place of their own.

use libm::log;
use rand::Rng;
use rand::distr::Open01;
use serde::{Deserialize, Serialize};

use crate::agents::NewAgent;
use crate::geometry::{Wall, Walls};
use crate::math::{Vector, direction};
use crate::random::{self, Purpose};

/// Bodies keep this distance in addition, meters: far above the rounding of coordinates up to 10⁶ m.
const ROUNDING: f64 = 1e-9;

/// A line through which agents come in.
#[derive(Debug, Clone, PartialEq)]
pub struct Entrance {
    /// Name in reports.
    pub name: String,
    /// The ends of the line, meters.
    pub line: [Vector; 2],
    /// Index of the group of its agents.
    pub group: u16,
    /// Their goal, meters.
    pub goal: Vector,
    /// When agents arrive. Each enters at once if there is room, and otherwise waits for room.
    pub arrivals: Arrivals,
}

/// An agent that comes in at a place of its own, such as the first one at which a person was recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScheduledAgent {
    /// When it arrives, seconds. It enters at once if there is room between the other bodies, and otherwise waits for
    /// room.
    pub at: f64,
    /// The agent; a speed above its s_max is clamped to it.
    pub agent: NewAgent,
}

impl ScheduledAgent {
    /// Whether a body of `radius` meters at its place overlaps none of the discs `others` (center and radius).
    pub fn has_room(&self, radius: f64, mut others: impl Iterator<Item = (Vector, f64)>) -> bool {
        let place = self.agent.position;
        others.all(|(center, other)| (center - place).norm() >= radius + other + ROUNDING)
    }
}

/// When agents arrive at an entrance.
#[derive(Debug, Clone, PartialEq)]
pub enum Arrivals {
    /// At equal intervals.
    Constant(Flow),
    /// At random, independently of each other.
    Poisson(Flow),
    /// At these times, in ascending order, seconds.
    At(Vec<f64>),
}

/// A flow of agents.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Flow {
    /// Agents per second; 0: none arrives.
    pub per_sec: f64,
    /// Its beginning, seconds.
    pub from: f64,
    /// No agent arrives at this time or later, seconds.
    pub until: f64,
    /// The most agents; `None`: unlimited.
    pub number: Option<u32>,
    /// The number of its first agent: of those that have arrived at this entrance before.
    pub first: u32,
    /// The part of the waiting time of its first agent, in units of its mean, that was over before `from`: of flows at
    /// random whose rate has changed.
    pub waited: f64,
}

impl Flow {
    /// Since when the next agent is waited for, seconds, and the part of its waiting time that was over then, in units
    /// of its mean. `before`: the time of the last arrival.
    fn start(&self, before: Option<f64>) -> (f64, f64) {
        match before {
            Some(before) if before >= self.from => (before, 0.0),
            _ => (self.from, self.waited),
        }
    }

    /// The part of the waiting time of the next agent that is over at `now`, in units of its mean.
    pub fn waited(&self, before: Option<f64>, now: f64) -> f64 {
        let (start, waited) = self.start(before);
        waited + (now - start).max(0.0) * self.per_sec
    }

    fn includes(&self, k: u32, time: f64) -> bool {
        self.per_sec > 0.0 && time < self.until && self.number.is_none_or(|number| k < number)
    }
}

impl Arrivals {
    /// The number of agents that are to arrive; `None`: unlimited.
    pub fn planned(&self) -> Option<u32> {
        match self {
            Self::Constant(flow) | Self::Poisson(flow) => flow.number,
            Self::At(times) => Some(times.len() as u32),
        }
    }

    /// The time of arrival number `k`, from 0, which follows the one at `before`, seconds; `None` if there is none.
    /// `seed` is that of the population, `entrance` the number of the entrance.
    pub fn time(&self, k: u32, before: Option<f64>, seed: u64, entrance: u32) -> Option<f64> {
        match self {
            Self::Constant(flow) => {
                let time = flow.from + f64::from(k - flow.first) / flow.per_sec;
                flow.includes(k, time).then_some(time)
            }
            Self::Poisson(flow) => {
                let mut random = random::stream(seed, Purpose::Arrival, entrance, u64::from(k));
                let share: f64 = random.sample(Open01);
                let (start, waited) = flow.start(before);
                let time = start + (-log(share) - waited).max(0.0) / flow.per_sec;
                flow.includes(k, time).then_some(time)
            }
            Self::At(times) => times.get(k as usize).copied(),
        }
    }
}

impl Arrivals {
    /// No agent arrives before this, seconds; `None`: no agent arrives.
    pub fn first(&self) -> Option<f64> {
        match self {
            Self::Constant(flow) | Self::Poisson(flow) => Some(flow.from),
            Self::At(times) => times.first().copied(),
        }
    }

    /// About how many agents arrive until `end` seconds.
    pub fn about(&self, end: f64) -> f64 {
        match self {
            Self::Constant(flow) | Self::Poisson(flow) => {
                let mean = (flow.until.min(end) - flow.from).max(0.0) * flow.per_sec;
                flow.number.map_or(mean, |number| mean.min(number.into()))
            }
            Self::At(times) => times.partition_point(|&time| time <= end) as f64,
        }
    }
}

/// A part of an entrance's line, in meters from its start.
pub type Span = [f64; 2];

impl Entrance {
    fn length(&self) -> f64 {
        (self.line[1] - self.line[0]).norm()
    }

    /// The point at a distance from the start of the line, meters.
    pub fn at(&self, along: f64) -> Vector {
        self.line[0] + self.along() * along
    }

    fn along(&self) -> Vector {
        direction(self.line[1] - self.line[0])
    }

    /// The parts of the line at which a body of `radius` meters overlaps neither a wall nor the discs `others`
    /// (center and radius), in their order along the line.
    pub fn free(
        &self,
        radius: f64,
        walls: &Walls,
        others: impl Iterator<Item = (Vector, f64)>,
    ) -> Vec<Span> {
        let mut blocked: Vec<Span> = others
            .filter_map(|(center, other)| self.in_disc(center, radius + other))
            .collect();
        for k in walls.near_any(&self.line, radius + ROUNDING) {
            blocked.extend(self.near_wall(walls.wall(k), radius));
        }
        blocked.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut free = Vec::new();
        let mut from = 0.0_f64;
        let end = self.length();
        for [start, stop] in blocked.into_iter().chain([[end, end]]) {
            // Discs can lie beyond the ends of the line.
            let start = start.min(end);
            if start > from {
                free.push([from, start]);
            }
            from = from.max(stop);
        }
        // Walls are blocked: each part is all inside or all outside of obstacles.
        free.retain(|[from, to]| walls.obstacle_at(self.at(0.5 * (from + to))).is_none());
        free
    }

    /// The part of the line less than `reach` meters from a point.
    fn in_disc(&self, center: Vector, reach: f64) -> Option<Span> {
        let offset = center - self.line[0];
        let (along, reach) = (self.along(), reach + ROUNDING);
        let (middle, aside) = (along.dot(&offset), along.perp(&offset));
        let half = reach * reach - aside * aside;
        (half > 0.0).then(|| [middle - half.sqrt(), middle + half.sqrt()])
    }

    /// The parts of the line less than `reach` meters from a wall: from its ends, and from the edge between.
    fn near_wall(&self, wall: &Wall, reach: f64) -> impl Iterator<Item = Span> {
        let (along, offset) = (self.along(), self.line[0] - wall.start);
        let reach = reach + ROUNDING;
        let beside = part(
            offset.dot(&wall.normal),
            along.dot(&wall.normal),
            [-reach, reach],
        );
        let length = [0.0, wall.length()];
        let between = part(offset.dot(&wall.tangent), along.dot(&wall.tangent), length);
        let edge = beside
            .zip(between)
            .map(|(a, b)| [a[0].max(b[0]), a[1].min(b[1])]);
        let ends = [wall.start, wall.end].map(|end| self.in_disc(end, reach));
        let edge = edge.filter(|[from, to]| from < to);
        ends.into_iter().chain([edge]).flatten()
    }
}

/// The values of x for which `at + slope * x` lies in a range.
fn part(at: f64, slope: f64, [low, high]: [f64; 2]) -> Option<Span> {
    if slope == 0.0 {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        return (low < at && at < high).then_some(all);
    }
    let ends = [(low - at) / slope, (high - at) / slope];
    Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
}

/// The place at a `share` of the whole length of some parts, meters; `None` if they have no length.
pub fn place(parts: &[Span], share: f64) -> Option<f64> {
    let whole: f64 = parts.iter().map(|[from, to]| to - from).sum();
    let mut left = share * whole;
    for [from, to] in parts {
        if left < to - from {
            return Some(from + left);
        }
        left -= to - from;
    }
    parts.last().filter(|_| whole > 0.0).map(|[_, to]| *to)
}
