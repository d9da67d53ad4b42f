//! The smallest distance between the centers of two agents.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Measure, Observed, Quantity, is_due};
use crate::keys::limits::LONGEST_TIME;
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

/// Time between the frames that are measured, seconds.
const EVERY_SECS: f64 = 0.1;

/// The smallest distance between the centers of two agents as a part of D_i + D_j, at most 1, from a given time on, in
/// ten frames of each second.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Closest {
    /// The time, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    #[serde(default)]
    from_secs: f64,
}

impl Measure for Closest {
    type Seen = Option<f64>;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn quantities(&self) -> Vec<Quantity> {
        let meaning = "smallest distance between two centers as a part of the sum of the radii, at most 1, in ten \
                       frames per second";
        vec![Quantity::new("closest_centers", "D_i + D_j", meaning)]
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        if is_due(simulation, [self.from_secs, f64::MAX], EVERY_SECS) {
            let now = closest(simulation);
            *seen = Some(seen.map_or(now, |before| before.min(now)));
        }
    }

    fn values(&self, seen: &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        vec![*seen]
    }
}

/// The smallest distance between the centers of two agents of an evaluated frame as a part of D_i + D_j; 1 if no two
/// touch or the frame has no lists of neighbors.
pub fn closest(simulation: &Simulation) -> f64 {
    let frame = simulation.frame();
    let agents = frame.agents;
    let widest = agents.radius.iter().copied().fold(0.0, f64::max);
    let mut least: f64 = 1.0;
    if frame.neighbors.near().is_empty() {
        return least;
    }
    for i in agents.present() {
        let near = frame.near(i, agents.radius[i] + widest);
        for (j, r_ij) in near.filter(|&(j, _)| agents.is_present(j)) {
            least = least.min(r_ij.norm() / (agents.radius[i] + agents.radius[j]));
        }
    }
    least
}
