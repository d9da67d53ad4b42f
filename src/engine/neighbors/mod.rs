//! Step 1: who is near whom, and which walls are near.
//!
//! Agents are sorted into the cells of a [`Grid`]; near neighbours (SPH, contact) are listed as
//! runs of agents in memory, for [`Clusters`] of agents who stand together, with a margin, the *skin*,
//! so that the lists hold until somebody is half of it away from where they were made: nobody is ever
//! missed in between. The wide circle of the avoidance methods is read from the grid's rows, without
//! lists.

mod clusters;
mod grid;
mod lists;

pub use clusters::{BLOCK, CLUSTER, ClusterBlock, Clusters, TASK};
use grid::bounds;
pub use grid::{Grid, Place};
pub use lists::Lists;

use std::ops::Range;

use crate::engine::agents::Agents;
use crate::engine::geometry::Walls;
use crate::engine::math::Vector;

/// Margin of all lists, metres: who is half of it away from where they were made has them made anew.
/// More of it makes rarer but longer lists.
pub const SKIN: f64 = 0.14;

/// When lists of near agents are made anew, and whether anybody can be missed in between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ListPolicy {
    /// As often as needed, with a margin: nobody is ever missed.
    #[default]
    Complete,
    /// In every coarse frame, without a margin (§5.1): whoever comes near in between is missed.
    Coarse,
}

/// How far neighbours are looked for; avoidance that nobody needs is `None`, and costs nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ranges {
    /// Support radius h of SPH, metres.
    pub support: f64,
    /// Radius of the avoidance methods, metres.
    pub avoidance: Option<f64>,
    /// Radius of social forces, metres.
    pub social: Option<f64>,
    /// The longest step that anybody makes in a frame, s_max Δt, metres.
    pub longest_step: f64,
    /// How far anybody may be from where they were listed, metres; nobody misses a wall.
    pub drift: f64,
    /// How far, so that nobody misses anybody either, metres; at most `drift`.
    pub margin: f64,
}

/// Neighbours as of the last sort.
#[derive(Debug, Clone, Default)]
pub struct Neighbors {
    ranges: Ranges,
    /// How far agents are listed as near, skin included, metres.
    reach: f64,
    grid: Grid,
    near: Clusters,
    near_walls: Lists,
    far_walls: Lists,
    /// Where everybody was at the last sort, metres.
    sorted_at: Vec<Vector>,
    /// The farthest that anybody is from there, metres.
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
        self.sorted_at.clone_from(&agents.position);
    }

    /// Lists everybody's near neighbours, as far as SPH and contact reach.
    ///
    /// May come some frames after the sort, as long as the lists would not be stale. They do not
    /// depend on whether a density is due: whoever asks for it must not change the order of any sum,
    /// and so the motion, not even by rounding.
    pub fn list_agents(&mut self) {
        self.near.rebuild(&self.grid, &self.sorted_at, self.reach);
    }

    /// Lists the walls near everybody: near ones for SPH and contact and for stopping moves, far ones
    /// for avoidance.
    pub fn list_walls(&mut self, agents: &Agents, walls: &Walls) {
        let margin = self.ranges.drift;
        let least = self.ranges.support.max(self.ranges.longest_step);
        list_walls(&mut self.near_walls, agents, walls, |radius| {
            least.max(radius) + margin
        });
        match self.ranges.avoidance {
            Some(radius) => list_walls(&mut self.far_walls, agents, walls, |_| radius + margin),
            None => self.far_walls.clear(),
        }
    }

    /// Where everybody was at the last sort, metres.
    pub fn sorted_at(&self) -> &[Vector] {
        &self.sorted_at
    }

    /// Notes how far, in metres, anybody is from there now.
    pub fn travelled(&mut self, farthest: f64) {
        self.travelled = farthest;
    }

    /// Has somebody gone so far that lists with the [`SKIN`] could miss somebody?
    pub fn are_stale(&self) -> bool {
        self.travelled > 0.5 * SKIN
    }

    /// All that are near, for SPH and contact, and some that are out of range.
    pub fn near(&self) -> &Clusters {
        &self.near
    }

    /// Coordinates may wrap at twice this length, metres: nobody whom a cluster is given is so far away
    /// that he would seem near. See [`Clusters::extent`]; in social forces that is a cluster's width, two
    /// cells, the radius and two moves.
    pub fn extent(&self) -> f64 {
        let far = |radius: f64| radius + 2.5 * self.reach + 2.0 * self.ranges.margin;
        let unlisted = 2.0 * (self.ranges.drift - self.ranges.margin);
        Clusters::extent(self.reach).max(self.ranges.social.map_or(0.0, far)) + unlisted
    }

    /// Candidates for avoidance within `radius` metres of `p`, as ranges of agents, some out of range
    /// and whoever stands at `p` among them.
    pub fn around(&self, p: Vector, radius: f64) -> impl Iterator<Item = Range<usize>> + '_ {
        let rows = self.grid.rows([p; 2], radius + self.ranges.margin);
        rows.map(|run| run.start as usize..run.end as usize)
    }

    /// Replaces `found` by runs of agents with all that are within `radius` metres of any of `agents`, of
    /// one cluster, and some that are not.
    pub fn around_cluster(
        &self,
        agents: Range<usize>,
        positions: &[Vector],
        radius: f64,
        found: &mut Vec<Range<u32>>,
    ) {
        found.clear();
        let reach = radius + self.ranges.margin;
        if self.grid.height() <= self.reach {
            found.extend(self.grid.rows(bounds(&positions[agents]), reach));
            return;
        }
        // Cells had to be made larger than lists reach: one agent each, and only who is near.
        for i in agents {
            let p = positions[i];
            let near = self.grid.rows([p; 2], reach).flatten();
            let near = near.filter(|&j| (p - positions[j as usize]).norm() < radius);
            found.extend(near.map(|j| j..j + 1));
        }
    }

    /// Walls that may be within reach of agent `i` for SPH and contact, rising.
    pub fn near_walls(&self, i: usize) -> &[u32] {
        self.near_walls.of(i)
    }

    /// Those of `agents`, all of one block, that may have walls in reach for SPH and contact, with those
    /// walls.
    pub fn agents_near_walls(&self, agents: Range<usize>) -> impl Iterator<Item = (usize, &[u32])> {
        self.near_walls.listed(agents)
    }

    /// Walls that may be within reach of agent `i` for avoidance, rising.
    pub fn far_walls(&self, i: usize) -> &[u32] {
        self.far_walls.of(i)
    }
}

