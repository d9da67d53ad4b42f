//! What a run found, without how long it took: any other run of the same scenario finds the same.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::engine::simulation::Simulation;
use crate::scenario::Scenario;
use crate::scenario::metrics::{Metric, Metrics};

/// The results of one run, as `--json` reports them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// What the scenario is called.
    pub scenario: String,
    /// The profile of agents that name none.
    pub profile: String,
    /// Seed of who enters.
    pub seed: u64,
    /// Seed of what they do.
    pub behaviour_seed: u64,
    /// SHA-256 of the final state.
    pub state_sha256: String,
    /// Frames computed.
    pub frames: u64,
    /// The simulated time at the end, seconds.
    pub time_secs: f64,
    /// How many agents entered.
    pub agents: u32,
    /// The measurements by name; counts are whole numbers, `null` where the run gave none.
    pub metrics: BTreeMap<String, Value>,
    /// Moves that would have crossed a wall.
    pub contained_moves: u64,
    /// Speeds that were cut to `max_speed`.
    pub clamped_speeds: u64,
    /// Agents who would have entered inside an obstacle.
    pub displaced_agents: usize,
}

impl Summary {
    /// Of a run that has come to its end.
    pub fn of(scenario: &Scenario, simulation: &Simulation, metrics: &Metrics) -> Self {
        let (frame, outcome) = (simulation.frame(), simulation.outcome());
        let measured = metrics.results(simulation).into_iter();
        Self {
            scenario: scenario.name.clone(),
            profile: scenario.profile_name.clone(),
            seed: simulation.scene().seed,
            behaviour_seed: frame.seed,
            state_sha256: simulation.digest(),
            frames: frame.clock.frame(),
            time_secs: frame.clock.time(),
            agents: frame.agents.entered(),
            metrics: measured.map(|m| (m.name.clone(), value(&m))).collect(),
            contained_moves: outcome.contained_moves,
            clamped_speeds: outcome.clamped_speeds,
            displaced_agents: outcome.displaced.len(),
        }
    }
}

/// A metric's value; counts of agents are whole numbers.
pub fn value(metric: &Metric) -> Value {
    match metric.value {
        Some(count) if metric.unit == "agents" => json!(count as u64),
        value => json!(value),
    }
}
