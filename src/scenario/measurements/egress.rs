//! How long people take to leave: the times by which parts of them have left.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Measure;
use crate::engine::simulation::Simulation;

/// Of the people on one journey, or on all journeys: how many have left at an exit, the mean time from entry to exit,
/// and the times by which 50 %, 95 % and all have left.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Egress {
    /// The name of the journey. Default: all journeys.
    journey: Option<String>,
}

/// How people on a journey have left.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// The number of people who have begun the journey.
    pub started: u32,
    /// The number of people who have left at an exit.
    pub finished: u32,
    /// The mean time from entry to exit, seconds.
    pub mean_secs: Option<f64>,
    /// When half of those who have started had left, seconds.
    pub t50_secs: Option<f64>,
    /// When 95 % of them had left, seconds.
    pub t95_secs: Option<f64>,
    /// When all of them had left, seconds.
    pub t100_secs: Option<f64>,
    /// The mean time spent in waiting areas and queues by those who have left, seconds.
    pub waited_secs: Option<f64>,
}

impl Left {
    /// Those on the journey with this number; `None`: on all journeys.
    pub fn of(simulation: &Simulation, journey: Option<u16>) -> Self {
        let begun = simulation.progress().begun.iter().enumerate();
        let asked = |number: usize| journey.is_none_or(|journey| usize::from(journey) == number);
        let started = begun.filter(|(k, _)| asked(*k)).map(|(_, count)| count);
        let started: u32 = started.sum();
        let arrivals = simulation.outcome().arrivals.iter();
        let left = arrivals.filter_map(|arrival| {
            let trip = arrival
                .trip
                .filter(|trip| asked(usize::from(trip.journey)))?;
            Some((arrival.time, arrival.time - trip.entered, trip.waited))
        });
        let left: Vec<(f64, f64, f64)> = left.collect(); // by time, as arrivals are
        let mean = |value: fn(&(f64, f64, f64)) -> f64| {
            let sum: f64 = left.iter().map(value).sum();
            (!left.is_empty()).then(|| sum / left.len() as f64)
        };
        let time_of = |part: f64| {
            let count = (part * f64::from(started)).ceil() as usize;
            let last = count.checked_sub(1).and_then(|k| left.get(k));
            last.map(|&(time, ..)| time)
        };
        Self {
            started,
            finished: left.len() as u32,
            mean_secs: mean(|&(_, lasting, _)| lasting),
            t50_secs: time_of(0.5),
            t95_secs: time_of(0.95),
            t100_secs: time_of(1.0),
            waited_secs: mean(|&(.., waited)| waited),
        }
    }
}

impl Measure for Egress {
    type Seen = ();

    fn names(&self) -> Vec<(String, &'static str)> {
        let of = self.journey.as_ref();
        let of = of.map_or(String::new(), |journey| format!("_{journey}"));
        let name = |(name, unit): (&str, &'static str)| (format!("{name}{of}"), unit);
        let values = [
            ("finished", "agents"),
            ("mean_secs", "s"),
            ("t50_secs", "s"),
            ("t95_secs", "s"),
            ("t100_secs", "s"),
        ];
        values.into_iter().map(name).collect()
    }

    fn values(&self, (): &(), simulation: &Simulation) -> Vec<Option<f64>> {
        let journeys = &simulation.scene().journeys.journeys;
        let number = self.journey.as_ref().map(|name| {
            let found = journeys.iter().position(|journey| journey.name == *name);
            found.map(|k| k as u16)
        });
        let Some(number) = number.map_or(Some(None), |found| found.map(Some)) else {
            return vec![None; 5];
        };
        let left = Left::of(simulation, number);
        vec![
            Some(f64::from(left.finished)),
            left.mean_secs,
            left.t50_secs,
            left.t95_secs,
            left.t100_secs,
        ]
    }
}
