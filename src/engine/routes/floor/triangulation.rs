//! The triangulation of the floor. The only file that names spade.

use std::collections::BTreeSet;

use spade::handles::FixedFaceHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::edges::Edges;
use super::mesh::{Mesh, Triangle};
use super::narrow::{Narrow, narrow};
use crate::geometry::Area;
use crate::math::Vector;
use crate::routes::WayError;

impl Mesh {
    /// Triangulates areas that share at most points. Passages narrower than `least_width` meters are closed: each is a
    /// side of triangles that routes do not cross.
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
    /// `lines`, are sides of triangles that routes do not cross.
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
