//! What sums over pairs read, packed.

use rayon::prelude::*;

use super::real::{LANES, Real};
use crate::agents::Agents;
use crate::neighbors::BLOCK;

/// One array per quantity in the agents' order, longer by [`LANES`] so that a whole chunk can always
/// be read.
#[derive(Debug, Clone)]
pub struct Columns<R: Real> {
    /// Metres per unit of the coordinates.
    pub(super) unit: f64,
    pub(super) x: Vec<R::Coordinate>,
    pub(super) y: Vec<R::Coordinate>,
    /// m_j.
    pub(super) mass: Vec<R>,
    /// D_j, metres.
    pub(super) radius: Vec<R>,
    /// v_j, m/s.
    pub(super) velocity_x: Vec<R>,
    pub(super) velocity_y: Vec<R>,
    /// m_j/ρ_j, m².
    pub(super) volume: Vec<R>,
    /// p_j.
    pub(super) pressure: Vec<R>,
}

impl<R: Real> Default for Columns<R> {
    fn default() -> Self {
        Self {
            unit: 1.0,
            x: Vec::new(),
            y: Vec::new(),
            mass: Vec::new(),
            radius: Vec::new(),
            velocity_x: Vec::new(),
            velocity_y: Vec::new(),
            volume: Vec::new(),
            pressure: Vec::new(),
        }
    }
}

impl<R: Real> Columns<R> {
    /// Packs everybody's body and motion; `unit` metres is one unit of the coordinates.
    pub fn take_bodies(&mut self, agents: &Agents, unit: f64) {
        self.unit = unit;
        let count = agents.len();
        let position = |i: usize| agents.position[i];
        fill(&mut self.x, count, |i| R::coordinate(position(i).x, unit));
        fill(&mut self.y, count, |i| R::coordinate(position(i).y, unit));
        fill(&mut self.mass, count, |i| R::of(agents.mass[i]));
        fill(&mut self.radius, count, |i| R::of(agents.radius[i]));
        let velocity = |i: usize| agents.velocity[i];
        fill(&mut self.velocity_x, count, |i| R::of(velocity(i).x));
        fill(&mut self.velocity_y, count, |i| R::of(velocity(i).y));
        // Zero until a density is known, so that sums that are not wanted stay finite.
        fill(&mut self.volume, count, |_| R::default());
        fill(&mut self.pressure, count, |_| R::default());
    }

    /// Packs m_j/ρ_j and p_j.
    pub fn take_pressures(&mut self, mass: &[f64], density: &[f64], pressure: &[f64]) {
        let count = mass.len();
        fill(&mut self.volume, count, |i| R::of(mass[i] / density[i]));
        fill(&mut self.pressure, count, |i| R::of(pressure[i]));
    }
}

/// `column[i] = value(i)` for i < `count`, and [`LANES`] zeros.
fn fill<T: Copy + Default + Send>(
    column: &mut Vec<T>,
    count: usize,
    value: impl Fn(usize) -> T + Sync,
) {
    column.resize(count + LANES, T::default());
    column[count..].fill(T::default());
    column[..count]
        .par_chunks_mut(BLOCK)
        .enumerate()
        .for_each(|(b, block)| {
            for (k, place) in block.iter_mut().enumerate() {
                *place = value(b * BLOCK + k);
            }
        });
}
