//! The floor as triangles. The only file that names spade.

use std::collections::{BTreeSet, HashMap};

use spade::handles::FixedFaceHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::WayError;
use super::expansion::Border;
use crate::engine::geometry::Area;
use crate::engine::math::{Vector, bounds};

/// A triangle of the floor.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangle {
    /// Its corners as numbers of points, counterclockwise.
    pub corners: [u32; 3],
    /// What lies beyond the side from corner k to corner k + 1: a triangle, or a wall.
    pub across: [Option<u32>; 3],
    /// The width of the way around corner k, from one of its sides to the other, meters (Demyen and Buro 2006).
    pub width: [f64; 3],
}

/// A constrained Delaunay triangulation of the areas that people walk in.
#[derive(Debug, Clone)]
pub struct Mesh {
    points: Vec<Vector>,
    triangles: Vec<Triangle>,
}

impl Mesh {
    /// Triangulates areas that touch at points at most.
    ///
    /// # Errors
    /// Edges that still cross where they were split, or coordinates that the triangulation cannot represent.
    pub fn new(areas: &[Area]) -> Result<Self, WayError> {
        let (mut points, mut walls) = edges_of(areas);
        for _ in 0..MOST_SPLITS {
            let mut crossing = Vec::new();
            let vertices = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
            let triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
                vertices,
                walls.clone(),
                |wall| crossing.push(wall),
            )
            .map_err(|error| WayError::Coordinates(error.to_string()))?;
            if crossing.is_empty() {
                let triangles = floor(&triangulation);
                let mut mesh = Self { points, triangles };
                mesh.measure();
                return Ok(mesh);
            }
            split(&mut points, &mut walls, &crossing);
        }
        Err(WayError::Crossing(points[points.len() - 1]))
    }

    /// Point `k`, meters.
    pub fn point(&self, k: u32) -> Vector {
        self.points[k as usize]
    }

    /// All points, meters.
    pub fn points(&self) -> &[Vector] {
        &self.points
    }

    /// Corner k of triangle `t`, as a border of what is seen.
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
        let across = &self.triangle(other).across;
        across.iter().position(|&side| side == Some(t)).unwrap_or(0)
    }

    /// Does triangle `t` contain `p`, borders included?
    pub fn contains(&self, t: u32, p: Vector) -> bool {
        let corners = self.corners(t);
        (0..3).all(|k| side(corners[k], corners[(k + 1) % 3], p) >= 0.0)
    }

    /// A distance, at most `most` meters, within which `p` stays in triangle `t`, in a neighbor of it, or between it and
    /// `place`.
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

    /// Computes the widths of all triangles.
    fn measure(&mut self) {
        for t in 0..self.triangles.len() as u32 {
            let widths = [0, 1, 2].map(|k| {
                let (c, ends) = (
                    self.corners(t)[k],
                    [1, 2].map(|n| self.corners(t)[(k + n) % 3]),
                );
                let sides = ends.map(|end| (end - c).norm());
                self.room(t, k, sides[0].min(sides[1]))
            });
            self.triangles[t as usize].width = widths;
        }
    }

    /// The distance from corner k of triangle `t` to the nearest wall on the other side of the opposite side, at most
    /// `most`, which is at most the distance to the ends of that side. A wall counts if its nearest point is not an
    /// end: in a Delaunay triangulation no end is nearer than those of the triangle's sides (Demyen and Buro 2006).
    pub fn room(&self, t: u32, k: usize, most: f64) -> f64 {
        self.nearest_wall(t, k, most)
            .map_or(most, |(distance, _)| distance)
    }

    /// The distance of [`room`](Self::room) and the nearest point of the wall; `None` if no wall is nearer than `most`.
    pub(super) fn nearest_wall(&self, t: u32, k: usize, most: f64) -> Option<(f64, Vector)> {
        let c = self.corners(t)[k];
        let mut found: Option<(f64, Vector)> = None;
        let mut beyond = vec![(t, (k + 1) % 3)];
        while let Some((t, side)) = beyond.pop() {
            let corners = self.corners(t);
            let (a, b) = (corners[side], corners[(side + 1) % 3]);
            let is_between = (c - a).dot(&(b - a)) > 0.0 && (c - b).dot(&(a - b)) > 0.0;
            let nearest = nearest_on(c, a, b);
            let distance = (nearest - c).norm();
            if !is_between || distance >= found.map_or(most, |(least, _)| least) {
                continue;
            }
            match self.triangle(t).across[side] {
                None => found = Some((distance, nearest)),
                Some(next) => {
                    let back = self.side_along(next, t);
                    beyond.extend([1, 2].map(|n| (next, (back + n) % 3)));
                }
            }
        }
        found
    }

    /// The narrowest places in triangle `t` that are narrower than `least` meters: their ends on both walls.
    pub fn gaps(&self, t: u32, least: f64) -> impl Iterator<Item = [Vector; 2]> {
        let (corners, across) = (self.corners(t), self.triangle(t).across);
        let beyond = (0..3).filter_map(move |k| {
            let (distance, wall) = self.nearest_wall(t, k, least)?;
            (distance < least).then_some([corners[k], wall])
        });
        let ends = move |side: usize| [corners[side], corners[(side + 1) % 3]];
        let portals = (0..3).filter(move |&side| across[side].is_some()).map(ends);
        beyond.chain(portals.filter(move |[a, b]| (b - a).norm() < least))
    }
}

