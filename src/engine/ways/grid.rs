//! Square cells over the floor, with the triangles that reach into each.

use super::mesh::{Mesh, side};
use crate::engine::math::Vector;

/// The side of a cell, meters, on floors that do not have too many.
const CELL: f64 = 0.5;
/// The most cells: on a floor with few triangles, and on any floor.
const FEW_CELLS: usize = 500;
const MOST_CELLS: usize = 200_000;
/// The most cells per triangle.
const PER_TRIANGLE: usize = 10;

/// The cells, in rows from the lower left.
#[derive(Debug, Clone)]
pub struct Grid {
    low: Vector,
    size: f64,
    columns: usize,
    rows: usize,
    /// The distance of a cell's corners from its center, meters.
    pub radius: f64,
    /// The triangles that reach into cell c are `triangles[starts[c]..starts[c + 1]]`.
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Grid {
    /// Covers a mesh.
    pub fn over(mesh: &Mesh) -> Self {
        let triangles = 0..mesh.triangles().len() as u32;
        let points = triangles.clone().flat_map(|t| mesh.corners(t));
        let none = [f64::INFINITY, f64::NEG_INFINITY].map(Vector::repeat);
        let [low, high] = points.fold(none, |[low, high], p| [low.inf(&p), high.sup(&p)]);
        let extent = high - low;
        let most = FEW_CELLS.max(PER_TRIANGLE * mesh.triangles().len());
        let most = most.min(MOST_CELLS) as f64;
        let size = CELL.max((extent.x * extent.y / most).sqrt());
        // A floor can be far longer than wide.
        let size = size.max(extent.max() / most);
        let [columns, rows] = [extent.x, extent.y].map(|x| (x / size).floor() as usize + 1);
        let mut grid = Self {
            low,
            size,
            columns,
            rows,
            radius: 0.5_f64.sqrt() * size,
            starts: vec![0],
            triangles: Vec::new(),
        };
        let mut found = vec![Vec::new(); columns * rows];
        for t in triangles {
            let [a, b, c] = mesh.corners(t);
            let ends = [a.inf(&b).inf(&c), a.sup(&b).sup(&c)];
            let [[x0, y0], [x1, y1]] = ends.map(|p| grid.place(p));
            for cell in (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| y * columns + x)) {
                let corners = grid.corners(cell);
                let is_beyond = |(a, b)| corners.iter().all(|&p| side(a, b, p) < 0.0);
                if ![(a, b), (b, c), (c, a)].into_iter().any(is_beyond) {
                    found[cell].push(t);
                }
            }
        }
        for triangles in found {
            grid.triangles.extend(triangles);
            grid.starts.push(grid.triangles.len() as u32);
        }
        grid
    }

    /// The triangles that reach into a cell.
    pub fn triangles(&self, cell: usize) -> &[u32] {
        let [from, to] = [cell, cell + 1].map(|cell| self.starts[cell] as usize);
        &self.triangles[from..to]
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        (self.starts.capacity() + self.triangles.capacity()) * size_of::<u32>()
    }

    /// Column and row of a point, clamped to the grid.
    fn place(&self, p: Vector) -> [usize; 2] {
        let place = (p - self.low) / self.size;
        [
            (place.x as usize).min(self.columns - 1),
            (place.y as usize).min(self.rows - 1),
        ]
    }

    /// The cell of a point; outside of the grid the nearest.
    pub fn cell(&self, p: Vector) -> usize {
        let [x, y] = self.place(p);
        y * self.columns + x
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.starts.len() - 1
    }

    /// The center of a cell, meters.
    pub fn center(&self, cell: usize) -> Vector {
        let (x, y) = (cell % self.columns, cell / self.columns);
        self.low + Vector::new(x as f64 + 0.5, y as f64 + 0.5) * self.size
    }

    /// The corners of a cell, meters.
    pub fn corners(&self, cell: usize) -> [Vector; 4] {
        let half = 0.5 * self.size;
        [(-half, -half), (half, -half), (half, half), (-half, half)]
            .map(|(x, y)| self.center(cell) + Vector::new(x, y))
    }
}
