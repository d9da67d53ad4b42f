//! Some agents laid open, frame by frame, by the engine's own breakdown.

use super::geometry::xy;
use crate::engine::breakdown::Breakdown;
use crate::engine::geometry::HiddenRegion;
use crate::engine::math::Vector;
use crate::engine::profile::Term;
use crate::engine::scene::Region;
use crate::engine::simulation::Simulation;

/// Parts of an arc in the outline of a hidden region.
const ARC_STEPS: usize = 24;
/// What the debug view shows round an agent, metres.
const FOCUS: f64 = 3.0;
/// What it shows round a rectangle, as a share of its sides.
const MARGIN: f64 = 0.05;

/// Who is laid open.
#[derive(Debug, Clone, PartialEq)]
pub enum DebugAgents {
    /// These, while they are there.
    Ids(Vec<u32>),
    /// Whoever is in a rectangle, in each frame anew.
    Region(Region),
    /// Everybody: some 1.5 kB per agent and frame.
    All,
    /// Nobody.
    None,
}

/// Finds the debug agents and lays them open.
pub struct Debug {
    who: DebugAgents,
}

impl Debug {
    pub fn new(who: DebugAgents) -> Self {
        Self { who }
    }

    /// The indices of the agents meant, in the order of their ids.
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

    /// Lays them open in the current frame; nobody, if it has no densities.
    pub fn open(&self, simulation: &Simulation) -> Vec<Open> {
        let chosen = self.among(simulation).into_iter();
        chosen.filter_map(|i| Open::of(simulation, i)).collect()
    }

    /// The part of the plane to look at: the rectangle asked for, or the surroundings of the first id
    /// given that is there now.
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

/// `region` with `margin` more on every side.
fn grown(region: Region, margin: Vector) -> Region {
    Region {
        min: region.min - margin,
        max: region.max + margin,
    }
}

/// An agent laid open.
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

    /// The weighted sum of one term over the profiles that act.
    pub fn force(&self, term: Term) -> Vector {
        let shares = self.breakdown.profiles.iter();
        let terms = shares.filter_map(|share| Some(share.accelerations.get(term)? * share.weight));
        terms.sum()
    }
}
