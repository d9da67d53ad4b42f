//! The number and the places of limited moves.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::math::Vector;

/// The side of the cells in which moves are counted, meters.
const CELL: f64 = 1.0;
/// The radius of [`Limited::spot`], meters.
pub const SPOT_RADIUS: f64 = 2.0;
/// The most cells; moves in further cells are counted without their place. A crowd that explodes would fill any number
/// of cells.
const MOST_CELLS: usize = 4096;

/// The number of limited moves, and the places where they began.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Limited {
    /// The number of these moves.
    pub count: u64,
    cells: BTreeMap<[i32; 2], u64>,
}

impl Limited {
    /// Counts a move that begins at `p`.
    pub(super) fn add(&mut self, p: Vector) {
        self.count += 1;
        let cell = <[f64; 2]>::from(p).map(|x| (x / CELL).floor() as i32); // saturates
        if self.cells.len() < MOST_CELLS || self.cells.contains_key(&cell) {
            *self.cells.entry(cell).or_default() += 1;
        }
    }

    /// The place with the most of these moves within [`SPOT_RADIUS`], meters, and their number; `None` without moves.
    pub fn spot(&self) -> Option<(Vector, u64)> {
        let reach = (SPOT_RADIUS / CELL) as i32;
        let offsets = (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| [x, y]));
        let offsets = offsets.filter(|[x, y]| x * x + y * y <= reach * reach);
        let offsets: Vec<[i32; 2]> = offsets.collect();
        let within = |&[x, y]: &[i32; 2]| -> u64 {
            let around = offsets.iter().filter_map(|[dx, dy]| {
                let cell = [x.checked_add(*dx)?, y.checked_add(*dy)?];
                self.cells.get(&cell)
            });
            around.sum()
        };
        let counted = self.cells.keys().map(|cell| (cell, within(cell)));
        // The first one of several.
        let most = counted.reduce(|a, b| if b.1 > a.1 { b } else { a });
        let center = |cell: [i32; 2]| Vector::from(cell.map(|k| (f64::from(k) + 0.5) * CELL));
        most.map(|(&cell, count)| (center(cell), count))
    }
}
