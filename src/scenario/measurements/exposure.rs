//! How long people are in dense crowds and stand, and how large dense crowds are.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::window::Window;
use super::{About, Measure, Observed};
use crate::analysis::exposure::{DENSITIES, Exposed, Exposure as Seen, PersonExposure};
use crate::engine::simulation::Simulation;
use crate::scenario::error::Problem;

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

    fn names(&self) -> Vec<(String, &'static str)> {
        let exposed = [
            ("agents", "agents"),
            ("person_secs", "s"),
            ("longest_secs", "s"),
        ];
        let alarm = [
            ("area_m2", "m²"),
            ("most_agents", "agents"),
            ("alarm_secs", "s"),
        ];
        let name = |condition: &str, (what, unit): (&str, &'static str)| {
            (format!("{}_{condition}_{what}", self.name()), unit)
        };
        let dense = DENSITIES.iter().flat_map(|density| {
            let all = exposed.into_iter().chain(alarm);
            all.map(move |value| name(&format!("above_{density}"), value))
        });
        dense
            .chain(exposed.into_iter().map(|value| name("slow", value)))
            .collect()
    }

    fn observe(&self, (seen, secs): &mut Self::Seen, simulation: &Simulation) {
        let window = self.window;
        if window.samples.is_due(simulation) {
            *secs = window.samples.secs(simulation);
            seen.add(window.people(simulation, false).iter());
        }
    }

    fn values(&self, (seen, secs): &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let exposed = seen.exposed(*secs);
        let of = |exposed: &Exposed| {
            let people = f64::from(exposed.people);
            [people, exposed.person_secs, exposed.longest_secs]
        };
        let dense = exposed
            .iter()
            .zip(&seen.alarms)
            .flat_map(|(exposed, alarm)| {
                let (people, longest) = (f64::from(alarm.people), alarm.spell.longest() * secs);
                of(exposed).into_iter().chain([alarm.area, people, longest])
            });
        let slow = of(&exposed[DENSITIES.len()]);
        let was_seen = *secs > 0.0;
        dense
            .chain(slow)
            .map(|value| was_seen.then_some(value))
            .collect()
    }

    fn data(&self, (seen, secs): &Self::Seen) -> Option<(String, Value)> {
        let people: Vec<PersonExposure> = seen.of_people(*secs).collect();
        Some((self.name().to_owned(), json!(people)))
    }
}
