//! Why an action is not possible.

use crate::journeys::{ChangeKind, Kind, Place};
use crate::math::Vector;
use crate::routes::WayError;

/// The most pushes of a scene.
pub(super) const MOST_PUSHES: usize = u16::MAX as usize;

/// An agent is not present.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Absent {
    /// Seconds.
    pub(super) time: f64,
    /// The number of agents that have entered, if this agent has not.
    pub(super) entered: Option<u32>,
}

impl std::fmt::Display for Absent {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "not present at {:.2} s: ", self.time)?;
        match self.entered {
            Some(entered) => write!(f, "only {entered} agents have entered, with ids from 0"),
            None => f.write_str("it has left"),
        }
    }
}

/// Why an action is not possible. Nothing is done then.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ActionError {
    /// There is no such agent.
    #[error("agent {0}: {1}")]
    Absent(u32, Absent),
    /// The agent is given twice.
    #[error("agent {0} is given twice; give each once")]
    Twice(u32),
    /// The agent's group walks in a direction.
    #[error("agent {0} walks in a direction, not to a point")]
    Directed(u32),
    /// The point is not in the walkable area.
    #[error(
        "({}, {}) lies in an obstacle or outside of the walkable area; give a point on the floor",
        .0.x, .0.y
    )]
    NotOnFloor(Vector),
    /// Walls close the goal off.
    #[error(
        "no way leads from agent {agent} at ({:.2}, {:.2}) to {to}; give one that it can reach",
        from.x, from.y
    )]
    NoWay {
        /// The agent's id.
        agent: u32,
        /// Its position, meters.
        from: Vector,
        /// The goal, in words.
        to: String,
    },
    /// No path map can be made.
    #[error(transparent)]
    Way(#[from] WayError),
    /// The scene has nothing of this kind with this number.
    #[error("no {kind} has the number {number}")]
    Unknown {
        /// What is asked for.
        kind: &'static str,
        /// Its number.
        number: u16,
    },
    /// The scene has no path maps to the places of a journey.
    #[error(
        "no agent of the scenario is on a journey, so that there are no path maps to the places of `{0}`; give a group \
         a journey"
    )]
    NoMaps(String),
    /// A number is out of range.
    #[error("{name} = {value}: give a number from {least} to {most}")]
    Range {
        /// What it is.
        name: &'static str,
        /// The number.
        value: f64,
        /// The least that is possible.
        least: f64,
        /// The most that is possible.
        most: f64,
    },
    /// The place cannot change in this way.
    #[error(
        "`{name}` is {kind}; exits, doors and entrances can open and close, and waiting areas can be released"
    )]
    Unchangeable {
        /// The name of the place.
        name: String,
        /// What it is.
        kind: &'static str,
    },
    /// There are too many pushes.
    #[error("{MOST_PUSHES} pushes are the most for one run")]
    TooManyPushes,
}

/// Why a place cannot change in a way, if it cannot.
#[doc(hidden)]
pub fn refused_change(places: &[Place], place: u16, change: ChangeKind) -> Option<ActionError> {
    let Some(known) = places.get(usize::from(place)) else {
        return Some(ActionError::Unknown {
            kind: "place",
            number: place,
        });
    };
    let is_possible = match known.kind {
        Kind::Exit(_) | Kind::Door(_) => change != ChangeKind::Release,
        Kind::Waiting(_) => change == ChangeKind::Release,
        _ => false,
    };
    (!is_possible).then(|| ActionError::Unchangeable {
        name: known.name.clone(),
        kind: match known.kind {
            Kind::Exit(_) => "an exit",
            Kind::Door(_) => "a door",
            Kind::Waiting(_) => "a waiting area",
            Kind::Queue(_) => "a queue",
            Kind::Line(_) | Kind::Disk { .. } => "a waypoint",
        },
    })
}

pub(super) fn within(
    name: &'static str,
    value: f64,
    [least, most]: [f64; 2],
) -> Result<(), ActionError> {
    match (least..=most).contains(&value) {
        true => Ok(()),
        false => Err(ActionError::Range {
            name,
            value,
            least,
            most,
        }),
    }
}
