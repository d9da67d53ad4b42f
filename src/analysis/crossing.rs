//! Lines that people cross.

use serde::{Deserialize, Serialize};

use engine::geometry::Walls;
use engine::math::Vector;

/// A measurement line. Forward is from its left to its right, seen from its first end to its second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// First end, meters; belongs to the line.
    pub start: Vector,
    /// Second end, meters; does not belong to the line, so that a path crosses only one of two lines that join.
    pub end: Vector,
}

impl Line {
    /// Length, meters.
    pub fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }

    /// The point at which the path from `from` to `to` crosses the line, as a fraction of the path, and whether it
    /// crosses forward. A point on the line counts as right of it.
    pub fn crossed(&self, from: Vector, to: Vector) -> Option<(f64, bool)> {
        let way = self.end - self.start;
        let [before, after] = [from, to].map(|p| way.perp(&(p - self.start)));
        if (before > 0.0) == (after > 0.0) {
            return None;
        }
        let part = before / (before - after);
        let along = (from + (to - from) * part - self.start).dot(&way);
        let within = (0.0..self.length() * self.length()).contains(&along);
        within.then_some((part, before > 0.0))
    }

    /// Its continuations beyond both ends, each up to the next wall.
    pub fn beside(&self, walls: &Walls) -> [Self; 2] {
        let all: Vec<u32> = (0..walls.len() as u32).collect();
        let half = 0.5 * (self.end - self.start);
        let middle = self.start + half;
        let to_wall = |half: Vector| {
            let way = half / half.norm() * FARTHEST;
            let wall = walls.first_crossing(middle, middle + way, &all);
            let reach = wall.map_or(FARTHEST, |(part, _)| part * FARTHEST);
            middle + way / FARTHEST * reach.max(half.norm())
        };
        let before = Self {
            start: to_wall(-half),
            end: self.start,
        };
        let after = Self {
            start: self.end,
            end: to_wall(half),
        };
        [before, after]
    }
}

/// Lines are continued up to this far if no wall is there, meters.
const FARTHEST: f64 = 1e4;

/// The balance of a person at a line: the crossings forward minus the crossings backward, with the extremes so far. A
/// crossing is a passage if the balance reaches a new extreme, so a person who sways back and forth across the line
/// passes it once. Who goes around the end of the line has a balance within these extremes, as after coming back
/// through the line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Balance {
    now: i64,
    lowest: i64,
    highest: i64,
}

impl Balance {
    /// Counts a crossing; returns whether it is a passage.
    pub fn passes(&mut self, is_forward: bool) -> bool {
        self.now += if is_forward { 1 } else { -1 };
        let is_new = self.now < self.lowest || self.now > self.highest;
        self.lowest = self.lowest.min(self.now);
        self.highest = self.highest.max(self.now);
        is_new
    }

    /// Counts a crossing of the line's continuation, which is never a passage.
    pub fn goes_around(&mut self, is_forward: bool) {
        let now = self.now + if is_forward { 1 } else { -1 };
        self.now = now.clamp(self.lowest, self.highest);
    }
}

/// Which passages of a line a flow counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Passages {
    /// From one part of all passages to another, 0 to 1, as 0.1 and 0.9.
    Parts([f64; 2]),
    /// From one passage to another, counted from 1.
    Ranks([usize; 2]),
}

/// The flow between two passages.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FlowBetween {
    /// Numbers n and m of the passages, from 1.
    pub passages: [usize; 2],
    /// Their times, seconds.
    pub secs: [f64; 2],
    /// (m − n) / (t_m − t_n), P/s.
    pub flow_per_s: f64,
}

impl Passages {
    /// The flow between two of the passages at `times`, ascending, seconds. `None` if there are fewer passages, or if
    /// they are at the same time.
    pub fn flow(self, times: &[f64]) -> Option<FlowBetween> {
        let last = times.len().checked_sub(1)?;
        let [n, m] = match self {
            Self::Parts(parts) => parts.map(|part| (part * last as f64).round() as usize + 1),
            Self::Ranks(ranks) => ranks,
        };
        let secs = [
            *times.get(n.checked_sub(1)?)?,
            *times.get(m.checked_sub(1)?)?,
        ];
        let span = secs[1] - secs[0];
        (span > 0.0).then(|| FlowBetween {
            passages: [n, m],
            secs,
            flow_per_s: (m as f64 - n as f64) / span,
        })
    }
}
