//! The frame time of the concert, for crowds of several sizes (Fig. 11).

use std::fmt::Write;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::engine::simulation::{Simulation, Stage};
use crate::lab::reproduce::case::{Case, CaseResult, Observer, Probe};
use crate::lab::reproduce::error::ReproduceError;

/// Numbers of agents, from the paper's sizes to ten times as many.
pub const SIZES: [u32; 7] = [2_500, 5_000, 10_000, 20_000, 30_000, 50_000, 100_000];
/// The largest crowd that can walk in within 100 s and arrive in time.
const MOST_WALKING: u32 = 30_000;
/// Time in which a standing crowd comes to rest, seconds.
const RELAXING: f64 = 10.0;
/// Duration of the timed frames, which begin at the push, seconds; the paper takes 30.
const TIMED: f64 = 6.0;
/// The push of the shipped concert, seconds.
const PUSH: f64 = super::concert::PUSH;

/// A concert with `agents` agents, timed from its push on; it runs alone. Up to 30,000 agents walk in as in the paper,
/// in rows over 100 m. More agents could not arrive in time: they stand at 5 P/m² in a jittered hexagonal half disc in
/// front of the stage.
pub fn case(agents: u32) -> Case {
    let (name, text, push) = if agents <= MOST_WALKING {
        (format!("concert-{agents}"), walking(agents), PUSH)
    } else {
        let text = standing(f64::from(agents));
        (format!("concert-{agents}-standing"), text, RELAXING)
    };
    Case::from_text(name, text.to_string())
        .keep(TimeProbe { from: push })
        .taking(
            f64::from(agents)
                * if agents <= MOST_WALKING {
                    1.5e-3
                } else {
                    0.3e-3
                },
        )
        .alone()
}

/// The common part of all sizes; the push is the shipped concert's.
fn concert(push: f64) -> Value {
    json!({
        "duration_secs": push + TIMED,
        "profile": "sph",
        "parameters": { "viscosity": 5, "goal_scale": 0.1 },
        "obstacles": [[[80, -10], [90, -10], [90, 10], [80, 10]]],
        "goal": [82, 0],
        "events": [{
            "at_secs": push, "for_secs": 0.5, "region": [[54.5, -10], [55.5, 10]],
            "goal_scale": 1, "ignore_contact": true, "ignore_sph": true
        }]
    })
}

/// All agents enter, in 100 batches over a width of 100 m.
fn walking(agents: u32) -> Value {
    let mut text = concert(PUSH);
    text["sources"] = json!([{
        "min": [0, -50], "max": [0, 50], "columns": 1, "rows": agents / 100,
        "jitter": 20.0 / f64::from(agents / 100),
        "start_secs": 0, "every_secs": 1, "times": 100
    }]);
    text
}

/// All agents stand: a half disc of columns along y, every other one shifted.
fn standing(agents: f64) -> Value {
    const DENSITY: f64 = 5.0;
    let spacing = (2.0 / (DENSITY * 3.0_f64.sqrt())).sqrt();
    let apart = 0.75_f64.sqrt() * spacing;
    let radius = (2.0 * agents / (DENSITY * std::f64::consts::PI)).sqrt();
    let columns = (radius / apart) as u32;
    let grids: Vec<Value> = (0..columns)
        .map(|k| {
            let away = (f64::from(k) + 0.5) * apart;
            let half = (radius * radius - away * away).sqrt();
            let rows = (2.0 * half / spacing).round().max(1.0);
            let shift = if k % 2 == 0 { 0.0 } else { 0.5 * spacing };
            let (x, y) = (80.0 - away, 0.5 * rows * spacing);
            json!({
                "min": [x, shift - y], "max": [x, shift + y],
                "columns": 1, "rows": rows as u32, "jitter": 0.05
            })
        })
        .collect();
    let mut text = concert(RELAXING);
    text["grids"] = Value::Array(grids);
    text
}

