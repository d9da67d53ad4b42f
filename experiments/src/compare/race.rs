//! Timing: all settings take turns with the same crowd.

use std::time::Instant;

use sandbox::analysis::statistics::Range;
use sandbox::engine::simulation::Simulation;
use sandbox::lab::bench::timing::{Contender, alternate};
use sandbox::lab::error::LabError;
use serde::Serialize;

use super::setting::{Description, Setting, Walk};

/// The simulated time of a turn, seconds: whole steps of every engine, and whole coarse frames of this one.
pub const TURN: f64 = 0.5;
/// Slow engines take fewer steps per turn, so that a turn takes about this time, seconds.
const LONGEST: f64 = 1.0;
/// A larger crowd is left out if a step or the start would take longer, seconds.
pub const PATIENCE: f64 = 10.0;

/// The times of one setting with one crowd.
#[derive(Serialize)]
pub struct Row {
    pub agents: u32,
    #[serde(flatten)]
    pub description: Description,
    /// Steps per turn.
    pub steps: u64,
    pub ms_per_step: Range,
    pub ms_per_simulated_second: Range,
    /// Cost per simulated second relative to this engine, if it has a model of this family: with the same radius and
    /// number of threads, turn by turn.
    pub ratio: Option<Range>,
    /// The mean distance between the first and the last positions of the agents, divided by the simulated time, m/s.
    pub mean_speed: f64,
}

/// What a setting took with the last crowd.
#[derive(Clone, Copy)]
struct Cost {
    agents: u32,
    /// Seconds until the agents were placed.
    start: f64,
    /// Seconds per step.
    step: f64,
}

/// A setting, and what is known about it.
pub struct Racer {
    pub setting: Setting,
    cost: Option<Cost>,
}

impl Racer {
    pub fn new(setting: Setting) -> Self {
        Self {
            setting,
            cost: None,
        }
    }

    /// Why this crowd is too large: what its start or a step would take if that grows like the number of agents.
    pub fn too_slow(&self, agents: u32) -> Option<String> {
        let cost = self.cost?;
        let times = f64::from(agents) / f64::from(cost.agents);
        let parts = [("the start", cost.start), ("a step", cost.step)];
        let (what, seconds) = parts.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        (seconds * times > PATIENCE).then(|| {
            let Description { engine, model, .. } = &self.setting.description;
            let seconds = seconds * times;
            format!("{engine}, {model}: no crowd of {agents}, as {what} would take {seconds:.0} s")
        })
    }
}

/// A crowd in one engine.
struct Runner {
    walk: Walk,
    start: f64,
    /// Steps per turn.
    steps: u64,
    /// Steps so far.
    taken: u64,
    moved: f64,
}

impl Runner {
    /// Places the agents, and takes the first steps: they allocate memory, and say how many steps fit into a turn.
    fn begin(setting: &Setting, crowd: &Simulation) -> Result<Self, LabError> {
        let begin = Instant::now();
        let mut walk = (setting.start)(crowd)?;
        let start = begin.elapsed().as_secs_f64();
        let stride = setting.stride;
        let first = walk(stride)?;
        let most = TURN / (stride as f64 * setting.description.time_step);
        let strides = (LONGEST / first.seconds).min(most.round()).max(1.0);
        Ok(Self {
            walk,
            start,
            steps: stride * strides as u64,
            taken: stride,
            moved: first.moved,
        })
    }

    /// Milliseconds per step of the next turn.
    fn turn(&mut self) -> Result<f64, LabError> {
        let turn = (self.walk)(self.steps)?;
        self.taken += self.steps;
        self.moved = turn.moved;
        Ok(1e3 * turn.seconds / self.steps as f64)
    }
}

/// Lets all settings take turns with this crowd, `repeats` times. The first `own` are those of this engine.
pub fn race(
    racers: &mut [&mut Racer],
    own: usize,
    crowd: &Simulation,
    repeats: usize,
) -> Result<Vec<Row>, LabError> {
    let agents = crowd.frame().agents.len() as u32;
    let runners = racers.iter();
    let runners = runners.map(|racer| Runner::begin(&racer.setting, crowd));
    let mut runners = runners.collect::<Result<Vec<_>, _>>()?;
    let contenders = runners.iter_mut();
    let contenders = contenders.map(|runner| -> Contender { Box::new(|_| runner.turn()) });
    let mut contenders: Vec<Contender> = contenders.collect();
    let ms_per_step = alternate(&mut contenders, repeats, 1)?;
    drop(contenders);
    for ((racer, runner), ms) in racers.iter_mut().zip(&runners).zip(&ms_per_step) {
        racer.cost = Some(Cost {
            agents,
            start: runner.start,
            step: 1e-3 * Range::of(ms).median,
        });
    }
    let descriptions: Vec<_> = racers.iter().map(|r| &r.setting.description).collect();
    let costs = descriptions.iter().zip(&ms_per_step);
    let costs = costs.map(|(of, ms)| ms.iter().map(|ms| ms / of.time_step).collect());
    let costs: Vec<Vec<f64>> = costs.collect();
    let row = |k: usize| {
        let (of, runner) = (descriptions[k], &runners[k]);
        let partner = descriptions[..own].iter().position(|ours| ours.is_like(of));
        Row {
            agents,
            description: of.clone(),
            steps: runner.steps,
            ms_per_step: Range::of(&ms_per_step[k]),
            ms_per_simulated_second: Range::of(&costs[k]),
            ratio: partner.map(|partner| Range::of_ratios(&costs[k], &costs[partner])),
            mean_speed: runner.moved / (runner.taken as f64 * of.time_step),
        }
    };
    Ok((0..runners.len()).map(row).collect())
}
