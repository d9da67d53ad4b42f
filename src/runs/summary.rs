//! The reproducible results of a run, without run times.

use std::collections::BTreeMap;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::runs::drive::Run;
use crate::scenario::measurements::Metric;

/// The results of a run, part of what `--json` reports.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// The name of the scenario.
    pub scenario: String,
    /// The default profile.
    pub profile: String,
    /// The scenario's `seed`.
    pub seed: u64,
    /// Seed of the population: bodies and start positions. 0 in files of versions that did not write it.
    #[serde(default)]
    pub population_seed: u64,
    /// Seed of the behavior: RVO's candidate velocities.
    #[serde(alias = "behaviour_seed")]
    pub behavior_seed: u64,
    /// SHA-256 of the final state.
    pub state_sha256: String,
    /// Frames computed.
    pub frames: u64,
    /// Simulated time at the end, seconds.
    pub time_secs: f64,
    /// Number of agents that entered.
    pub agents: u32,
    /// The measurements by name; counts are integers, missing values are `null`.
    pub metrics: BTreeMap<String, Value>,
    /// Data of measurements that have more than values, such as snapshots, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub data: BTreeMap<String, Value>,
    /// Moves that were stopped at a wall that they would have crossed.
    pub contained_moves: u64,
    /// How many times a speed was clamped to `max_speed`.
    pub clamped_speeds: u64,
    /// Agents that would have entered inside an obstacle and were moved.
    pub displaced_agents: usize,
}

impl Summary {
    /// The summary of a finished run.
    pub fn of(run: &Run) -> Self {
        let (scenario, simulation) = (&run.scenario, &run.simulation);
        let (frame, outcome) = (simulation.frame(), simulation.outcome());
        let measured = run.metrics.results(simulation).into_iter();
        Self {
            scenario: scenario.name.clone(),
            profile: scenario.profile_name.clone(),
            seed: scenario.seed,
            population_seed: simulation.scene().seed,
            behavior_seed: frame.seed,
            state_sha256: simulation.digest(),
            frames: frame.clock.frame(),
            time_secs: frame.clock.time(),
            agents: frame.agents.entered(),
            metrics: measured.map(|m| (m.name.clone(), value(&m))).collect(),
            data: run.metrics.data().collect(),
            contained_moves: outcome.contained_moves,
            clamped_speeds: outcome.clamped_speeds,
            displaced_agents: outcome.displaced.len(),
        }
    }

    /// A metric by name; `None` if it is not measured or has no value.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.metrics.get(name)?.as_f64()
    }

    /// Data by name; `None` if they are not measured, have another form, or the run ended before them.
    pub fn data<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        T::deserialize(self.data.get(name)?).ok()
    }
}

/// A metric's value as JSON; counts of agents are integers.
pub fn value(metric: &Metric) -> Value {
    match metric.value {
        Some(count) if metric.unit == "agents" => json!(count as u64),
        value => json!(value),
    }
}
