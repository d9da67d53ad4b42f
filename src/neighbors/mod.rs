//! Step 1: who is near whom, and which walls are near.
//!
//! Agents are sorted into the cells of a [`Grid`]; near neighbours (SPH, contact) are listed as
//! [`Chunks`] of agents that are neighbours in memory, with a margin, the *skin*, so that the lists
//! hold until somebody has moved half of it: nobody is ever missed in between. The wide circle of the
//! avoidance methods is read from the grid's rows, without lists.

mod chunks;
mod grid;
mod lists;

pub use chunks::{BLOCK, CHUNK, Chunk, Chunks};
pub use grid::Grid;
pub use lists::Lists;

use std::ops::Range;

use crate::agents::Agents;
use crate::geometry::Walls;
use crate::math::Vector;

/// Margin of all lists, metres: half of it may be walked before they are made anew. More of it makes
/// rarer but longer lists.
pub const SKIN: f64 = 0.2;

/// How far neighbours are looked for; avoidance that nobody needs is `None`, and costs nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ranges {
    /// Support radius h of SPH, metres.
    pub support: f64,
    /// Radius of the avoidance methods, metres.
    pub avoidance: Option<f64>,
    /// The longest step that anybody makes in a frame, s_max Δt, metres.
    pub longest_step: f64,
}

/// Neighbours as of the last sort.
#[derive(Debug, Clone, Default)]
pub struct Neighbors {
    ranges: Ranges,
    /// How far agents are listed as near, skin included, metres.
    reach: f64,
    grid: Grid,
    near: Chunks,
    near_walls: Lists,
    far_walls: Lists,
    /// The most that anybody has moved since the last sort, metres.
    travelled: f64,
}

impl Neighbors {
    /// Sorts the agents into the cells of a new grid. Invalidates all lists.
    pub fn sort(&mut self, agents: &mut Agents, ranges: Ranges) {
        self.ranges = ranges;
        self.travelled = 0.0;
        self.near.clear();
        self.reach = near_radius(agents, &ranges);
        let order = self.grid.rebuild(&agents.position, self.reach);
        agents.arrange(&order);
    }

    /// Lists everybody's near neighbours, as far as SPH and contact reach.
    ///
    /// May come some frames after the sort, as long as the lists would not be stale. They do not
    /// depend on whether a density is due: whoever asks for it must not change the order of any sum,
    /// and so the motion, not even by rounding.
    pub fn list_agents(&mut self, agents: &Agents) {
        self.near.rebuild(&self.grid, &agents.position, self.reach);
    }

    /// Lists the walls near everybody: near ones for SPH and contact and for stopping moves, far ones
    /// for avoidance.
    pub fn list_walls(&mut self, agents: &Agents, walls: &Walls) {
        let least = self.ranges.support.max(self.ranges.longest_step);
        let position = &agents.position;
        self.near_walls
            .rebuild_unless(walls.is_empty(), agents.len(), |i, found| {
                let reach = least.max(agents.radius[i]) + 0.5 * SKIN;
                walls.near(position[i], reach, found);
            });
        let avoidance = self.ranges.avoidance.filter(|_| !walls.is_empty());
        self.far_walls
            .rebuild_unless(avoidance.is_none(), agents.len(), |i, found| {
                let reach = avoidance.unwrap_or(0.0) + 0.5 * SKIN;
                walls.near(position[i], reach, found);
            });
    }

    /// Notes that everybody has moved, by at most `step` metres.
    pub fn moved(&mut self, step: f64) {
        self.travelled += step;
    }

    /// Could somebody be missed?
    pub fn are_stale(&self) -> bool {
        self.travelled > 0.5 * SKIN
    }

    /// All that are near, for SPH and contact, and some that are out of range.
    pub fn near(&self) -> &Chunks {
        &self.near
    }

    /// A distance within which everybody in a list is, metres, for choosing units.
    pub fn extent(&self) -> f64 {
        4.0 * self.reach
    }

