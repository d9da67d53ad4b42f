//! Debug agents: some agents with the full breakdown of their forces, frame by frame.

use super::geometry::xy;
use crate::engine::breakdown::Breakdown;
use crate::engine::geometry::HiddenRegion;
use crate::engine::math::Vector;
use crate::engine::profile::Term;
use crate::engine::scene::Region;
use crate::engine::simulation::Simulation;

/// Number of segments of an arc in the outline of a hidden region.
const ARC_STEPS: usize = 24;
/// Half the side of the debug view around an agent, meters.
const FOCUS: f64 = 3.0;
/// Margin of the debug view around a rectangle, relative to its sides.
const MARGIN: f64 = 0.05;

/// Selects the debug agents.
#[derive(Debug, Clone, PartialEq)]
pub enum DebugAgents {
    /// The agents with these ids, while they are present.
    Ids(Vec<u32>),
    /// The agents inside a rectangle, selected anew in each frame.
    Region(Region),
    /// All agents: about 1.5 kB per agent and frame.
    All,
    /// No agents.
    None,
}

/// Finds the debug agents and computes their breakdowns.
pub struct Debug {
    who: DebugAgents,
}

impl Debug {
    pub fn new(who: DebugAgents) -> Self {
        Self { who }
    }

    /// The indices of the selected agents, in the order of their ids.
    fn among(&self, simulation: &Simulation) -> Vec<usize> {
        let agents = simulation.frame().agents;
        let everybody = 0..agents.len();
        let mut chosen: Vec<usize> = match &self.who {
            DebugAgents::None => Vec::new(),
            DebugAgents::All => everybody.collect(),
            DebugAgents::Region(region) => everybody
                .filter(|&i| region.contains(agents.position[i]))
                .collect(),
            DebugAgents::Ids(ids) => {
                let mut wanted = vec![false; agents.entered() as usize];
                for &id in ids {
                    if let Some(wanted) = wanted.get_mut(id as usize) {
                        *wanted = true;
                    }
                }
                everybody
                    .filter(|&i| wanted[agents.id[i] as usize])
                    .collect()
            }
        };
        chosen.sort_unstable_by_key(|&i| agents.id[i]);
        chosen
    }

    /// The breakdowns of the debug agents in the current frame; empty if the frame has no densities.
    pub fn open(&self, simulation: &Simulation) -> Vec<Open> {
        let chosen = self.among(simulation).into_iter();
        chosen.filter_map(|i| Open::of(simulation, i)).collect()
    }

    /// The region to show: the selected rectangle with a margin, or the surroundings of the first selected id that is
    /// present.
    pub fn focus(&self, simulation: &Simulation) -> Option<Region> {
        let agents = simulation.frame().agents;
        match &self.who {
            DebugAgents::Region(region) => {
                let margin = (region.max - region.min) * MARGIN;
                Some(grown(*region, margin))
            }
            DebugAgents::Ids(ids) => {
                let first = ids.iter().find_map(|&id| agents.index_of(id))?;
                let (min, max) = (agents.position[first], agents.position[first]);
                Some(grown(Region { min, max }, Vector::repeat(FOCUS)))
            }
            DebugAgents::All | DebugAgents::None => None,
        }
    }
}

/// `region` grown by `margin` on every side.
fn grown(region: Region, margin: Vector) -> Region {
    Region {
        min: region.min - margin,
        max: region.max + margin,
    }
}

/// An agent with its breakdown.
pub struct Open {
    pub breakdown: Breakdown,
    pub position: Vector,
    pub support_radius: f64,
    /// The outlines of P_k, in the order of the breakdown's walls.
    pub hidden: Vec<Vec<[f32; 2]>>,
}

impl Open {
    fn of(simulation: &Simulation, i: usize) -> Option<Self> {
        let breakdown = Breakdown::of(simulation, i)?;
        let frame = simulation.frame();
        let position = frame.agents.position[i];
        let support_radius = simulation.blend(i).sph.support_radius;
        let regions = breakdown.walls.iter().filter_map(|term| {
            HiddenRegion::behind(frame.walls.wall(term.wall), position, support_radius)
        });
        let outline = |region: HiddenRegion| region.outline(position, ARC_STEPS);
        let hidden = regions.map(|region| outline(region).into_iter().map(xy).collect());
        Some(Self {
            hidden: hidden.collect(),
            breakdown,
            position,
            support_radius,
        })
    }

    /// The weighted sum of one term over the active profiles.
    pub fn force(&self, term: Term) -> Vector {
        let shares = self.breakdown.profiles.iter();
        let terms = shares.filter_map(|share| Some(share.accelerations.get(term)? * share.weight));
        terms.sum()
    }
}
