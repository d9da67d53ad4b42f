//! Where agents enter: at the cell centers of a rectangle, with jitter.

use rand::Rng;

use crate::engine::math::Vector;
use crate::engine::random::{self, Purpose};

/// A rectangle divided into columns × rows of equal cells, with one agent at the center of each.
///
/// With a single row or column, the rectangle may be a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Lower left corner, meters.
    pub min: Vector,
    /// Upper right corner, meters.
    pub max: Vector,
    /// Number of cells along x.
    pub columns: u32,
    /// Number of cells along y.
    pub rows: u32,
    /// Largest random shift of each coordinate, in either direction, meters.
    pub jitter: f64,
}

impl Grid {
    /// The number of agents.
    pub fn len(&self) -> u64 {
        u64::from(self.columns) * u64::from(self.rows)
    }

    /// Does the grid have no cells?
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The positions, row by row from the lower left, for agents with ids from `first_id` on.
    pub fn positions(&self, seed: u64, first_id: u32) -> impl Iterator<Item = Vector> + '_ {
        let cell = (self.max - self.min).component_div(&Vector::new(
            f64::from(self.columns.max(1)),
            f64::from(self.rows.max(1)),
        ));
        let cells =
            (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        cells.zip(first_id..).map(move |((column, row), id)| {
            let step = Vector::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            let center = self.min + cell.component_mul(&step);
            if self.jitter == 0.0 {
                return center;
            }
            let mut rng = random::stream(seed, Purpose::Placement, id, 0);
            let mut shift = || rng.random_range(-self.jitter..=self.jitter);
            center + Vector::new(shift(), shift())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agents_stand_at_the_centres_of_the_cells() {
        let grid = Grid {
            min: Vector::new(0.0, 0.0),
            max: Vector::new(20.0, 20.0),
            columns: 20,
            rows: 20,
            jitter: 0.0,
        };
        let positions: Vec<Vector> = grid.positions(1, 0).collect();
        assert_eq!(positions.len(), 400);
        assert_eq!(positions[0], Vector::new(0.5, 0.5));
        assert_eq!(positions[399], Vector::new(19.5, 19.5));
    }

    #[test]
    fn a_row_is_a_grid_of_one_column_and_jitter_stays_in_bounds() {
        let row = Grid {
            min: Vector::new(0.0, -50.0),
            max: Vector::new(0.0, 50.0),
            columns: 1,
            rows: 100,
            jitter: 0.2,
        };
        for (k, p) in row.positions(1, 0).enumerate() {
            assert!(p.x.abs() <= 0.2);
            assert!((p.y - (k as f64 - 49.5)).abs() <= 0.2);
        }
        assert_ne!(row.positions(1, 0).next(), row.positions(2, 0).next());
        assert_ne!(row.positions(1, 0).next(), row.positions(1, 100).next());
    }
}
