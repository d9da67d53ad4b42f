//! Lines of a plane, divided where they cross: the edges between the areas that they enclose.
//!
//! i_overlay divides the lines on a grid. Everything after that is exact.

use libm::{exp2, log2};
use std::cmp::Ordering;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::i_float::int::point::IntPoint;
use i_overlay::string::clip::ClipRule;
use i_overlay::string::overlay::StringOverlay;

use super::map::Point;
use crate::floor_plan::boundary::Point as GridPoint;

/// The grid reaches from −2²⁹ to 2²⁹.
const REACH: f64 = (1 << 29) as f64;

/// A line through points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Line {
    /// Its points.
    pub points: Vec<Point>,
    /// Whether the areas on its two sides are connected, as at doors.
    pub is_open: bool,
}

/// The grid on which lines are divided.
#[derive(Debug, Clone, Copy)]
pub struct Grid {
    middle: Point,
    /// The length between neighboring points.
    pub step: f64,
}

impl Grid {
    fn new<'a>(points: impl Iterator<Item = &'a Point>) -> Self {
        let infinity = f64::INFINITY;
        let (mut low, mut high) = ([infinity; 2], [-infinity; 2]);
        for p in points {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let half = 0.5 * (high[0] - low[0]).max(high[1] - low[1]);
        if !half.is_finite() {
            return Self {
                middle: [0.0, 0.0],
                step: 1.0,
            };
        }
        // A power of two keeps the rounding of coordinates small.
        let step = exp2(log2(half.max(1e-3) / REACH).ceil());
        Self {
            middle: [0, 1].map(|k| 0.5 * (low[k] + high[k])),
            step,
        }
    }

    /// The nearest point of the grid.
    pub fn nearest(&self, p: Point) -> GridPoint {
        let one = |k: usize| {
            ((p[k] - self.middle[k]) / self.step)
                .round()
                .clamp(-REACH, REACH)
        };
        [one(0) as i64, one(1) as i64]
    }

    /// Where a point of the grid is.
    pub fn place(&self, [x, y]: GridPoint) -> Point {
        [
            self.middle[0] + x as f64 * self.step,
            self.middle[1] + y as f64 * self.step,
        ]
    }
}

/// An edge between two nodes.
#[derive(Debug, Clone, Copy)]
pub struct Edge {
    /// The numbers of its nodes.
    pub nodes: [usize; 2],
    /// Whether the areas on its two sides are connected.
    pub is_open: bool,
}

/// Edges that meet only at nodes.
pub struct Network {
    /// The grid.
    pub grid: Grid,
    /// The nodes, sorted.
    pub nodes: Vec<GridPoint>,
    /// The edges.
    pub edges: Vec<Edge>,
    /// For each node, the halves of edges that leave it, counterclockwise: half 2k leads from the first node of edge
    /// k to its second one, half 2k + 1 back.
    pub leaving: Vec<Vec<usize>>,
}

impl Network {
    /// Divides lines where they cross.
    pub fn new(lines: &[Line]) -> Self {
        let grid = Grid::new(lines.iter().flat_map(|line| &line.points));
        let pieces = divided(lines, &grid);
        let mut nodes: Vec<GridPoint> = pieces.iter().flat_map(|piece| piece.ends).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let number = |p: GridPoint| nodes.partition_point(|node| *node < p);
        let edge = |piece: &Piece| Edge {
            nodes: piece.ends.map(number),
            is_open: piece.is_open,
        };
        let edges: Vec<Edge> = pieces.iter().map(edge).collect();
        let mut leaving = vec![Vec::new(); nodes.len()];
        for (k, edge) in edges.iter().enumerate() {
            leaving[edge.nodes[0]].push(2 * k);
            leaving[edge.nodes[1]].push(2 * k + 1);
        }
        let mut network = Self {
            grid,
            nodes,
            edges,
            leaving: Vec::new(),
        };
        for halves in &mut leaving {
            halves.sort_by(|&a, &b| by_angle(network.direction(a), network.direction(b)));
        }
        network.leaving = leaving;
        network
    }

