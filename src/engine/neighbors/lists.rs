//! One list of indices per agent, filled in parallel, stored contiguously.

use std::ops::Range;

use rayon::prelude::*;

use super::{BLOCK, TASK};

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
    /// Fills the lists of agents 0..`count`: `among` finds what may belong to any of some agents, and
    /// `find` appends what of that belongs to one.
    pub fn rebuild(
        &mut self,
        count: usize,
        among: impl Fn(Range<usize>) -> Vec<u32> + Sync,
        find: impl Fn(usize, &[u32], &mut Vec<u32>) + Sync,
    ) {
        self.blocks
            .resize_with(count.div_ceil(BLOCK), Block::default);
        self.blocks
            .par_iter_mut()
            .with_min_len(TASK)
            .enumerate()
            .for_each(|(b, block)| {
                block.ends.clear();
                block.indices.clear();
                let agents = b * BLOCK..((b + 1) * BLOCK).min(count);
                let candidates = among(agents.clone());
                if candidates.is_empty() {
                    return;
                }
                for i in agents {
                    find(i, &candidates, &mut block.indices);
                    block.ends.push(block.indices.len() as u32);
                }
            });
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
