//! Mean speed by density: the fundamental diagram of the crowd's own densities.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{About, Mean, Measure, Observed, Quantity, is_due};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

/// The mean speed of agents with ρ_i in bins 1 P/m² wide, m/s, between two times.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedByDensity {
    /// The start, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    from_secs: f64,
    /// The end, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    until_secs: f64,
    /// Time between the frames that are looked at, seconds.
    #[schemars(range(max = LONGEST_TIME), extend("exclusiveMinimum" = 0))]
    every_secs: f64,
    /// The lower ends of the bins, ascending, P/m².
    #[schemars(inner(range(min = 0, max = 1000)))]
    bins: Vec<f64>,
}

impl Measure for SpeedByDensity {
    type Seen = Vec<Mean>;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn check(&self) -> Result<(), Problem> {
        if self.bins.is_empty() || !self.bins.is_sorted_by(|a, b| a < b) {
            let reason = "must be ascending densities";
            return Err(Problem::new("speed_by_density.bins", reason));
        }
        Ok(())
    }

    fn quantities(&self) -> Vec<Quantity> {
        let of = |&low: &f64| {
            let high = low + 1.0;
            let meaning =
                format!("mean speed of agents at SPH densities from {low} to {high} P/m²");
            Quantity::new(format!("speed_at_{low}_to_{high}_per_m2"), "m/s", &meaning)
        };
        self.bins.iter().map(of).collect()
    }

    fn about(&self) -> About {
        About::with_density_until(self.until_secs)
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let frame = simulation.frame();
        let is_early = frame.clock.frame() < frame.clock.frame_at(self.from_secs);
        // Counted from the start of the run.
        if is_early || !is_due(simulation, [0.0, self.until_secs], self.every_secs) {
            return;
        }
        seen.resize(self.bins.len(), Mean::default());
        // In frames without densities there is nothing to add.
        let present = frame.agents.present().take(frame.fields.density.len());
        for i in present {
            let density = frame.fields.density[i];
            let bin = self.bins.iter().rposition(|&low| density >= low);
            if let Some(bin) = bin.filter(|&bin| density - self.bins[bin] < 1.0) {
                seen[bin].add(frame.agents.velocity[i].norm());
            }
        }
    }

    fn values(&self, seen: &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let bins = 0..self.bins.len();
        bins.map(|k| seen.get(k)?.value()).collect()
    }
}
