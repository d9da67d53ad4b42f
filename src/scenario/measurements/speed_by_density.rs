//! Mean speed by density: the fundamental diagram of the crowd's own densities.

use serde::{Deserialize, Serialize};

use super::{Due, Measure};
use crate::engine::simulation::Simulation;
use crate::scenario::check::UNTIL;
use crate::scenario::error::Problem;
use crate::scenario::parameters::DENSITY;
use crate::scenario::range::TIME;

/// The mean speed of agents with ρ_i in bins 1 P/m² wide, m/s, between two times.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedByDensity {
    /// The start, seconds.
    from_secs: f64,
    /// The end, seconds.
    to_secs: f64,
    /// Time between the frames that are looked at, seconds.
    every_secs: f64,
    /// The lower ends of the bins, ascending, P/m².
    bins: Vec<f64>,
}

/// Sum and number of speeds.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Speeds {
    sum: f64,
    count: f64,
}

impl Measure for SpeedByDensity {
    type Seen = Vec<Speeds>;

    fn check(&self) -> Result<(), Problem> {
        TIME.check("speed_by_density.from_secs", self.from_secs)?;
        TIME.check("speed_by_density.to_secs", self.to_secs)?;
        UNTIL.check("speed_by_density.every_secs", self.every_secs)?;
        for (k, &bin) in self.bins.iter().enumerate() {
            DENSITY.check(&format!("speed_by_density.bins[{k}]"), bin)?;
        }
        match self.bins.is_sorted_by(|a, b| a < b) && !self.bins.is_empty() {
            true => Ok(()),
            false => Err(Problem::new(
                "speed_by_density.bins",
                "must be ascending densities",
            )),
        }
    }

    fn names(&self) -> Vec<(String, &'static str)> {
        let name = |low| (format!("speed_at_{low}_to_{}_per_m2", low + 1.0), "m/s");
        self.bins.iter().map(name).collect()
    }

    fn begin(&self, simulation: &mut Simulation) {
        let last = simulation.frame().clock.frame_at(self.to_secs);
        simulation.request_density_until(last + 1);
    }

    fn observe(&self, seen: &mut Self::Seen, simulation: &Simulation) {
        if !Due::new(simulation, self.from_secs, self.to_secs, self.every_secs).is_now(simulation) {
            return;
        }
        seen.resize(self.bins.len(), Speeds::default());
        let frame = simulation.frame();
        for (density, v) in frame.fields.density.iter().zip(&frame.agents.velocity) {
            let bin = self.bins.iter().rposition(|low| density >= low);
            if let Some(bin) = bin.filter(|&bin| density - self.bins[bin] < 1.0) {
                seen[bin].sum += v.norm();
                seen[bin].count += 1.0;
            }
        }
    }

    fn values(&self, seen: &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let mean = |k| {
            let speeds = seen.get(k).filter(|speeds: &&Speeds| speeds.count > 0.0)?;
            Some(speeds.sum / speeds.count)
        };
        (0..self.bins.len()).map(mean).collect()
    }
}
