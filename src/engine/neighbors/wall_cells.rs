//! The walls around each cell of the floor: found once, as walls do not move.

use std::sync::OnceLock;

use crate::geometry::Walls;
use crate::math::{Vector, bounds};

/// The side of a cell, meters: doubled until there are few enough cells.
const SIDE: f64 = 1.0;
/// The most cells per wall.
const PER_WALL: f64 = 32.0;

/// Square cells over all walls and their surroundings.
#[derive(Debug, Clone, Default)]
pub struct WallCells {
    /// Walls up to this distance from a cell are found, meters.
    reach: f64,
    /// The lower left corner of the first cell, meters.
    low: Vector,
    /// The side of a cell, meters.
    side: f64,
    columns: usize,
    /// Row by row, each found when it is first asked for.
    cells: Vec<OnceLock<Box<[u32]>>>,
}

impl WallCells {
    /// Prepares to find the walls up to `reach` meters away.
    pub fn reach_to(&mut self, walls: &Walls, reach: f64) {
        if reach <= self.reach || walls.is_empty() {
            return;
        }
        let ends = (0..walls.len() as u32).map(|k| walls.wall(k));
        let ends = ends.flat_map(|wall| [wall.start, wall.end]);
        let [low, high] = bounds(ends).unwrap_or_default();
        let size = (high - low).add_scalar(2.0 * reach);
        let count = |side: f64| size.map(|length| (length / side).floor() + 1.0);
        self.side = SIDE;
        while count(self.side).product() > PER_WALL * walls.len() as f64 {
            self.side *= 2.0;
        }
        let [columns, rows] = count(self.side).into();
        (self.reach, self.low) = (reach, low.add_scalar(-reach));
        self.columns = columns as usize;
        self.cells.clear();
        let all = self.columns * rows as usize;
        self.cells.resize_with(all, OnceLock::new);
    }

    /// The walls with a point less than the reach from `p`, and some farther away, in ascending order.
    pub fn around(&self, walls: &Walls, p: Vector) -> &[u32] {
        let place = (p - self.low) / self.side;
        let (column, row) = (place.x as usize, place.y as usize);
        let is_inside = place.min() >= 0.0 && column < self.columns;
        let Some(cell) = self
            .cells
            .get(row * self.columns + column)
            .filter(|_| is_inside)
        else {
            return &[]; // far from all walls
        };
        cell.get_or_init(|| {
            let corner = self.low + Vector::new(column as f64, row as f64) * self.side;
            let corners = [corner, corner.add_scalar(self.side)];
            walls
                .near_any(&corners, self.reach * (1.0 + ROUNDING))
                .into()
        })
    }
}

/// Places are rounded.
const ROUNDING: f64 = 1e-6;
