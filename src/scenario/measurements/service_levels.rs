//! Levels of service: how much room people have.

use schemars::JsonSchema;
use serde::Deserialize;

use super::window::Window;
use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use analysis::evaluated::Evaluated;
use analysis::service::{LEVELS, Levels};
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "service";

/// The shares of the time that people spend at each level of service, A to F, by Fruin's (1971) thresholds for walkways
/// and for queues. Planning values from the literature, not safety limits.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct ServiceLevels {
    /// The beginning of the names of its values. Default: `service`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    #[serde(flatten)]
    pub(super) window: Window,
}

impl Measure for ServiceLevels {
    type Seen = Levels;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("service_levels.region", self.window.region)
    }

    fn about(&self) -> About {
        About {
            has_thresholds: true,
            ..About::default()
        }
    }

    fn check(&self) -> Result<(), Problem> {
        self.window.check("service_levels")
    }

    fn quantities(&self) -> Vec<Quantity> {
        let name = self.name.as_deref().unwrap_or(NAME);
        let kinds = [("walkway", "for walkways"), ("queue", "for queues")].into_iter();
        let quantities = kinds.flat_map(|(kind, place)| {
            LEVELS.into_iter().map(move |level| {
                let letter = level.to_uppercase();
                let meaning = format!("share of person-seconds at Fruin's level {letter} {place}");
                Quantity::new(format!("{name}_{kind}_{level}"), "", &meaning)
            })
        });
        quantities.collect()
    }

    fn observe(&self, seen: &mut Levels, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let window = self.window;
        if window.samples.is_due(simulation) {
            seen.add(window.people(evaluated, false));
        }
    }

    fn values(&self, seen: &Levels, _: &Simulation) -> Vec<Option<f64>> {
        match seen.shares() {
            Some(shares) => shares.into_iter().flatten().map(Some).collect(),
            None => vec![None; 2 * LEVELS.len()],
        }
    }
}
