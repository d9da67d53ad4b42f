//! Builds areas from boundaries that touch themselves, such as the results of boolean operations, whose points
//! are rounded to a grid.
//!
//! Points within a tolerance are merged, a corner on another edge splits that edge, and pairs of opposite edges
//! cancel. The remaining edges are walked with the area on the left, and each path is cut at every corner that
//! it meets twice. So every ring is simple, outlines run counterclockwise and holes clockwise, and rings touch
//! only at points.

use libm::atan2;
use parry2d::bounding_volume::BoundingVolume;

use super::corners::Corners;
use super::ring::signed_area;
use super::ring_index::RingIndex;
use super::{Area, PolygonError, Ring, bounds_of, index_of};
use crate::math::{Vector, sides};

/// A piece of an edge, by the numbers of its end points.
#[derive(Clone, Copy)]
struct Piece {
    from: u32,
    to: u32,
    /// The number of the edge to which it belongs.
    edge: u32,
}

/// The areas on the left of `rings`, in the order of their outlines. Every corner within `tolerance` meters of a
/// `given` point is moved to that point.
///
/// # Errors
/// Rings that cross each other by more than the tolerance, with the points of one of them.
pub fn assemble(
    rings: &[Vec<Vector>],
    given: impl Iterator<Item = Vector>,
    tolerance: f64,
) -> Result<Vec<Area>, (PolygonError, Vec<Vector>)> {
    let mut corners = Corners::new(tolerance);
    given.for_each(|p| {
        corners.number(p);
    });
    let edges = edges(rings, &mut corners);
    let pieces = without_opposites(split(&edges, &corners, tolerance));
    let (mut outlines, mut holes) = (Vec::new(), Vec::new());
    for points in loops(&pieces, &corners) {
        let around: f64 = sides(&points).map(|(a, b)| (b - a).norm()).sum();
        let area = signed_area(&points);
        // Rings narrower than this on average come from rounding.
        if area.abs() <= tolerance * around {
            continue;
        }
        let ring = Ring::new(points.clone()).map_err(|error| (error, points))?;
        if area > 0.0 {
            outlines.push(ring);
        } else {
            holes.push(ring);
        }
    }
    Ok(nested(outlines, holes))
}

fn edges(rings: &[Vec<Vector>], corners: &mut Corners) -> Vec<Piece> {
    let mut edges = Vec::new();
    for ring in rings {
        let numbers: Vec<u32> = ring.iter().map(|&p| corners.number(p)).collect();
        for (from, to) in sides(&numbers).filter(|(from, to)| from != to) {
            let edge = edges.len() as u32;
            edges.push(Piece { from, to, edge });
        }
    }
    edges
}

/// Splits the edges at all corners that lie on them.
fn split(edges: &[Piece], corners: &Corners, tolerance: f64) -> Vec<Piece> {
    let ends = |piece: &Piece| [corners.at(piece.from), corners.at(piece.to)];
    let bounds = edges.iter().map(|edge| bounds_of(ends(edge)));
    let index = index_of(bounds.map(|around| around.loosened(tolerance)));
    let mut seen = vec![false; corners.len()];
    // Edge, position along it (0 to 1), corner.
    let mut cuts: Vec<(u32, f64, u32)> = Vec::new();
    for &Piece { from: corner, .. } in edges {
        if std::mem::replace(&mut seen[corner as usize], true) {
            continue;
        }
        let p = corners.at(corner);
        for k in index.intersect_aabb(&bounds_of([p])) {
            let edge = &edges[k as usize];
            let [a, b] = ends(edge);
            let along = (b - a).dot(&(p - a)) / (b - a).norm_squared();
            let is_end = corner == edge.from || corner == edge.to;
            let off = (a + (b - a) * along - p).norm();
            if !is_end && along > 0.0 && along < 1.0 && off < tolerance {
                cuts.push((k, along, corner));
            }
        }
    }
    cuts.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut cuts = cuts.into_iter().peekable();
    let mut pieces = Vec::with_capacity(edges.len() + cuts.len());
    for &Piece { mut from, to, edge } in edges {
        while let Some((_, _, corner)) = cuts.next_if(|cut| cut.0 == edge) {
            pieces.push(Piece {
                from,
                to: corner,
                edge,
            });
            from = corner;
        }
        pieces.push(Piece { from, to, edge });
    }
    pieces
}

/// Removes pairs of pieces that run between the same corners in opposite directions.
fn without_opposites(pieces: Vec<Piece>) -> Vec<Piece> {
    let ends = |k: &usize| {
        let Piece { from, to, .. } = pieces[*k];
        (from.min(to), from.max(to))
    };
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(ends);
    let mut keep = vec![true; pieces.len()];
    for same in order.chunk_by(|a, b| ends(a) == ends(b)) {
        let (up, down): (Vec<usize>, Vec<usize>) =
            same.iter().partition(|&&k| pieces[k].from < pieces[k].to);
        for (a, b) in up.into_iter().zip(down) {
            (keep[a], keep[b]) = (false, false);
        }
    }
    let kept = pieces.iter().zip(keep).filter(|(_, keep)| *keep);
    kept.map(|(piece, _)| *piece).collect()
}

