//! The compared methods of including walls.

use super::integrals::{Integrals, Region};
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::math::Vector;

use super::{Case, Map, Particles, SUPPORT_RADIUS, Stored, Volumes};

/// A method of including walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// One of the engine's methods, on the polygons themselves.
    Polygons(WallMethod),
    /// Boundary particles, and the distance between neighboring ones, meters.
    Particles(Volumes, f64),
    /// A map on a grid, and the distance between nodes, meters.
    Map(Stored, f64),
}

/// The compared methods.
///
/// A particle spacing of a quarter of h is usual for fluids; a tenth is finer than agents' bodies.
pub const METHODS: [Method; 11] = [
    Method::Polygons(WallMethod::Representative),
    Method::Polygons(WallMethod::Exact),
    Method::Polygons(WallMethod::Union),
    Method::Particles(Volumes::Whole, 0.1),
    Method::Particles(Volumes::Whole, 0.25),
    Method::Particles(Volumes::Cut, 0.1),
    Method::Particles(Volumes::Cut, 0.25),
    Method::Particles(Volumes::Akinci, 0.1),
    Method::Particles(Volumes::Akinci, 0.25),
    Method::Map(Stored::Integrals, 0.1),
    Method::Map(Stored::Volume, 0.1),
];

impl Method {
    /// A readable name.
    pub fn name(&self) -> String {
        let (kind, spacing) = match self {
            Self::Polygons(WallMethod::Representative) => return "representative point".to_owned(),
            Self::Polygons(WallMethod::Exact) => return "exact".to_owned(),
            Self::Polygons(WallMethod::Union) => return "union".to_owned(),
            Self::Particles(Volumes::Whole, spacing) => ("particles", spacing),
            Self::Particles(Volumes::Cut, spacing) => ("particles (cut cells)", spacing),
            Self::Particles(Volumes::Akinci, spacing) => ("particles (Akinci)", spacing),
            Self::Map(Stored::Integrals, spacing) => ("map of integrals", spacing),
            Self::Map(Stored::Volume, spacing) => ("volume map (Bender)", spacing),
        };
        format!("{kind}, {spacing} m")
    }

    /// The region that the method is meant to integrate over.
    pub fn region(&self) -> Region {
        match self {
            // Akinci's volumes represent a solid body behind the wall, even if the wall is thin.
            Self::Polygons(_) | Self::Particles(Volumes::Akinci, _) => Region::Hidden,
            Self::Particles(..) | Self::Map(..) => Region::Solid,
        }
    }

    /// Does all the work before the first frame.
    pub fn prepare(self, case: &Case) -> Prepared<'_> {
        let (walls, h) = (&case.walls, SUPPORT_RADIUS);
        match self {
            Self::Polygons(method) => {
                let mut near = Vec::new();
                let integrals = move |r_i| {
                    near.clear();
                    walls.near(r_i, h, &mut near);
                    let mut sum = Integrals::none();
                    method.shares(walls, &near, r_i, h, |share| sum = sum + (&share).into());
                    sum
                };
                (Box::new(integrals), 0)
            }
            Self::Particles(volumes, spacing) => {
                let particles = Particles::fill(walls, spacing, volumes, h);
                let bytes = particles.bytes();
                (Box::new(move |r_i| particles.integrals(r_i)), bytes)
            }
            Self::Map(stored, spacing) => {
                let floor: Vec<Vector> = case.places.iter().map(|place| place.position).collect();
                let map = Map::over(walls, &floor, spacing, stored, h);
                let bytes = map.bytes();
                (Box::new(move |r_i| map.integrals(r_i)), bytes)
            }
        }
    }
}

/// A method prepared for one case: a function from r_i to the integrals over the walls, which includes the search for
/// walls within reach; and the memory that it needs in addition to the polygons, bytes.
pub type Prepared<'a> = (Box<dyn FnMut(Vector) -> Integrals + 'a>, usize);
