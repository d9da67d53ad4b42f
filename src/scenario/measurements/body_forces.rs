//! Forces on people, in newtons.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::window::{MOST_MASS, Window, body_mass};
use super::{About, Measure, Observed};
use crate::analysis::body_forces::{BodyForces as Seen, PersonForce, THRESHOLDS, WIDTH, pressed};
use crate::engine::simulation::Simulation;
use crate::scenario::error::Problem;

/// The name of the values if none is given.
const NAME: &str = "body_force";

/// The largest force by pressure and contact on any person, N, from the virial stress, with time and place; the number
/// of people above 623, 1112 and 6227 N and the longest time of one of them. These thresholds are from the literature
/// (Lee and Hughes 2006), not safety limits. Per agent, in the data: its largest force.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct BodyForces {
    /// The beginning of the names of its values. Default: `body_force`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    #[serde(flatten)]
    pub(super) window: Window,
    /// The mass of an average person, m = 1, kg.
    #[schemars(range(max = MOST_MASS), extend("exclusiveMinimum" = 0))]
    #[serde(default = "body_mass")]
    body_mass_kg: f64,
}

impl BodyForces {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }
}

impl Measure for BodyForces {
    /// With the time between two samples, seconds.
    type Seen = (Seen, f64);

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("body_forces.region", self.window.region)
    }

    fn about(&self) -> About {
        About {
            has_thresholds: true,
            peaks_from_start: (self.window.samples.from_secs == 0.0).then_some("body_forces"),
            ..About::default()
        }
    }

    fn check(&self) -> Result<(), Problem> {
        self.window.check("body_forces")
    }

    fn names(&self) -> Vec<(String, &'static str)> {
        let name = |what: &str| format!("{}_{what}", self.name());
        let most = [
            (name("max_n"), "N"),
            (name("max_at_secs"), "s"),
            (name("max_x_m"), "m"),
            (name("max_y_m"), "m"),
            (name("max_stress_n_per_m"), "N/m"),
        ];
        let above = THRESHOLDS.into_iter().flat_map(|mark| {
            [
                (name(&format!("above_{mark}_n_agents")), "agents"),
                (name(&format!("above_{mark}_n_secs")), "s"),
            ]
        });
        most.into_iter().chain(above).collect()
    }

    fn observe(&self, (seen, secs): &mut Self::Seen, simulation: &Simulation) {
        let window = self.window;
        if !window.samples.is_due(simulation) {
            return;
        }
        *secs = window.samples.secs(simulation);
        let region = window.region();
        let mut people = pressed(simulation, self.body_mass_kg);
        people.retain(|person| region.is_none_or(|region| region.contains(person.position)));
        seen.add(simulation.frame().clock.time(), &people);
    }

    fn values(&self, (seen, secs): &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let peak = seen.peak;
        let most = [
            peak.map(|(person, _)| person.force),
            peak.map(|(_, time)| time),
            peak.map(|(person, _)| person.position.x),
            peak.map(|(person, _)| person.position.y),
            peak.map(|(person, _)| person.force / WIDTH),
        ];
        let above = seen.above().into_iter();
        let above = above.flat_map(|(people, samples)| [f64::from(people), samples * secs]);
        let above = above.map(|value| peak.map(|_| value));
        most.into_iter().chain(above).collect()
    }

    fn data(&self, (seen, _): &Self::Seen) -> Option<(String, Value)> {
        let people: Vec<PersonForce> = seen.of_people().collect();
        Some((self.name().to_owned(), json!(people)))
    }
}
