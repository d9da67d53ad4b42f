//! Measurements of arrivals: their number, flows (Tables 1 and 2), pauses.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Measure, Observed, Quantity};
use crate::keys::limits::LONGEST_TIME;
use engine::clock::Clock;
use engine::simulation::Simulation;

/// Decimal times are rarely whole frames: a part of a frame.
const ROUNDING: f64 = 1e-6;

/// (n − 1) / (time of the n-th counted arrival − time of the first), P/s.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowOfFirst {
    /// n, at least 2.
    #[schemars(range(min = 2))]
    arrivals: u32,
}

/// Counted arrivals until the frame nearest to a given time, divided by the time of that frame, P/s.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FlowUntil {
    /// The time, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    until_secs: f64,
}

/// The number of counted arrivals.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evacuated {}

/// The number of arrivals that are not counted.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Uncounted {}

/// The sum of all long gaps between the first n counted arrivals, seconds, and the flow of these arrivals without the
/// gaps, P/s.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pauses {
    /// n, at least 2.
    #[schemars(range(min = 2))]
    arrivals: u32,
    /// Gaps at least this long are pauses, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    longer_than_secs: f64,
}

/// 1 if fewer than n counted agents have arrived at the end of the run, else 0; its mean over seeds is the share of
/// runs that lock.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Locked {
    /// n, at least 2.
    #[schemars(range(min = 2))]
    arrivals: u32,
}

impl Measure for FlowOfFirst {
    type Seen = ();

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        let meaning = format!(
            "(n − 1) / (time of the n-th counted arrival − time of the first), n = {}",
            self.arrivals
        );
        vec![Quantity::new("flow_per_s", "P/s", &meaning)]
    }

    fn values(&self, (): &(), simulation: &Simulation) -> Vec<Option<f64>> {
        let times = first(simulation, self.arrivals);
        vec![times.and_then(|times| flow(&times, 0.0))]
    }
}

impl Measure for FlowUntil {
    type Seen = ();

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        let secs = self.until_secs;
        let meaning = format!("counted arrivals in the first {secs} s, per second");
        vec![Quantity::new(
            format!("flow_first_{secs}s_per_s"),
            "P/s",
            &meaning,
        )]
    }

    fn values(&self, (): &(), simulation: &Simulation) -> Vec<Option<f64>> {
        let clock = simulation.frame().clock;
        let due = clock.frame_at(self.until_secs).max(1);
        let end = clock.time_at(due);
        let counted = counted(simulation).into_iter();
        let count = counted.filter(|&time| time <= end).count();
        vec![(clock.frame() >= due).then(|| count as f64 / end)]
    }
}

impl Measure for Evacuated {
    type Seen = ();

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        vec![Quantity::new(
            "evacuated",
            "agents",
            "number of counted arrivals",
        )]
    }

    fn values(&self, (): &(), simulation: &Simulation) -> Vec<Option<f64>> {
        vec![Some(counted(simulation).len() as f64)]
    }
}

impl Measure for Uncounted {
    type Seen = ();

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        let meaning = "number of arrivals that are not counted";
        vec![Quantity::new("uncounted", "agents", meaning)]
    }

    fn values(&self, (): &(), simulation: &Simulation) -> Vec<Option<f64>> {
        let all = simulation.outcome().arrivals.len();
        vec![Some((all - counted(simulation).len()) as f64)]
    }
}

impl Measure for Pauses {
    type Seen = ();

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        let (count, longest) = (self.arrivals, self.longer_than_secs);
        let sum = format!(
            "sum of the gaps of at least {longest} s between the first {count} counted arrivals"
        );
        let flow = format!("flow of the first {count} counted arrivals without these gaps");
        vec![
            Quantity::new("pauses_secs", "s", &sum),
            Quantity::new("flow_between_pauses_per_s", "P/s", &flow),
        ]
    }

    fn values(&self, (): &(), simulation: &Simulation) -> Vec<Option<f64>> {
        let Some(times) = first(simulation, self.arrivals) else {
            return vec![None, None];
        };
        let paused = paused(&times, self.longer_than_secs, simulation.frame().clock);
        vec![Some(paused), flow(&times, paused)]
    }
}

impl Measure for Locked {
    type Seen = ();

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        let meaning = format!(
            "1 if fewer than {} counted agents arrived by the end of the run, else 0",
            self.arrivals
        );
        vec![Quantity::new("locked", "runs", &meaning)]
    }

    fn values(&self, (): &(), simulation: &Simulation) -> Vec<Option<f64>> {
        let locked = first(simulation, self.arrivals).is_none();
        vec![Some(f64::from(u8::from(locked)))]
    }
}

/// The times of all counted arrivals, seconds, ascending.
fn counted(simulation: &Simulation) -> Vec<f64> {
    let arrivals = simulation.outcome().arrivals.iter();
    let counted = arrivals.filter(|arrival| arrival.counted);
    counted.map(|arrival| arrival.time).collect()
}

/// The times of the first `count` counted arrivals, if there were as many.
fn first(simulation: &Simulation, count: u32) -> Option<Vec<f64>> {
    let mut times = counted(simulation);
    let enough = times.len() >= count as usize;
    times.truncate(count as usize);
    enough.then_some(times)
}

/// (n − 1) / (t_n − t_1 − paused) for ascending times.
fn flow(times: &[f64], paused: f64) -> Option<f64> {
    let span = times.last()? - times.first()? - paused;
    (span > 0.0).then(|| (times.len() - 1) as f64 / span)
}

/// The sum of all gaps of at least `longest` seconds between ascending times of frames, seconds. Gaps are whole frames.
fn paused(times: &[f64], longest: f64, clock: &Clock) -> f64 {
    let frames: Vec<u64> = times.iter().map(|&time| clock.frame_at(time)).collect();
    let gaps = frames.windows(2).map(|pair| pair[1] - pair[0]);
    let longest = longest / clock.time_step();
    let paused = gaps.filter(|&gap| gap as f64 >= longest - ROUNDING);
    clock.time_at(paused.sum())
}
