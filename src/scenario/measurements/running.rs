//! Measurements during a run, whatever they measure.

use serde_json::Value;

use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

/// A measurement during a run, whatever it measures: the methods of [`Measure`].
pub trait Running: Send + Sync {
    fn check(&self) -> Result<(), Problem>;
    fn quantities(&self) -> Vec<Quantity>;
    fn places(&self) -> Vec<(&'static str, Observed)>;
    fn about(&self) -> About;
    fn observe(&mut self, evaluated: &Evaluated);
    fn values(&self, simulation: &Simulation) -> Vec<Option<f64>>;
    fn data(&self) -> Option<(String, Value)>;
    fn seen(&self) -> Value;
    fn resume(&mut self, seen: &str) -> serde_json::Result<()>;
}

/// A measurement that has seen nothing yet.
pub fn started<M: Measure>(keys: &M) -> Box<dyn Running> {
    Box::new((keys.clone(), M::Seen::default()))
}

/// The keys of a measurement, and what it has seen.
impl<M: Measure> Running for (M, M::Seen) {
    fn check(&self) -> Result<(), Problem> {
        self.0.check()
    }

    fn quantities(&self) -> Vec<Quantity> {
        self.0.quantities()
    }

    fn places(&self) -> Vec<(&'static str, Observed)> {
        self.0.places()
    }

    fn about(&self) -> About {
        self.0.about()
    }

    fn observe(&mut self, evaluated: &Evaluated) {
        self.0.observe(&mut self.1, evaluated);
    }

    fn values(&self, simulation: &Simulation) -> Vec<Option<f64>> {
        self.0.values(&self.1, simulation)
    }

    fn data(&self) -> Option<(String, Value)> {
        self.0.data(&self.1)
    }

    fn seen(&self) -> Value {
        serde_json::to_value(&self.1).unwrap_or_default()
    }

    fn resume(&mut self, seen: &str) -> serde_json::Result<()> {
        self.1 = serde_json::from_str(seen)?;
        Ok(())
    }
}
