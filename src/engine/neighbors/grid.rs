//! A uniform grid over the crowd. Agents are sorted by cell, row by row, so that a run of cells in a row is a run
//! of agents in memory.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::Run;
use crate::levels::{Join, Levels};
use crate::math::{Vector, bounds};
use crate::period::Period;

/// The fewest agents per parallel task.
const SOME: usize = 4096;

/// The most cells per agent, and the limit on cells for small crowds: a crowd scattered over a wide area gets
/// larger cells instead of a larger grid.
const CELLS_PER_AGENT: usize = 4;
const FEWEST_CELLS: usize = 1024;

/// Height of a row over the width of its cells: with narrow cells, runs end near the circle they must cover.
const NARROWNESS: f64 = 8.0;

/// The lower left and the upper right corner of the rectangle around all agents.
fn extent(positions: &[Vector]) -> [Vector; 2] {
    let some = positions.par_chunks(SOME);
    let corners = some.filter_map(|some| bounds(some.iter().copied()));
    let all = corners.reduce_with(|[low, high], [a, b]| [low.inf(&a), high.sup(&b)]);
    all.unwrap_or_default()
}

/// The most cells over a building. With the cells at rest, people elsewhere change no sum.
const CELLS_OF_BUILDING: usize = 1 << 16;

/// The agents beyond a join that can be seen through it.
#[derive(Debug, Clone)]
struct Through {
    join: Join,
    /// Agents and their distances from the join, meters.
    agents: Vec<(u32, f64)>,
}

impl Through {
    /// Whether a box, given by its lower left and upper right corners, may be at most `radius` meters from the join.
    fn is_near(&self, [low, high]: [Vector; 2], radius: f64) -> bool {
        let [a, b] = self.join.line;
        let (before, after) = (a.inf(&b) - high, low - a.sup(&b));
        before.max().max(after.max()) <= radius
    }

    /// The agents at most `radius` meters from the join.
    fn within(&self, radius: f64) -> impl Iterator<Item = Run> + '_ {
        let all = self.agents.iter();
        all.filter(move |(_, distance)| *distance <= radius)
            .map(|&(agent, _)| Run {
                agents: agent..agent + 1,
                laps: -self.join.to,
            })
    }
}

/// A position in a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The row, neither the first nor the last.
    pub row: usize,
    /// Distance from the left end of the row, meters.
    pub x: f64,
    /// Distance from the lower edge of the row, meters.
    pub y: f64,
}

/// The cells of a bounding box, with an empty row below and above it, and the range of agents in each cell.
#[derive(Debug, Clone)]
pub struct Grid {
    origin: Vector,
    height: f64,
    width: f64,
    /// Cells per meter, along the rows and across.
    per_meter: Vector,
    columns: usize,
    rows: usize,
    /// Repeats the cells.
    period: Option<Period>,
    levels: Option<Arc<Levels>>,
    /// What is seen through each of their joins.
    through: Vec<Through>,
    /// The first agent of each cell, row by row; the last entry is the number of agents.
    start: Vec<u32>,
    /// The cell of each agent before the sort: memory that every sort needs.
    cell_of: Vec<u32>,
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            origin: Vector::zeros(),
            height: 1.0,
            width: 1.0,
            per_meter: Vector::repeat(1.0),
            columns: 1,
            rows: 3,
            period: None,
            levels: None,
            through: Vec::new(),
            start: vec![0; 4],
            cell_of: Vec::new(),
        }
    }
}

impl Grid {
    /// A grid over levels, or over wherever agents are.
    pub fn on(levels: Option<Arc<Levels>>) -> Self {
        Self {
            levels,
            ..Self::default()
        }
    }

