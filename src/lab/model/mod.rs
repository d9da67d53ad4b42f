//! The error of the model: how far a result may be from what people would do.
//!
//! `sandbox validate` compares values of each profile with measured ones. What remains between both is the error of the
//! model: it is not known for a scene that nobody has measured, but its sizes in experiments are. [`Deviations`] turn
//! them into intervals, and [`Model`] says for which results of a scenario these count.

mod deviations;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::error::LabError;
use analysis::round;
use deviations::{Deviations, Factors};
pub use deviations::{People, SHARE};
use runs::summary::Summary;
use scenario::Scenario;
use scenario::measurements::Measurement;
use scenario::quote::shown;

/// Results of every run that are times at which people have left.
const TIMES: [&str; 4] = ["time_secs", "t50_secs", "t95_secs", "t100_secs"];
/// People who are told to hurry at least this much count as hurried.
const HURRIED: f64 = 0.5;
/// A queue of this many people, and of this part of all, makes the time that people take to leave.
const LONG_QUEUE: f64 = 5.0;
const LONG_QUEUE_SHARE: f64 = 0.05;

/// What a result is about: results about the same vary and deviate alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Densities.
    Density,
    /// Flows, also per width.
    Flow,
    /// Speeds.
    Speed,
    /// Times.
    Time,
}

impl Quantity {
    /// By the unit of a result.
    pub fn of_unit(unit: &str) -> Option<Self> {
        match unit {
            "P/m²" => Some(Self::Density),
            "P/s" | "P/(m s)" => Some(Self::Flow),
            "m/s" => Some(Self::Speed),
            "s" => Some(Self::Time),
            _ => None,
        }
    }
}

/// What experiments say about the results of a scenario.
pub struct Model {
    /// The deviations of the profile from experiments, or why there are none.
    known: Result<Deviations, String>,
    people: People,
    measurements: Vec<Measurement>,
}

/// The part of the model in the error of a result.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ModelPart {
    /// The bounds of what people would do, in the unit of the result.
    pub low: f64,
    /// The upper one.
    pub high: f64,
    /// The probability with which they hold it.
    pub share: f64,
    /// The number of experiments that measure results of this kind.
    pub experiments: usize,
    /// Those of them with people like these.
    pub alike: usize,
    /// The people of the scenario.
    pub people: People,
    /// Whether flows are compared, and the result is a time that follows from them.
    pub through_flows: bool,
}

impl Model {
    /// What is known for the profile and the people of a scenario.
    ///
    /// # Errors
    /// Data that ship with the program are invalid.
    pub fn of(scenario: &Scenario) -> Result<Self, LabError> {
        let profile = &scenario.profile_name;
        let groups = &scenario.scene.groups;
        let known = if changes_profile(scenario) {
            Err("this run changes parameters of the profile, so its comparison with experiments does not count".into())
        } else if groups.iter().any(|group| group.blend.name != *profile) {
            Err("its people have several profiles".to_owned())
        } else {
            let unknown = || {
                let name = shown(profile);
                format!("the profile `{name}` was not compared with experiments")
            };
            Deviations::of(profile)?.ok_or_else(unknown)
        };
        let motivations = groups.iter().map(|group| group.motivation);
        Ok(Self {
            known,
            people: match motivations.fold(0.0, f64::max) >= HURRIED {
                true => People::Hurried,
                false => People::Calm,
            },
            measurements: scenario.measurements.clone(),
        })
    }

