//! An independent check whether a path leads through a wall. It shares no code with the engine whose moves it checks:
//! not the index of walls, the test for crossings, or the test for points inside.

use engine::geometry::Walls;
use engine::math::{Vector, bounds, perpendicular};

/// Walls begin this far inside, meters: the engine stops agents 10⁻⁶ m in front of a wall, and coordinates of 10⁶ m are
/// rounded to 10⁻¹⁰ m.
const TOLERANCE: f64 = 1e-8;
/// Cells along the longer side of the index.
const CELLS: usize = 64;

/// An edge, with its solid side to the left.
#[derive(Debug, Clone, Copy)]
struct Edge {
    start: Vector,
    /// As the obstacle gives it, so that edges have no gaps between them.
    end: Vector,
    along: Vector,
    length: f64,
}

/// All edges of a scene, indexed by the square cells that their bounding boxes touch.
#[derive(Debug, Clone)]
pub(super) struct Fence {
    edges: Vec<Edge>,
    /// Number of edges of each obstacle, in order, and whether the obstacle is solid outside.
    counts: Vec<(usize, bool)>,
    low: Vector,
    cell: f64,
    cells: Vec<Vec<u32>>,
}

impl Fence {
    /// The edges of `walls`.
    pub(super) fn new(walls: &Walls) -> Self {
        let obstacles = walls.obstacles();
        let edges: Vec<Edge> = obstacles
            .iter()
            .flat_map(|polygon| polygon.edges())
            .map(|(start, end)| {
                let length = (end - start).norm();
                let along = (end - start) / length;
                Edge {
                    start,
                    end,
                    along,
                    length,
                }
            })
            .collect();
        let ends = edges.iter().flat_map(|edge| [edge.start, edge.end]);
        let [low, high] = bounds(ends).unwrap_or_default();
        let mut fence = Self {
            counts: obstacles
                .iter()
                .map(|o| (o.points().len(), o.is_unbounded()))
                .collect(),
            cell: ((high - low).max() / CELLS as f64).max(TOLERANCE),
            cells: vec![Vec::new(); (CELLS + 1) * (CELLS + 1)],
            low,
            edges,
        };
        for (k, edge) in fence.edges.clone().into_iter().enumerate() {
            for cell in fence.touched(edge.start, edge.end) {
                fence.cells[cell].push(k as u32);
            }
        }
        fence
    }

    /// The cells that the bounding box of two points touches.
    fn touched(&self, a: Vector, b: Vector) -> impl Iterator<Item = usize> + use<> {
        let margin = Vector::new(TOLERANCE, TOLERANCE);
        let place = |p: Vector| (p - self.low) / self.cell;
        let (first, last) = (place(a.inf(&b) - margin), place(a.sup(&b) + margin));
        let most = CELLS as f64;
        let range = |from: f64, to: f64| {
            let outside = to < 0.0 || from > most + 1.0;
            let first = from.clamp(0.0, most) as usize;
            let end = to.min(most) as usize + 1;
            first..if outside { 0 } else { end }
        };
        let (columns, rows) = (range(first.x, last.x), range(first.y, last.y));
        let cell = |row, column| row * (CELLS + 1) + column;
        rows.flat_map(move |row| columns.clone().map(move |column| cell(row, column)))
    }

    /// Whether the straight path from `a` to `b` leads into an obstacle.
    pub(super) fn is_crossed(&self, a: Vector, b: Vector) -> bool {
        let mut near = self.touched(a, b).flat_map(|cell| &self.cells[cell]);
        near.any(|&k| self.edges[k as usize].is_crossed(a, b))
    }

    /// Is `p` inside an obstacle? Counts the edges that a ray to the right crosses.
    pub(super) fn encloses(&self, p: Vector) -> bool {
        let mut edges = self.edges.iter();
        self.counts.iter().any(|&(count, unbounded)| {
            let (mut odd, mut near) = (unbounded, false);
            for edge in edges.by_ref().take(count) {
                let (from, to) = (edge.start, edge.end);
                near |= edge.distance(p) <= TOLERANCE;
                if (from.y > p.y) != (to.y > p.y) {
                    let x = from.x + (p.y - from.y) / (to.y - from.y) * (to.x - from.x);
                    odd ^= p.x < x;
                }
            }
            odd && !near
        })
    }
}

impl Edge {
    /// Whether the path from `a` to `b` starts on the free side and crosses this edge.
    fn is_crossed(&self, a: Vector, b: Vector) -> bool {
        let inward = perpendicular(self.along);
        let depth = |p: Vector| (p - self.start).dot(&inward) - TOLERANCE;
        let (before, after) = (depth(a), depth(b));
        if before > 0.0 || after <= 0.0 {
            return false;
        }
        let there = a + (b - a) * (before / (before - after));
        let place = (there - self.start).dot(&self.along);
        (-TOLERANCE..=self.length + TOLERANCE).contains(&place)
    }

    /// Distance from `p`, meters.
    fn distance(&self, p: Vector) -> f64 {
        let place = (p - self.start).dot(&self.along).clamp(0.0, self.length);
        (p - self.start - self.along * place).norm()
    }
}