    /// Lays a grid with rows of at least `height` meters over `positions`, and finds the order that sorts them by cell.
    /// The sort is stable. All positions lie in the `period`, if there is one.
    pub fn rebuild(
        &mut self,
        positions: &[Vector],
        height: f64,
        period: Option<Period>,
        order: &mut Vec<u32>,
    ) {
        self.period = period;
        let [low, high] = match &self.levels {
            Some(levels) => levels.extent(),
            None => extent(positions),
        };
        self.size_cells(high - low, positions.len(), height);
        self.origin = low - Vector::new(0.0, self.height);

        let mut cell_of = std::mem::take(&mut self.cell_of);
        cell_of.clear();
        let cells = positions.par_iter().with_min_len(SOME);
        cell_of.par_extend(cells.map(|&p| self.cell_of(p) as u32));
        // Entry c + 2 counts the agents of cell c; from the sums on, entry c + 1 is where the next agent of cell c
        // goes.
        let cells = self.cells();
        self.start.clear();
        self.start.resize(cells + 2, 0);
        for &cell in &cell_of {
            self.start[cell as usize + 2] += 1;
        }
        let mut before = 0;
        for count in &mut self.start {
            before += *count;
            *count = before;
        }
        order.resize(positions.len(), 0);
        for (i, &cell) in cell_of.iter().enumerate() {
            let next = &mut self.start[cell as usize + 1];
            order[*next as usize] = i as u32;
            *next += 1;
        }
        self.start.truncate(cells + 1);
        self.cell_of = cell_of;
    }

    /// Finds who is seen through the joins of levels: those beyond a join and at most `radius` meters from it. All
    /// agents are at the `positions` over which the grid was laid, in order.
    pub fn look_through(&mut self, positions: &[Vector], radius: f64) {
        let Some(levels) = self.levels.clone() else {
            return;
        };
        let seen = levels.joins().iter().map(|join| {
            let way = levels.way(join.to);
            let [a, b] = join.line.map(|p| p + way);
            let rows = self.own_rows([a.inf(&b), a.sup(&b)], radius);
            let agents = rows.flatten().filter_map(|j| {
                let p = positions[j as usize] - way;
                let distance = join.distance_squared(p).sqrt();
                (!join.is_before(p) && distance <= radius).then_some((j, distance))
            });
            Through {
                join: *join,
                agents: agents.collect(),
            }
        });
        self.through = seen.collect();
    }

    /// Whether agents at two places see the same agents through joins, as far as they see.
    pub fn see_alike(&self, p: Vector, other: Vector) -> bool {
        self.joins_at(p)
            .iter()
            .all(|through| through.join.is_beyond(p) == through.join.is_beyond(other))
    }

    /// What is seen through the joins of the level at `p`.
    fn joins_at(&self, p: Vector) -> &[Through] {
        match &self.levels {
            Some(levels) if !self.through.is_empty() => &self.through[levels.joins_at(p)],
            _ => &[],
        }
    }

