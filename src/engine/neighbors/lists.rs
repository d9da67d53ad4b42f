//! One list of indices per agent, filled in parallel, stored contiguously.

use std::ops::Range;

use rayon::prelude::*;

use super::{BLOCK, TASK};

/// Lists in blocks of consecutive agents. Blocks are filled in parallel and never merged; they keep their memory
/// between rebuilds.
#[derive(Debug, Clone, Default)]
pub struct Lists {
    blocks: Vec<Block>,
}

#[derive(Debug, Clone, Default)]
struct Block {
    /// The end of each agent's list in `indices`.
    ends: Vec<u32>,
    indices: Vec<u32>,
}

impl Lists {
    /// Fills the lists of agents 0..`count`: `among` returns the candidates for a range of agents, and `find` appends
    /// the candidates that belong to one agent.
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

    /// Drops all lists.
    pub fn clear(&mut self) {
        self.blocks.clear();
    }

    /// The non-empty lists of `agents`, all of one block, each after its agent.
    pub fn listed(&self, agents: Range<usize>) -> impl Iterator<Item = (usize, &[u32])> {
        let block = self.blocks.get(agents.start / BLOCK);
        let first = agents.start % BLOCK;
        let (before, ends, indices) = match block {
            Some(block) if !block.indices.is_empty() => {
                let (before, ends) = block.ends.split_at(first);
                (before, ends, &block.indices[..])
            }
            _ => (&[][..], &[][..], &[][..]),
        };
        let mut start = before.last().map_or(0, |&end| end as usize);
        agents.zip(ends).filter_map(move |(i, &end)| {
            let end = end as usize;
            let list = &indices[std::mem::replace(&mut start, end)..end];
            (!list.is_empty()).then_some((i, list))
        })
    }

    /// The list of agent `i`; empty after [`clear`](Self::clear).
    pub fn of(&self, i: usize) -> &[u32] {
        let own = self.listed(i..i + 1).next();
        own.map_or(&[], |(_, list)| list)
    }
}
