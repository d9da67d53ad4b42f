//! All agents at one time, for pictures.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::case::{Observer, Probe};
use crate::engine::simulation::Simulation;

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

/// Keeps a [`Snapshot`] at a time in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SnapshotAt(pub f64);

impl Probe for SnapshotAt {
    fn name(&self) -> String {
        format!("snapshot at {} s", self.0)
    }

    fn begin(&self, simulation: &mut Simulation) -> Box<dyn Observer> {
        let frame = simulation.frame().clock.frame_at(self.0);
        simulation.request_density_until(frame + 1);
        Box::new(Waiting { frame, seen: None })
    }
}

/// Waits for the frame of the snapshot.
struct Waiting {
    frame: u64,
    seen: Option<Snapshot>,
}

impl Observer for Waiting {
    fn observe(&mut self, simulation: &Simulation) {
        if simulation.frame().clock.frame() == self.frame {
            self.seen = Some(Snapshot::of(simulation));
        }
    }

    fn finish(self: Box<Self>) -> Value {
        serde_json::to_value(self.seen).unwrap_or_default()
    }
}

impl Snapshot {
    /// A snapshot of an evaluated frame whose densities are known.
    pub fn of(simulation: &Simulation) -> Self {
        let frame = simulation.frame();
        let agents = frame.agents;
        // More digits would only make the files larger.
        let rounded = |value: f64| (1e3 * value).round() / 1e3;
        let all = |values: &[f64]| values.iter().map(|&v| rounded(v)).collect();
        Self {
            time_secs: frame.clock.time(),
            x: agents.position.iter().map(|r| rounded(r.x)).collect(),
            y: agents.position.iter().map(|r| rounded(r.y)).collect(),
            radius: all(&agents.radius),
            speed: agents.velocity.iter().map(|v| rounded(v.norm())).collect(),
            density: all(&frame.fields.density),
        }
    }
}
