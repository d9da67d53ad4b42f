//! Step 1: who is near whom, and which walls are near.
//!
//! Agents are sorted into the cells of a [`Grid`]; near neighbours (SPH, contact) are listed once
//! per coarse frame with a margin, the *skin*, so that nobody is missed in between; the wide circle
//! of the avoidance methods is read from the grid's rows, without lists.

mod grid;
mod lists;

pub use grid::Grid;
pub use lists::Lists;

use std::ops::Range;

use crate::agents::Agents;
use crate::geometry::Walls;
use crate::math::Vector;

/// How far neighbours are looked for; a range that nobody needs is `None`, and costs nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ranges {
    /// Support radius h of SPH, metres; lists go so far only while the density is due.
    pub support: Option<f64>,
    /// Do discs in contact matter?
    pub contact: bool,
    /// Radius of the avoidance methods, metres.
    pub avoidance: Option<f64>,
    /// The most that anybody walks between two rebuilds, s_max Δt_coarse, metres.
    pub drift: f64,
}

/// Neighbours as of the last coarse frame.
#[derive(Debug, Clone, Default)]
pub struct Neighbors {
    ranges: Ranges,
    grid: Grid,
    /// Near agents with the skin, as of the last coarse frame.
    candidates: Lists,
    /// Those in range now; no lists where candidates are good enough.
    in_range: Lists,
    near_walls: Lists,
    far_walls: Lists,
}

impl Neighbors {
    /// Sorts the agents into the cells of a new grid. Invalidates all lists.
    ///
    /// The cells, and with them the order of all sums, do not depend on whether the density is due:
    /// whoever asks for it must not change the motion, not even by rounding.
    pub fn sort(&mut self, agents: &mut Agents, ranges: Ranges) {
        self.ranges = ranges;
        let near = near_radius(agents, &ranges, true);
        let cell = 0.5 * near.unwrap_or(2.0);
        let order = self.grid.rebuild(&agents.position, cell);
        agents.arrange(&order);
    }

    /// Lists everybody's near neighbours, for SPH too if the `density` is due.
    ///
    /// May come some frames after the sort: who has drifted out of the cells searched here is too
    /// far away to come back before the next rebuild.
    pub fn list_agents(&mut self, agents: &Agents, density: bool) {
        self.in_range.clear();
        let Some(radius) = near_radius(agents, &self.ranges, density) else {
            self.candidates.clear();
            return;
        };
        let (grid, position) = (&self.grid, &agents.position);
        self.candidates.rebuild(agents.len(), |i, found| {
            let r_i = position[i];
            for row in grid.rows(r_i, radius) {
                found.extend(row.filter_map(|j| {
                    let near = (r_i - position[j]).norm_squared() < radius * radius;
                    (near && j != i).then_some(j as u32)
                }));
            }
        });
    }

    /// Narrows the lists to who is within the interaction radius in this frame. It pays where several
    /// sums follow, as in SPH: half of the candidates are skin.
    pub fn narrow(&mut self, agents: &Agents) {
        let radius = interaction_radius(agents, &self.ranges, true);
        let (candidates, position) = (&self.candidates, &agents.position);
        self.in_range
            .rebuild_unless(radius.is_none(), agents.len(), |i, found| {
                let r_i = position[i];
                let reach = radius.unwrap_or(0.0).powi(2);
                let mut end = found.len();
                found.resize(end + candidates.of(i).len(), 0);
                // Written first, kept if in range: a branch here would be a coin toss.
                for &j in candidates.of(i) {
                    found[end] = j;
                    end += usize::from((r_i - position[j as usize]).norm_squared() < reach);
                }
                found.truncate(end);
            });
    }

    /// Undoes [`narrow`](Self::narrow): all candidates again.
    pub fn widen(&mut self) {
        self.in_range.clear();
    }

    /// Lists the walls near everybody: near ones for SPH and contact and for stopping moves, far ones
    /// for avoidance.
    pub fn list_walls(&mut self, agents: &Agents, walls: &Walls, density: bool) {
        let drift = self.ranges.drift;
        let support = self.ranges.support.filter(|_| density).unwrap_or(0.0);
        let position = &agents.position;
        self.near_walls
            .rebuild_unless(walls.is_empty(), agents.len(), |i, found| {
                // A move that a wall stops begins at most one drift away from it.
                let reach = support.max(agents.radius[i]).max(drift) + drift;
                walls.near(position[i], reach, found);
            });
        let avoidance = self.ranges.avoidance.filter(|_| !walls.is_empty());
        self.far_walls
            .rebuild_unless(avoidance.is_none(), agents.len(), |i, found| {
                let reach = avoidance.unwrap_or(0.0) + drift;
                walls.near(position[i], reach, found);
            });
    }