    /// The part of the model in a result with this mean over `runs`.
    ///
    /// # Errors
    /// Why no experiment is comparable, in words.
    pub fn part<'r>(
        &self,
        name: &str,
        value: f64,
        runs: impl Iterator<Item = &'r Summary>,
    ) -> Result<ModelPart, String> {
        let known = self.known.as_ref().map_err(Clone::clone)?;
        let all: Vec<&Summary> = runs.collect();
        if TIMES.contains(&name) {
            if !all.iter().any(|run| has_queue(run)) {
                return Err(
                    "no queue formed, so it does not follow from a flow that experiments measure"
                        .into(),
                );
            }
            let flows = self.factors(known, Quantity::Flow)?;
            let first = mean(all.iter().filter_map(|run| run.first_secs)).unwrap_or(0.0);
            let after = value - first;
            let bounds = [first + after / flows.high, first + after / flows.low];
            return Ok(self.bounded(bounds, &flows, true));
        }
        let quantity = self.quantity(name).ok_or("no experiment measures it")?;
        let factors = self.factors(known, quantity)?;
        let bounds = [value * factors.low, value * factors.high];
        Ok(self.bounded(bounds, &factors, false))
    }

    fn factors(&self, known: &Deviations, quantity: Quantity) -> Result<Factors, String> {
        known
            .factors(quantity, self.people)
            .ok_or_else(|| "too few experiments measure it".to_owned())
    }

    fn bounded(&self, [low, high]: [f64; 2], of: &Factors, through_flows: bool) -> ModelPart {
        ModelPart {
            low,
            high,
            share: SHARE,
            experiments: of.experiments,
            alike: of.alike,
            people: self.people,
            through_flows,
        }
    }

    /// What a result is about, if experiments measure it: flows, and densities and speeds before lines or by density.
    fn quantity(&self, name: &str) -> Option<Quantity> {
        let of = |one: &Measurement| one.quantities().into_iter().find(|own| own.name == name);
        let (measurement, found) = self
            .measurements
            .iter()
            .find_map(|one| Some((one, of(one)?)))?;
        let is_spread = found.meaning.contains("standard deviation");
        let quantity = Quantity::of_unit(found.unit).filter(|_| !is_spread)?;
        let is_measured = matches!(
            measurement,
            Measurement::LineFlow(_) | Measurement::SpeedByDensity(_)
        );
        match quantity {
            Quantity::Flow => Some(quantity),
            Quantity::Density | Quantity::Speed => Some(quantity).filter(|_| is_measured),
            Quantity::Time => None,
        }
    }
}

impl ModelPart {
    /// In words, around this value, with numbers written as `written` does: `model −10 … +25 (90 %; …)`.
    pub fn text(&self, value: f64, written: impl Fn(f64) -> String) -> String {
        let [low, high] = around(value, [self.low, self.high], written);
        let flows = match self.through_flows {
            true => ", by their flows",
            false => "",
        };
        format!(
            "model {low} … {high} ({} %; {} experiments{flows}, {} of them with {} people)",
            round::brief(100.0 * self.share),
            self.experiments,
            self.alike,
            self.people.word(),
        )
    }
}

/// Two bounds as differences from a value, with their signs: `−10` and `+25`.
pub fn around(value: f64, bounds: [f64; 2], written: impl Fn(f64) -> String) -> [String; 2] {
    bounds.map(|bound| {
        let sign = if bound < value { '−' } else { '+' };
        format!("{sign}{}", written((bound - value).abs()))
    })
}

/// Whether people wait in a long queue.
fn has_queue(run: &Summary) -> bool {
    let longest = run.longest_queues.first().map_or(0, |queue| queue.agents);
    f64::from(longest) >= LONG_QUEUE.max(LONG_QUEUE_SHARE * f64::from(run.agents))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let all: Vec<f64> = values.collect();
    let sum: f64 = all.iter().sum();
    (!all.is_empty()).then(|| sum / all.len() as f64)
}

/// A parameter of the computation that presets set: no change of the model.
const OF_PRESETS: &str = "avoidance_tolerance";

/// Whether a scenario changes parameters of its profiles.
pub fn changes_profile(scenario: &Scenario) -> bool {
    let parameters = scenario.document.get("parameters");
    let own = parameters.and_then(Value::as_object);
    own.is_some_and(|own| own.keys().any(|name| name != OF_PRESETS))
}
