//! Forces on walls, in newtons per meter.

use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};

use super::window::{MOST_MASS, Samples, body_mass};
use super::{About, Measure, Observed, Quantity};
use crate::error::Problem;
use analysis::evaluated::Evaluated;
use analysis::wall_forces::{CellForce, WallForces as Seen};
use engine::simulation::Simulation;

/// The name of the values if none is given.
const NAME: &str = "wall_force";

/// The largest force on 1 m of wall by pressure and contact, N/m, with time and place; the longest time and the most
/// meters of wall above 3 kN/m, the least design load of railings for crowds (EN 1991-1-1), which is not a limit of
/// safety. Per part of a wall, in the data: its largest force. Recordings and pictures of the run color its walls by
/// force.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct WallForces {
    /// The beginning of the names of its values. Default: `wall_force`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    #[serde(flatten)]
    pub(super) samples: Samples,
    /// The mass of an average person, m = 1, kg.
    #[schemars(range(max = MOST_MASS), extend("exclusiveMinimum" = 0))]
    #[serde(default = "body_mass")]
    pub(super) body_mass_kg: f64,
}

impl WallForces {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }
}

impl Measure for WallForces {
    /// With the time between two samples, seconds.
    type Seen = (Seen, f64);

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn about(&self) -> About {
        About {
            has_thresholds: true,
            peaks_from_start: (self.samples.from_secs == 0.0).then_some("wall_forces"),
            mass_on_walls: Some(self.body_mass_kg),
            ..About::default()
        }
    }

    fn check(&self) -> Result<(), Problem> {
        self.samples.check("wall_forces")
    }

    fn quantities(&self) -> Vec<Quantity> {
        let values = [
            (
                "max_n_per_m",
                "N/m",
                "largest force per meter of wall, mean over 1 m of outline, at any sample",
            ),
            ("max_at_secs", "s", "when it was largest"),
            ("max_x_m", "m", "where it was largest: x"),
            ("max_y_m", "m", "where it was largest: y"),
            (
                "above_3000_n_per_m_secs",
                "s",
                "longest time without a break with more than 3 kN/m somewhere",
            ),
            (
                "above_3000_n_per_m_m",
                "m",
                "most meters of wall above 3 kN/m at one time",
            ),
        ];
        Quantity::all(self.name(), &values)
    }

    fn observe(&self, (seen, secs): &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        if self.samples.is_due(simulation) {
            *secs = self.samples.secs(simulation);
            seen.add(evaluated, self.body_mass_kg);
        }
    }

    fn values(&self, (seen, secs): &Self::Seen, _: &Simulation) -> Vec<Option<f64>> {
        let peak = seen.peak;
        vec![
            peak.map(|peak| peak.force),
            peak.map(|peak| peak.time),
            peak.map(|peak| peak.place.x),
            peak.map(|peak| peak.place.y),
            peak.map(|_| seen.spell.longest() * secs),
            peak.map(|_| seen.meters),
        ]
    }

    fn data(&self, (seen, _): &Self::Seen) -> Option<(String, Value)> {
        let cells: Vec<&CellForce> = seen.of_cells().collect();
        Some((self.name().to_owned(), json!(cells)))
    }
}
