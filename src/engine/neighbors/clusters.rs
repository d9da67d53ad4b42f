//! Neighbor lists shared by clusters of a few agents that are close together, in space and in memory.

use std::ops::Range;

use rayon::prelude::*;

use super::{Grid, Run};
use crate::math::{Vector, bounds};

/// The number of agents that are processed together, and whose lists share memory.
pub const BLOCK: usize = 128;

/// The fewest blocks per parallel task.
pub const TASK: usize = 8;

/// The most agents in a cluster.
pub const CLUSTER: usize = 8;

/// The greatest width of a cluster, in units of the lists' reach: in a sparse crowd clusters have fewer agents.
pub const WIDEST: f64 = 3.0;

/// That of clusters for social forces, whose directions have the more rounding the wider clusters are.
pub const WIDEST_SOCIAL: f64 = 2.0;

/// Half the period of coordinates that may wrap, in units of the lists' reach.
const EXTENT: f64 = 4.5;

/// All agents in clusters of at most [`CLUSTER`] agents, in blocks of [`BLOCK`] agents.
#[derive(Debug, Clone, Default)]
pub struct Clusters {
    /// They keep their memory between rebuilds: allocated by several threads at every sort, it took longer than the
    /// lists.
    blocks: Vec<ClusterBlock>,
    is_listed: bool,
}

/// The clusters of one block of consecutive agents.
#[derive(Debug, Clone, Default)]
pub struct ClusterBlock {
    clusters: Vec<Cluster>,
    runs: Vec<Run>,
}

#[derive(Debug, Clone)]
struct Cluster {
    agents: Range<u32>,
    /// The end of its runs in the block's `runs`.
    runs_end: u32,
}

impl Clusters {
    /// Half the period of coordinates that may wrap, meters, for lists that reach `reach` meters: large enough that
    /// wrapping makes no listed agent seem near. Along x or y, the distance to a listed agent is at most the sum of a
    /// cluster's width, the reach, two cells of at most `reach` each, and two displacements since the sort. This is 7
    /// `reach`; 8 are allowed.
    pub fn extent(reach: f64) -> f64 {
        EXTENT * reach
    }

    /// For each cluster, lists all agents within `reach` meters of any of its members, and some that are farther away,
    /// as runs of agents. No cluster is wider than `widest` times the reach. `grid` must have been laid over the
    /// `positions`.
    pub fn rebuild(&mut self, grid: &Grid, positions: &[Vector], [reach, widest]: [f64; 2]) {
        let count = positions.len();
        self.is_listed = true;
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
                    block.list_together(grid, positions, agents, [reach, widest]);
                }
            });
    }

    /// Whether there are no lists.
    pub fn is_empty(&self) -> bool {
        !self.is_listed || self.blocks.is_empty()
    }

    /// Drops all lists.
    pub fn clear(&mut self) {
        self.is_listed = false;
    }

    /// The clusters of block `b`, which begins with agent `b` × [`BLOCK`]; none after [`clear`](Self::clear).
    pub fn block(&self, b: usize) -> &ClusterBlock {
        const NOBODY: &ClusterBlock = &ClusterBlock {
            clusters: Vec::new(),
            runs: Vec::new(),
        };
        let listed = self.blocks.get(b).filter(|_| self.is_listed);
        listed.unwrap_or(NOBODY)
    }

    /// All agents in the list of agent `i`, including itself, in ascending order, then those across the ends of the
    /// period, each with its laps (see [`Run`]); some are out of reach.
    pub fn near(&self, i: usize) -> impl Iterator<Item = (usize, i32)> + '_ {
        let own = self.block(i / BLOCK).clusters();
        own.filter(move |(agents, _)| agents.contains(&i))
            .flat_map(|(_, runs)| runs)
            .flat_map(|run| run.indices().map(|j| (j, run.laps)))
    }
}

impl ClusterBlock {
    /// The agents of each cluster, with the runs of their list.
    pub fn clusters(&self) -> impl Iterator<Item = (Range<usize>, &[Run])> {
        self.clusters.iter().scan(0, |start, cluster| {
            let runs = &self.runs[*start..cluster.runs_end as usize];
            *start = cluster.runs_end as usize;
            let agents = cluster.agents.start as usize..cluster.agents.end as usize;
            Some((agents, runs))
        })
    }

    /// Clusters of agents in one row of the grid, whose reach ends within the rows above and below.
    fn list_together(
        &mut self,
        grid: &Grid,
        positions: &[Vector],
        agents: Range<usize>,
        [reach, widest]: [f64; 2],
    ) {
        let half_curvature = 0.5 / reach;
        let mut start = agents.start;
        while start < agents.end {
            let first = grid.place(positions[start]);
            let mut extent = Extent::default();
            let mut end = start;
            while end < agents.end.min(start + CLUSTER) {
                let place = grid.place(positions[end]);
                let is_far = (place.x - first.x).abs() > widest * reach;
                if place.row != first.row
                    || is_far
                    || !grid.see_alike(positions[start], positions[end])
                {
                    break;
                }
                extent.include(place.x, place.y, grid.height(), (reach, half_curvature));
                end += 1;
            }
            for (row, [from, to]) in (first.row - 1..).zip(extent.rows) {
                let run = grid.run(row, from, to);
                if !run.is_empty() {
                    self.runs.push(run.into());
                }
            }
            if grid.has_images() {
                let corners = bounds(positions[start..end].iter().copied()).unwrap_or_default();
                self.runs
                    .extend(grid.across(positions[start], corners, reach));
            }
            self.close(start..end);
            start = end;
        }
    }

    /// Clusters of one agent, with only the agents in reach: for cells that had to be made larger than the reach.
    fn list_one_by_one(
        &mut self,
        grid: &Grid,
        positions: &[Vector],
        agents: Range<usize>,
        reach: f64,
    ) {
        for i in agents {
            grid.each_near([positions[i]; 2], positions, [reach, 0.0], &mut self.runs);
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

/// The intervals that a cluster reaches in the row below its own, in its own row, and in the row above, in meters
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
    /// Extends the intervals by a circle of radius `reach` meters around a place `x` along the row and `y` above its
    /// lower edge; `half_curvature` is that of the circle.
    #[inline(always)]
    fn include(&mut self, x: f64, y: f64, height: f64, (reach, half_curvature): (f64, f64)) {
        for (row, gap) in self.rows.iter_mut().zip([y, 0.0, height - y]) {
            // √(reach² − gap²) is at most this.
            let half = reach - gap * gap * half_curvature;
            let (from, to) = (x - half, x + half);
            // Without branches; nothing here is NaN.
            row[0] = if from < row[0] { from } else { row[0] };
            row[1] = if to > row[1] { to } else { row[1] };
        }
    }
}
