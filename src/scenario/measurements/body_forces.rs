//! Forces on people, in newtons.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::window::{MOST_MASS, Window, body_mass};
use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use analysis::body_forces::{BodyForces as Seen, PersonForce, THRESHOLDS, WIDTH, pressed};
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

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

    fn quantities(&self) -> Vec<Quantity> {
        let most = [
            (
                "max_n",
                "N",
                "largest force on a person: the largest principal pressure times a width of 0.5 m",
            ),
            ("max_at_secs", "s", "when it was largest"),
            ("max_x_m", "m", "where it was largest: x"),
            ("max_y_m", "m", "where it was largest: y"),
            (
                "max_stress_n_per_m",
                "N/m",
                "largest principal pressure there",
            ),
        ];
        let above = THRESHOLDS.into_iter().flat_map(|mark| {
            let of = |what: &str, unit, meaning: &str| {
                Quantity::new(
                    format!("{}_above_{mark}_n_{what}", self.name()),
                    unit,
                    meaning,
                )
            };
            [
                of(
                    "agents",
                    "agents",
                    &format!("people who were ever above {mark} N"),
                ),
                of(
                    "secs",
                    "s",
                    &format!("longest time of one person above {mark} N without a break"),
                ),
            ]
        });
        let mut quantities = Quantity::all(self.name(), &most);
        quantities.extend(above);
        quantities
    }

    fn observe(&self, (seen, secs): &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let window = self.window;
        if !window.samples.is_due(simulation) {
            return;
        }
        *secs = window.samples.secs(simulation);
        let region = window.region();
        let mut people = pressed(evaluated, self.body_mass_kg);
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
        let counts = seen.above().into_iter();
        let values = counts.flat_map(|(people, samples)| [f64::from(people), samples * secs]);
        let above = values.map(|value| peak.map(|_| value));
        most.into_iter().chain(above).collect()
    }

    fn data(&self, (seen, _): &Self::Seen) -> Option<(String, Value)> {
        let people: Vec<PersonForce> = seen.of_people().collect();
        Some((self.name().to_owned(), json!(people)))
    }
}
