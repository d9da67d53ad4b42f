//! Quantities of a run, and functions of several values.

use serde::de::{Deserialize, Deserializer};
use serde_untagged::UntaggedEnumVisitor;

use analysis::statistics::{MeanStd, uniform_probability};
use engine::distribution::{Distribution, Family};
use runs::summary::{PlaceResult, Summary};
use scenario::measurements::Walk;

/// What every run counts, beside its measurements.
pub(super) const COUNTS: [&str; 4] = ["entered", "remaining", "stuck", "time_secs"];

/// A quantity of a run.
#[derive(Debug, Clone)]
pub enum Quantity {
    /// A measured value, or one of `COUNTS`.
    Named(String),
    /// Another one.
    Other(Other),
}

/// A quantity that is not measured by name.
#[derive(Debug, Clone, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Other {
    /// The number of agents that have passed this place.
    Passed(String),
    /// The flow of all agents at this exit, P/s.
    Flow(String),
    /// A statistic of the walks of agents.
    Walks(OfWalks),
}

/// A statistic of the walks of agents.
#[derive(Debug, Clone, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OfWalks {
    /// The name of the measurement.
    #[serde(default = "walks")]
    pub(super) name: String,
    /// The name of the agents' group; all groups without one.
    pub(super) group: Option<String>,
    each: Each,
    take: Take,
}

fn walks() -> String {
    "walks".to_owned()
}

/// A value of each walk.
#[derive(Debug, Clone, Copy, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum Each {
    /// The time in the region, seconds.
    Secs,
    /// The speed there, m/s.
    Speed,
    /// s_pref, m/s.
    PreferredSpeed,
    /// The distance of the speed from s_pref, m/s.
    SpeedError,
    /// The time of the start, seconds.
    StartedSecs,
    /// Its distance from the time at which the agent may start, seconds.
    StartErrorSecs,
}

/// A statistic of the values of all walks.
#[derive(Debug, Clone, Copy, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum Take {
    Mean,
    StandardDeviation,
    Largest,
    /// The probability that values of this distribution differ from it by as much (Kolmogorov–Smirnov test).
    Probability(Spread),
}

/// A distribution.
#[derive(Debug, Clone, Copy, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum Spread {
    Uniform([f64; 2]),
    /// Shape and scale.
    Gamma([f64; 2]),
    /// Mean and standard deviation of the logarithm.
    Lognormal([f64; 2]),
    /// Scale and shape.
    Weibull([f64; 2]),
}

/// A function of several values: of all quantities of the first run, then of the second, and so on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Function {
    /// The mean.
    Mean,
    /// The sum.
    Sum,
    /// The first value minus the second.
    Difference,
    /// The mean of the first half over the mean of the second half.
    Ratio,
    /// Where the second value lies between the first (0) and the third (1).
    Place,
}

impl Function {
    /// The reason if it does not take this number of values.
    pub(super) fn refuses(self, count: usize) -> Option<&'static str> {
        match self {
            Self::Mean | Self::Sum => None,
            Self::Difference => (count != 2).then_some("needs two values"),
            Self::Ratio => (!count.is_multiple_of(2)).then_some("needs an even number of values"),
            Self::Place => (count != 3).then_some("needs three values"),
        }
    }

    /// Its value.
    pub(super) fn of(self, values: &[f64]) -> f64 {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        match (self, values) {
            (Self::Difference, [one, other, ..]) => one - other,
            (Self::Place, [from, at, to, ..]) => (at - from) / (to - from),
            (Self::Ratio, _) => {
                let (over, under) = values.split_at(values.len() / 2);
                mean(over) / mean(under)
            }
            (Self::Sum, _) => values.iter().sum(),
            _ => mean(values),
        }
    }
}

impl Quantity {
    /// The value in a run; `None` if it has none.
    pub(super) fn value(&self, run: &Summary) -> Option<f64> {
        let place = |name: &String| run.places.iter().find(|place| place.name == *name);
        match self {
            Self::Named(name) => match name.as_str() {
                "entered" => Some(f64::from(run.agents)),
                "remaining" => Some(run.remaining as f64),
                "stuck" => Some(run.stuck as f64),
                "time_secs" => Some(run.time_secs),
                name => run.metric(name),
            },
            Self::Other(Other::Passed(name)) => Some(f64::from(place(name)?.passed)),
            Self::Other(Other::Flow(exit)) => flow(place(exit)?),
            Self::Other(Other::Walks(of)) => of.value(&run.data::<Vec<Walk>>(&of.name)?),
        }
    }
}

/// The flow of all agents at an exit, P/s.
fn flow(exit: &PlaceResult) -> Option<f64> {
    let [from, to] = exit.from_to_secs?;
    Some(f64::from(exit.passed.saturating_sub(1)) / (to - from))
}

impl OfWalks {
    fn value(&self, walks: &[Walk]) -> Option<f64> {
        let is_own = |walk: &&Walk| self.group.as_ref().is_none_or(|group| walk.group == *group);
        let own = walks.iter().filter(is_own);
        let all: Option<Vec<f64>> = own.map(|walk| self.each.value(walk)).collect();
        let values = all?;
        let found = MeanStd::of(&values);
        match self.take {
            Take::Mean => found.map(|found| found.mean),
            Take::StandardDeviation => found.and_then(|found| found.std()),
            Take::Largest => values.into_iter().reduce(f64::max),
            Take::Probability(spread) => {
                let unbounded = [f64::NEG_INFINITY, f64::INFINITY];
                let spread = Distribution::new(&spread.family(), unbounded).ok()?;
                let shares = values.into_iter().map(|value| spread.share_up_to(value));
                uniform_probability(&shares.collect::<Vec<_>>())
            }
        }
    }
}

impl Each {
    fn value(self, walk: &Walk) -> Option<f64> {
        let speed = walk.meters / walk.secs;
        match self {
            Self::Secs => Some(walk.secs),
            Self::Speed => Some(speed),
            Self::PreferredSpeed => Some(walk.preferred_speed),
            Self::SpeedError => Some((speed - walk.preferred_speed).abs()),
            Self::StartedSecs => walk.started_secs,
            Self::StartErrorSecs => Some((walk.started_secs? - walk.due_secs).abs()),
        }
    }
}

impl Spread {
    fn family(self) -> Family {
        match self {
            Self::Uniform(ends) => Family::Uniform(ends),
            Self::Gamma(shape_scale) => Family::Gamma(shape_scale),
            Self::Lognormal(mean_std) => Family::LogNormal(mean_std),
            Self::Weibull(scale_shape) => Family::Weibull(scale_shape),
        }
    }
}

/// Not derived: the errors of a derived untagged enum do not name the wrong key.
impl<'de> Deserialize<'de> for Quantity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        UntaggedEnumVisitor::new()
            .expecting("the name of a quantity, or an object such as {\"passed\": \"door\"}")
            .string(|name| Ok(Self::Named(name.to_owned())))
            .map(|keys| Ok(Self::Other(keys.deserialize()?)))
            .deserialize(deserializer)
    }
}
