//! The compared methods of including walls.

use super::{Case, Integrals, Map, Particles, Region, SUPPORT_RADIUS, Stored, Volumes};
use crate::engine::boundary::WallMethod;
use crate::engine::geometry::Walls;
use crate::engine::math::Vector;

/// A method of including walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// One of the engine's methods, on the polygons themselves.
    Polygons(WallMethod),
    /// Boundary particles.
    Particles {
        /// Distance between neighboring particles, meters.
        spacing: f64,
        /// What each particle stands for.
        volumes: Volumes,
    },
    /// A map on a grid.
    Map {
        /// Distance between nodes, meters.
        spacing: f64,
        /// What each node stores.
        stored: Stored,
    },
}

const fn particles(spacing: f64, volumes: Volumes) -> Method {
    Method::Particles { spacing, volumes }
}

/// The compared methods.
///
/// A particle spacing of a quarter of h is usual for fluids; a tenth is finer than agents' bodies.
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
    /// A readable name.
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

    /// The region that the method is meant to integrate over.
    pub fn region(&self) -> Region {
        match self {
            Self::Polygons(_) => Region::Hidden,
            // Their volumes represent a solid body behind the wall, even if the wall is thin.
            Self::Particles {
                volumes: Volumes::Akinci,
                ..
            } => Region::Hidden,
            Self::Particles { .. } | Self::Map { .. } => Region::Solid,
        }
    }

    /// Does all the work before the first frame.
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

/// A method prepared for one case.
#[derive(Debug, Clone)]
pub enum Prepared<'a> {
    /// The polygons themselves.
    Polygons {
        /// The method.
        method: WallMethod,
        /// The polygons.
        walls: &'a Walls,
        /// A buffer for the walls within reach.
        near: Vec<u32>,
    },
    /// Particles in the obstacles.
    Particles(Particles),
    /// A map of the floor.
    Map(Map),
}

impl Prepared<'_> {
    /// The integrals over the walls for an agent at `r_i`, including the search for what is within reach.
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

    /// Memory in addition to the polygons, which a crowd needs anyway, bytes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Polygons { .. } => 0,
            Self::Particles(particles) => particles.bytes(),
            Self::Map(map) => map.bytes(),
        }
    }
}