    /// The agents that somebody at `viewer` sees through joins, within `radius` meters of a box, and some farther away.
    fn through_joins(
        &self,
        viewer: Vector,
        corners: [Vector; 2],
        radius: f64,
    ) -> impl Iterator<Item = Run> + '_ {
        let open = self.open_joins(viewer, corners, radius);
        open.flat_map(move |through| through.within(radius))
    }

    /// The joins before which somebody at `viewer` is, within `radius` meters of a box.
    fn open_joins(
        &self,
        viewer: Vector,
        corners: [Vector; 2],
        radius: f64,
    ) -> impl Iterator<Item = &Through> {
        let of_level = self.joins_at(viewer).iter();
        of_level.filter(move |through| {
            through.is_near(corners, radius) && !through.join.is_beyond(viewer)
        })
    }

    /// Doubles the cell size, from the smallest, until the number of cells is within the limit.
    fn size_cells(&mut self, extent: Vector, agents: usize, height: f64) {
        let is_at_rest = self.levels.is_some();
        let most = match is_at_rest {
            true => CELLS_OF_BUILDING,
            false => (agents * CELLS_PER_AGENT).max(FEWEST_CELLS),
        } as f64;
        self.height = height.max(f64::MIN_POSITIVE); // so that doubling makes it grow
        self.width = (self.height / NARROWNESS).max(f64::MIN_POSITIVE);
        // If the extent is NaN, `max` gives the fewest columns or rows; the NaN is found and reported later.
        let columns = |width: f64| ((extent.x / width).floor() + 1.0).max(1.0);
        let rows = |height: f64| ((extent.y / height).floor() + 3.0).max(3.0);
        while columns(self.width) * rows(self.height) > most {
            if self.width < self.height || (is_at_rest && columns(self.width) > 1.0) {
                self.width *= 2.0;
            } else {
                self.width *= 2.0;
                self.height *= 2.0;
            }
        }
        self.per_meter = Vector::new(1.0 / self.width, 1.0 / self.height);
        self.columns = columns(self.width) as usize;
        self.rows = rows(self.height) as usize;
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// The height of the rows, meters.
    pub fn height(&self) -> f64 {
        self.height
    }

    /// The numbers of columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.rows]
    }

    /// The fewest columns and rows that are at least `meters` wide and high.
    pub fn cells_within(&self, meters: f64) -> [usize; 2] {
        [self.width, self.height].map(|side| ((meters / side).ceil() as usize).max(1))
    }

    /// The column and the row of `p`, one of the positions over which the grid was laid.
    pub fn column_and_row(&self, p: Vector) -> [usize; 2] {
        let offset = p - self.origin;
        let column = ((offset.x / self.width) as usize).min(self.columns - 1);
        let row = ((offset.y / self.height) as usize).min(self.rows - 2);
        [column, row]
    }

    fn cell_of(&self, p: Vector) -> usize {
        let [column, row] = self.column_and_row(p);
        row * self.columns + column
    }

    /// The place of `p`, one of the positions over which the grid was laid.
    pub fn place(&self, p: Vector) -> Place {
        let offset = p - self.origin;
        let row = ((offset.y / self.height) as usize).clamp(1, self.rows - 2);
        Place {
            row,
            x: offset.x,
            y: offset.y - row as f64 * self.height,
        }
    }

    /// The agents in the cells of a row from `from` to `to`, meters from the left end of the row.
    pub fn run(&self, row: usize, from: f64, to: f64) -> Range<u32> {
        let column = |x: f64| ((x * self.per_meter.x) as usize).min(self.columns - 1);
        let first = row * self.columns;
        self.start[first + column(from)]..self.start[first + column(to) + 1]
    }

    /// The agents in all cells within `radius` meters of a box, given by its lower left and upper right corners, row by
    /// row, then those that somebody at `viewer` sees across the ends of the period or through joins. Some agents are
    /// out of reach.
    pub fn rows(
        &self,
        viewer: Vector,
        corners: [Vector; 2],
        radius: f64,
    ) -> impl Iterator<Item = Run> + '_ {
        let rows = self.own_rows(corners, radius).map(Run::from);
        rows.chain(self.across(viewer, corners, radius))
    }

    fn own_rows(
        &self,
        [low, high]: [Vector; 2],
        radius: f64,
    ) -> impl Iterator<Item = Range<u32>> + '_ {
        let (low, high) = (low - self.origin, high - self.origin);
        let row = move |y: f64| ((y / self.height) as usize).min(self.rows - 1);
        (row(low.y - radius)..=row(high.y + radius)).map(move |row| {
            let floor = row as f64 * self.height;
            let gap = (floor - high.y).max(low.y - floor - self.height).max(0.0);
            let half = (radius * radius - gap * gap).max(0.0).sqrt();
            self.run(row, low.x - half, high.x + half)
        })
    }

    /// The agents that are seen elsewhere than they are, within `radius` meters of a box, and some farther away: across
    /// the ends of the period, and by somebody at `viewer` through joins of levels.
    pub fn across(
        &self,
        viewer: Vector,
        corners: [Vector; 2],
        radius: f64,
    ) -> impl Iterator<Item = Run> + '_ {
        let of_period = self.across_period(corners, radius);
        of_period.chain(self.through_joins(viewer, corners, radius))
    }

    /// The agents in all cells within `radius` meters of a box across the ends of the period; none without period.
    fn across_period(
        &self,
        [low, high]: [Vector; 2],
        radius: f64,
    ) -> impl Iterator<Item = Run> + '_ {
        let sides = self.period.map(|period| {
            [-1, 1].map(|laps| {
                let corners = [low, high].map(|p| p - period.way(laps));
                let is_near = self.is_near(corners, radius);
                (laps, is_near.then_some(corners))
            })
        });
        sides
            .into_iter()
            .flatten()
            .flat_map(move |(laps, corners)| {
                let rows = corners.into_iter();
                let rows = rows.flat_map(move |corners| self.own_rows(corners, radius));
                let rows = rows.filter(|agents| !agents.is_empty());
                rows.map(move |agents| Run { agents, laps })
            })
    }

    /// Appends the agents in all cells that a rectangle reaches into, given by its lower left and upper right corners,
    /// row by row, then those seen across the ends of the period, and those that somebody at `viewer` sees through
    /// joins of levels.
    pub fn inside(&self, viewer: Option<Vector>, [low, high]: [Vector; 2], found: &mut Vec<Run>) {
        let [across, up] = [self.columns, self.rows].map(|count| (count - 1) as f64);
        let place = |p: Vector| {
            let cell = (p - self.origin).component_mul(&self.per_meter);
            [
                cell.x.clamp(0.0, across) as usize,
                cell.y.clamp(0.0, up) as usize,
            ]
        };
        let ([left, bottom], [right, top]) = (place(low), place(high));
        for row in bottom..=top {
            let first = row * self.columns;
            let agents = self.start[first + left]..self.start[first + right + 1];
            if !agents.is_empty() {
                found.push(Run::from(agents));
            }
        }
        if self.period.is_some() {
            found.extend(self.across_period([low, high], 0.0));
        }
        if let Some(viewer) = viewer {
            // All that are listed: those in the rectangle may stand far from the join.
            let open = self.open_joins(viewer, [low, high], 0.0);
            found.extend(open.flat_map(|through| through.within(f64::INFINITY)));
        }
    }

    /// Whether a box is within `radius` meters of the cells.
    fn is_near(&self, [low, high]: [Vector; 2], radius: f64) -> bool {
        let extent = Vector::new(
            self.columns as f64 * self.width,
            self.rows as f64 * self.height,
        );
        let (low, high) = (low - self.origin, high - self.origin);
        let (before, after) = (high.add_scalar(radius), low.add_scalar(-radius) - extent);
        before.min() >= 0.0 && after.max() <= 0.0
    }

    /// Appends the agents nearer to `p` than `radius` meters, each as a run of its own. When the grid was laid, they
    /// were less than `margin` meters farther from `place`.
    pub fn each_near(
        &self,
        [place, p]: [Vector; 2],
        positions: &[Vector],
        [radius, margin]: [f64; 2],
        found: &mut Vec<Run>,
    ) {
        for Run { agents, laps } in self.rows(place, [place; 2], radius + margin) {
            let p = self.seen_from(p, laps);
            let near = agents.filter(|&j| (p - positions[j as usize]).norm() < radius);
            found.extend(near.map(|j| Run {
                agents: j..j + 1,
                laps,
            }));
        }
    }

    /// The place from which an agent at `p` sees the agents of a run, meters.
    pub fn seen_from(&self, p: Vector, laps: i32) -> Vector {
        if laps == 0 {
            return p;
        }
        p - self.way() * f64::from(laps)
    }

    /// The way of one lap: over the period, or from a level to the next, meters; zero without either.
    pub fn way(&self) -> Vector {
        let of_levels = self.levels.as_ref().map(|levels| levels.way(1));
        let of_period = self.period.map(|period| period.way(1));
        of_period.or(of_levels).unwrap_or_default()
    }

    /// Whether agents may be seen elsewhere than they are.
    pub fn has_images(&self) -> bool {
        self.period.is_some() || self.levels.is_some()
    }

    /// The period of the cells.
    pub fn period(&self) -> Option<&Period> {
        self.period.as_ref()
    }
}
