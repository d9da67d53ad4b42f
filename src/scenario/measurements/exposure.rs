//! How long people are in dense crowds and stand, and how large dense crowds are.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::window::Window;
use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use analysis::evaluated::Evaluated;
use analysis::exposure::{DENSITIES, Exposed, Exposure as Seen, PersonExposure};
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "exposure";

/// How long people are above 4, 5 and 6 P/m² and below 0.2 m/s, and the alarms: the largest area, the most people and
/// the longest time above each density. Per agent, in the data: its seconds. Values from the literature, not limits of
/// safety.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Exposure {
    /// The beginning of the names of its values. Default: `exposure`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    #[serde(flatten)]
    pub(super) window: Window,
}

impl Exposure {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }
}

impl Measure for Exposure {
    /// With the time between two samples, seconds.
    type Seen = (Seen, f64);

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("exposure.region", self.window.region)
    }

    fn about(&self) -> About {
        About {
            has_thresholds: true,
            ..About::default()
        }
    }

    fn check(&self) -> Result<(), Problem> {
        self.window.check("exposure")
    }

    fn quantities(&self) -> Vec<Quantity> {
        let named = |short: &str, (what, unit, meaning): (&str, &'static str, String)| {
            Quantity::new(format!("{}_{short}_{what}", self.name()), unit, &meaning)
        };
        let exposed = |condition: &str, short: &str| {
            [
                (
                    "agents",
                    "agents",
                    format!("people who were ever {condition}"),
                ),
                (
                    "person_secs",
                    "s",
                    format!("sum of their times {condition}"),
                ),
                (
                    "longest_secs",
                    "s",
                    format!("longest total time of one person {condition}"),
                ),
            ]
            .map(|value| named(short, value))
        };
        let dense = DENSITIES.iter().flat_map(|density| {
            let above = format!("above {density} P/m² (h = √5 m)");
            let short = format!("above_{density}");
            let alarm = [
                (
                    "area_m2",
                    "m²",
                    format!("largest area at one time, Σ 1/ρ_i over the people {above}"),
                ),
                (
                    "most_agents",
                    "agents",
                    format!("most people {above} at one time"),
                ),
                (
                    "alarm_secs",
                    "s",
                    format!("longest time without a break with at least one person {above}"),
                ),
            ]
            .map(|value| named(&short, value));
            exposed(&above, &short).into_iter().chain(alarm)
        });
        let slow = exposed("slower than 0.2 m/s", "slow");
        dense.chain(slow).collect()
    }

    fn observe(&self, (seen, secs): &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let window = self.window;
        if window.samples.is_due(simulation) {
            *secs = window.samples.secs(simulation);
            seen.add(window.people(evaluated, false));
        }
    }

    fn values(&self, (seen, secs): &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let exposed = seen.exposed(*secs);
        let of = |exposed: &Exposed| {
            let people = f64::from(exposed.people);
            [people, exposed.person_secs, exposed.longest_secs]
        };
        let pairs = exposed.iter().zip(&seen.alarms);
        let dense = pairs.flat_map(|(exposed, alarm)| {
            let (people, longest) = (f64::from(alarm.people), alarm.spell.longest() * secs);
            of(exposed).into_iter().chain([alarm.area, people, longest])
        });
        let slow = of(&exposed[DENSITIES.len()]);
        let was_seen = *secs > 0.0;
        let all = dense.chain(slow);
        all.map(|value| was_seen.then_some(value)).collect()
    }

    fn data(&self, (seen, secs): &Self::Seen) -> Option<(String, Value)> {
        let people: Vec<PersonExposure> = seen.of_people(*secs).collect();
        Some((self.name().to_owned(), json!(people)))
    }
}
