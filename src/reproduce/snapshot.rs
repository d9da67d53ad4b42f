//! Everybody at one moment, for pictures.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::case::{Observer, Probe};
use crate::simulation::Simulation;

/// One agent at one moment; the digits of `f32` are enough for a picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// The agent's id.
    pub id: u32,
    /// Position, metres.
    pub position: [f32; 2],
    /// Velocity, m/s.
    pub velocity: [f32; 2],
    /// ρ_i, P/m².
    pub density: f32,
    /// D_i, metres.
    pub radius: f32,
}

/// Everybody at one moment, by rising id.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The moment, seconds.
    pub time_secs: f64,
    /// Everybody.
    pub bodies: Vec<Body>,
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

/// Waits for the frame.
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
    /// An evaluated frame that has its densities.
    pub fn of(simulation: &Simulation) -> Self {
        let frame = simulation.frame();
        let agents = frame.agents;
        let mut bodies: Vec<Body> = (0..agents.len())
            .map(|i| Body {
                id: agents.id[i],
                position: [agents.position[i].x as f32, agents.position[i].y as f32],
                velocity: [agents.velocity[i].x as f32, agents.velocity[i].y as f32],
                density: frame.fields.density.get(i).copied().unwrap_or_default() as f32,
                radius: agents.radius[i] as f32,
            })
            .collect();
        bodies.sort_by_key(|body| body.id);
        Self {
            time_secs: frame.clock.time(),
            bodies,
        }
    }
}