    /// Candidates for SPH and contact with agent `i`, rising, without `i`; some are out of range.
    pub fn near(&self, i: usize) -> &[u32] {
        if self.in_range.is_empty() {
            self.candidates.of(i)
        } else {
            self.in_range.of(i)
        }
    }

    /// Candidates for avoidance within `radius` metres of `p`, as ranges of agents, some out of range
    /// and agent `i` itself among them.
    pub fn around(&self, p: Vector, radius: f64) -> impl Iterator<Item = Range<usize>> + '_ {
        self.grid.rows(p, radius + self.ranges.drift)
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

/// How far agents act on each other by contact and, if the `density` is due, by SPH; `None` where
/// neither is needed.
fn interaction_radius(agents: &Agents, ranges: &Ranges, density: bool) -> Option<f64> {
    let widest = agents.radius.iter().copied().fold(0.0, f64::max);
    let contact = ranges.contact.then_some(2.0 * widest);
    let support = ranges.support.filter(|_| density);
    support.into_iter().chain(contact).reduce(f64::max)
}

/// The list radius of near neighbours: interaction radius + skin, 2 s_max Δt_coarse.
fn near_radius(agents: &Agents, ranges: &Ranges, density: bool) -> Option<f64> {
    Some(interaction_radius(agents, ranges, density)? + 2.0 * ranges.drift)
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

    fn ranges() -> Ranges {
        Ranges {
            support: Some(1.0),
            contact: true,
            avoidance: Some(5.0),
            drift: 0.18,
        }
    }

    #[test]
    fn near_lists_are_what_brute_force_finds() {
        for (count, side) in [(0, 1.0), (1, 1.0), (300, 6.0), (300, 300.0)] {
            let mut agents = crowd(count, side);
            let mut neighbors = Neighbors::default();
            neighbors.sort(&mut agents, ranges());
            neighbors.list_agents(&agents, true);
            for i in 0..agents.len() {
                let expected: Vec<u32> = (0..agents.len())
                    .filter(|&j| j != i)
                    .filter(|&j| (agents.position[i] - agents.position[j]).norm() < 1.36)
                    .map(|j| j as u32)
                    .collect();
                assert_eq!(neighbors.near(i), expected);
            }
        }
    }

    #[test]
    fn narrowed_lists_hold_exactly_who_is_in_range() {
        let mut agents = crowd(300, 6.0);
        let mut neighbors = Neighbors::default();
        neighbors.sort(&mut agents, ranges());
        neighbors.list_agents(&agents, true);
        neighbors.narrow(&agents);
        for i in 0..agents.len() {
            let distance = |j: usize| (agents.position[i] - agents.position[j]).norm();
            let expected = (0..agents.len()).filter(|&j| j != i && distance(j) < 1.0);
            let expected: Vec<u32> = expected.map(|j| j as u32).collect();
            assert_eq!(neighbors.near(i), expected);
        }
    }

    #[test]
    fn nobody_is_missed_until_the_next_rebuild() {
        let mut agents = crowd(400, 12.0);
        let mut neighbors = Neighbors::default();
        neighbors.sort(&mut agents, ranges());
        neighbors.list_agents(&agents, true);
        for (i, r) in agents.position.iter_mut().enumerate() {
            let angle = i as f64;
            *r += Vector::new(angle.cos(), angle.sin()) * 0.18;
        }
        for i in 0..agents.len() {
            let r_i = agents.position[i];
            let around: Vec<usize> = neighbors.around(r_i, 5.0).flatten().collect();
            for j in (0..agents.len()).filter(|&j| j != i) {
                let distance = (r_i - agents.position[j]).norm();
                assert!(distance >= 1.0 || neighbors.near(i).contains(&(j as u32)));
                assert!(distance >= 5.0 || around.contains(&j));
            }
        }
    }

    #[test]
    fn the_grid_stays_small_when_somebody_is_far_away() {
        let mut agents = crowd(50, 5.0);
        agents.enter(NewAgent::at(Vector::new(1e9, -1e9), Vector::zeros(), 0), 0);
        let mut neighbors = Neighbors::default();
        neighbors.sort(&mut agents, ranges());
        neighbors.list_agents(&agents, true);
        assert!(neighbors.grid.cells() < 10_000);
        let loner = agents.index_of(50).unwrap();
        assert!(neighbors.near(loner).is_empty());
    }
}
