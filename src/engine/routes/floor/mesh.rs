//! The floor as triangles.

use super::lines::{from_line, side, to_segment};
use crate::math::{Vector, bytes_of};

/// A triangle of the floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangle {
    /// Its corners as numbers of points, counterclockwise.
    pub corners: [u32; 3],
    /// The triangle beyond the side from corner k to corner k + 1; `None` if the side is a wall or a closed passage.
    pub across: [Option<u32>; 3],
    /// The triangle beyond the same side if the side is a closed passage.
    pub closed: [Option<u32>; 3],
}

impl Triangle {
    /// The triangle beyond side k, which may be a closed passage; `None` beyond a wall.
    pub fn beyond(&self, k: usize) -> Option<u32> {
        self.across[k].or(self.closed[k])
    }
}

/// A constrained Delaunay triangulation of the areas that people walk in.
#[derive(Debug, Clone)]
pub struct Mesh {
    pub(super) points: Vec<Vector>,
    pub(super) triangles: Vec<Triangle>,
}

impl Mesh {
    /// Point `k`, meters.
    pub fn point(&self, k: u32) -> Vector {
        self.points[k as usize]
    }

    /// All points, meters.
    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    /// The triangles.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Triangle `t`.
    pub fn triangle(&self, t: u32) -> &Triangle {
        &self.triangles[t as usize]
    }

    /// The corners of triangle `t`, meters.
    pub fn corners(&self, t: u32) -> [Vector; 3] {
        self.triangle(t).corners.map(|k| self.point(k))
    }

    /// The middle of triangle `t`, meters.
    pub fn middle(&self, t: u32) -> Vector {
        let [a, b, c] = self.corners(t);
        (a + b + c) / 3.0
    }

    /// The middle of the side between the triangles `t` and `next`, meters.
    pub fn opening(&self, t: u32, next: u32) -> Vector {
        let corners = self.corners(t);
        let side = self.side_along(t, next);
        (corners[side] + corners[(side + 1) % 3]) * 0.5
    }

    /// The closed sides: the ends of each, meters, and the triangles beside it.
    pub fn closed_sides(&self) -> impl Iterator<Item = ([Vector; 2], [u32; 2])> {
        (0..).zip(&self.triangles).flat_map(|(t, triangle)| {
            let corners = self.corners(t);
            let beyond = triangle.closed.into_iter().enumerate();
            beyond.filter_map(move |(k, other)| {
                let other = other.filter(|&other| other > t)?;
                Some(([corners[k], corners[(k + 1) % 3]], [t, other]))
            })
        })
    }

    /// The parts that are connected without closed sides: the number of each triangle's part.
    pub fn parts(&self) -> Vec<u32> {
        const NONE: u32 = u32::MAX;
        let mut part = vec![NONE; self.triangles.len()];
        let mut count = 0;
        for start in 0..part.len() as u32 {
            if part[start as usize] != NONE {
                continue;
            }
            let mut waiting = vec![start];
            while let Some(t) = waiting.pop() {
                if part[t as usize] == NONE {
                    part[t as usize] = count;
                    waiting.extend(self.triangle(t).across.iter().flatten());
                }
            }
            count += 1;
        }
        part
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        bytes_of(&self.points) + bytes_of(&self.triangles)
    }

    /// The side of triangle `other` that lies along triangle `t`.
    pub fn side_along(&self, other: u32, t: u32) -> usize {
        let other = self.triangle(other);
        let is_along = |&side: &usize| other.beyond(side) == Some(t);
        (0..3).find(is_along).unwrap_or(0)
    }

    /// Whether triangle `t` contains `p`, borders included.
    pub fn contains(&self, t: u32, p: Vector) -> bool {
        let corners = self.corners(t);
        (0..3).all(|k| side(corners[k], corners[(k + 1) % 3], p) >= 0.0)
    }

    /// A distance, at most `most` meters, by which `p` can move in any direction and still be in triangle `t`, in a
    /// neighbor of it, or between it and `place`.
    pub fn room_before(&self, t: u32, p: Vector, place: Vector, most: f64) -> f64 {
        let mut room = most;
        for (ends, next) in self.sides(t) {
            let here = from_line(ends, p, room);
            if here >= room || side(ends[0], ends[1], place) <= 0.0 {
                continue;
            }
            room = match next {
                None => here,
                Some(next) => {
                    let others = self.sides(next).filter(|&(_, across)| across != Some(t));
                    let there = others.map(|(ends, _)| from_line(ends, p, room));
                    here.max(there.fold(room, f64::min))
                }
            };
        }
        room
    }

    /// The sides of triangle `t`, and what lies beyond each.
    fn sides(&self, t: u32) -> impl Iterator<Item = ([Vector; 2], Option<u32>)> {
        let (corners, across) = (self.corners(t), self.triangle(t).across);
        (0..3).map(move |k| ([corners[k], corners[(k + 1) % 3]], across[k]))
    }

    /// The distance from `p` to triangle `t`, meters; 0 inside.
    pub fn distance(&self, t: u32, p: Vector) -> f64 {
        if self.contains(t, p) {
            return 0.0;
        }
        let corners = self.corners(t);
        let sides = (0..3).map(|k| to_segment(p, corners[k], corners[(k + 1) % 3]));
        sides.fold(f64::INFINITY, f64::min)
    }

    /// The distance from corner k of triangle `t` to the nearest wall behind the opposite side, at most `most`, which
    /// is at most the distance to the ends of that side. Walls whose nearest point is an end are skipped: in a Delaunay
    /// triangulation no end is nearer than the corners of the triangle (Demyen and Buro 2006).
    pub fn room(&self, t: u32, k: usize, most: f64) -> f64 {
        let c = self.corners(t)[k];
        let mut least = most;
        let mut beyond = vec![(t, (k + 1) % 3)];
        while let Some((t, side)) = beyond.pop() {
            let corners = self.corners(t);
            let (a, b) = (corners[side], corners[(side + 1) % 3]);
            let is_between = (c - a).dot(&(b - a)) > 0.0 && (c - b).dot(&(a - b)) > 0.0;
            let distance = to_segment(c, a, b);
            if !is_between || distance >= least {
                continue;
            }
            match self.triangle(t).across[side] {
                None => least = distance,
                Some(next) => {
                    let back = self.side_along(next, t);
                    beyond.extend([1, 2].map(|n| (next, (back + n) % 3)));
                }
            }
        }
        least
    }
}
