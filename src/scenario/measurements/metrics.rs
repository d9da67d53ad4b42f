//! The measurements of one run, and what every run observes beside them.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::overview::Overview;
use super::running::Running;
use super::stuck::{self, Stuck};
use super::{HighestDensity, LongestQueue, Measure, Measurement, Quantity, StuckGroup};
use crate::error::quote::shown_message;
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

/// A measured value.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// Its name in reports.
    pub name: String,
    /// The number of the scenario's measurement, from 0.
    pub measurement: usize,
    /// The value; `None` if there were no agents or too few arrivals, or if the run ended too early.
    pub value: Option<f64>,
    /// The unit of the value.
    pub unit: &'static str,
}

/// The measurements of one run.
pub struct Metrics {
    running: Vec<Box<dyn Running>>,
    /// Observed in every run.
    stuck: (Stuck, <Stuck as Measure>::Seen),
    overview: Overview,
    /// The number of the last observed frame.
    observed: Option<u64>,
}

impl Metrics {
    /// Prepares the measurements, and requests from `simulation` what they need.
    pub fn new(measurements: &[Measurement], simulation: &mut Simulation) -> Self {
        let running: Vec<_> = measurements.iter().map(Measurement::started).collect();
        for until in running.iter().filter_map(|one| one.about().density_until) {
            let last = simulation.frame().clock.frame_at(until);
            simulation.request_density_until(last + 1);
        }
        Self {
            running,
            stuck: (Stuck, Vec::new()),
            overview: Overview::default(),
            observed: None,
        }
    }

    /// Observes an evaluated frame; call it in every frame. A frame counts once, also if a run resumes at it.
    pub fn observe(&mut self, simulation: &Simulation) {
        let frame = simulation.frame().clock.frame();
        if self.observed.replace(frame) == Some(frame) {
            return;
        }
        let evaluated = Evaluated::new(simulation);
        for measurement in &mut self.running {
            measurement.observe(&evaluated);
        }
        self.stuck.observe(&evaluated);
        self.overview.observe(&self.stuck.1, simulation);
    }

    /// The highest SPH density at an agent in a coarse frame; `None` if no force needs densities.
    pub fn highest_density(&self) -> Option<HighestDensity> {
        self.overview.highest()
    }

    /// The longest queue before each passage, the longest one first: before exits, waypoints, waiting areas and goals,
    /// declared doors, and openings of the floor. In a queue are the agents whose routes lead through the passage and
    /// that are slower than [`SLOW`](super::SLOW) times their preferred speed, from the passage up to the first
    /// [`GAP`](super::GAP) along their routes; at a place with a queue of its own, the agents in it. Observed every
    /// second.
    pub fn longest_queues(&self, simulation: &Simulation) -> Vec<LongestQueue> {
        self.overview.longest(simulation)
    }

    /// The agents in the queue before each place, by its number, when they were last observed: once per second. Queues
    /// with a line are left out, and places without a queue.
    pub fn queues(&self) -> &BTreeMap<u16, u32> {
        self.overview.queues()
    }

    /// The agents that made less than [`HEADWAY`](super::HEADWAY) in [`STUCK_AFTER`](super::STUCK_AFTER) seconds of
    /// walking, grouped by the likely cause, the largest group first.
    pub fn stuck(&self, simulation: &Simulation) -> Vec<StuckGroup> {
        stuck::groups(&self.stuck.1, simulation)
    }

    /// The ids of these agents, in order.
    pub fn stuck_ids(&self, simulation: &Simulation) -> Vec<u32> {
        let ids = &simulation.frame().agents.id;
        let agents = stuck::agents(&self.stuck.1, simulation);
        agents.into_iter().map(|(i, ..)| ids[i]).collect()
    }

    /// The values measured so far.
    pub fn results(&self, simulation: &Simulation) -> Vec<Metric> {
        let measured = self.running.iter().enumerate().flat_map(|(k, running)| {
            let measured = Quantity::paired(running.quantities(), running.values(simulation));
            measured.map(move |(quantity, value)| Metric {
                name: quantity.name,
                measurement: k,
                value,
                unit: quantity.unit,
            })
        });
        measured.collect()
    }

    /// The data of measurements that have more than values, by name.
    pub fn data(&self) -> impl Iterator<Item = (String, Value)> {
        let all = self.running.iter();
        all.filter_map(|measurement| measurement.data())
    }

    /// The number of the last observed frame.
    pub fn observed(&self) -> Option<u64> {
        self.observed
    }

    /// What each measurement has seen so far, as JSON.
    pub fn seen(&self) -> Vec<String> {
        let seen = self.running.iter().map(|one| one.seen().to_string());
        let overview = json!(self.overview).to_string();
        seen.chain([self.stuck.seen().to_string(), overview])
            .collect()
    }

    /// Restores what was [`seen`](Self::seen) up to and in frame number `frame`.
    ///
    /// # Errors
    /// It is that of other measurements: which one does not fit, and why.
    pub fn resume(&mut self, seen: &[String], frame: u64) -> Result<(), String> {
        self.observed = Some(frame);
        let [of_all @ .., stuck, overview] = seen else {
            return Err("it has no measurements".to_owned());
        };
        if of_all.len() != self.running.len() {
            let [has, wanted] = [of_all.len(), self.running.len()];
            return Err(format!(
                "it has {has} measurements, and the scenario {wanted}"
            ));
        }
        for (k, (measurement, seen)) in self.running.iter_mut().zip(of_all).enumerate() {
            let resumed = measurement.resume(seen);
            resumed.map_err(|error| defect(&format!("measurements[{k}]"), &error))?;
        }
        let stuck = self.stuck.resume(stuck);
        stuck.map_err(|error| defect("agents that are stuck", &error))?;
        let overview = serde_json::from_str(overview);
        self.overview = overview.map_err(|error| defect("the overview", &error))?;
        Ok(())
    }
}

/// What is wrong with the state of a measurement.
fn defect(of: &str, error: &serde_json::Error) -> String {
    format!("the state of {of}: {}", shown_message(&error.to_string()))
}