/// Marks a corner that is not on the path.
const NOWHERE: usize = usize::MAX;

/// Closed paths that visit no corner twice, each with the area on its left.
fn loops(pieces: &[Piece], corners: &Corners) -> Vec<Vec<Vector>> {
    let leaving = Leaving::new(pieces, corners);
    let mut walked = vec![false; pieces.len()];
    let mut place = vec![NOWHERE; corners.len()];
    let mut found = Vec::new();
    let mut path: Vec<usize> = Vec::new();
    for first in 0..pieces.len() {
        let mut next = Some(first);
        while let Some(k) = next.filter(|&k| !std::mem::replace(&mut walked[k], true)) {
            place[pieces[k].from as usize] = path.len();
            path.push(k);
            let back = place[pieces[k].to as usize];
            if back != NOWHERE {
                let closed = path.split_off(back);
                for &k in &closed {
                    place[pieces[k].from as usize] = NOWHERE;
                }
                found.push((
                    closed.iter().min().copied(),
                    outline(pieces, &closed, corners),
                ));
            }
            next = leaving.after(k);
        }
        for k in path.drain(..) {
            place[pieces[k].from as usize] = NOWHERE;
        }
    }
    found.sort_by_key(|(first, _)| *first);
    found.into_iter().map(|(_, points)| points).collect()
}

/// The corners of a closed path, without those between two pieces of the same edge.
fn outline(pieces: &[Piece], closed: &[usize], corners: &Corners) -> Vec<Vector> {
    let before = closed.iter().cycle().skip(closed.len() - 1);
    let turns = closed.iter().zip(before);
    let turns = turns.filter(|&(&k, &last)| pieces[k].edge != pieces[last].edge);
    turns.map(|(&k, _)| corners.at(pieces[k].from)).collect()
}

/// The pieces that begin at each corner.
struct Leaving<'a> {
    pieces: &'a [Piece],
    corners: &'a Corners,
    /// Pieces, sorted by the corner at which they begin.
    order: Vec<usize>,
    /// The first position in `order` for each corner, and the end of `order`.
    starts: Vec<usize>,
}

impl<'a> Leaving<'a> {
    fn new(pieces: &'a [Piece], corners: &'a Corners) -> Self {
        let mut order: Vec<usize> = (0..pieces.len()).collect();
        order.sort_by_key(|&k| pieces[k].from);
        let mut starts = vec![0; corners.len() + 1];
        for piece in pieces {
            starts[piece.from as usize + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        Self {
            pieces,
            corners,
            order,
            starts,
        }
    }

    /// The piece that continues piece `k` along the same area: the next one clockwise.
    fn after(&self, k: usize) -> Option<usize> {
        let Piece { from, to, .. } = self.pieces[k];
        let leaving = &self.order[self.starts[to as usize]..self.starts[to as usize + 1]];
        let middle = self.corners.at(to);
        let back = self.corners.at(from) - middle;
        let turn = |k: usize| {
            let out = self.corners.at(self.pieces[k].to) - middle;
            // Clockwise from `back`, in (0, 2π].
            let angle = atan2(-back.perp(&out), back.dot(&out));
            if angle > 0.0 {
                angle
            } else {
                angle + std::f64::consts::TAU
            }
        };
        match leaving {
            [one] => Some(*one),
            several => several
                .iter()
                .copied()
                .min_by(|&a, &b| turn(a).total_cmp(&turn(b))),
        }
    }
}

/// Assigns each hole to the smallest outline that contains it.
fn nested(outlines: Vec<Ring>, holes: Vec<Ring>) -> Vec<Area> {
    let sizes: Vec<f64> = outlines.iter().map(Ring::area).collect();
    let parents: Vec<Option<usize>> = {
        let index = RingIndex::new(outlines.iter().collect());
        let parent = |hole: &Ring| {
            let around = index.around(hole.inner_point()).into_iter();
            let size = hole.area();
            // Smaller outlines lie in the hole.
            let larger = around.filter(|&k| sizes[k] > size);
            larger.min_by(|&a, &b| sizes[a].total_cmp(&sizes[b]))
        };
        holes.iter().map(parent).collect()
    };
    let area = |exterior| Area {
        exterior,
        holes: Vec::new(),
    };
    let mut areas: Vec<Area> = outlines.into_iter().map(area).collect();
    for (hole, parent) in holes.into_iter().zip(parents) {
        // A hole outside all outlines changes nothing: everything around it is solid anyway.
        if let Some(parent) = parent {
            areas[parent].holes.push(hole);
        }
    }
    areas
}
