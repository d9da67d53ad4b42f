//! Computing time per frame, by stage.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{Measure, Observed};
use crate::keys::limits::LONGEST_TIME;
use analysis::evaluated::Evaluated;
use engine::simulation::Stage;

/// The computing time per frame from a given time on, milliseconds, for each stage. It depends on the machine and on
/// what runs beside it, so it is data rather than a value.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrameTime {
    /// The time, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    from_secs: f64,
}

/// The data of a [`FrameTime`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageTimes {
    /// Number of agents at the end.
    pub agents: usize,
    /// Number of threads.
    pub threads: usize,
    /// Mean milliseconds per frame of each stage, by its name.
    pub stages: Vec<(String, f64)>,
}

impl StageTimes {
    /// Milliseconds per frame.
    pub fn total(&self) -> f64 {
        self.stages.iter().map(|(_, ms)| ms).sum()
    }

    /// Milliseconds per frame of a stage; `None` if it took no time.
    pub fn of_stage(&self, stage: Stage) -> Option<f64> {
        let found = self.stages.iter().find(|(name, _)| name == stage.name())?;
        Some(found.1).filter(|&ms| ms > 0.0)
    }
}

/// The computing time of each stage up to a frame, milliseconds.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Spent {
    frame: u64,
    stages: BTreeMap<String, f64>,
}

impl FrameTime {
    /// The name of its data.
    pub const NAME: &'static str = "frame_time";
}

impl Measure for FrameTime {
    /// The times at the first and at the last frame, and the number of agents in the last one.
    type Seen = (Option<Spent>, Option<Spent>, usize);

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn observe(&self, (first, last, agents): &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let frame = simulation.frame();
        let now = frame.clock.frame();
        if now < frame.clock.frame_at(self.from_secs) {
            return;
        }
        let per_frame = simulation.stages().ms_per_frame();
        let spent = per_frame.map(|(stage, ms)| (stage.name().to_owned(), ms * now as f64));
        let spent = Some(Spent {
            frame: now,
            stages: spent.collect(),
        });
        *agents = frame.agents.count_present();
        *(if first.is_none() { first } else { last }) = spent;
    }

    fn data(&self, (first, last, agents): &Self::Seen) -> Option<(String, Value)> {
        let name = Self::NAME.to_owned();
        let (Some(first), Some(last)) = (first, last) else {
            return Some((name, Value::Null));
        };
        let frames = (last.frame - first.frame) as f64;
        let ms = |stage: &Stage| {
            let before = first.stages.get(stage.name()).unwrap_or(&0.0);
            Some((
                stage.name().to_owned(),
                (last.stages.get(stage.name())? - before).max(0.0) / frames,
            ))
        };
        let times = StageTimes {
            agents: *agents,
            threads: rayon::current_num_threads(),
            stages: Stage::ALL.iter().filter_map(ms).collect(),
        };
        Some((name, json!(times)))
    }
}
