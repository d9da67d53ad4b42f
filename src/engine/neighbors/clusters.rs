//! Who is near whom, for a few agents at a time that stand together, in space and in memory.

use std::ops::Range;

use rayon::prelude::*;

use super::Grid;
use crate::engine::math::Vector;

/// Agents that are worked on in one go, and whose lists share memory.
pub const BLOCK: usize = 128;

/// Blocks that are worth another thread.
pub const TASK: usize = 8;

/// The most agents in a cluster.
pub const CLUSTER: usize = 8;

/// The widest cluster, in radii of the lists: in a sparse crowd clusters have fewer agents.
const WIDEST: f64 = 2.0;

/// Everybody in clusters of at most [`CLUSTER`] agents, in blocks of [`BLOCK`] agents.
#[derive(Debug, Clone, Default)]
pub struct Clusters {
    blocks: Vec<ClusterBlock>,
}

/// The clusters of some consecutive agents.
#[derive(Debug, Clone, Default)]
pub struct ClusterBlock {
    clusters: Vec<Cluster>,
    runs: Vec<Range<u32>>,
}

#[derive(Debug, Clone)]
struct Cluster {
    agents: Range<u32>,
    /// Where its runs end.
    runs_end: u32,
}

impl Clusters {
    /// A length for coordinates that wrap at twice of it, metres, when lists reach `reach` metres: nobody
    /// in a list is so far away, in either direction, that he would seem near. That is a cluster's width,
    /// the reach, two cells, of `reach` at most, and two moves: 6 `reach`, of the 8 that are allowed.
    pub fn extent(reach: f64) -> f64 {
        (WIDEST + 2.5) * reach
    }

    /// Lists for everybody the runs of agents with all that are within `reach` metres of somebody in the
    /// cluster, and some that are not; `grid` has been laid over `positions`.
    pub fn rebuild(&mut self, grid: &Grid, positions: &[Vector], reach: f64) {
        let count = positions.len();
        self.blocks
            .resize_with(count.div_ceil(BLOCK), ClusterBlock::default);
        self.blocks
            .par_iter_mut()
            .with_min_len(TASK)
            .enumerate()
            .for_each(|(b, block)| {
                let agents = b * BLOCK..((b + 1) * BLOCK).min(count);
                block.clusters.clear();
                block.runs.clear();
                if grid.height() > reach {
                    block.list_one_by_one(grid, positions, agents, reach);
                } else {
                    block.list_together(grid, positions, agents, reach);
                }
            });
    }

    /// Are there no lists?
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Forgets all lists.
    pub fn clear(&mut self) {
        self.blocks.clear();
    }

    /// The clusters of agents `b` [`BLOCK`] and up; none after [`clear`](Self::clear).
    pub fn block(&self, b: usize) -> &ClusterBlock {
        const NOBODY: &ClusterBlock = &ClusterBlock {
            clusters: Vec::new(),
            runs: Vec::new(),
        };
        self.blocks.get(b).unwrap_or(NOBODY)
    }

    /// Everybody in the list of agent `i`, itself among them, rising; some are out of reach.
    pub fn near(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let own = self.block(i / BLOCK).clusters();
        own.filter(move |(agents, _)| agents.contains(&i))
            .flat_map(|(_, runs)| runs.iter().cloned().flatten())
            .map(|j| j as usize)
    }
}

impl ClusterBlock {
    /// Every cluster's agents, and the runs of their list.
    pub fn clusters(&self) -> impl Iterator<Item = (Range<usize>, &[Range<u32>])> {
        self.clusters.iter().scan(0, |start, cluster| {
            let runs = &self.runs[*start..cluster.runs_end as usize];
            *start = cluster.runs_end as usize;
            let agents = cluster.agents.start as usize..cluster.agents.end as usize;
            Some((agents, runs))
        })
    }

    /// Clusters of agents that stand in one row of the grid, in reach of its rows above and below.
    fn list_together(
        &mut self,
        grid: &Grid,
        positions: &[Vector],
        agents: Range<usize>,
        reach: f64,
    ) {
        let mut start = agents.start;
        while start < agents.end {
            let first = grid.place(positions[start]);
            let mut extent = Extent::default();
            let mut end = start;
            while end < agents.end.min(start + CLUSTER) {
                let place = grid.place(positions[end]);
                if place.row != first.row || (place.x - first.x).abs() > WIDEST * reach {
                    break;
                }
                extent.include(place.x, place.y, grid.height(), reach);
                end += 1;
            }
            for (row, [from, to]) in (first.row - 1..).zip(extent.rows) {
                let run = grid.run(row, from, to);
                if !run.is_empty() {
                    self.runs.push(run);
                }
            }
            self.close(start..end);
            start = end;
        }
    }

    /// One agent each, and only who is in reach: where cells had to be made larger than that.
    fn list_one_by_one(
        &mut self,
        grid: &Grid,
        positions: &[Vector],
        agents: Range<usize>,
        reach: f64,
    ) {
        for i in agents {
            let p = positions[i];
            for run in grid.rows([p; 2], reach) {
                let near = run.filter(|&j| (p - positions[j as usize]).norm() < reach);
                self.runs.extend(near.map(|j| j..j + 1));
            }
            self.close(i..i + 1);
        }
    }

    fn close(&mut self, agents: Range<usize>) {
        self.clusters.push(Cluster {
            agents: agents.start as u32..agents.end as u32,
            runs_end: self.runs.len() as u32,
        });
    }
}

/// From where to where a cluster reaches in the row below its own, its own, and the one above, metres
/// from the left end of the rows.
struct Extent {
    rows: [[f64; 2]; 3],
}

impl Default for Extent {
    fn default() -> Self {
        Self {
            rows: [[f64::INFINITY, f64::NEG_INFINITY]; 3],
        }
    }
}

impl Extent {
    /// A circle of `reach` metres round a place `x` along a row, `y` above its floor.
    fn include(&mut self, x: f64, y: f64, height: f64, reach: f64) {
        for (row, gap) in self.rows.iter_mut().zip([y, 0.0, height - y]) {
            // √(reach² − gap²) is at most this.
            let half = reach - gap * gap / (2.0 * reach);
            *row = [row[0].min(x - half), row[1].max(x + half)];
        }
    }
}
