//! Jitter: the kinetic energy of a crowd that should rest.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{About, Mean, Measure, Observed, Quantity, is_due};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

/// The share of the agents, the least dense ones, that count as the rim of a crowd.
const RIM: f64 = 0.25;

/// The mean kinetic energy ½ m v² per agent, m²/s², between two times: of all agents, of the denser three quarters of
/// the crowd, and of its rim, the quarter with the lowest densities.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Jitter {
    /// The start, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    from_secs: f64,
    /// The end, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    until_secs: f64,
}

impl Measure for Jitter {
    /// Over agents and frames: all, inside and rim.
    type Seen = [Mean; 3];

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn check(&self) -> Result<(), Problem> {
        if self.from_secs > self.until_secs {
            let reason = "must not be before from_secs";
            return Err(Problem::new("jitter.until_secs", reason));
        }
        Ok(())
    }

    fn quantities(&self) -> Vec<Quantity> {
        let (from, until) = (self.from_secs, self.until_secs);
        let of = |(part, people): (&str, &str)| {
            let meaning =
                format!("mean kinetic energy per mass of {people} from {from} to {until} s");
            Quantity::new(
                format!("jitter{part}_{from}_to_{until}s"),
                "m²/s²",
                &meaning,
            )
        };
        let parts = [
            ("", "all agents"),
            ("_inside", "the denser three quarters of the agents"),
            ("_rim", "the least dense quarter of the agents"),
        ];
        parts.map(of).into()
    }

    fn about(&self) -> About {
        About::with_density_until(self.until_secs)
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let frame = simulation.frame();
        let (agents, density) = (frame.agents, &frame.fields.density);
        let mut sorted: Vec<f64> = agents.present().map(|i| density[i]).collect();
        if !is_due(simulation, [self.from_secs, self.until_secs], 0.0) {
            return;
        }
        sorted.sort_by(f64::total_cmp);
        let Some(&dense) = sorted.get((RIM * sorted.len() as f64) as usize) else {
            return;
        };
        for i in agents.present() {
            let part = if density[i] >= dense { 1 } else { 2 };
            for k in [0, part] {
                seen[k].add(0.5 * agents.mass[i] * agents.velocity[i].norm_squared());
            }
        }
    }

    fn values(&self, seen: &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        seen.map(Mean::value).into()
    }
}
