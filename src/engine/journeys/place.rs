//! Places that agents visit: exits, waypoints, waiting areas and queues.

use crate::distribution::Distribution;
use crate::geometry::Ring;
use crate::math::{Vector, direction, sides};
use crate::routes::{Goal, nearest_on};

/// A place that agents visit.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// Name in reports.
    pub name: String,
    /// Its kind.
    pub kind: Kind,
    /// The points and lines that agents walk to, for a path map: those parts of it that they can reach.
    pub goals: Vec<Goal>,
}

/// The kind of a place.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// Agents leave here.
    Exit(Exit),
    /// A line that agents cross, ends in meters.
    Line([Vector; 2]),
    /// A disk that agents enter.
    Disk {
        /// Its center, meters.
        at: Vector,
        /// Its radius, meters.
        within: f64,
    },
    /// Agents wait here.
    Waiting(WaitingArea),
    /// Agents queue here.
    Queue(Queue),
    /// A door between rooms.
    Door(Door),
}

/// A door between rooms.
#[derive(Debug, Clone, PartialEq)]
pub struct Door {
    /// Its ends, meters.
    pub line: [Vector; 2],
    /// Whether people pass it only from the left to the right of its line.
    pub one_way: bool,
}

/// A line at which agents leave.
#[derive(Debug, Clone, PartialEq)]
pub struct Exit {
    /// Its ends, meters.
    pub line: [Vector; 2],
    /// The most agents that pass it per second; `None`: no limit.
    pub most_per_sec: Option<f64>,
}

/// An area in which agents wait.
#[derive(Debug, Clone, PartialEq)]
pub struct WaitingArea {
    /// Where, corners in meters.
    pub area: Ring,
    /// Spots to stand, in the order in which they are taken, meters.
    pub spots: Vec<Vector>,
    /// The time until which they wait, seconds; `None`: no given time.
    pub until: Option<f64>,
    /// The time from its arrival after which an agent goes on, seconds; `None`: never.
    pub lasting: Option<Distribution>,
}

/// A queue.
#[derive(Debug, Clone, PartialEq)]
pub struct Queue {
    /// The line on which agents stand, from the front, meters.
    pub path: Vec<Vector>,
    /// The length of the line and of its continuation in the last direction up to the next wall, meters. If it is too
    /// short for all agents, the last ones gather at its end.
    pub length: f64,
    /// The distance between agents, meters.
    pub spacing: f64,
    /// The number of agents that are served at a time.
    pub servers: u32,
    /// The time that it takes to serve an agent, seconds.
    pub service: Distribution,
    /// Its mean, seconds.
    pub mean_service: f64,
}

impl Kind {
    /// Its name in reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Exit(_) => "exit",
            Self::Line(_) | Self::Disk { .. } => "waypoint",
            Self::Waiting(_) => "waiting area",
            Self::Queue(_) => "queue",
            Self::Door(_) => "door",
        }
    }
}

impl Place {
    /// A place with all its parts.
    pub fn new(name: String, kind: Kind) -> Self {
        let goals = match &kind {
            Kind::Exit(Exit { line, .. }) | Kind::Line(line) | Kind::Door(Door { line, .. }) => {
                vec![Goal::Line(*line)]
            }
            Kind::Disk { at, .. } => vec![Goal::Point(*at)],
            Kind::Waiting(waiting) => {
                let sides = sides(waiting.area.points());
                sides.map(|(a, b)| Goal::Line([a, b])).collect()
            }
            Kind::Queue(queue) => queue.path.iter().map(|&p| Goal::Point(p)).collect(),
        };
        Self { name, kind, goals }
    }

    /// The point of the place nearest to `p` that agents walk to, meters.
    pub fn nearest_point(&self, p: Vector) -> Vector {
        match &self.kind {
            Kind::Waiting(waiting) if waiting.area.contains(p) => p,
            _ => {
                let points = self.goals.iter().map(|goal| match *goal {
                    Goal::Point(point) => point,
                    Goal::Line([a, b]) => nearest_on(p, a, b),
                });
                nearest(points, p)
            }
        }
    }

    /// The line that agents cross, if it has one.
    pub fn line(&self) -> Option<[Vector; 2]> {
        match self.kind {
            Kind::Exit(Exit { line, .. }) | Kind::Line(line) | Kind::Door(Door { line, .. }) => {
                Some(line)
            }
            _ => None,
        }
    }

    /// Whether an agent that has come here leaves.
    pub fn is_exit(&self) -> bool {
        matches!(self.kind, Kind::Exit(_))
    }
}

fn nearest(points: impl Iterator<Item = Vector>, p: Vector) -> Vector {
    let distance = |q: &Vector| (q - p).norm_squared();
    let least = points.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    least.unwrap_or(p)
}

impl Queue {
    /// The spot of the agent with `ahead` agents before it, meters. Beyond the end of the path, the queue goes on in
    /// the same direction up to a wall.
    pub fn spot(&self, ahead: usize) -> Vector {
        let mut left = self.length.min(ahead as f64 * self.spacing);
        let mut end = [self.path[0]; 2];
        for pair in self.path.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let length = (b - a).norm();
            if left <= length {
                return a + direction(b - a) * left;
            }
            left -= length;
            end = [a, b];
        }
        end[1] + direction(end[1] - end[0]) * left
    }

    /// The number of agents that have room on its line; the others gather at its end.
    pub fn room(&self) -> u32 {
        1 + (self.length / self.spacing) as u32
    }

    /// The corner of the path that comes next for an agent that stands near corner `k` and walks to the spot behind
    /// `ahead` agents.
    pub fn next_corner(&self, k: usize, ahead: usize) -> usize {
        let behind = ahead as f64 * self.spacing;
        let sides = self.path.windows(2).map(|pair| (pair[1] - pair[0]).norm());
        if behind > sides.take(k).sum::<f64>() {
            (k + 1).min(self.path.len() - 1)
        } else {
            k.saturating_sub(1)
        }
    }
}
