//! The progress of an agent on its journey.

use serde::{Deserialize, Serialize};

use crate::math::Vector;

/// The progress of an agent on its journey.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Trip {
    /// The number of its journey.
    pub journey: u16,
    /// The current stage, from 0.
    pub stage: u16,
    /// The place that it has chosen for this stage.
    pub place: u16,
    /// What it does.
    pub status: Status,
    /// The spot where it stands or wants to stand, meters; `None` while it walks to its place.
    pub hold: Option<Vector>,
    /// The frame in which it chooses between places again.
    pub chooses_at: u64,
    /// The number of its choices so far.
    pub choices: u32,
    /// The time of its entry, seconds.
    pub entered: f64,
    /// The time that it has waited in waiting areas and queues, seconds.
    pub waited: f64,
}

impl Trip {
    /// Whether the agent has left by an exit, and only its body walks on.
    pub fn is_outside(&self) -> bool {
        matches!(self.status, Status::Outside { .. })
    }

    /// The place that the agent walks to or is at; `None` once it has left the journey for a goal of its own, or has
    /// left by an exit.
    pub fn place_ahead(&self) -> Option<u16> {
        let has_left = self.status == Status::Finished && self.hold.is_none();
        (!has_left && !self.is_outside()).then_some(self.place)
    }
}

/// What an agent on a journey does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// It walks to its place.
    Walking,
    /// It waits in a waiting area.
    Waiting {
        /// The number of its spot.
        spot: u32,
        /// The frame in which it arrived.
        since: u64,
        /// The frame in which it goes on, if nothing releases it earlier.
        until: u64,
    },
    /// It stands in a queue.
    Queued {
        /// Agents with lower numbers are ahead.
        ticket: u32,
        /// The frame in which it arrived.
        since: u64,
        /// The frame in which it has been served, once it is being served.
        until: Option<u64>,
    },
    /// It has ended its journey and stays. Or it has abandoned the journey and walks to its goal; then `hold` is
    /// `None`.
    Finished,
    /// It has left by an exit. Its body walks on behind the line, so that agents before the line do not walk into a gap
    /// that real doors do not have.
    Outside {
        /// The last frame of the body.
        until: u64,
    },
}
