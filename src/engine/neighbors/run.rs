//! Agents that are next to each other in memory.

use std::ops::Range;

/// A run of agents in memory, seen across the ends of a period.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// Indices.
    pub agents: Range<u32>,
    /// The number of periods from the agents to where they are seen; 0 without period.
    pub laps: i32,
}

impl Run {
    /// The indices of its agents.
    pub fn indices(&self) -> Range<usize> {
        self.agents.start as usize..self.agents.end as usize
    }
}

impl From<Range<u32>> for Run {
    fn from(agents: Range<u32>) -> Self {
        Self { agents, laps: 0 }
    }
}
