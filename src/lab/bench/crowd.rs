//! Crowds of any size and density, without walls.

use super::timing::{failed, ms_per_frame};
use crate::error::LabError;
use engine::agents::NewAgent;
use engine::math::Vector;
use engine::placement::Grid;
use engine::scene::{Group, Scene};
use engine::simulation::Simulation;
use scenario::catalog::{self, Parameters};

/// Distance to the goals of agents that walk, meters: no agent arrives.
const AHEAD: f64 = 100.0;
/// Each coordinate is moved by up to ± this fraction of the distance between neighbors.
const JITTER: f64 = 0.05;

/// Where the agents of a crowd want to go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Nowhere: their goals are their own positions.
    Stay,
    /// To the right.
    Right,
    /// Alternately to the right and to the left.
    Both,
}

/// A square block of agents on a hexagonal grid with jitter.
#[derive(Debug, Clone, PartialEq)]
pub struct Crowd {
    /// Number of agents.
    pub agents: u32,
    /// Density, P/m².
    pub density: f64,
    /// The name of one of the paper's profiles.
    pub profile: &'static str,
    /// Changes to the profile's parameters.
    pub parameters: Vec<(&'static str, f64)>,
    /// Where they want to go.
    pub way: Way,
}

impl Crowd {
    /// As dense as the crowd in front of the concert's stage, with its parameters: 5 P/m², μ = 5, K^goal = 0.1.
    ///
    /// The goal of each agent is its own position, which keeps crowds of all sizes at the same density.
    pub fn concert(agents: u32) -> Self {
        Self {
            agents,
            density: 5.0,
            profile: "sph",
            parameters: vec![("viscosity", 5.0), ("goal_scale", 0.1)],
            way: Way::Stay,
        }
    }

    /// Agents at 4 P/m² that avoid each other. Half of them walk to the right and half to the left.
    pub fn streams(agents: u32, profile: &'static str) -> Self {
        Self {
            agents,
            density: 4.0,
            profile,
            parameters: Vec::new(),
            way: Way::Both,
        }
    }

    /// Agents that all walk to the right, at 1.3 m/s when they are alone.
    pub fn walkers(agents: u32, density: f64, profile: &'static str) -> Self {
        Self {
            agents,
            density,
            profile,
            parameters: Vec::new(),
            way: Way::Right,
        }
    }

    /// The scene before the first frame.
    ///
    /// # Errors
    /// The profile or a parameter does not exist.
    pub fn scene(&self) -> Result<Scene, LabError> {
        let parameters = Parameters::of(self.parameters.iter().copied());
        let parameters = parameters.map_err(|error| LabError::Data(error.to_string()))?;
        let found = catalog::named(self.profile, &parameters);
        let blend = found.map_err(|error| LabError::Data(error.to_string()))?;
        let mut scene = Scene::default();
        let group = scene.add_group(Group {
            counted: false,
            ..Group::new("crowd", blend)
        });
        let agent = |(k, place): (usize, Vector)| {
            let way = match self.way {
                Way::Stay => 0.0,
                Way::Both if !k.is_multiple_of(2) => -AHEAD,
                Way::Right | Way::Both => AHEAD,
            };
            NewAgent::at(place, place + Vector::new(way, 0.0), group)
        };
        let places = self.places(scene.seed).into_iter().enumerate();
        scene.agents = places.map(agent).collect();
        Ok(scene)
    }

    /// Row by row; every other row is shifted by half the distance between neighbors.
    fn places(&self, seed: u64) -> Vec<Vector> {
        let spacing = (2.0 / (self.density * 3.0_f64.sqrt())).sqrt();
        let height = 0.75_f64.sqrt() * spacing;
        let columns = ((f64::from(self.agents) * 0.75_f64.sqrt()).sqrt().round() as u32).max(1);
        let rows = self.agents.div_ceil(columns);
        let row = |k: u32| {
            let shift = 0.5 * spacing * f64::from(k % 2);
            let grid = Grid {
                min: Vector::new(shift, f64::from(k) * height),
                max: Vector::new(
                    shift + f64::from(columns) * spacing,
                    f64::from(k + 1) * height,
                ),
                columns,
                rows: 1,
                jitter: JITTER * spacing,
            };
            grid.positions(seed, k * columns).collect::<Vec<_>>()
        };
        (0..rows).flat_map(row).take(self.agents as usize).collect()
    }

    /// The crowd after `frames` frames.
    ///
    /// # Errors
    /// As [`scene`](Self::scene), or the simulation fails.
    pub fn settled(&self, frames: u64) -> Result<Simulation, LabError> {
        let mut simulation = Simulation::new(self.scene()?).map_err(failed)?;
        ms_per_frame(&mut simulation, frames)?;
        Ok(simulation)
    }
}
