//! Who is near whom, as runs of agents that are neighbours in memory.

use std::ops::Range;

use rayon::prelude::*;

use super::Grid;
use crate::math::Vector;

/// Agents whose lists share a block: enough to be worth a task, few enough to spread.
pub const BLOCK: usize = 128;

/// The longest run in one chunk.
pub const CHUNK: usize = 8;

/// At most [`CHUNK`] consecutive agents.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Chunk {
    /// The first.
    pub start: u32,
    /// How many there are from `start` on to the end of their run: all of the chunk, or fewer.
    pub count: f32,
}

/// Per agent the chunks that hold all near neighbours, itself, and some that are out of range.
#[derive(Debug, Clone, Default)]
pub struct Chunks {
    blocks: Vec<Block>,
}

#[derive(Debug, Clone, Default)]
struct Block {
    /// Where each agent's chunks end in `chunks`.
    ends: Vec<u32>,
    chunks: Vec<Chunk>,
}

impl Chunks {
    /// Lists for everybody the cells of `grid` within `reach` metres; where cells had to be made
    /// larger than that, the single agents within reach.
    pub fn rebuild(&mut self, grid: &Grid, positions: &[Vector], reach: f64) {
        let count = positions.len();
        self.blocks
            .resize_with(count.div_ceil(BLOCK), Block::default);
        self.blocks
            .par_iter_mut()
            .zip(positions.par_chunks(BLOCK))
            .for_each(|(block, block_positions)| {
                block.ends.clear();
                block.chunks.clear();
                for &p in block_positions {
                    for run in grid.near_rows(p, reach) {
                        if grid.height() > reach {
                            block.push_near(run, |j| (p - positions[j]).norm() < reach);
                        } else {
                            block.push(run);
                        }
                    }
                    block.ends.push(block.chunks.len() as u32);
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

    /// The chunks of agent `i`; none after [`clear`](Self::clear).
    pub fn of(&self, i: usize) -> &[Chunk] {
        let Some(block) = self.blocks.get(i / BLOCK) else {
            return &[];
        };
        let k = i % BLOCK;
        let start = if k == 0 { 0 } else { block.ends[k - 1] };
        &block.chunks[start as usize..block.ends[k] as usize]
    }

    /// Everybody in the chunks of agent `i`, rising.
    pub fn agents(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        self.of(i).iter().flat_map(|chunk| {
            let start = chunk.start as usize;
            start..start + CHUNK.min(chunk.count as usize)
        })
    }
}

impl Block {
    /// Makes a chunk of everybody in a run who is near.
    fn push_near(&mut self, run: Range<u32>, is_near: impl Fn(usize) -> bool) {
        let near = run.filter(|&j| is_near(j as usize));
        self.chunks
            .extend(near.map(|start| Chunk { start, count: 1.0 }));
    }

    /// Cuts a run into chunks.
    fn push(&mut self, run: Range<u32>) {
        for start in run.clone().step_by(CHUNK) {
            self.chunks.push(Chunk {
                start,
                count: (run.end - start) as f32,
            });
        }
    }
}
