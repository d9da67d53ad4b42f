//! The floor as triangles. The only file that names spade.

use std::collections::BTreeSet;

use spade::handles::FixedFaceHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::WayError;
use super::edges::Edges;
use super::expansion::Border;
use super::narrow::{Narrow, narrow};
use crate::geometry::Area;
use crate::math::Vector;

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
    points: Vec<Vector>,
    triangles: Vec<Triangle>,
}

impl Mesh {
    /// Triangulates areas that share at most points. Passages narrower than `least_width` meters are closed: each is a
    /// side of triangles that ways do not cross.
    ///
    /// # Errors
    /// Edges still cross after they were split, or the triangulation cannot represent a coordinate.
    pub fn new(areas: &[Area], least_width: f64) -> Result<Self, WayError> {
        let mut edges = Edges::of(areas);
        let open = Self::of(&mut edges)?;
        let closed = narrow(&open, least_width);
        if closed.is_empty() {
            return Ok(open);
        }
        edges.close(&closed);
        Self::of(&mut edges)
    }

    /// Triangulates areas that share at most points. `passages` of their triangulation without closed passages, and
    /// `lines`, are sides of triangles that ways do not cross.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn divided(
        areas: &[Area],
        passages: &[Narrow],
        lines: &[[Vector; 2]],
    ) -> Result<Self, WayError> {
        let mut edges = Edges::of(areas);
        edges.close(passages);
        edges.draw(lines);
        Self::of(&mut edges)
    }

    /// Triangulates the floor between `edges`, and splits edges that cross.
    fn of(edges: &mut Edges) -> Result<Self, WayError> {
        for _ in 0..MOST_SPLITS {
            let mut crossing = Vec::new();
            let vertices = edges.points.iter().map(|p| Point2::new(p.x, p.y)).collect();
            let triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
                vertices,
                edges.all(),
                |edge| crossing.push(edge),
            )
            .map_err(|error| WayError::Coordinates(error.to_string()))?;
            if crossing.is_empty() {
                return Ok(Self {
                    points: edges.points.clone(),
                    triangles: floor(&triangulation, &edges.closed),
                });
            }
            edges.split(&crossing);
        }
        Err(WayError::Crossing(edges.points[edges.points.len() - 1]))
    }

    /// Point `k`, meters.
    pub fn point(&self, k: u32) -> Vector {
        self.points[k as usize]
    }

    /// All points, meters.
    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    /// Corner k of triangle `t`, as an edge of a visible cone.
    pub fn border(&self, t: u32, k: usize) -> Border {
        let number = self.triangle(t).corners[k];
        Border {
            at: self.point(number),
            number,
        }
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

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.points.capacity() * size_of::<Vector>()
            + self.triangles.capacity() * size_of::<Triangle>()
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

/// Positive if `p` lies on the left of the line from `a` to `b`. Swapping `a` and `b` negates it exactly.
pub fn side(a: Vector, b: Vector, p: Vector) -> f64 {
    if (a.x, a.y) <= (b.x, b.y) {
        (b - a).perp(&(p - a))
    } else {
        -(a - b).perp(&(p - b))
    }
}

/// The distance from `p` to a segment, meters.
pub fn to_segment(p: Vector, a: Vector, b: Vector) -> f64 {
    (nearest_on(p, a, b) - p).norm()
}

/// The point of a segment nearest to `p`.
pub fn nearest_on(p: Vector, a: Vector, b: Vector) -> Vector {
    let along = b - a;
    let squared = along.norm_squared();
    if squared == 0.0 {
        return a;
    }
    a + along * ((p - a).dot(&along) / squared).clamp(0.0, 1.0)
}

/// Crossing edges are split at most this many times: rounding can make the parts cross again.
const MOST_SPLITS: usize = 4;

/// The triangles of the floor: those with an odd number of walls between them and the outside. `closed` lists the edges
/// that are not walls.
fn floor(
    triangulation: &ConstrainedDelaunayTriangulation<Point2<f64>>,
    closed: &BTreeSet<[usize; 2]>,
) -> Vec<Triangle> {
    const OUTSIDE: u32 = u32::MAX;
    let is_closed = |ends: [usize; 2]| closed.contains(&Edges::sorted(ends));
    let mut inside: Vec<Option<bool>> = vec![None; triangulation.num_all_faces()];
    let outer = triangulation.outer_face().fix();
    inside[outer.index()] = Some(false);
    let mut stack: Vec<(FixedFaceHandle<_>, bool)> = Vec::new();
    for edge in triangulation.convex_hull() {
        let is_wall = edge.is_constraint_edge();
        let face = [edge.face().fix(), edge.rev().face().fix()];
        let inner = face.into_iter().find(|face| *face != outer);
        stack.extend(inner.map(|face| (face, is_wall)));
    }
    while let Some((face, is_inside)) = stack.pop() {
        if inside[face.index()].replace(is_inside).is_some() {
            continue;
        }
        let Some(face) = triangulation.face(face).as_inner() else {
            continue;
        };
        for edge in face.adjacent_edges() {
            let next = edge.rev().face().fix();
            if inside[next.index()].is_none() {
                let ends = [edge.from(), edge.to()].map(|end| end.fix().index());
                let is_wall = edge.is_constraint_edge() && !is_closed(ends);
                stack.push((next, is_inside != is_wall));
            }
        }
    }
    let mut number = vec![OUTSIDE; triangulation.num_all_faces()];
    let faces = || {
        let faces = triangulation.inner_faces();
        faces.filter(|face| inside[face.fix().index()] == Some(true))
    };
    for (k, face) in faces().enumerate() {
        number[face.fix().index()] = k as u32;
    }
    let triangle = |face: spade::handles::FaceHandle<'_, _, _, _, _, _>| {
        let edges = face.adjacent_edges();
        let beyond = |is_beyond: &dyn Fn([usize; 2], bool) -> bool| {
            edges.map(|edge| {
                let ends = [edge.from(), edge.to()].map(|end| end.fix().index());
                let next = number[edge.rev().face().fix().index()];
                (next != OUTSIDE && is_beyond(ends, edge.is_constraint_edge())).then_some(next)
            })
        };
        Triangle {
            corners: edges.map(|edge| edge.from().fix().index() as u32),
            across: beyond(&|_, is_edge| !is_edge),
            closed: beyond(&|ends, is_edge| is_edge && is_closed(ends)),
        }
    };
    faces().map(triangle).collect()
}

/// The distance of `p` from a line, meters, at most `most`; negative on its right.
fn from_line([a, b]: [Vector; 2], p: Vector, most: f64) -> f64 {
    part(side(a, b, p), b - a, most)
}

/// `product` divided by the length of a vector, clamped to `most`, which most quotients exceed.
#[inline]
pub fn part(product: f64, vector: Vector, most: f64) -> f64 {
    // These need neither a square root nor a division.
    if product > 0.0 && product * product >= most * most * vector.norm_squared() {
        most
    } else {
        product / vector.norm()
    }
}
