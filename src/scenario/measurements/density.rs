//! Mean and standard deviation of ρ_i at one time (Tables 1 and 2).

use schemars::JsonSchema;
use serde::Deserialize;

use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::shapes::{Corners, region};
use analysis::evaluated::Evaluated;
use analysis::statistics::MeanStd;
use engine::scene::Region;
use engine::simulation::Simulation;

/// Mean and population standard deviation of ρ_i at one time, over all agents or those in a region, P/m².
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Density {
    /// The time, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    at_secs: f64,
    /// The region: lower left and upper right corner, meters; everywhere if missing.
    pub(super) region: Option<Corners>,
}

impl Measure for Density {
    type Seen = [Option<f64>; 2];

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("density.region", self.region)
    }

    fn check(&self) -> Result<(), Problem> {
        self.region.map_or(Ok(()), |corners| {
            region("density.region", corners).map(|_| ())
        })
    }

    fn quantities(&self) -> Vec<Quantity> {
        let region = if self.region.is_some() {
            " in the region"
        } else {
            ""
        };
        let of = |what: &str, meaning: &str| {
            let meaning = format!(
                "{meaning} of the SPH densities of the agents{region} at {} s",
                self.at_secs
            );
            Quantity::new(
                format!("density_{what}_{}s", self.at_secs),
                "P/m²",
                &meaning,
            )
        };
        vec![
            of("mean", "mean"),
            of("std", "population standard deviation"),
        ]
    }

    fn about(&self) -> About {
        About::with_density_until(self.at_secs)
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let frame = simulation.frame();
        let densities = &frame.fields.density;
        if frame.clock.frame() != frame.clock.frame_at(self.at_secs) || densities.is_empty() {
            return;
        }
        let region = self.region.map(Region::from);
        let positions = &frame.agents.position;
        let there = frame.agents.present();
        let inside = there.filter(|&i| region.is_none_or(|r| r.contains(positions[i])));
        let densities: Vec<f64> = inside.map(|i| densities[i]).collect();
        let found = MeanStd::of(&densities);
        *seen = [found.map(|of| of.mean), found.map(|of| of.population_std())];
    }

    fn values(&self, seen: &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        seen.to_vec()
    }
}