/// The mean frame time of one crowd.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrameTime {
    /// Number of agents.
    pub agents: usize,
    /// Number of threads.
    pub threads: usize,
    /// Milliseconds per frame of every stage that ran, by [`Stage::name`].
    pub stages: Vec<(String, f64)>,
}

impl FrameTime {
    /// The data that a run has kept.
    ///
    /// # Errors
    /// The run was not timed.
    pub fn of(result: &CaseResult) -> Result<Self, ReproduceError> {
        result.kept(NAME)
    }

    /// The sum of all stages, ms.
    pub fn total(&self) -> f64 {
        self.stages.iter().map(|(_, ms)| ms).sum()
    }

    /// One stage, ms; `None` if it never ran.
    pub fn of_stage(&self, stage: Stage) -> Option<f64> {
        let found = self.stages.iter().find(|(name, _)| name == stage.name())?;
        Some(found.1).filter(|&ms| ms > 0.0)
    }
}

/// All sizes as CSV.
pub fn csv(times: &[FrameTime]) -> String {
    let mut text = "agents,threads,total_ms".to_owned();
    for stage in Stage::ALL {
        let _ = write!(text, ",{}_ms", stage.name());
    }
    text.push('\n');
    for time in times {
        let _ = write!(text, "{},{},{:.4}", time.agents, time.threads, time.total());
        for stage in Stage::ALL {
            let _ = write!(text, ",{:.4}", time.of_stage(stage).unwrap_or(0.0));
        }
        text.push('\n');
    }
    text
}

const NAME: &str = "frame time from the push on";

/// Keeps a [`FrameTime`] of all frames from a time in seconds on.
struct TimeProbe {
    from: f64,
}

impl Probe for TimeProbe {
    fn name(&self) -> String {
        NAME.to_owned()
    }

    fn begin(&self, simulation: &mut Simulation) -> Box<dyn Observer> {
        Box::new(Watch {
            first: simulation.frame().clock.frame_at(self.from),
            before: None,
            last: None,
        })
    }
}

/// Frames so far, and the time of each stage.
type Spent = (u64, Vec<(Stage, Duration)>);

struct Watch {
    first: u64,
    before: Option<Spent>,
    last: Option<(usize, Spent)>,
}

impl Observer for Watch {
    fn observe(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let now = frame.clock.frame();
        if now < self.first {
            return;
        }
        let per_frame = simulation.stages().ms_per_frame();
        let spent: Vec<_> = per_frame
            .map(|(stage, ms)| (stage, Duration::from_secs_f64(1e-3 * ms * now as f64)))
            .collect();
        if now == self.first {
            self.before = Some((now, spent));
        } else {
            self.last = Some((frame.agents.len(), (now, spent)));
        }
    }

    fn finish(self: Box<Self>) -> Value {
        let (Some((first, before)), Some((agents, (last, after)))) = (self.before, self.last)
        else {
            return Value::Null;
        };
        let frames = (last - first) as f64;
        let per_frame = |(stage, spent): &(Stage, Duration)| {
            let earlier = before.iter().find(|(other, _)| other == stage);
            let earlier = earlier.map_or(Duration::ZERO, |(_, spent)| *spent);
            let ms = 1e3 * spent.saturating_sub(earlier).as_secs_f64() / frames;
            (stage.name().to_owned(), ms)
        };
        let time = FrameTime {
            agents,
            threads: rayon::current_num_threads(),
            stages: after.iter().map(per_frame).collect(),
        };
        serde_json::to_value(time).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn so_many_come_as_were_asked_for() {
        for agents in SIZES {
            let scene = case(agents).scenario().unwrap().scene;
            let walking = scene.sources.iter().map(|source| source.grid.rows * 100);
            let came = scene.agents.len() as f64 + f64::from(walking.sum::<u32>());
            assert!((came / f64::from(agents) - 1.0).abs() < 0.01, "{came}");
        }
    }
}
