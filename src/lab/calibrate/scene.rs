//! Scenes with their measured values: cases of the validation, or own scenarios.

use serde::Serialize;

use super::file::Rule;
use crate::suite::Check;
use runs::case::{Case, RunResult};

/// The measurement of people who pass through walls.
const THROUGH_WALLS: &str = "agents_through_walls";

/// What a value is compared for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Set {
    /// The search minimizes its residual.
    Fit,
    /// Held out from the search: the same kind of scene.
    HoldOut,
    /// Held out from the search: another kind of scene.
    Transfer,
}

impl Set {
    /// All sets.
    pub const ALL: [Self; 3] = [Self::Fit, Self::HoldOut, Self::Transfer];

    /// Its name for readers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::HoldOut => "hold-out",
            Self::Transfer => "transfer",
        }
    }
}

/// One run, without parameters and seed.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Its name in messages.
    pub name: String,
    /// The run without the parameters.
    pub(super) case: Case,
    /// Its document without the parameters.
    pub(super) document: serde_json::Value,
    /// Whether it stops when it is empty.
    pub(super) ends_empty: bool,
}

/// A measured value.
#[derive(Clone)]
pub struct Target {
    /// What it is compared for.
    pub set: Set,
    /// The number of its scene.
    pub scene: usize,
    /// The name of the case or scenario.
    pub of: String,
    /// The quantity, with its unit if it is known.
    pub quantity: String,
    /// The measured value.
    pub measured: f64,
    /// The tolerance, as a fraction of the measured value.
    pub tolerance: f64,
    /// Gives the value of a run.
    pub(super) check: Check,
}

impl Target {
    /// The value of a run, or the reason why it has none.
    pub(super) fn read(&self, scene: &Scene, run: &RunResult, rule: &Rule) -> Result<f64, String> {
        let through = run.summary.metric(THROUGH_WALLS).unwrap_or_default();
        if through > 0.0 {
            return Err(format!("{through} people passed through walls"));
        }
        if let Some(why) = scene.stuck(run, rule.stuck_secs) {
            return Err(why);
        }
        let value = self.check.value(|_| Some(&run.summary));
        match value {
            Some(value) if value > 0.0 => Ok(value),
            Some(value) => Err(format!("{} is {value}", self.quantity)),
            None => Err(format!("{} has no value", self.quantity)),
        }
    }
}

impl Scene {
    /// Estimated time of its run on one core, seconds.
    pub fn expected_secs(&self) -> f64 {
        self.case.expected_secs
    }

    /// The reason why a run is stuck; `None` if it is not.
    fn stuck(&self, run: &RunResult, secs: f64) -> Option<String> {
        let backlogs = run.summary.backlogs.iter();
        let waiting: u32 = backlogs.map(|backlog| backlog.at_end).sum();
        let left = run.summary.remaining + waiting as usize;
        if !self.ends_empty || left == 0 {
            return None;
        }
        let exits = run.summary.places.iter();
        let ends = exits.filter_map(|exit| Some(exit.from_to_secs?[1]));
        let last = ends.max_by(f64::total_cmp);
        let idle = run.summary.time_secs - last.unwrap_or_default();
        (idle > secs).then(|| match last {
            Some(last) => {
                format!("stuck: {left} people are left after the last one left at {last:.1} s")
            }
            None => format!("stuck: {left} people are left"),
        })
    }
}
