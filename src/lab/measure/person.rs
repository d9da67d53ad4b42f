//! A person in a frame.

use engine::math::Vector;

/// A person in a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    /// The person's index among all ids, from 0.
    pub number: u32,
    /// The id in the file.
    pub id: i64,
    /// Meters.
    pub position: Vector,
    /// The point from which the person sees and is seen, meters: see
    /// [`Hidden::eye`](analysis::site::Hidden::eye).
    pub eye: Vector,
    /// 1 = an average person.
    pub mass: f64,
    /// m/s; `None` if unknown.
    pub velocity: Option<Vector>,
    /// ρ_i, P/m², with the person's own weight.
    pub density: f64,
    /// ρ_i without the person's own weight, P/m².
    pub density_of_others: f64,
    /// 1 / the area of the person's Voronoi cell, P/m²; `None` deep inside an obstacle.
    pub voronoi: Option<f64>,
    /// The walls' part of `density`, P/m².
    pub density_from_walls: f64,
}
