//! A grid over the floor. Each cell lists the triangles that overlap it. Cells with many triangles are divided again,
//! so that all lists are short, even on floors far larger than their rooms.

use std::collections::VecDeque;

use super::lines::side;
use super::mesh::Mesh;
use crate::math::{Vector, bounds, bytes_of};

/// Cells with more triangles are divided.
const MANY: usize = 10;
/// Cells are divided as long as their lists hold no more than this many entries per triangle.
const PER_TRIANGLE: usize = 12;
/// The smallest cells, meters.
const SMALLEST: f64 = 0.01;
/// Triangles within this distance of a cell are listed in it, so that rounding loses none, meters.
const MARGIN: f64 = 1e-6;

/// Equal cells that cover a rectangle, in rows from the lower left.
#[derive(Debug, Clone)]
struct Block {
    low: Vector,
    /// The sides of a cell, meters.
    size: Vector,
    columns: u32,
    rows: u32,
    /// The number of the first cell.
    first: u32,
}

/// What a cell holds.
#[derive(Debug, Clone, Copy)]
enum Cell {
    /// Triangles: this range of the list.
    Few { start: u32, count: u32 },
    /// Smaller cells: this block.
    Many(u32),
}

/// The blocks of cells, the first of which covers the whole floor.
#[derive(Debug, Clone)]
pub struct Grid {
    blocks: Vec<Block>,
    cells: Vec<Cell>,
    triangles: Vec<u32>,
}

impl Block {
    /// A block over a rectangle with about `count` cells, which are nearly square.
    fn over([low, high]: [Vector; 2], count: usize, first: usize) -> Self {
        let extent = (high - low).sup(&Vector::repeat(SMALLEST));
        let side = (extent.x * extent.y / count as f64).sqrt().max(SMALLEST);
        // A rectangle can be far longer than wide.
        let number = |x: f64| ((x / side).ceil() as usize).clamp(1, count);
        let [columns, rows] = [extent.x, extent.y].map(number);
        Self {
            low,
            size: Vector::new(extent.x / columns as f64, extent.y / rows as f64),
            columns: columns as u32,
            rows: rows as u32,
            first: first as u32,
        }
    }

    /// Column and row of a point, clamped to the block.
    #[inline]
    fn place(&self, p: Vector) -> [u32; 2] {
        let place = (p - self.low).component_div(&self.size);
        [
            (place.x as u32).min(self.columns - 1),
            (place.y as u32).min(self.rows - 1),
        ]
    }

    /// Its upper right corner, meters.
    fn high(&self) -> Vector {
        self.low + self.steps([self.columns, self.rows])
    }

    /// So many cells to the right and up, meters.
    fn steps(&self, [columns, rows]: [u32; 2]) -> Vector {
        let steps = Vector::new(f64::from(columns), f64::from(rows));
        self.size.component_mul(&steps)
    }

    /// The numbers of the cells that a rectangle reaches into, with their rectangles.
    fn cells(&self, [low, high]: [Vector; 2]) -> impl Iterator<Item = (usize, [Vector; 2])> {
        let ([x0, y0], [x1, y1]) = (self.place(low), self.place(high));
        (y0..=y1).flat_map(move |y| {
            (x0..=x1).map(move |x| {
                let cell = self.first + y * self.columns + x;
                let ends = [[x, y], [x + 1, y + 1]];
                (cell as usize, ends.map(|end| self.low + self.steps(end)))
            })
        })
    }
}

impl Grid {
    /// Covers a mesh.
    pub fn over(mesh: &Mesh) -> Self {
        let mut grid = Self {
            blocks: Vec::new(),
            cells: Vec::new(),
            triangles: Vec::new(),
        };
        let all: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
        let most = PER_TRIANGLE * all.len();
        let mut listed = all.len();
        let around = bounds(mesh.points().iter().copied()).unwrap_or_default();
        let first = grid.add(around, all.len());
        let mut waiting = VecDeque::from([(first, all)]);
        while let Some((block, triangles)) = waiting.pop_front() {
            for (cell, around, found) in grid.divide(mesh, block, &triangles) {
                listed += found.len();
                let is_small = (around[1] - around[0]).max() <= SMALLEST;
                grid.cells[cell] = if found.len() <= MANY || listed > most || is_small {
                    let start = grid.triangles.len() as u32;
                    let count = found.len() as u32;
                    grid.triangles.extend(found);
                    Cell::Few { start, count }
                } else {
                    let block = grid.add(around, found.len());
                    waiting.push_back((block, found));
                    Cell::Many(block as u32)
                };
            }
        }
        grid
    }

