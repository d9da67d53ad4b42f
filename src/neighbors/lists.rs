//! One list of indices per agent, filled in parallel, stored contiguously.

use std::ops::Range;

use rayon::prelude::*;

use super::BLOCK;

/// Lists in blocks of consecutive agents, so that blocks are filled side by side and nothing is
/// copied together afterwards; memory is kept between rebuilds.
#[derive(Debug, Clone, Default)]
pub struct Lists {
    blocks: Vec<Block>,
}

#[derive(Debug, Clone, Default)]
struct Block {
    /// Where each agent's list ends in `indices`.
    ends: Vec<u32>,
    indices: Vec<u32>,
}

impl Lists {
    /// Fills the lists of agents 0..`count`: `find(i, found)` appends what belongs to agent i.
    pub fn rebuild(&mut self, count: usize, find: impl Fn(usize, &mut Vec<u32>) + Sync) {
        self.blocks
            .resize_with(count.div_ceil(BLOCK), Block::default);
        self.blocks
            .par_iter_mut()
            .enumerate()
            .for_each(|(b, block)| {
                block.ends.clear();
                block.indices.clear();
                for i in b * BLOCK..((b + 1) * BLOCK).min(count) {
                    find(i, &mut block.indices);
                    block.ends.push(block.indices.len() as u32);
                }
            });
    }

    /// As [`rebuild`](Self::rebuild), but all lists are empty, at no cost, where `skip` holds.
    pub fn rebuild_unless(
        &mut self,
        skip: bool,
        count: usize,
        find: impl Fn(usize, &mut Vec<u32>) + Sync,
    ) {
        if skip {
            self.clear();
        } else {
            self.rebuild(count, find);
        }
    }

    /// Forgets all lists.
    pub fn clear(&mut self) {
        self.blocks.clear();
    }

    /// Those of `agents`, all of one block, whose lists are not empty, with their lists.
    pub fn listed(&self, agents: Range<usize>) -> impl Iterator<Item = (usize, &[u32])> {
        let block = self.blocks.get(agents.start / BLOCK);
        let any = block.is_some_and(|block| !block.indices.is_empty());
        let agents = if any { agents } else { 0..0 };
        agents
            .map(|i| (i, self.of(i)))
            .filter(|(_, list)| !list.is_empty())
    }

    /// The list of agent `i`; empty after [`clear`](Self::clear).
    pub fn of(&self, i: usize) -> &[u32] {
        let Some(block) = self.blocks.get(i / BLOCK) else {
            return &[];
        };
        if block.indices.is_empty() {
            return &[];
        }
        let k = i % BLOCK;
        let start = if k == 0 { 0 } else { block.ends[k - 1] };
        &block.indices[start as usize..block.ends[k] as usize]
    }
}
