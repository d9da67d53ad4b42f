//! All agents at one time, for pictures.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{About, Measure, Observed};
use crate::keys::limits::LONGEST_TIME;
use analysis::evaluated::Evaluated;
use engine::simulation::Simulation;

/// All agents at one time: positions, radii, speeds and densities.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SnapshotAt {
    /// The time, seconds.
    #[schemars(range(min = 0, max = LONGEST_TIME))]
    at_secs: f64,
}

/// All agents at one time, rounded to three decimals. The lists of all quantities have the same order.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The time, seconds.
    pub time_secs: f64,
    /// x of the positions, meters.
    pub x: Vec<f64>,
    /// y of the positions, meters.
    pub y: Vec<f64>,
    /// D_i, meters.
    pub radius: Vec<f64>,
    /// |v_i|, m/s.
    pub speed: Vec<f64>,
    /// ρ_i, P/m².
    pub density: Vec<f64>,
}

impl Snapshot {
    /// The name of the data of a snapshot at this time, seconds.
    pub fn name(at_secs: f64) -> String {
        format!("snapshot_{at_secs}s")
    }

    /// A snapshot of an evaluated frame whose densities are known.
    pub fn of(simulation: &Simulation) -> Self {
        let frame = simulation.frame();
        let agents = frame.agents;
        // More digits would only make the files larger.
        let rounded = |value: f64| (1e3 * value).round() / 1e3;
        let all =
            |value: &dyn Fn(usize) -> f64| agents.present().map(|i| rounded(value(i))).collect();
        Self {
            time_secs: frame.clock.time(),
            x: all(&|i| agents.position[i].x),
            y: all(&|i| agents.position[i].y),
            radius: all(&|i| agents.radius[i]),
            speed: all(&|i| agents.velocity[i].norm()),
            density: all(&|i| frame.fields.density[i]),
        }
    }
}

impl Measure for SnapshotAt {
    type Seen = Option<Snapshot>;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        Vec::new()
    }

    fn about(&self) -> About {
        About::with_density_until(self.at_secs)
    }

    fn observe(&self, seen: &mut Self::Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let clock = simulation.frame().clock;
        if clock.frame() == clock.frame_at(self.at_secs) {
            *seen = Some(Snapshot::of(simulation));
        }
    }

    fn data(&self, seen: &Self::Seen) -> Option<(String, Value)> {
        Some((Snapshot::name(self.at_secs), json!(seen)))
    }
}
