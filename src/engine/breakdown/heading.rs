//! The headings between which an agent chooses, by the choice of headings.

use serde::Serialize;

use crate::forces::walking::headings::{End, Fan};
use crate::simulation::Simulation;

/// The choice of an agent among headings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeadingChoice {
    /// How much it hurries, from 0 to 1.
    pub motivation: f64,
    /// The factor of its time gap T: by motivation, density and the next narrowing.
    pub gap_factor: f64,
    /// The headings, from the right of its way to its left.
    pub headings: Vec<HeadingSeen>,
}

/// A heading, as an agent sees it in the current frame. It chooses in coarse frames and holds its choice in between.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeadingSeen {
    /// Its angle from the way, degrees, positive to the left.
    pub angle: f64,
    /// Its direction, of length 1.
    pub direction: [f64; 2],
    /// The speed for which it has room, S_k, m/s.
    pub room: f64,
    /// U_k, m/s.
    pub utility: f64,
    /// Whether the agent follows it.
    pub followed: bool,
    /// The agent at which the room ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ends_at_agent: Option<u32>,
    /// The index of the wall at which the room ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ends_at_wall: Option<u32>,
}

impl HeadingChoice {
    /// The choice of agent `i` of an evaluated frame; `None` if it follows no choice of headings or does not walk.
    pub fn of(simulation: &Simulation, i: usize) -> Option<Self> {
        let fan: Fan = simulation.fan(i)?;
        let frame = simulation.frame();
        let (agents, time) = (frame.agents, frame.clock.time());
        let seen = fan.headings.iter().enumerate();
        let seen = seen.map(|(k, heading)| HeadingSeen {
            angle: heading.angle.to_degrees(),
            direction: heading.direction.into(),
            room: heading.room,
            utility: heading.utility,
            followed: k == fan.followed,
            ends_at_agent: match heading.ends_at {
                Some(End::Agent(j)) => Some(agents.id[j]),
                _ => None,
            },
            ends_at_wall: match heading.ends_at {
                Some(End::Wall(k)) => Some(k),
                _ => None,
            },
        });
        Some(Self {
            motivation: simulation.scene().motivation(agents, i, time),
            gap_factor: fan.gap,
            headings: seen.collect(),
        })
    }
}
