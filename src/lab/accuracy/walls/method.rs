//! The ways of seeing walls that are compared.

use super::{Case, Integrals, Map, Particles, Region, SUPPORT_RADIUS, Stored, Volumes};
use crate::engine::boundary::WallMethod;
use crate::engine::geometry::Walls;
use crate::engine::math::Vector;

/// A way of seeing walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// One of the engine's, on the polygons themselves.
    Polygons(WallMethod),
    /// Boundary particles.
    Particles {
        /// Metres between neighbours.
        spacing: f64,
        /// What each stands for.
        volumes: Volumes,
    },
    /// A map on a grid.
    Map {
        /// Metres between nodes.
        spacing: f64,
        /// What each node knows.
        stored: Stored,
    },
}

const fn particles(spacing: f64, volumes: Volumes) -> Method {
    Method::Particles { spacing, volumes }
}

/// What is compared.
///
/// Particles at a quarter of h are what fluids usually have, at a tenth they are finer than people's bodies.
pub const METHODS: [Method; 11] = [
    Method::Polygons(WallMethod::Representative),
    Method::Polygons(WallMethod::Exact),
    Method::Polygons(WallMethod::Union),
    particles(0.1, Volumes::Whole),
    particles(0.25, Volumes::Whole),
    particles(0.1, Volumes::Cut),
    particles(0.25, Volumes::Cut),
    particles(0.1, Volumes::Akinci),
    particles(0.25, Volumes::Akinci),
    Method::Map {
        spacing: 0.1,
        stored: Stored::Integrals,
    },
    Method::Map {
        spacing: 0.1,
        stored: Stored::Volume,
    },
];

impl Method {
    /// For people.
    pub fn name(&self) -> String {
        let (kind, spacing) = match self {
            Self::Polygons(WallMethod::Representative) => return "representative point".to_owned(),
            Self::Polygons(WallMethod::Exact) => return "exact".to_owned(),
            Self::Polygons(WallMethod::Union) => return "union".to_owned(),
            Self::Particles { spacing, volumes } => match volumes {
                Volumes::Whole => ("particles", spacing),
                Volumes::Cut => ("particles (cut cells)", spacing),
                Volumes::Akinci => ("particles (Akinci)", spacing),
            },
            Self::Map { spacing, stored } => match stored {
                Stored::Integrals => ("map of integrals", spacing),
                Stored::Volume => ("volume map (Bender)", spacing),
            },
        };
        format!("{kind}, {spacing} m")
    }

    /// What it means to integrate over.
    pub fn region(&self) -> Region {
        match self {
            Self::Polygons(_) => Region::Hidden,
            // A body behind the wall, however thin the wall is.
            Self::Particles {
                volumes: Volumes::Akinci,
                ..
            } => Region::Hidden,
            Self::Particles { .. } | Self::Map { .. } => Region::Solid,
        }
    }

    /// All that is done before the first frame.
    pub fn prepare(self, case: &Case) -> Prepared<'_> {
        let (walls, h) = (&case.walls, SUPPORT_RADIUS);
        match self {
            Self::Polygons(method) => Prepared::Polygons {
                method,
                walls,
                near: Vec::new(),
            },
            Self::Particles { spacing, volumes } => {
                Prepared::Particles(Particles::fill(walls, spacing, volumes, h))
            }
            Self::Map { spacing, stored } => {
                let floor: Vec<Vector> = case.places.iter().map(|place| place.position).collect();
                Prepared::Map(Map::over(walls, &floor, spacing, stored, h))
            }
        }
    }
}

/// A method at one place, ready to be asked.
#[derive(Debug, Clone)]
pub enum Prepared<'a> {
    /// Nothing but the polygons.
    Polygons {
        /// Which method.
        method: WallMethod,
        /// The polygons.
        walls: &'a Walls,
        /// Room for the walls in reach.
        near: Vec<u32>,
    },
    /// Particles in the obstacles.
    Particles(Particles),
    /// A map of the floor.
    Map(Map),
}

impl Prepared<'_> {
    /// The walls as an agent at `r_i` sees them, the search for what is in reach included.
    pub fn integrals(&mut self, r_i: Vector) -> Integrals {
        match self {
            Self::Polygons {
                method,
                walls,
                near,
            } => {
                near.clear();
                walls.near(r_i, SUPPORT_RADIUS, near);
                let mut sum = Integrals::none();
                method.shares(walls, near, r_i, SUPPORT_RADIUS, |share| {
                    sum.area += share.hidden_area;
                    sum.kernel += share.kernel;
                    sum.gradient += share.gradient;
                });
                sum
            }
            Self::Particles(particles) => particles.integrals(r_i),
            Self::Map(map) => map.integrals(r_i),
        }
    }

    /// Memory beside the polygons, which a crowd needs anyway.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Polygons { .. } => 0,
            Self::Particles(particles) => particles.bytes(),
            Self::Map(map) => map.bytes(),
        }
    }
}
