//! Levels of service: how much room people have.

use schemars::JsonSchema;
use serde::Deserialize;

use super::window::{Window, every};
use super::{Measure, Observed};
use crate::analysis::service::{LEVELS, Levels};
use crate::engine::simulation::Simulation;
use crate::scenario::error::Problem;
use crate::scenario::keys::limits::LONGEST_TIME;
use crate::scenario::keys::shapes::Corners;

/// The name of the values if none is given.
const NAME: &str = "service";

/// The shares of the time that people spend at each level of service, A to F, by Fruin's (1971) thresholds for walkways
/// and for queues. Planning values from the literature, not safety limits.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ServiceLevels {
    /// The beginning of the names of its values. Default: `service`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    /// The region: lower left and upper right corner, meters; everywhere if missing.
    pub(super) region: Option<Corners>,
    /// The start, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    #[serde(default)]
    from_secs: f64,
    /// The end, seconds. Default: the end of the run.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    until_secs: Option<f64>,
    /// Time between two samples, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    #[serde(default = "every")]
    every_secs: f64,
}

impl ServiceLevels {
    fn window(&self) -> Window {
        Window {
            region: self.region,
            from_secs: self.from_secs,
            until_secs: self.until_secs,
            every_secs: self.every_secs,
        }
    }
}

impl Measure for ServiceLevels {
    type Seen = Levels;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("service_levels.region", self.region)
    }

    fn check(&self) -> Result<(), Problem> {
        self.window().check("service_levels")
    }

    fn names(&self) -> Vec<(String, &'static str)> {
        let name = self.name.as_deref().unwrap_or(NAME);
        let kinds = ["walkway", "queue"].into_iter();
        let names = kinds.flat_map(|kind| {
            let levels = LEVELS.into_iter();
            levels.map(move |level| (format!("{name}_{kind}_{level}"), ""))
        });
        names.collect()
    }

    fn observe(&self, seen: &mut Levels, simulation: &Simulation) {
        let window = self.window();
        if window.is_due(simulation) {
            seen.add(window.people(simulation, false).iter());
        }
    }

    fn values(&self, seen: &Levels, _: &Simulation) -> Vec<Option<f64>> {
        match seen.shares() {
            Some(shares) => shares.into_iter().flatten().map(Some).collect(),
            None => vec![None; 2 * LEVELS.len()],
        }
    }
}
