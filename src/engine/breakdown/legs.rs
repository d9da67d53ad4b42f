//! The legs of one agent, term by term.

use serde::Serialize;

use crate::forces::near;
use crate::simulation::Simulation;

/// The legs under a body. Accelerations are in m/s².
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LegsPart {
    /// y_i, meters.
    pub position: [f64; 2],
    /// w_i, m/s.
    pub velocity: [f64; 2],
    /// |r_i − y_i|, meters.
    pub lean: f64,
    /// The lean at which balance is lost, meters.
    pub lean_limit: f64,
    /// Legs run after the body.
    pub balance: [f64; 2],
    /// The repulsion by the legs of other agents.
    pub agents: [f64; 2],
    /// The repulsion by walls.
    pub walls: [f64; 2],
    /// The sum of these terms, as the frame has it.
    pub acceleration: [f64; 2],
}

impl LegsPart {
    /// The legs of agent `i` of an evaluated frame; `None` without legs.
    pub fn of(simulation: &Simulation, i: usize) -> Option<Self> {
        let frame = simulation.frame();
        let law = simulation.blend(i).legs()?;
        let (agents, walls) = (frame.agents, frame.neighbors.near_walls(i));
        Some(Self {
            position: (*agents.legs.get(i)?).into(),
            velocity: (*agents.legs_velocity.get(i)?).into(),
            lean: agents.lean(i).norm(),
            lean_limit: law.lean_limit,
            balance: law.balance(&frame, i).legs.into(),
            agents: near::repulsion_of(&frame, i).legs.into(),
            walls: law.from_walls(&frame, i, walls).legs.into(),
            acceleration: (*frame.fields.legs_acceleration.get(i)?).into(),
        })
    }
}
