//! The frozen frame: what every force reads and no force writes.

use std::ops::Range;

use crate::engine::agents::Agents;
use crate::engine::clock::Clock;
use crate::engine::geometry::Walls;
use crate::engine::math::Vector;
use crate::engine::neighbors::{BLOCK, CLUSTER, Neighbors};
use crate::engine::pairs::{Packed, PairCoefficients, Wanted};

/// What a frame derives from the state, one array per quantity; the step that writes it in brackets.
#[derive(Debug, Clone, Default)]
pub struct Fields {
    /// ρ_i, P/m² (1B).
    pub density: Vec<f64>,
    /// The walls' part of ρ_i, P/m² (1B).
    pub density_from_walls: Vec<f64>,
    /// ρ̂_i, P/m², before it is clamped (1B).
    pub mean_density: Vec<f64>,
    /// ρ_i⁰, P/m² (1B).
    pub rest_density: Vec<f64>,
    /// p_i (1B).
    pub pressure: Vec<f64>,
    /// Σ_k ∫ ∇W over P_k, 1/m (1B): times −p_i it is the walls' pressure force.
    pub wall_gradient: Vec<Vector>,
    /// v_i^pref, m/s (2).
    pub preferred_velocity: Vec<Vector>,
    /// The lowest and highest components of the velocities of every [`CLUSTER`] consecutive agents, m/s
    /// (3); empty where no social force has a tolerance.
    pub velocity_ranges: Vec<[Vector; 2]>,
    /// a_i, m/s² (3, 3B, 4).
    pub acceleration: Vec<Vector>,
}

impl Fields {
    /// No field of any agent.
    pub const NONE: Self = Self {
        density: Vec::new(),
        density_from_walls: Vec::new(),
        mean_density: Vec::new(),
        rest_density: Vec::new(),
        pressure: Vec::new(),
        wall_gradient: Vec::new(),
        preferred_velocity: Vec::new(),
        velocity_ranges: Vec::new(),
        acceleration: Vec::new(),
    };

    /// Nobody has been near a wall yet: what walls give to an agent is zero until a frame says otherwise.
    pub fn forget_walls(&mut self) {
        self.density_from_walls.clear();
        self.wall_gradient.clear();
    }

    /// Makes room for `count` agents; where `density` is not computed in this frame its arrays are
    /// empty, so that nobody can read an old one.
    pub fn resize(&mut self, count: usize, density: bool) {
        let sph = if density { count } else { 0 };
        self.density.resize(sph, 0.0);
        self.density_from_walls.resize(sph, 0.0);
        self.mean_density.resize(sph, 0.0);
        self.rest_density.resize(sph, 0.0);
        self.pressure.resize(sph, 0.0);
        self.wall_gradient.resize(sph, Vector::zeros());
        self.preferred_velocity.resize(count, Vector::zeros());
        self.acceleration.resize(count, Vector::zeros());
    }
}

/// The smallest and largest components of some lowest and highest ones; zero of none.
pub fn velocity_range(of: impl Iterator<Item = [Vector; 2]>) -> [Vector; 2] {
    of.reduce(|[low, high], [lower, higher]| [low.inf(&lower), high.sup(&higher)])
        .unwrap_or([Vector::zeros(); 2])
}

/// One frame, frozen between [`evaluate`](crate::engine::simulation::Simulation::evaluate) and
/// [`integrate`](crate::engine::simulation::Simulation::integrate): positions and everything computed from
/// them agree.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// Which frame it is.
    pub clock: &'a Clock,
    /// The obstacles.
    pub walls: &'a Walls,
    /// The crowd's state.
    pub agents: &'a Agents,
    /// What was derived from it.
    pub fields: &'a Fields,
    /// Who is near whom.
    pub neighbors: &'a Neighbors,
    /// Bodies and fields as sums over pairs read them.
    pub packed: &'a Packed,
    /// Which of them some profile reads.
    pub wanted: Wanted,
    /// Seed of what people choose.
    pub seed: u64,
}

impl Frame<'_> {
    /// The near neighbours j of agent `i` strictly within `radius` metres, with r_ij = r_i − r_j.
    pub fn near(&self, i: usize, radius: f64) -> impl Iterator<Item = (usize, Vector)> + '_ {
        let position = &self.agents.position;
        let candidates = self.neighbors.near().near(i).filter(move |&j| j != i);
        candidates
            .map(move |j| (j, position[i] - position[j]))
            .filter(move |(_, r_ij)| r_ij.norm_squared() < radius * radius)
    }

    /// No two velocities of `agents` and of `others` differ by more than this, m/s; in scenes where some
    /// social force has a tolerance.
    pub(crate) fn relative_speed(&self, agents: Range<usize>, others: &[Range<u32>]) -> f64 {
        let velocities = &self.agents.velocity[agents];
        let [low, high] = velocity_range(velocities.iter().map(|&v| [v, v]));
        let ranges = others.iter().flat_map(|run| {
            let cells = run.start as usize / CLUSTER..(run.end as usize).div_ceil(CLUSTER);
            &self.fields.velocity_ranges[cells]
        });
        let [lowest, highest] = velocity_range(ranges.copied());
        (high - lowest).sup(&(highest - low)).norm()
    }

    /// What the agents near agent `i` do to it, m/s².
    pub fn from_near_agents(&self, i: usize, coefficients: &PairCoefficients) -> Vector {
        let mut accelerations = [Vector::zeros(); BLOCK];
        let block = self.neighbors.near().block(i / BLOCK);
        self.packed
            .accelerations(block, coefficients, self.wanted, &mut accelerations);
        accelerations[i % BLOCK]
    }
}
