//! Corners of walls that shortest routes bend around.

use libm::atan2;
use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::expansion::Border;
use super::mesh::Mesh;
use crate::math::{Vector, bytes_of, direction, perpendicular};

/// Widens the visible cone of a corner beyond the lines of its walls, radians, so that rounding loses no position on
/// such a line. Shortest routes never need it.
const MARGIN: f64 = 1e-6;
/// The distance from a corner to a point that represents a direction, meters. No wall ends at such a point: it must be
/// far from agents that turn around the corner.
const FAR: f64 = 1000.0;

/// How a way bends at a corner, seen from the way's end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Turn {
    /// The corner's walls are on the right of the direction from the corner to the way's end.
    First,
    /// The corner's walls are on the left of this direction.
    Last,
}

impl Turn {
    /// Both, in order.
    pub const BOTH: [Self; 2] = [Self::First, Self::Last];

    /// The opposite turn: seen from its two ends, a way around a corner has opposite turns.
    pub fn other(self) -> Self {
        match self {
            Self::First => Self::Last,
            Self::Last => Self::First,
        }
    }

    /// A point on the edge of the region from which routes with this turn bend at the corner and then continue against
    /// `along`. It lies in the direction of `along` from the corner, rotated a little so that rounding loses no
    /// position on the edge.
    #[inline]
    pub fn beyond(self, corner: Vector, along: Vector) -> Vector {
        let margin = match self {
            Self::First => MARGIN,
            Self::Last => -MARGIN,
        };
        corner + along + perpendicular(along) * margin
    }
}

/// A corner with the turn of the routes that come to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bend {
    /// The number of the corner.
    pub corner: u32,
    /// How routes that come to it bend there.
    pub turn: Turn,
}

impl Bend {
    /// The number of this bend; bends are numbered corner by corner, in the order of [`Turn::BOTH`].
    pub fn index(self) -> usize {
        2 * self.corner as usize + usize::from(self.turn == Turn::Last)
    }

    /// The bend with this number.
    pub fn of_index(index: usize) -> Self {
        Self {
            corner: (index / 2) as u32,
            turn: Turn::BOTH[index % 2],
        }
    }
}

/// A corner with at least 180° of floor around it. The triangles around it are its fan, counterclockwise from one wall
/// to the other. Here, closed passages are walls.
#[derive(Debug, Clone, PartialEq)]
pub struct Corner {
    /// Its place, meters.
    pub place: Vector,
    /// The triangles of the fan, each with the number of this corner in it.
    pub fan: Vec<(u32, usize)>,
    /// The angles of the fan's sides from the first wall, radians: one more than triangles.
    angles: Vec<f64>,
    /// For each turn, a point on the extension of the corner's other wall, where the visible cone ends, meters.
    pub rays: [Vector; 2],
    /// Half of the width of the narrowest way around it, meters.
    pub room: f64,
}

impl Corner {
    /// All corners of the mesh; routes narrower than `least_width` meters are closed.
    pub fn all(mesh: &Mesh, least_width: f64) -> Vec<Self> {
        let triangles = 0..mesh.triangles().len() as u32;
        let places = triangles.flat_map(|t| [0, 1, 2].map(|k| (t, k)));
        let starts = places.filter(|&(t, k)| mesh.triangle(t).across[k].is_none());
        let corners = starts.filter_map(|(t, k)| Self::new(mesh, (t, k), least_width));
        corners.collect()
    }

    fn new(mesh: &Mesh, start: (u32, usize), least_width: f64) -> Option<Self> {
        let (mut fan, mut angles) = (Vec::new(), vec![0.0]);
        let mut next = Some(start);
        let mut total = 0.0;
        while let Some((t, k)) = next {
            let corners = mesh.corners(t);
            let [a, b] = [1, 2].map(|n| corners[(k + n) % 3] - corners[k]);
            total += atan2(a.perp(&b), a.dot(&b));
            fan.push((t, k));
            angles.push(total);
            let side = (k + 2) % 3;
            let across = mesh.triangle(t).across[side];
            next = across.map(|other| (other, mesh.side_along(other, t)));
        }
        if total <= PI - MARGIN {
            return None;
        }
        let rooms = fan.iter().map(|&(t, k)| {
            let (triangle, corners) = (mesh.triangle(t), mesh.corners(t));
            let sides = [(k, k + 1), (k + 2, k + 2)].map(|(side, end)| {
                let portal = triangle.across[side % 3].is_some();
                let length = (corners[end % 3] - corners[k]).norm();
                if portal { length } else { f64::INFINITY }
            });
            mesh.room(t, k, sides[0].min(sides[1]))
        });
        // Narrower places are dents in the walls, not routes.
        let passable = rooms.filter(|&room| room >= least_width);
        let room = 0.5 * passable.fold(f64::INFINITY, f64::min);
        let place = mesh.corners(start.0)[start.1];
        let mut corner = Self {
            place,
            fan,
            angles,
            rays: [place; 2],
            room,
        };
        let ends = [corner.fan.len(), 0].map(|i| corner.end(mesh, i).at);
        let ray = |k: usize| Turn::BOTH[k].beyond(place, direction(place - ends[k]) * FAR);
        corner.rays = [ray(0), ray(1)];
        Some(corner)
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + bytes_of(&self.fan) + bytes_of(&self.angles)
    }

    /// The end of side `i` of the fan.
    fn end(&self, mesh: &Mesh, i: usize) -> Border {
        let last = self.fan.len() - 1;
        let (t, k) = self.fan[i.min(last)];
        mesh.border(t, (k + if i > last { 2 } else { 1 }) % 3)
    }

    /// The range of the angles at which the ends of routes with this `turn` lie, radians.
    fn sector(&self, turn: Turn) -> [f64; 2] {
        let total = self.angles[self.fan.len()];
        match turn {
            Turn::First => [0.0, total - PI + MARGIN],
            Turn::Last => [PI - MARGIN, total],
        }
    }

    /// The right and left edges of the visible cone of this corner, number `bend.corner`, in triangle `i` of its fan,
    /// for routes with the turn of `bend`; `None` if the cone misses the triangle.
    pub fn view(&self, mesh: &Mesh, i: usize, bend: Bend) -> Option<[Border; 2]> {
        let turn = bend.turn;
        let [low, high] = self.sector(turn);
        let (from, to) = (self.angles[i], self.angles[i + 1]);
        if from.max(low) >= to.min(high) {
            return None;
        }
        let ray = || Border {
            at: self.rays[usize::from(turn == Turn::Last)],
            number: (mesh.points().len() + bend.index()) as u32,
        };
        let right = match from >= low {
            true => self.end(mesh, i),
            false => ray(),
        };
        let left = match to <= high {
            true => self.end(mesh, i + 1),
            false => ray(),
        };
        Some([right, left])
    }

    /// The turn of a way that ends in the direction of `p`, which lies in triangle `i` of the fan or beyond its
    /// opposite side. `None` if the shortest way does not bend here.
    pub fn turn(&self, mesh: &Mesh, i: usize, p: Vector) -> Option<Turn> {
        let (side, ray) = (self.end(mesh, i).at - self.place, p - self.place);
        let angle = self.angles[i] + atan2(side.perp(&ray), side.dot(&ray));
        Turn::BOTH.into_iter().find(|&turn| {
            let [low, high] = self.sector(turn);
            (low - MARGIN..=high + MARGIN).contains(&angle)
        })
    }
}
