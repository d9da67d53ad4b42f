//! The places where agents enter: the cell centers of a rectangle, with jitter.

use rand::Rng;

use crate::math::Vector;
use crate::random::{self, Purpose};

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

    /// Whether the grid has no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cell centers, row by row from the lower left.
    pub fn centers(&self) -> impl Iterator<Item = Vector> + '_ {
        let cell = (self.max - self.min).component_div(&Vector::new(
            f64::from(self.columns.max(1)),
            f64::from(self.rows.max(1)),
        ));
        let cells =
            (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        cells.map(move |(column, row)| {
            let step = Vector::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            self.min + cell.component_mul(&step)
        })
    }

    /// The positions, row by row from the lower left, for agents with ids from `first_id` on.
    pub fn positions(&self, seed: u64, first_id: u32) -> impl Iterator<Item = Vector> + '_ {
        self.centers().zip(first_id..).map(move |(center, id)| {
            if self.jitter == 0.0 {
                return center;
            }
            let mut rng = random::stream(seed, Purpose::Placement, id, 0);
            let mut shift = || rng.random_range(-self.jitter..=self.jitter);
            center + Vector::new(shift(), shift())
        })
    }
}
