//! Contacts between agents, for the speed of sound.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Measure, Observed, Quantity};
use crate::error::Problem;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::shapes::{Corners, region};
use analysis::evaluated::Evaluated;
use analysis::sound::{self, Contacts};
use engine::simulation::Simulation;

/// The mean number of contacts per agent in a region at one time, and their modulus M along x, m²: with it linear
/// theory gives the speed of sound (see `analysis::sound`).
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactsAt {
    /// The time, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    at_secs: f64,
    /// The region: lower left and upper right corner, meters.
    pub(super) region: Corners,
}

impl Measure for ContactsAt {
    type Seen = Option<Contacts>;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Observed::region("contacts.region", Some(self.region))
    }

    fn check(&self) -> Result<(), Problem> {
        region("contacts.region", self.region).map(|_| ())
    }

    fn quantities(&self) -> Vec<Quantity> {
        let at = format!("agents in the region at {} s", self.at_secs);
        vec![
            Quantity::new(
                "contacts_per_agent",
                "contacts",
                &format!("mean number of contacts of {at}"),
            ),
            Quantity::new(
                "contact_modulus_m2",
                "m²",
                &format!(
                    "stiffness of the contacts of {at} against compression, per contact stiffness"
                ),
            ),
        ]
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let frame = simulation.frame();
        if frame.clock.frame() == frame.clock.frame_at(self.at_secs) {
            *seen = sound::contacts(simulation, &self.region.into());
        }
    }

    fn values(&self, seen: &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        vec![
            seen.map(|found| found.per_agent),
            seen.map(|found| found.modulus),
        ]
    }
}