/// Above 0 if `p` lies on the left of the line from `a` to `b`, exactly opposite for the line from `b` to `a`.
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

/// The distinct corners of the areas, and their edges.
fn edges_of(areas: &[Area]) -> (Vec<Vector>, Vec<[usize; 2]>) {
    let (mut points, mut edges) = (Vec::new(), Vec::new());
    let mut numbers = HashMap::new();
    for ring in areas.iter().flat_map(Area::rings) {
        let mut number = |p: &Vector| {
            // + 0.0 turns −0 into 0.
            let key = [p.x, p.y].map(|x| (x + 0.0).to_bits());
            *numbers.entry(key).or_insert_with(|| {
                points.push(*p);
                points.len() - 1
            })
        };
        let around: Vec<usize> = ring.points().iter().map(&mut number).collect();
        let ends = around.iter().cycle().skip(1);
        edges.extend(around.iter().zip(ends).map(|(&a, &b)| [a, b]));
    }
    (points, edges)
}

/// Walls are split where they cross at most this often: rounding can make the parts cross again.
const MOST_SPLITS: usize = 4;

/// An end of a wall this near to another wall is on it, meters, or as a part of the extent: corners of floor plans are
/// moved by up to a micrometer to given corners.
const TOUCHING: f64 = 4e-6;
const TOUCHING_PART: f64 = 4e-8;

/// Splits walls where those in `crossing` cross others: at an end that lies on the other wall, else where they cross.
fn split(points: &mut Vec<Vector>, walls: &mut Vec<[usize; 2]>, crossing: &[[usize; 2]]) {
    let [low, high] = bounds(points.iter().copied()).unwrap_or_default();
    let touching = TOUCHING.max((high - low).max() * TOUCHING_PART);
    let mut cuts: Vec<Vec<usize>> = vec![Vec::new(); walls.len()];
    for (k, one) in walls
        .iter()
        .enumerate()
        .filter(|(_, wall)| crossing.contains(wall))
    {
        let [a, b] = one.map(|end| points[end]);
        for (other, ends) in walls.iter().enumerate() {
            let [c, d] = ends.map(|end| points[end]);
            let (from, to) = (side(a, b, c), side(a, b, d));
            let crosses = from * to < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
            if !crosses {
                continue;
            }
            let on = |ends: &[usize; 2], [a, b]: [Vector; 2]| {
                let near = |end: &&usize| to_segment(points[**end], a, b) <= touching;
                ends.iter().filter(near).copied().collect::<Vec<usize>>()
            };
            let (on_one, on_other) = (on(ends, [a, b]), on(one, [c, d]));
            if on_one.is_empty() && on_other.is_empty() {
                points.push(c + (d - c) * (from / (from - to)));
                cuts[k].push(points.len() - 1);
                cuts[other].push(points.len() - 1);
            }
            cuts[k].extend(on_one);
            cuts[other].extend(on_other);
        }
    }
    let parts = walls.iter().zip(cuts).flat_map(|(&[from, to], mut cuts)| {
        let distance = |&point: &usize| (points[point] - points[from]).norm_squared();
        cuts.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
        cuts.insert(0, from);
        cuts.push(to);
        let parts = cuts
            .windows(2)
            .map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]);
        parts.collect::<Vec<[usize; 2]>>()
    });
    // Two walls at the same place enclose nothing.
    let mut odd = BTreeSet::new();
    for part in parts.filter(|[from, to]| from != to) {
        if !odd.remove(&part) {
            odd.insert(part);
        }
    }
    *walls = odd.into_iter().collect();
}

/// The triangles inside: those behind an odd number of walls from outside.
fn floor(triangulation: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<Triangle> {
    const OUTSIDE: u32 = u32::MAX;
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
                stack.push((next, is_inside != edge.is_constraint_edge()));
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
        Triangle {
            corners: edges.map(|edge| edge.from().fix().index() as u32),
            across: edges.map(|edge| {
                let next = number[edge.rev().face().fix().index()];
                (next != OUTSIDE && !edge.is_constraint_edge()).then_some(next)
            }),
            width: [0.0; 3],
        }
    };
    faces().map(triangle).collect()
}

/// The distance of `p` from a line, meters, at most `most`; negative on its right.
fn from_line([a, b]: [Vector; 2], p: Vector, most: f64) -> f64 {
    part(side(a, b, p), b - a, most)
}

/// `product` divided by the length of a vector, at most `most`, which most quotients exceed.
#[inline]
pub fn part(product: f64, vector: Vector, most: f64) -> f64 {
    // No root and no division for them.
    if product > 0.0 && product * product >= most * most * vector.norm_squared() {
        most
    } else {
        product / vector.norm()
    }
}