    /// Candidates for avoidance within `radius` metres of `p`, as ranges of agents, some out of range
    /// and agent `i` itself among them.
    pub fn around(&self, p: Vector, radius: f64) -> impl Iterator<Item = Range<usize>> + '_ {
        self.grid.rows(p, radius + 0.5 * SKIN)
    }

    /// Walls that may be within reach of agent `i` for SPH and contact, rising.
    pub fn near_walls(&self, i: usize) -> &[u32] {
        self.near_walls.of(i)
    }

    /// Walls that may be within reach of agent `i` for avoidance, rising.
    pub fn far_walls(&self, i: usize) -> &[u32] {
        self.far_walls.of(i)
    }
}

/// How far agents act on each other by SPH and contact, and the skin.
fn near_radius(agents: &Agents, ranges: &Ranges) -> f64 {
    let widest = agents.radius.iter().copied().fold(0.0, f64::max);
    ranges.support.max(2.0 * widest) + SKIN
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agents::NewAgent;
    use crate::random::{Purpose, stream};
    use rand::Rng;

    fn crowd(count: u32, side: f64) -> Agents {
        let mut agents = Agents::default();
        for id in 0..count {
            let mut rng = stream(7, Purpose::Placement, id, 0);
            let position = Vector::new(rng.random_range(0.0..side), rng.random_range(0.0..side));
            agents.enter(NewAgent::at(position, Vector::zeros(), 0), 7);
        }
        agents
    }

    fn listed(agents: &mut Agents) -> Neighbors {
        let mut neighbors = Neighbors::default();
        let ranges = Ranges {
            support: 1.0,
            avoidance: Some(5.0),
            longest_step: 0.036,
        };
        neighbors.sort(agents, ranges);
        neighbors.list_agents(agents);
        neighbors
    }

    fn near(neighbors: &Neighbors, i: usize) -> Vec<usize> {
        neighbors.near().agents(i).collect()
    }

    #[test]
    fn whom_brute_force_finds_near_is_listed_once() {
        for (count, side) in [(0, 1.0), (1, 1.0), (300, 6.0), (300, 300.0), (300, 0.1)] {
            let mut agents = crowd(count, side);
            let neighbors = listed(&mut agents);
            for i in 0..agents.len() {
                let found = near(&neighbors, i);
                assert!(found.is_sorted_by(|a, b| a < b) && found.contains(&i));
                for j in 0..agents.len() {
                    let distance = (agents.position[i] - agents.position[j]).norm();
                    assert!(distance >= 1.2 || found.contains(&j));
                }
            }
        }
    }

    #[test]
    fn fewer_are_listed_than_three_by_three_cells_hold() {
        let mut agents = crowd(2000, 20.0);
        let neighbors = listed(&mut agents);
        let listed: usize = (0..2000).map(|i| near(&neighbors, i).len()).sum();
        let area = listed as f64 / 2000.0 / 5.0;
        assert!(area < 0.7 * (3.0 * 1.2_f64).powi(2), "{area} m²");
    }

    #[test]
    fn nobody_is_missed_until_the_lists_are_stale() {
        let mut agents = crowd(400, 12.0);
        let mut neighbors = listed(&mut agents);
        for _ in 0..2 {
            assert!(!neighbors.are_stale());
            for (i, r) in agents.position.iter_mut().enumerate() {
                let angle = i as f64;
                *r += Vector::new(angle.cos(), angle.sin()) * 0.05;
            }
            neighbors.moved(0.05);
            for i in 0..agents.len() {
                let r_i = agents.position[i];
                let around: Vec<usize> = neighbors.around(r_i, 5.0).flatten().collect();
                let near = near(&neighbors, i);
                for j in (0..agents.len()).filter(|&j| j != i) {
                    let distance = (r_i - agents.position[j]).norm();
                    assert!(distance >= 1.0 || near.contains(&j));
                    assert!(distance >= 5.0 || around.contains(&j));
                }
            }
            // Lists made anew on the old cells hold as long.
            neighbors.list_agents(&agents);
        }
        neighbors.moved(1e-6);
        assert!(neighbors.are_stale());
    }

    #[test]
    fn the_grid_stays_small_when_somebody_is_far_away() {
        let mut agents = crowd(50, 5.0);
        agents.enter(NewAgent::at(Vector::new(1e9, -1e9), Vector::zeros(), 0), 0);
        let neighbors = listed(&mut agents);
        assert!(neighbors.grid.cells() < 10_000);
        let loner = agents.index_of(50).unwrap();
        assert_eq!(near(&neighbors, loner), [loner]);
    }
}
