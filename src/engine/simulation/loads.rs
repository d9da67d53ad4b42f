//! The pressure and contact forces of a frame on agents and walls, pair by pair and wall by wall.

use rayon::prelude::*;

use super::Simulation;
use crate::forces::near::PairCoefficients;
use crate::forces::virial::virials;
use crate::math::Vector;
use crate::neighbors::{BLOCK, TASK};
use crate::pairs::Columns;

impl Simulation {
    /// Σ_j r_ij ⊗ a_ij of each agent of the evaluated frame as xx, xy and yy, m²/s², where a_ij is the acceleration of
    /// i by the pressure (Eq. 11) and contact (Eq. 22) of j. Uses the force functions of the frame, in double
    /// precision.
    pub fn virials(&self) -> Vec<[f64; 3]> {
        let frame = self.frame();
        let (agents, fields, near) = (frame.agents, frame.fields, frame.neighbors.near());
        let mut found = vec![[0.0; 3]; agents.len()];
        if near.is_empty() {
            return found; // the scene has no such forces
        }
        let mut columns = Columns::<f64>::default();
        columns.take_bodies(agents, 1.0, frame.neighbors.way(), |i| {
            self.blend(i).reach()
        });
        columns.bodies.take_motions(agents);
        for (i, (&density, &pressure)) in fields.density.iter().zip(&fields.pressure).enumerate() {
            columns.volume[i] = agents.mass[i] / density;
            columns.pressure[i] = pressure;
        }
        let blocks = found.par_chunks_mut(BLOCK).with_min_len(TASK).enumerate();
        blocks.for_each(|(b, found)| {
            let from = b * BLOCK;
            let mut felt = PairCoefficients::default();
            self.fixed
                .each_span(agents, from..from + found.len(), |span, blend, changed| {
                    blend.add_pair_coefficients(&frame, span, changed, &mut felt);
                });
            virials(&columns, near.block(b), &felt, found);
        });
        found
    }

    /// Calls `take` for each agent and wall that press on each other in the evaluated frame, with the acceleration of
    /// the agent, m/s²: pressure (Eq. 12) and contact (Eq. 23).
    pub fn each_wall_push(&self, mut take: impl FnMut(usize, u32, Vector)) {
        let frame = self.frame();
        if frame.fields.acceleration.is_empty() {
            return; // not evaluated
        }
        let method = self.scene().wall_method;
        for i in 0..frame.agents.len() {
            let how = (self.change(i), method);
            self.blend(i)
                .each_wall_push(&frame, i, how, |wall, push| take(i, wall, push));
        }
    }
}
