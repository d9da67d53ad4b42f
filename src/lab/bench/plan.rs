//! The amount of work of a benchmark.

/// The amount of work of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The number of repetitions of the same steps.
    pub repeats: usize,
    /// Small crowds and few steps: a check that everything works; the times are meaningless.
    pub quick: bool,
    /// The largest crowd of benchmarks that measure several sizes.
    pub largest: u32,
}

impl Plan {
    /// `usual`, or `few` if the plan is quick.
    pub fn choose<T>(&self, usual: T, few: T) -> T {
        if self.quick { few } else { usual }
    }

    /// The number of frames in which `agents` agents take about `agent_frames` steps together, between two limits.
    pub fn frames(&self, agents: u32, agent_frames: u64, [fewest, most]: [u64; 2]) -> u64 {
        self.choose((agent_frames / u64::from(agents)).clamp(fewest, most), 5)
    }
}
