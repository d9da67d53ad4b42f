//! Wall-clock time per stage of the loop: the tasks of Fig. 11.

use std::time::{Duration, Instant};

use super::Simulation;

/// A stage of the loop. A stage that a scene does not need never runs and has no entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Entries and pushes, coarse.
    Schedule,
    /// Journeys: choices, waiting and queues, coarse; and crossings of lines.
    Journeys,
    /// Sorting agents into cells (the paper builds a kd-tree), when neighbor lists are rebuilt.
    Sort,
    /// Listing near agents and walls, when neighbor lists are rebuilt.
    Neighbors,
    /// Packing the positions and velocities that the sums over pairs read.
    Packing,
    /// Step 1B.
    DensityAndPressure,
    /// Next corners on the routes around walls, coarse.
    Routes,
    /// Step 2.
    PreferredVelocity,
    /// A model of one's own.
    OwnModel,
    /// Walking laws, coarse.
    WalkingLaws,
    /// Velocity obstacles, coarse.
    Rvo,
    /// Steps 3, 3B and 4.
    Acceleration,
    /// Step 5.
    Integration,
    /// Removing agents that have reached their goal.
    Removal,
}

impl Stage {
    /// All stages in the order of the loop.
    pub const ALL: [Self; 14] = [
        Self::Schedule,
        Self::Journeys,
        Self::Sort,
        Self::Neighbors,
        Self::Packing,
        Self::DensityAndPressure,
        Self::Routes,
        Self::PreferredVelocity,
        Self::OwnModel,
        Self::WalkingLaws,
        Self::Rvo,
        Self::Acceleration,
        Self::Integration,
        Self::Removal,
    ];

    /// Name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Schedule => "schedule",
            Self::Journeys => "journeys",
            Self::Sort => "sort",
            Self::Neighbors => "neighbors",
            Self::Packing => "packing",
            Self::DensityAndPressure => "density_and_pressure",
            Self::Routes => "routes",
            Self::PreferredVelocity => "preferred_velocity",
            Self::OwnModel => "own_model",
            Self::WalkingLaws => "walking_laws",
            Self::Rvo => "rvo",
            Self::Acceleration => "acceleration",
            Self::Integration => "integration",
            Self::Removal => "removal",
        }
    }
}

/// Wall-clock time per stage over some frames.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StageTimes {
    spent: [Option<Duration>; Stage::ALL.len()],
    frames: u64,
}

impl StageTimes {
    pub(super) fn time<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        let spent = self.spent[stage as usize].get_or_insert(Duration::ZERO);
        *spent += start.elapsed();
        result
    }

    pub(super) fn count_frame(&mut self) {
        self.frames += 1;
    }

    /// Mean milliseconds per frame of every stage that ran.
    pub fn ms_per_frame(&self) -> impl Iterator<Item = (Stage, f64)> + '_ {
        Stage::ALL.into_iter().filter_map(|stage| {
            let spent = self.spent[stage as usize]?;
            Some((stage, 1e3 * spent.as_secs_f64() / self.frames.max(1) as f64))
        })
    }

    /// Mean milliseconds per frame over all stages.
    pub fn total_ms_per_frame(&self) -> f64 {
        self.ms_per_frame().map(|(_, ms)| ms).sum()
    }
}

impl Simulation {
    /// Time spent per stage.
    pub fn stages(&self) -> &StageTimes {
        &self.stages
    }

    /// Resets the times per stage.
    pub fn reset_stages(&mut self) {
        self.stages = StageTimes::default();
    }
}
