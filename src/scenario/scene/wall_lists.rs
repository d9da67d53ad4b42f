//! An upper bound on the size of the lists of walls near agents, without building the lists.

use engine::agents::Agents;
use engine::geometry::{Wall, Walls};
use engine::math::{Vector, bounds};
use engine::scene::Scene;

/// Most cells per side.
const MOST_CELLS: f64 = 1024.0;
/// Cells per reach: more cells make the bound tighter.
const CELLS_PER_REACH: f64 = 4.0;
/// Below this (a few megabytes), agents times walls is a good enough bound.
const FEW_ENTRIES: u64 = 1 << 20;
/// Most agents per square meter: twice the density of the paper's crowds.
const DENSEST: f64 = 20.0;

/// Upper bound on the entries of the wall lists of `agents` agents.
///
/// Agents move, so the bound packs them as densely as possible where the lists are longest.
pub fn entries(scene: &Scene, agents: u64) -> u64 {
    let ranges = scene.ranges(&scene.needs(), &Agents::default());
    let radii = scene.agents.iter().filter_map(|agent| agent.radius);
    let widest = radii.fold(ranges.support.max(ranges.longest_step), f64::max);
    let reaches = [Some(widest), ranges.avoidance];
    let given = reaches.into_iter().flatten();
    let bounds = given.map(|reach| bound(&scene.walls, reach + ranges.drift, agents));
    bounds.fold(0, u64::saturating_add)
}

fn bound(walls: &Walls, reach: f64, agents: u64) -> u64 {
    let every = agents.saturating_mul(walls.len() as u64);
    if every <= FEW_ENTRIES {
        return every;
    }
    let cells = Cells::over(walls, reach);
    let mut counts = cells.count(walls, reach);
    counts.sort_unstable_by(|a, b| b.cmp(a));
    let capacity = ((DENSEST * cells.side * cells.side).ceil() as u64).max(1);
    let (mut left, mut entries) = (agents, 0_u64);
    for walls in counts {
        if left == 0 || walls == 0 {
            break;
        }
        let here = left.min(capacity);
        entries = entries.saturating_add(here.saturating_mul(walls));
        left -= here;
    }
    entries
}

/// A grid of square cells that covers all points within reach of a wall.
struct Cells {
    corner: Vector,
    side: f64,
    columns: usize,
    rows: usize,
}

impl Cells {
    fn over(walls: &Walls, reach: f64) -> Self {
        let ends = walls.iter().flat_map(|wall| [wall.start, wall.end]);
        let [min, max] = bounds(ends).unwrap_or_default();
        let margin = Vector::repeat(reach);
        let (corner, size) = (min - margin, max - min + 2.0 * margin);
        let side = (reach / CELLS_PER_REACH).max(size.amax() / MOST_CELLS);
        let cells = |length: f64| (length / side).floor() as usize + 1;
        Self {
            corner,
            side,
            columns: cells(size.x),
            rows: cells(size.y),
        }
    }

    /// For each cell, an upper bound on the walls within `reach` of a point in it. For each row of cells, a wall
    /// is clipped to the row's height ± reach and counted in the columns of this part ± reach.
    fn count(&self, walls: &Walls, reach: f64) -> Vec<u64> {
        let width = self.columns + 1;
        // First the differences between neighboring cells in a row.
        let mut counts = vec![0_i64; width * self.rows];
        for wall in walls.iter() {
            let (low, high) = (
                wall.start.y.min(wall.end.y) - reach,
                wall.start.y.max(wall.end.y) + reach,
            );
            let [first, last] = [low, high].map(|y| self.place(y - self.corner.y, self.rows));
            for row in first..=last {
                let y = self.corner.y + row as f64 * self.side;
                let Some([left, right]) = span(wall, y - reach, y + self.side + reach) else {
                    continue;
                };
                let [left, right] = [left - reach, right + reach]
                    .map(|x| self.place(x - self.corner.x, self.columns));
                counts[row * width + left] += 1;
                counts[row * width + right + 1] -= 1;
            }
        }
        let rows = counts.chunks_exact(width).flat_map(|row| {
            row[..self.columns].iter().scan(0_i64, |sum, difference| {
                *sum += difference;
                Some(sum.unsigned_abs())
            })
        });
        rows.collect()
    }

    /// The index of the cell that contains a coordinate, at most `cells - 1`.
    fn place(&self, along: f64, cells: usize) -> usize {
        ((along / self.side).floor() as usize).min(cells - 1)
    }
}

/// The extent in x of the part of a wall between two heights; `None` if there is no such part.
fn span(wall: &Wall, low: f64, high: f64) -> Option<[f64; 2]> {
    let (a, b) = match wall.start.y <= wall.end.y {
        true => (wall.start, wall.end),
        false => (wall.end, wall.start),
    };
    if b.y < low || a.y > high {
        return None;
    }
    let rise = b.y - a.y;
    let at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / rise).clamp(0.0, 1.0);
    let ends = match rise > 0.0 {
        true => [at(low), at(high)],
        false => [a.x, b.x],
    };
    Some([ends[0].min(ends[1]), ends[0].max(ends[1])])
}