/// So many walls are looked at one by one rather than searched.
const FEW_WALLS: usize = 16;

/// Lists the walls within reach of everybody, by the radius of the body.
fn list_walls(
    lists: &mut Lists,
    agents: &Agents,
    walls: &Walls,
    reach: impl Fn(f64) -> f64 + Sync,
) {
    if walls.is_empty() {
        lists.clear();
        return;
    }
    let reach = |i: usize| reach(agents.radius[i]);
    lists.rebuild(
        agents.len(),
        |some| {
            let widest = some.clone().map(reach).fold(0.0, f64::max);
            walls.near_any(&agents.position[some], widest)
        },
        |i, candidates, found| {
            let (p, radius) = (agents.position[i], reach(i));
            if candidates.len() > FEW_WALLS {
                walls.near(p, radius, found);
                return;
            }
            found.extend(candidates.iter().filter(|&&k| {
                let nearest = walls.wall(k).nearest_point(p).point;
                (nearest - p).norm_squared() < radius * radius
            }));
        },
    );
}

/// How far agents act on each other by SPH and contact, and twice the margin.
fn near_radius(agents: &Agents, ranges: &Ranges) -> f64 {
    let widest = agents.radius.iter().copied().fold(0.0, f64::max);
    ranges.support.max(2.0 * widest) + 2.0 * ranges.margin
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::agents::NewAgent;
    use crate::engine::random::{Purpose, stream};
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
            social: Some(5.0),
            longest_step: 0.036,
            drift: 0.5 * SKIN,
            margin: 0.5 * SKIN,
        };
        neighbors.sort(agents, ranges);
        neighbors.list_agents();
        neighbors
    }

    fn near(neighbors: &Neighbors, i: usize) -> Vec<usize> {
        neighbors.near().near(i).collect()
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
                    assert!(distance >= 1.0 + SKIN || found.contains(&j));
                }
            }
        }
    }

    #[test]
    fn few_are_listed_beyond_the_reach_of_a_cluster() {
        let mut agents = crowd(8000, 40.0);
        let neighbors = listed(&mut agents);
        let listed: usize = (0..8000).map(|i| near(&neighbors, i).len()).sum();
        let area = listed as f64 / 8000.0 / 5.0;
        // Eight in a row 1.2 m high take 1.33 m; circles round them reach 13.3 m² at most.
        assert!(area < 13.3, "{area} m²");
    }

    #[test]
    fn clusters_hold_everybody_once_in_order() {
        for (count, side) in [(0, 1.0), (1, 1.0), (300, 6.0), (300, 300.0), (300, 0.1)] {
            let mut agents = crowd(count, side);
            let neighbors = listed(&mut agents);
            let blocks = (0..agents.len().div_ceil(BLOCK)).map(|b| neighbors.near().block(b));
            let members: Vec<usize> = blocks
                .flat_map(|block| block.clusters())
                .inspect(|(agents, _)| assert!(agents.len() <= CLUSTER))
                .flat_map(|(agents, _)| agents)
                .collect();
            assert_eq!(members, (0..agents.len()).collect::<Vec<_>>());
        }
    }

    #[test]
    fn nobody_is_missed_until_the_lists_are_stale() {
        let mut agents = crowd(400, 12.0);
        let mut neighbors = listed(&mut agents);
        for step in 1..=2 {
            assert!(!neighbors.are_stale());
            for (i, r) in agents.position.iter_mut().enumerate() {
                let angle = i as f64;
                *r += Vector::new(angle.cos(), angle.sin()) * 0.05;
            }
            neighbors.travelled(0.05 * f64::from(step));
            for i in 0..agents.len() {
                let r_i = agents.position[i];
                let around: Vec<usize> = neighbors.around(r_i, 5.0).flatten().collect();
                let near = near(&neighbors, i);
                let mut runs = Vec::new();
                let alone = i..i + 1;
                neighbors.around_cluster(alone, &agents.position, 5.0, &mut runs);
                for j in (0..agents.len()).filter(|&j| j != i) {
                    let distance = (r_i - agents.position[j]).norm();
                    assert!(distance >= 1.0 || near.contains(&j));
                    assert!(distance >= 5.0 || around.contains(&j));
                    assert!(distance >= 5.0 || runs.iter().any(|run| run.contains(&(j as u32))));
                }
            }
            // Lists made anew on the old cells hold as long.
            neighbors.list_agents();
        }
        neighbors.travelled(0.1 + 1e-6);
        assert!(neighbors.are_stale());
    }

    #[test]
    fn whom_brute_force_finds_around_a_cluster_is_found_once() {
        for (count, side) in [(1, 1.0), (300, 6.0), (300, 60.0), (300, 3000.0)] {
            let mut agents = crowd(count, side);
            let neighbors = listed(&mut agents);
            let mut runs = Vec::new();
            let blocks = (0..agents.len().div_ceil(BLOCK)).map(|b| neighbors.near().block(b));
            for (cluster, _) in blocks.flat_map(|block| block.clusters()) {
                for radius in [0.5, 2.7, 5.0] {
                    neighbors.around_cluster(cluster.clone(), &agents.position, radius, &mut runs);
                    let found: Vec<usize> =
                        runs.iter().cloned().flatten().map(|j| j as usize).collect();
                    assert!(found.is_sorted_by(|a, b| a < b));
                    for (i, j) in cluster
                        .clone()
                        .flat_map(|i| (0..agents.len()).map(move |j| (i, j)))
                    {
                        let offset = agents.position[i] - agents.position[j];
                        assert!(offset.norm() >= radius || found.contains(&j));
                        // Nor does somebody who is found seem near when coordinates wrap.
                        let wrapped = 2.0 * neighbors.extent() - offset.amax() - SKIN;
                        assert!(!found.contains(&j) || wrapped > radius + SKIN, "{offset}");
                    }
                }
            }
        }
    }

    #[test]
    fn nobody_who_is_listed_seems_near_when_coordinates_wrap() {
        for (count, side) in [(300, 6.0), (300, 40.0), (300, 60.0), (40, 300.0)] {
            let mut agents = crowd(count, side);
            let neighbors = listed(&mut agents);
            for i in 0..agents.len() {
                for j in near(&neighbors, i) {
                    let offset = (agents.position[i] - agents.position[j]).abs();
                    let wrapped = 2.0 * neighbors.extent() - offset.max() - SKIN;
                    assert!(wrapped > 1.0 + SKIN, "{offset}");
                }
            }
        }
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
