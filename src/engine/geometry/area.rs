//! Areas with holes.

use super::ring::Ring;
use crate::math::Vector;

/// A part of the plane, inside its outline and outside its holes. The holes lie in the outline and may touch it
/// and each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    /// The outline.
    pub exterior: Ring,
    /// The holes cut out of it.
    pub holes: Vec<Ring>,
}

impl Area {
    /// The outline, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> {
        std::iter::once(&self.exterior).chain(&self.holes)
    }

    /// The area in m², without the holes.
    pub fn area(&self) -> f64 {
        self.exterior.area() - self.holes.iter().map(Ring::area).sum::<f64>()
    }

    /// Whether `p` lies in the area. Within rounding of the boundary either answer is possible.
    pub fn contains(&self, p: Vector) -> bool {
        self.exterior.contains(p) && !self.holes.iter().any(|hole| hole.contains(p))
    }
}
