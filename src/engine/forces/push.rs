//! The force from outside on the agents of a push, as it was measured.

use serde::{Deserialize, Serialize};

use super::own::Force;
use super::rates::{Extremes, Rates};
use crate::frame::Frame;
use crate::math::Vector;

/// A force on the agents that take part in a push, whatever their profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PushForce {
    /// The index of the push in the scene.
    pub push: u16,
    /// When the push begins, seconds.
    pub at: f64,
    /// Where the force points: a unit vector.
    pub direction: Vector,
    /// Seconds since `at`, rising, and accelerations, m/s²: straight lines in between, zero before and behind.
    pub curve: Vec<[f64; 2]>,
}

impl PushForce {
    /// The acceleration at this time since the beginning of the push, m/s².
    pub fn strength(&self, secs: f64) -> f64 {
        let next = self.curve.partition_point(|[at, _]| *at <= secs);
        match (
            next.checked_sub(1).map(|k| self.curve[k]),
            self.curve.get(next),
        ) {
            (Some([from, start]), Some([to, end])) => {
                start + (end - start) * (secs - from) / (to - from)
            }
            (Some([last, end]), None) if last == secs => end,
            _ => 0.0,
        }
    }
}

impl Force for PushForce {
    fn name(&self) -> &str {
        "push"
    }

    fn rates(&self, _: &Extremes) -> Rates {
        Rates::default()
    }

    fn acceleration(&self, frame: &Frame, i: usize) -> Vector {
        match frame.agents.push[i] == Some(self.push) {
            true => self.direction * self.strength(frame.clock.time() - self.at),
            false => Vector::zeros(),
        }
    }
}
