//! An engine with one setting, which can begin with crowds of any size.

use sandbox::engine::math::Vector;
use sandbox::engine::simulation::Simulation;
use sandbox::lab::error::LabError;
use serde::Serialize;

/// Models that can be compared with each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Forces between agents.
    SocialForce,
    /// Velocities without collisions.
    VelocityObstacles,
    /// A speed that follows from the gap ahead.
    CollisionFreeSpeed,
}

impl Family {
    /// The profile of this engine, if it has a model of this family.
    pub fn profile(self) -> Option<&'static str> {
        match self {
            Self::SocialForce => Some("sf"),
            Self::VelocityObstacles => Some("rvo"),
            Self::CollisionFreeSpeed => None,
        }
    }
}

/// An engine with one setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Description {
    pub engine: String,
    pub family: Family,
    pub model: &'static str,
    /// Agents farther away have no effect, meters.
    pub radius: f64,
    pub precision: &'static str,
    /// Δt, seconds.
    pub time_step: f64,
    pub threads: usize,
}

impl Description {
    /// Whether the two are comparable: models of one family with the same radius and number of threads.
    pub fn is_like(&self, other: &Self) -> bool {
        let like = |of: &Self| (of.family, of.radius, of.threads);
        like(self) == like(other)
    }
}

/// What some steps took, and where they led.
pub struct Turn {
    /// Seconds of computing.
    pub seconds: f64,
    /// The mean distance of the agents from their first positions, meters.
    pub moved: f64,
}

/// A crowd that takes steps on request.
pub type Walk = Box<dyn FnMut(u64) -> Result<Turn, LabError>>;

/// Places the agents of a crowd in an engine.
pub type Start = Box<dyn Fn(&Simulation) -> Result<Walk, LabError>>;

/// An engine with one setting, ready to start.
pub struct Setting {
    pub description: Description,
    /// Number of steps after which the work repeats.
    pub stride: u64,
    /// Whether it is measured at all sizes; otherwise only with the main crowd.
    pub all_sizes: bool,
    pub start: Start,
}

/// The mean distance between two lists of positions, meters.
pub fn mean_distance(first: &[Vector], now: impl Iterator<Item = Vector>) -> f64 {
    let distances = first.iter().zip(now).map(|(a, b)| (b - a).norm());
    distances.sum::<f64>() / first.len().max(1) as f64
}
