//! The crowds that are cut.

use sandbox::engine::simulation::Simulation;
use sandbox::lab::bench::{Crowd, Plan, Stretch, begin};
use sandbox::lab::error::LabError;

/// Sizes of the dense block.
const BLOCKS: [u32; 3] = [100_000, 1_000_000, 10_000_000];
/// The size of the streams.
const STREAMS: u32 = 100_000;
/// Frames until a block or streams have settled, and the fewest for large blocks.
const SETTLING: u64 = 100;
const LEAST_SETTLING: u64 = 20;
/// Agents × frames until a block has settled.
const SETTLING_AGENT_FRAMES: u64 = 100_000_000;
/// The shipped scenes that move.
const SCENES: [Stretch; 2] = [("concert", 150.0, 10.0), ("plaza", 10.0, 10.0)];
/// A crowd to cut.
pub enum Kind {
    /// The dense block at rest.
    Block(u32),
    /// Two streams through each other.
    Streams(u32),
    /// A shipped scenario.
    Scene(Stretch),
}

impl Kind {
    /// The crowds of a plan.
    pub fn all(plan: &Plan) -> Vec<Self> {
        if plan.quick {
            return vec![Self::Block(2_000), Self::Streams(1_000)];
        }
        let blocks = BLOCKS.into_iter().filter(|&agents| agents <= plan.largest);
        let small = (plan.largest < BLOCKS[0]).then_some(plan.largest);
        let blocks = small.into_iter().chain(blocks).map(Self::Block);
        let scenes = SCENES.into_iter().map(Self::Scene);
        blocks
            .chain([Self::Streams(STREAMS)])
            .chain(scenes)
            .collect()
    }

    pub fn name(&self) -> String {
        match self {
            Self::Block(_) => "block".to_owned(),
            Self::Streams(_) => "streams".to_owned(),
            Self::Scene((name, ..)) => (*name).to_owned(),
        }
    }

    /// Whether it drifts away from a cut.
    pub fn moves(&self) -> bool {
        !matches!(self, Self::Block(_))
    }

    /// The crowd before it is cut.
    ///
    /// # Errors
    /// The simulation fails.
    pub fn start(&self, plan: &Plan) -> Result<Simulation, LabError> {
        match self {
            &Self::Block(agents) => {
                let frames = SETTLING_AGENT_FRAMES / u64::from(agents);
                let frames = plan.choose(frames.clamp(LEAST_SETTLING, SETTLING), 5);
                Crowd::concert(agents).settled(frames)
            }
            &Self::Streams(agents) => {
                Crowd::streams(agents, "sph").settled(plan.choose(SETTLING, 5))
            }
            Self::Scene(stretch) => Ok(begin(stretch, plan, None)?.simulation),
        }
    }
}
