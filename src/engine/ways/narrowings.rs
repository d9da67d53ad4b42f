//! Narrowings: places where the floor is narrower than before and behind, such as doors and gaps.

use super::mesh::Mesh;
use super::narrow::{End, narrow};
use crate::engine::math::Vector;

/// The narrow places of a floor.
#[derive(Debug, Clone, Default)]
pub struct Narrowings(Vec<[Vector; 2]>);

/// A narrowing that an agent walks to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Narrowing {
    /// How far it is, meters.
    pub distance: f64,
    /// How wide it is, meters.
    pub width: f64,
}

impl Narrowings {
    /// The passages of a floor up to `widest` meters wide: the diameters of circles between two walls into which no wall
    /// reaches.
    pub fn of(mesh: &Mesh, widest: f64) -> Self {
        let ends = |passage: super::narrow::Narrow| {
            let to = match passage.to {
                End::Corner(corner) => mesh.point(corner),
                End::Wall { at, .. } => at,
            };
            [mesh.point(passage.from), to]
        };
        Self(narrow(mesh, widest).into_iter().map(ends).collect())
    }

    /// The first narrowing on the straight way from `p` in this direction, of length 1, at most `far` meters away.
    pub fn next(&self, p: Vector, heading: Vector, far: f64) -> Option<Narrowing> {
        let crossed = self.0.iter().filter_map(|[a, b]| {
            let along = b - a;
            let across = heading.perp(&along);
            let from = a - p;
            let distance = from.perp(&along) / across;
            let share = from.perp(&heading) / across;
            let is_crossed = (0.0..=far).contains(&distance) && (0.0..=1.0).contains(&share);
            is_crossed.then(|| Narrowing {
                distance,
                width: along.norm(),
            })
        });
        crossed.min_by(|one, other| one.distance.total_cmp(&other.distance))
    }
}
