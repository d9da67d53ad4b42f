//! The frozen frame: read by every force, written by none.

use std::ops::Index;

use crate::agents::Agents;
use crate::clock::Clock;
use crate::geometry::Walls;
use crate::math::Vector;
use crate::neighbors::{BLOCK, Neighbors};
use crate::pairs::Packed;

/// Quantities derived from the state, one array each, with the step that writes it in parentheses.
#[derive(Debug, Clone, Default)]
pub struct Fields {
    /// ρ_i, P/m² (1B).
    pub density: Vec<f64>,
    /// The part of ρ_i from walls, P/m² (1B).
    pub density_from_walls: Walled<f64>,
    /// ρ̂_i, P/m², unclamped (1B).
    pub mean_density: Vec<f64>,
    /// ρ_i⁰, P/m² (1B).
    pub rest_density: Vec<f64>,
    /// p_i, 1/s² (1B).
    pub pressure: Vec<f64>,
    /// Σ_k ∫ ∇W over P_k, 1/m (1B). Times −p_i it is the pressure force of all walls.
    pub wall_gradient: Walled<Vector>,
    /// v_i^pref, m/s (2).
    pub preferred_velocity: Vec<Vector>,
    /// a_i, m/s² (3, 3B, 4).
    pub acceleration: Vec<Vector>,
    /// The rates of change of the states that forces keep, per second, as [`Agents::states`] (3, 3B, 4).
    pub state_rates: Vec<Vec<f64>>,
}

/// A quantity that is zero for agents without walls near them: in blocks of agents, only those that have some.
#[derive(Debug, Clone, Default)]
pub struct Walled<T> {
    blocks: Vec<Vec<T>>,
    zero: T,
}

impl<T: Copy + Default> Walled<T> {
    /// The blocks of `BLOCK` agents; empty where no agent has walls near it.
    #[doc(hidden)]
    pub fn blocks_mut(&mut self) -> &mut [Vec<T>] {
        &mut self.blocks
    }

    fn clear(&mut self) {
        self.blocks.iter_mut().for_each(Vec::clear);
    }

    fn resize(&mut self, count: usize) {
        let blocks = count.div_ceil(BLOCK);
        self.blocks.resize_with(blocks, Vec::new);
    }
}

impl<T> Index<usize> for Walled<T> {
    type Output = T;

    fn index(&self, i: usize) -> &T {
        let block = self.blocks.get(i / BLOCK);
        block
            .and_then(|block| block.get(i % BLOCK))
            .unwrap_or(&self.zero)
    }
}

impl Fields {
    /// Discards all wall contributions; [`resize_sph`](Self::resize_sph) sets them to zero.
    #[doc(hidden)]
    pub fn forget_walls(&mut self) {
        self.density_from_walls.clear();
        self.wall_gradient.clear();
    }

    /// Resizes the arrays that step 1B writes.
    #[doc(hidden)]
    pub fn resize_sph(&mut self, count: usize) {
        self.density.resize(count, 0.0);
        self.density_from_walls.resize(count);
        self.mean_density.resize(count, 0.0);
        self.rest_density.resize(count, 0.0);
        self.pressure.resize(count, 0.0);
        self.wall_gradient.resize(count);
    }
}

/// One frame, frozen between [`evaluate`](crate::simulation::Simulation::evaluate) and
/// [`integrate`](crate::simulation::Simulation::integrate): all fields match the positions.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// The number and time of the frame.
    pub clock: &'a Clock,
    /// Walls of the obstacles.
    pub walls: &'a Walls,
    /// The state of the crowd.
    pub agents: &'a Agents,
    /// Quantities derived from the state.
    pub fields: &'a Fields,
    /// Neighbor lists.
    #[doc(hidden)]
    pub neighbors: &'a Neighbors,
    /// Agents and fields, packed for sums over pairs.
    #[doc(hidden)]
    pub packed: &'a Packed,
    /// Seed of the agents' random choices.
    pub seed: u64,
}

impl Frame<'_> {
    /// The near neighbors j of agent `i` at less than `radius` meters, with r_ij = r_i − r_j.
    pub fn near(&self, i: usize, radius: f64) -> impl Iterator<Item = (usize, Vector)> + '_ {
        let position = &self.agents.position;
        let candidates = self.neighbors.near().near(i);
        let candidates = candidates.filter(move |&(j, _)| j != i);
        candidates
            .map(move |(j, laps)| (j, self.neighbors.seen_from(position[i], laps) - position[j]))
            .filter(move |(_, r_ij)| r_ij.norm_squared() < radius * radius)
    }

    /// All other agents j within `radius` meters of agent `i`, and some farther away, with r_ij = r_i − r_j.
    pub fn around(&self, i: usize, radius: f64) -> impl Iterator<Item = (usize, Vector)> + '_ {
        let positions = &self.agents.position;
        let p = positions[i];
        let runs = self.neighbors.around(i, positions, radius);
        let all = runs.flat_map(move |run| {
            let from = self.neighbors.seen_from(p, run.laps);
            run.indices().map(move |j| (j, from - positions[j]))
        });
        all.filter(move |&(j, _)| j != i)
    }
}