    /// Adds a block of empty cells over a rectangle with `triangles` triangles.
    fn add(&mut self, around: [Vector; 2], triangles: usize) -> usize {
        let block = Block::over(around, triangles.max(1), self.cells.len());
        let cells = block.columns as usize * block.rows as usize;
        let none = Cell::Few { start: 0, count: 0 };
        self.cells.resize(self.cells.len() + cells, none);
        self.blocks.push(block);
        self.blocks.len() - 1
    }

    /// The cells of a block with their rectangles and those of `triangles` that reach into them.
    fn divide(
        &self,
        mesh: &Mesh,
        block: usize,
        triangles: &[u32],
    ) -> Vec<(usize, [Vector; 2], Vec<u32>)> {
        let block = &self.blocks[block];
        let mut pairs = Vec::new();
        for &t in triangles {
            let [a, b, c] = mesh.corners(t);
            let margin = Vector::repeat(MARGIN);
            let ends = [a.inf(&b).inf(&c) - margin, a.sup(&b).sup(&c) + margin];
            for (cell, [low, high]) in block.cells(ends) {
                let (low, high) = (low - margin, high + margin);
                let corners = [(low, low), (high, low), (high, high), (low, high)];
                let corners = corners.map(|(x, y)| Vector::new(x.x, y.y));
                let is_beyond = |(a, b)| corners.iter().all(|&p| side(a, b, p) < 0.0);
                if ![(a, b), (b, c), (c, a)].into_iter().any(is_beyond) {
                    pairs.push((cell as u32, t));
                }
            }
        }
        pairs.sort_unstable();
        let all = block.cells([block.low, block.high()]);
        all.map(|(cell, around)| {
            let [from, to] =
                [0, 1].map(|k| pairs.partition_point(|pair| (pair.0 as usize) < cell + k));
            let found = pairs[from..to].iter().map(|pair| pair.1).collect();
            (cell, around, found)
        })
        .collect()
    }

    /// The triangles near a point; outside of the grid those of the nearest cell.
    #[inline]
    pub fn triangles(&self, p: Vector) -> &[u32] {
        let mut block = &self.blocks[0];
        loop {
            let [x, y] = block.place(p);
            match self.cells[(block.first + y * block.columns + x) as usize] {
                Cell::Few { start, count } => {
                    return &self.triangles[start as usize..][..count as usize];
                }
                Cell::Many(next) => block = &self.blocks[next as usize],
            }
        }
    }

    /// The triangle nearest to `p`; of equally near ones, the one with the smallest number.
    pub fn nearest(&self, mesh: &Mesh, p: Vector) -> Option<u32> {
        let whole = &self.blocks[0];
        let high = whole.high();
        let outside = (p - p.sup(&whole.low).inf(&high)).norm();
        let farthest = outside + (high - whole.low).norm();
        let mut within = outside + SMALLEST;
        loop {
            let (mut found, mut waiting) = (Vec::new(), vec![0]);
            let around = [p.add_scalar(-within), p.add_scalar(within)];
            while let Some(block) = waiting.pop() {
                for (cell, _) in self.blocks[block].cells(around) {
                    match self.cells[cell] {
                        Cell::Few { start, count } => found
                            .extend_from_slice(&self.triangles[start as usize..][..count as usize]),
                        Cell::Many(next) => waiting.push(next as usize),
                    }
                }
            }
            let distances = found.into_iter().map(|t| (mesh.distance(t, p), t));
            let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            match nearest {
                Some((distance, t)) if distance <= within || within >= farthest => return Some(t),
                None if within >= farthest => return None,
                _ => within *= 2.0,
            }
        }
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        bytes_of(&self.blocks) + bytes_of(&self.cells) + bytes_of(&self.triangles)
    }
}
