//! A uniform grid over the crowd; agents sorted by cell, row by row, so that a row of cells is a
//! contiguous range of agents.

use std::ops::Range;

use crate::math::Vector;

/// At most this many cells per agent (and this many for an empty crowd): a crowd strewn over a wide
/// area gets larger cells instead of a larger grid.
const CELLS_PER_AGENT: usize = 4;
const FEWEST_CELLS: usize = 1024;

/// Cells of a bounding box and the range of agents in each.
#[derive(Debug, Clone)]
pub struct Grid {
    origin: Vector,
    cell: f64,
    columns: usize,
    rows: usize,
    /// First agent of every cell, row by row, and the number of agents at the end.
    start: Vec<u32>,
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            origin: Vector::zeros(),
            cell: 1.0,
            columns: 1,
            rows: 1,
            start: vec![0, 0],
        }
    }
}

impl Grid {
    /// Lays a grid of about `cell` metres over `positions` and returns the order that sorts them by
    /// cell; agents of one cell keep their order.
    pub fn rebuild(&mut self, positions: &[Vector], cell: f64) -> Vec<u32> {
        let (low, high) = bounds(positions);
        self.origin = low;
        self.cell = cell.max(f64::MIN_POSITIVE); // so that doubling makes it grow
        let most = (positions.len() * CELLS_PER_AGENT).max(FEWEST_CELLS) as f64;
        let extent = high - low;
        let cells =
            |cell: f64| ((extent.x / cell).floor() + 1.0) * ((extent.y / cell).floor() + 1.0);
        while cells(self.cell) > most {
            self.cell *= 2.0;
        }
        self.columns = (extent.x / self.cell) as usize + 1;
        self.rows = (extent.y / self.cell) as usize + 1;

        let cell_of: Vec<u32> = positions.iter().map(|&p| self.cell_of(p) as u32).collect();
        self.start.clear();
        self.start.resize(self.cells() + 1, 0);
        for &cell in &cell_of {
            self.start[cell as usize + 1] += 1;
        }
        for cell in 0..self.cells() {
            self.start[cell + 1] += self.start[cell];
        }
        let mut next = self.start.clone();
        let mut order = vec![0; positions.len()];
        for (i, &cell) in cell_of.iter().enumerate() {
            let place = &mut next[cell as usize];
            order[*place as usize] = i as u32;
            *place += 1;
        }
        order
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.columns * self.rows
    }

    fn cell_of(&self, p: Vector) -> usize {
        let offset = (p - self.origin) / self.cell;
        let column = (offset.x as usize).min(self.columns - 1);
        let row = (offset.y as usize).min(self.rows - 1);
        row * self.columns + column
    }

    /// For every row of cells that the square of half side `radius` round `p` meets: its agents.
    pub fn rows(&self, p: Vector, radius: f64) -> impl Iterator<Item = Range<usize>> + '_ {
        let half = Vector::new(radius, radius);
        // Conversions to usize saturate, so what lies left of or below the grid becomes 0; what lies
        // wholly outside is an empty range of columns or rows.
        let low = (p - half - self.origin) / self.cell;
        let high = (p + half - self.origin) / self.cell;
        let outside = high.x < 0.0 || high.y < 0.0;
        let columns = low.x as usize..((high.x as usize).saturating_add(1)).min(self.columns);
        let rows = low.y as usize..((high.y as usize).saturating_add(1)).min(self.rows);
        let rows = if outside || columns.is_empty() {
            0..0
        } else {
            rows
        };
        rows.map(move |row| {
            let first = row * self.columns;
            self.start[first + columns.start] as usize..self.start[first + columns.end] as usize
        })
    }
}

/// The corners of the bounding box; the origin twice for nobody.
fn bounds(positions: &[Vector]) -> (Vector, Vector) {
    let Some(&first) = positions.first() else {
        return (Vector::zeros(), Vector::zeros());
    };
    positions
        .iter()
        .fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_no_size_are_made_larger() {
        for cell in [0.0, 5e-324, 1e-300] {
            for positions in [
                vec![Vector::zeros()],
                vec![Vector::zeros(), Vector::new(9.0, 1e9)],
            ] {
                let mut grid = Grid::default();
                assert_eq!(grid.rebuild(&positions, cell).len(), positions.len());
                assert!(grid.cells() <= FEWEST_CELLS);
            }
        }
    }
}
