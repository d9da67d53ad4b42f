//! Passages that are too narrow for routes.
//!
//! A passage connects a corner with the nearest point of another wall, or with another corner, if no wall reaches into
//! the circle whose diameter it is. A disc with this diameter is the widest that passes there. Two passages never
//! cross: an end of one would lie in the circle of the other. The widths of triangles (Demyen and Buro 2006) do not
//! find all passages (Kallmann 2014).

use super::lines::{nearest_on, to_segment};
use super::mesh::Mesh;
use crate::math::Vector;

/// A passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Narrow {
    /// The number of the point at which it begins.
    pub from: u32,
    /// Where it ends.
    pub to: End,
}

impl Narrow {
    /// The ends of the passage, which is one of this triangulation, meters.
    pub fn ends(&self, mesh: &Mesh) -> [Vector; 2] {
        let to = match self.to {
            End::Corner(corner) => mesh.point(corner),
            End::Wall { at, .. } => at,
        };
        [mesh.point(self.from), to]
    }
}

/// The end of a passage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// At the point with this number.
    Corner(u32),
    /// Between the ends of a wall.
    Wall {
        /// The numbers of the wall's ends.
        ends: [u32; 2],
        /// The end of the passage, meters. If it equals the beginning, the corner touches the wall.
        at: Vector,
    },
}

/// Passages are closed if they are narrower than the least width by more than this, meters: rounding must not close a
/// door of exactly that width.
const EXACT: f64 = 1e-6;
/// A corner this near to a wall touches it, meters.
const TOUCHING: f64 = 1e-6;
/// An upper bound of rounding errors, meters.
const TINY: f64 = 1e-9;
/// The cosine of a right angle to within rounding.
const RIGHT: f64 = 1e-6;

/// The passages narrower than `least` meters.
pub fn narrow(mesh: &Mesh, least: f64) -> Vec<Narrow> {
    let least = least - EXACT;
    let mut found = Vec::new();
    if least <= 0.0 {
        return found;
    }
    let mut fans: Vec<Vec<(u32, usize)>> = vec![Vec::new(); mesh.points().len()];
    for t in 0..mesh.triangles().len() as u32 {
        for (k, &point) in mesh.triangle(t).corners.iter().enumerate() {
            fans[point as usize].push((t, k));
        }
    }
    // For each triangle, the last corner whose surroundings contained it.
    let mut last = vec![u32::MAX; mesh.triangles().len()];
    for (point, fan) in fans.iter().enumerate() {
        let here = Surroundings::new(mesh, (point as u32, fan), least, &mut last);
        here.passages(least, &mut found);
    }
    found
}

/// The walls around a corner.
struct Surroundings<'a> {
    mesh: &'a Mesh,
    corner: u32,
    place: Vector,
    /// The triangles at the corner, each with the number of the corner in it.
    fan: &'a [(u32, usize)],
    walls: Vec<[u32; 2]>,
}

impl<'a> Surroundings<'a> {
    /// The walls nearer than `least` meters to a corner with this fan. `last` has, for each triangle, the last corner
    /// whose surroundings contained it.
    fn new(
        mesh: &'a Mesh,
        (corner, fan): (u32, &'a [(u32, usize)]),
        least: f64,
        last: &mut [u32],
    ) -> Self {
        let place = mesh.point(corner);
        let mut is_new = |t: u32| std::mem::replace(&mut last[t as usize], corner) != corner;
        let mut waiting: Vec<u32> = fan.iter().map(|&(t, _)| t).filter(|&t| is_new(t)).collect();
        let mut walls = Vec::new();
        while let Some(t) = waiting.pop() {
            let triangle = mesh.triangle(t);
            for side in 0..3 {
                let ends = [side, (side + 1) % 3].map(|k| triangle.corners[k]);
                let [a, b] = ends.map(|end| mesh.point(end));
                if to_segment(place, a, b) >= least {
                    continue;
                }
                match triangle.across[side] {
                    None => walls.push(ends),
                    Some(other) if is_new(other) => waiting.push(other),
                    Some(_) => (),
                }
            }
        }
        Self {
            mesh,
            corner,
            place,
            fan,
            walls,
        }
    }

    /// Adds the passages that begin here; those between two corners begin at the one with the smaller number.
    fn passages(&self, least: f64, found: &mut Vec<Narrow>) {
        let from = self.corner;
        for &ends in self.walls.iter().filter(|ends| !ends.contains(&from)) {
            let [a, b] = ends.map(|end| self.mesh.point(end));
            let at = nearest_on(self.place, a, b);
            let is_inside = (at - a).norm() > TINY && (at - b).norm() > TINY;
            let touches = (at - self.place).norm() <= TOUCHING;
            if is_inside && (touches || self.is_passage(at, least, |wall| *wall == ends)) {
                let at = if touches { self.place } else { at };
                let to = End::Wall { ends, at };
                found.push(Narrow { from, to });
            }
            // Each corner is the beginning of one wall.
            let other = ends[0];
            if other > from && self.is_passage(a, least, |wall| wall.contains(&other)) {
                let to = End::Corner(other);
                found.push(Narrow { from, to });
            }
        }
    }

    /// Whether the straight line to `at` is a passage narrower than `least` meters. `ends_at` is true for the walls
    /// that contain `at`.
    fn is_passage(&self, at: Vector, least: f64, ends_at: impl Fn(&[u32; 2]) -> bool) -> bool {
        let way = at - self.place;
        let length = way.norm();
        if length >= least {
            return false;
        }
        let is_beside = |wall: &[u32; 2], from: Vector, way: Vector| {
            let mut ends = wall.iter().map(|&end| self.mesh.point(end) - from);
            ends.all(|along| along.dot(&way) <= RIGHT * along.norm() * length)
        };
        let is_here = |wall: &&[u32; 2]| wall.contains(&self.corner);
        let mut here = self.walls.iter().filter(is_here);
        if !here.all(|wall| is_beside(wall, self.place, way)) || !self.is_free(way) {
            return false;
        }
        let (middle, radius) = (self.place + 0.5 * way, 0.5 * length + TINY);
        let mut others = self.walls.iter().filter(|wall| !is_here(wall));
        others.all(|wall| match ends_at(wall) {
            true => is_beside(wall, at, -way),
            false => {
                let [a, b] = wall.map(|end| self.mesh.point(end));
                to_segment(middle, a, b) > radius
            }
        })
    }

    /// Whether there is floor in this direction from the corner.
    fn is_free(&self, way: Vector) -> bool {
        self.fan.iter().any(|&(t, k)| {
            let corners = self.mesh.corners(t);
            let [a, b] = [1, 2].map(|n| corners[(k + n) % 3] - self.place);
            a.perp(&way) >= 0.0 && way.perp(&b) >= 0.0
        })
    }
}
