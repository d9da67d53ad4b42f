//! The rule by which agents choose, between places and between routes.
//!
//! An agent expects to pass a line when it has walked there, or when all agents that pass it before have walked there
//! and passed at its flow, whichever is later. Agents change their minds only for what is clearly quicker.

use serde::Serialize;

use super::stream::Stream;

/// An agent changes its mind if that saves at least this time, seconds, and this part of the time.
const LEAST_GAIN: f64 = 1.0;
const LEAST_SHARE: f64 = 0.1;

/// The times that an agent expects for passing a line, and for walking on to its next stage or its goal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Expected {
    /// Walking to the line, seconds.
    pub walking_secs: f64,
    /// Agents that pass the line before: those that are nearer, and at openings those that come from the other side.
    pub ahead: u32,
    /// The flow through the line, P/s; `None` if it is unlimited.
    pub flow_per_sec: Option<f64>,
    /// Waiting until these agents have passed, seconds; at a closed door, until it opens.
    pub waiting_secs: f64,
    /// Walking on from the line, seconds.
    pub onward_secs: f64,
    /// The total time, seconds: the crowd ahead passes while the agent walks.
    pub total_secs: f64,
}

impl Expected {
    /// The time until the agent has passed the line, seconds.
    pub fn through_secs(&self) -> f64 {
        self.walking_secs.max(self.waiting_secs)
    }

    /// The same if walking to the line takes another time, seconds.
    #[must_use]
    pub(super) fn walking(self, walking_secs: f64) -> Self {
        Self {
            walking_secs,
            total_secs: walking_secs.max(self.waiting_secs) + self.onward_secs,
            ..self
        }
    }
}

/// A line, as an agent sees it.
pub(super) struct Line<'a> {
    /// Its distance from the agent, meters.
    pub length: f64,
    /// The agents bound for it; `None` if they have not been counted yet.
    pub stream: Option<&'a Stream>,
    /// The number of agents from the other side that pass it before the agent.
    pub oncoming: u32,
    /// Its flow, P/s.
    pub flow: f64,
}

impl Line<'_> {
    /// The time until all agents that pass the line before have passed it, seconds; they walk there at `speed`.
    pub fn waiting(&self, speed: f64) -> f64 {
        let own = self.stream;
        let clear = own.map_or(0.0, |own| own.clear_after(self.length, speed, self.flow));
        clear + f64::from(self.oncoming) / self.flow
    }

    /// What an agent expects that walks to the line, waits there and walks on, in parts, for these times, seconds.
    pub fn expected(&self, walking: f64, waiting: f64, onward: &[f64]) -> Expected {
        let nearer = (self.stream).map_or(0, |own| own.nearer_than(self.length));
        let through = walking.max(waiting);
        Expected {
            walking_secs: walking,
            ahead: nearer + self.oncoming,
            flow_per_sec: Some(self.flow).filter(|flow| flow.is_finite()),
            waiting_secs: waiting,
            onward_secs: onward.iter().sum(),
            total_secs: onward.iter().fold(through, |sum, secs| sum + secs),
        }
    }
}

/// Whether something that takes `new` seconds is so much quicker than what takes `old` that an agent changes to it.
pub(super) fn is_clearly_quicker(new: f64, old: f64) -> bool {
    new < old - LEAST_GAIN.max(LEAST_SHARE * old)
}

/// Of some things with their values, the one with the least value, but `kept` unless the least one `is_better`. Also
/// returns whether `kept` has not the least value; `None` if there is nothing.
pub(super) fn least_or_kept<T: Copy + PartialEq>(
    values: impl Iterator<Item = (T, f64)> + Clone,
    kept: Option<T>,
    is_better: impl Fn(f64, f64) -> bool,
) -> Option<(T, bool)> {
    let own = kept.and_then(|kept| values.clone().find(|(one, _)| *one == kept));
    let (least, value) = values.min_by(|a, b| a.1.total_cmp(&b.1))?;
    match own {
        Some((kept, own)) if !is_better(value, own) => Some((kept, kept != least)),
        _ => Some((least, false)),
    }
}
