//! The shortest routes to one destination, sampled on a grid of square cells.

use rayon::prelude::*;

use super::round;

use engine::math::Vector;
use engine::routes::{Destination, Next, Routes, Way};

/// Square cells in rows from the lower left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// The lower left corner, meters.
    pub min: Vector,
    /// The side of a cell, meters.
    pub cell: f64,
    /// Cells per row.
    pub columns: usize,
    /// The number of rows.
    pub rows: usize,
}

impl Grid {
    /// Covers a rectangle with cells of this size, meters.
    pub fn over([min, max]: [Vector; 2], cell: f64) -> Self {
        let [columns, rows] =
            [max.x - min.x, max.y - min.y].map(|length| (length / cell).ceil().max(1.0) as usize);
        Self {
            min,
            cell,
            columns,
            rows,
        }
    }

    /// The center of cell `k`, meters.
    pub fn center(&self, k: usize) -> Vector {
        let (column, row) = (k % self.columns, k / self.columns);
        self.min + Vector::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The routes from the centers of cells.
#[derive(Debug, Clone)]
pub struct WayField {
    /// The cells.
    pub grid: Grid,
    /// The length of the way from each cell, meters; `None` outside of the floor, and where no way leads or every way
    /// is somewhere narrower than the floor's least width.
    pub lengths: Vec<Option<f64>>,
    /// The first corner on the way from each cell, as a number.
    next: Vec<u32>,
}

/// Bands of length, from 0 on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bands {
    /// The width of each: 1, 2 or 5 times a power of ten, meters.
    pub width: f64,
    /// Their number.
    pub count: u32,
}

impl Bands {
    /// The end of the last one, meters.
    pub fn end(&self) -> f64 {
        self.width * f64::from(self.count)
    }
}

/// The most bands.
const MOST_BANDS: f64 = 14.0;

/// The numbers that stand for no way, and for a way without a corner.
const NOTHING: u32 = u32::MAX;
const GOAL: u32 = u32::MAX - 1;

impl WayField {
    /// The routes to a destination that has a path map.
    pub fn new(routes: &Routes, to: Destination, grid: Grid) -> Self {
        Self::drawn(routes, to, grid, Some)
    }

    /// The same of a floor that is drawn elsewhere: `place` has the place on it of each point, if there is one.
    pub fn drawn(
        routes: &Routes,
        to: Destination,
        grid: Grid,
        place: impl Fn(Vector) -> Option<Vector> + Sync,
    ) -> Self {
        let from = |k: usize| {
            let on_floor = place(grid.center(k)).filter(|&p| routes.floor.locate(p).is_some());
            let way = on_floor.and_then(|p| routes.open_way(p, to));
            (way.map(|way| way.length), way.map_or(NOTHING, number))
        };
        let cells = (0..grid.len()).into_par_iter().with_min_len(1024);
        let (lengths, next) = cells.map(from).unzip();
        Self {
            grid,
            lengths,
            next,
        }
    }

    /// The longest way, meters; 0 if there is none.
    pub fn longest(&self) -> f64 {
        let lengths = self.lengths.iter().copied().flatten();
        lengths.fold(0.0, f64::max)
    }

    /// Bands of length.
    pub fn bands(&self) -> Bands {
        let longest = self.longest().max(1e-3);
        let width = round::step(longest / MOST_BANDS);
        Bands {
            width,
            count: (longest / width).ceil().max(1.0) as u32,
        }
    }

    /// Whether the first corner is another one in the cell on the right of cell `k` or above it.
    pub fn is_border(&self, k: usize) -> bool {
        let differs = |other: usize| {
            let next = self.next.get(other).copied().unwrap_or(NOTHING);
            next != NOTHING && next != self.next[k]
        };
        let is_last = (k + 1).is_multiple_of(self.grid.columns);
        self.next[k] != NOTHING && ((!is_last && differs(k + 1)) || differs(k + self.grid.columns))
    }

    /// The numbers of all first corners.
    pub fn corners(&self) -> Vec<u32> {
        let bends = self.next.iter().copied().filter(|&next| next < GOAL);
        let mut corners: Vec<u32> = bends.map(|bend| bend / 2).collect();
        corners.sort_unstable();
        corners.dedup();
        corners
    }
}

fn number(way: Way) -> u32 {
    match way.next {
        Next::Goal(_) | Next::Out(_) => GOAL,
        Next::Corner(bend) => bend.index() as u32,
    }
}
