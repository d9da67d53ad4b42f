//! How far agents have moved against each other since the sort.
//!
//! The shift of an agent is the way from its position at the sort to where it is. Lists with a margin miss no neighbor
//! as long as the shifts of any two agents that may meet differ by at most the margin: in a crowd that walks as one,
//! they are valid much longer than until somebody has walked half the margin. Shifts are compared by square [`Tiles`]
//! of the floor. Agents of tiles that do not touch are too far apart to meet before the next sort. The shifts of agents
//! of two tiles that touch, or of one tile, differ at most by the diagonal of the rectangle around all of them.

use super::Grid;
use crate::math::Vector;

/// The number of agents, one after the other in the order of the sort, whose shifts have one rectangle.
pub const STRIP: usize = 32;

/// The rectangle around some shifts, meters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shifts {
    low: Vector,
    high: Vector,
}

impl Default for Shifts {
    fn default() -> Self {
        Self {
            low: Vector::repeat(f64::INFINITY),
            high: Vector::repeat(f64::NEG_INFINITY),
        }
    }
}

impl Shifts {
    /// The shifts of some agents: their positions, and those at the sort.
    #[inline(always)]
    pub fn of(positions: &[Vector], sorted_at: &[Vector]) -> Self {
        // Four rectangles side by side: none waits for another.
        let mut some = [Self::default(); 4];
        let shifts = positions.iter().zip(sorted_at);
        for (k, (position, start)) in shifts.enumerate() {
            some[k % 4].include(position - start);
        }
        some.into_iter().fold(Self::default(), Self::and)
    }

    #[inline(always)]
    fn include(&mut self, shift: Vector) {
        let less = |a: f64, b: f64| if b < a { b } else { a };
        let greater = |a: f64, b: f64| if b > a { b } else { a };
        self.low = Vector::new(less(self.low.x, shift.x), less(self.low.y, shift.y));
        self.high = Vector::new(greater(self.high.x, shift.x), greater(self.high.y, shift.y));
    }

    /// The rectangle around both.
    fn and(self, other: Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    /// The square of the greatest difference of two shifts, m²; infinite without shifts.
    fn difference(&self) -> f64 {
        (self.high - self.low).norm_squared()
    }

    fn is_empty(&self) -> bool {
        self.low.x > self.high.x
    }
}

/// The shifts of the agents that were in each square tile of the floor at the sort.
#[derive(Debug, Clone, Default)]
pub struct Tiles {
    /// Row by row.
    shifts: Vec<Shifts>,
    columns: usize,
}

impl Tiles {
    /// Whether shifts of agents that may meet differ by more than `most` meters. `strips` has the shifts of [`STRIP`]
    /// agents each; agents that are farther apart than `size` meters at the sort do not meet.
    pub fn differ(
        &mut self,
        (grid, sorted_at): (&Grid, &[Vector]),
        strips: &[Shifts],
        size: f64,
        most: f64,
    ) -> bool {
        self.collect((grid, sorted_at), strips, size);
        let rows = self.shifts.len() / self.columns;
        let is_apart = |row: usize, column: usize| {
            let own = self.shifts[row * self.columns + column];
            let left = column.saturating_sub(1);
            let right = (column + 1).min(self.columns - 1);
            let beside = (row, right..=right);
            let above = ((row + 1).min(rows - 1), left..=right);
            [beside, above].into_iter().any(|(row, columns)| {
                let others = &self.shifts[row * self.columns..][columns];
                let mut others = others.iter().filter(|other| !other.is_empty());
                others.any(|&other| own.and(other).difference() > most * most)
            })
        };
        let mut places =
            (0..rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        places.any(|(row, column)| {
            let own = self.shifts[row * self.columns + column];
            !own.is_empty() && (own.difference() > most * most || is_apart(row, column))
        })
    }

    /// Adds each strip to all tiles in which it has agents.
    fn collect(&mut self, (grid, sorted_at): (&Grid, &[Vector]), strips: &[Shifts], size: f64) {
        let [columns, rows] = grid.size();
        let [wide, high] = grid.cells_within(size);
        self.columns = columns.div_ceil(wide);
        self.shifts.clear();
        self.shifts
            .resize(self.columns * rows.div_ceil(high), Shifts::default());
        for (agents, &strip) in sorted_at.chunks(STRIP).zip(strips) {
            let (Some(&first), Some(&last)) = (agents.first(), agents.last()) else {
                continue;
            };
            let ([from, bottom], [to, top]) =
                (grid.column_and_row(first), grid.column_and_row(last));
            for row in bottom..=top {
                let from = if row == bottom { from } else { 0 };
                let to = if row == top { to } else { columns - 1 };
                let first = row / high * self.columns;
                for tile in &mut self.shifts[first + from / wide..=first + to / wide] {
                    *tile = tile.and(strip);
                }
            }
        }
    }
}