    /// The nodes of half an edge, from its beginning to its end.
    pub fn ends(&self, half: usize) -> [usize; 2] {
        let [a, b] = self.edges[half / 2].nodes;
        if half.is_multiple_of(2) {
            [a, b]
        } else {
            [b, a]
        }
    }

    fn direction(&self, half: usize) -> GridPoint {
        let [from, to] = self.ends(half).map(|node| self.nodes[node]);
        [to[0] - from[0], to[1] - from[1]]
    }

    /// The half that comes after another one around the area on its left.
    pub fn after(&self, half: usize) -> usize {
        let back = half ^ 1;
        let around = &self.leaving[self.ends(half)[1]];
        let own = around.iter().position(|&other| other == back).unwrap_or(0);
        around[(own + around.len() - 1) % around.len()]
    }

    /// The nodes at which a line ends, without those of open lines.
    pub fn loose_ends(&self) -> Vec<usize> {
        let is_loose = |&node: &usize| match self.leaving[node].as_slice() {
            [half] => !self.edges[half / 2].is_open,
            _ => false,
        };
        (0..self.nodes.len()).filter(is_loose).collect()
    }
}

/// By the angle from the x axis, counterclockwise.
fn by_angle(u: GridPoint, v: GridPoint) -> Ordering {
    let is_lower = |[x, y]: GridPoint| y < 0 || y == 0 && x < 0;
    // The products are at most 2⁶⁰ in size.
    let turn = u[0] * v[1] - u[1] * v[0];
    is_lower(u).cmp(&is_lower(v)).then(0.cmp(&turn))
}

/// A part of a line, or of several that coincide.
struct Piece {
    /// Its ends, sorted.
    ends: [GridPoint; 2],
    is_open: bool,
}

/// Divides lines on the grid. A piece is open if only open lines lead along it.
///
/// i_overlay merges lines that coincide, and keeps their directions. Open lines are given in one direction, from left
/// to right or upwards; all others in both.
fn divided(lines: &[Line], grid: &Grid) -> Vec<Piece> {
    let mut overlay = StringOverlay::new(lines.iter().map(|line| line.points.len()).sum());
    let point = |[x, y]: GridPoint| IntPoint::new(x as i32, y as i32);
    for line in lines {
        for pair in line.points.windows(2) {
            let [a, b] = [grid.nearest(pair[0]), grid.nearest(pair[1])];
            let along = [b[0] - a[0], b[1] - a[1]];
            let is_wide = along[0].abs() >= along[1].abs();
            let is_back = along[if is_wide { 0 } else { 1 }] < 0;
            let [from, to] = if is_back { [b, a] } else { [a, b] };
            overlay.add_string_line([point(from), point(to)]);
            if !line.is_open {
                overlay.add_string_line([point(to), point(from)]);
            }
        }
    }
    let all = ClipRule {
        invert: true,
        boundary_included: true,
    };
    let paths = overlay.clip_string_lines(FillRule::NonZero, all);
    let steps = paths.iter().flat_map(|path| path.windows(2));
    let place = |p: IntPoint| [i64::from(p.x), i64::from(p.y)];
    let mut directed: Vec<[GridPoint; 2]> = steps.map(|p| [place(p[0]), place(p[1])]).collect();
    directed.retain(|[from, to]| from != to);
    directed.sort_unstable_by_key(|&[from, to]| ([from.min(to), from.max(to)], from));
    directed.dedup();
    let piece = |same: &[[GridPoint; 2]]| Piece {
        ends: [same[0][0].min(same[0][1]), same[0][0].max(same[0][1])],
        is_open: same.len() == 1,
    };
    let same = |a: &[GridPoint; 2], b: &[GridPoint; 2]| {
        a[0].min(a[1]) == b[0].min(b[1]) && a[0].max(a[1]) == b[0].max(b[1])
    };
    directed.chunk_by(same).map(piece).collect()
}
