//! Debug agents: some agents with the full breakdown of their forces, frame by frame.

pub mod arrows;
pub mod focus;
pub mod follow;
pub mod layers;
pub mod moment;

use super::draw::{Point, xy};
use crate::drawing::Drawing;
use crate::over_joins::in_building;
use engine::breakdown::Breakdown;
use engine::geometry::HiddenRegion;
use engine::math::Vector;
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;
use figures::colors::Rgb;

/// Number of segments of an arc in the outline of a hidden region.
const ARC_STEPS: usize = 24;

/// Selects the debug agents.
#[derive(Debug, Clone, PartialEq)]
pub enum DebugAgents {
    /// The agents with these ids, while they are present.
    Ids(Vec<u32>),
    /// The agents inside a rectangle, selected anew in each frame, and the one that is followed.
    Region(Region),
    /// All agents: about 1.5 kB per agent and frame.
    All,
    /// No agents.
    None,
}

impl DebugAgents {
    /// Whether agent `i` of the current frame is a debug agent.
    pub(in crate::recording) fn includes(&self, simulation: &Simulation, i: usize) -> bool {
        let agents = simulation.frame().agents;
        if !agents.is_present(i) {
            return false;
        }
        match self {
            Self::Ids(ids) => ids.contains(&agents.id[i]),
            Self::Region(region) => region.contains(agents.position[i]),
            Self::All => true,
            Self::None => false,
        }
    }

    /// The breakdowns of the debug agents in the current frame, and of the agents `also` that are present, in the order
    /// of their ids; empty if the frame has no densities.
    pub(in crate::recording) fn open(
        &self,
        simulation: &Simulation,
        also: &[Option<u32>],
    ) -> Vec<Open> {
        let agents = simulation.frame().agents;
        let also = also.iter().flatten();
        let mut candidates: Vec<usize> = match self {
            Self::None => Vec::new(),
            // A search for each is faster than a test of every agent.
            Self::Ids(ids) => ids.iter().filter_map(|&id| agents.index_of(id)).collect(),
            Self::Region(_) | Self::All => (0..agents.len())
                .filter(|&i| self.includes(simulation, i))
                .chain(also.filter_map(|&id| agents.index_of(id)))
                .collect(),
        };
        candidates.sort_unstable_by_key(|&i| agents.id[i]);
        candidates.dedup();
        let chosen = candidates.into_iter();
        chosen.filter_map(|i| Open::of(simulation, i)).collect()
    }
}

/// The names and colors of the accelerations that act in a scene, their sum first.
pub fn force_terms(scene: &Scene) -> Vec<(String, Rgb)> {
    let acting = arrows::acting(scene).into_iter();
    let terms = acting.map(|term| (term.in_words(), term.color.1));
    let total = ("total".to_owned(), arrows::TOTAL);
    std::iter::once(total).chain(terms).collect()
}

/// The accelerations of the debug agents in the current frame, by id: their sum, then those of [`force_terms`], m/s².
pub fn forces_on(simulation: &Simulation, debug: &DebugAgents) -> Vec<(u32, Vec<Vector>)> {
    let terms = arrows::acting(simulation.scene());
    let open = debug.open(simulation, &[]).into_iter();
    let forces = open.map(|agent| {
        let total = Vector::from(agent.breakdown.acceleration);
        let of_terms = terms.iter().map(|term| agent.force(&term.name));
        let all = std::iter::once(total).chain(of_terms);
        (agent.breakdown.id, all.collect())
    });
    forces.collect()
}

/// An agent with its breakdown.
pub struct Open {
    pub breakdown: Breakdown,
    /// Where it is drawn, meters.
    pub position: Vector,
    /// From the points of the breakdown to where they are drawn, meters: zero on a plane.
    to_drawing: Vector,
    /// The name of its level in a building.
    pub level: Option<String>,
    pub support_radius: f64,
    /// The outlines of P_k, in the order of the breakdown's walls.
    pub hidden: Vec<Vec<Point>>,
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
            to_drawing: Vector::zeros(),
            level: None,
            support_radius,
        })
    }

    /// Moves it to where it is drawn, and the points of its breakdown to their places in the building.
    pub(in crate::recording) fn draw(&mut self, drawing: &Drawing) {
        let plane = self.position;
        self.position = drawing.place(plane);
        self.to_drawing = drawing.from_building(plane);
        for point in self.hidden.iter_mut().flatten() {
            let [x, y] = xy(self.position - plane);
            *point = [point[0] + x, point[1] + y];
        }
        in_building(drawing.levels(), &mut self.breakdown);
        self.level = Some(drawing.level(plane).to_owned());
    }

    /// Where a point of its breakdown is drawn.
    fn drawn(&self, p: [f64; 2]) -> Vector {
        Vector::from(p) + self.to_drawing
    }

    /// The weighted sum of one term over the active profiles.
    pub fn force(&self, term: &str) -> Vector {
        let terms = self.breakdown.profiles.iter().flat_map(|share| {
            let listed = share.accelerations.listed();
            listed.map(|(name, value)| (name, value * share.weight))
        });
        terms
            .filter(|(name, _)| *name == term)
            .map(|(_, value)| value)
            .sum()
    }
}
