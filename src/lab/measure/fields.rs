//! Mean fields over time on a grid: the kernel density at cell centers instead of at people.

use std::ops::Range;

use rayon::prelude::*;

use super::options::MOST_CELLS;
use super::person::Person;
use super::view::View;
use analysis::site::{Kernel, Site};
use analysis::way_field::Grid;
use engine::kernel;
use engine::math::Vector;

/// Rows of cells per parallel task.
const BAND: usize = 8;

/// Whole cells that cover a rectangle; `None` if there are too many. Fields are evaluated at their centers.
pub fn cells_over(low: Vector, high: Vector, cell: f64) -> Option<Grid> {
    let min = (low / cell).map(f64::floor);
    let count = (high / cell).map(f64::ceil) - min;
    let [columns, rows] = [count.x, count.y].map(|n| n.max(1.0));
    (columns * rows <= MOST_CELLS as f64).then(|| Grid {
        min: min * cell,
        cell,
        columns: columns as usize,
        rows: rows as usize,
    })
}

/// Sums over people and frames for one cell.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Σ m W.
    mass: f64,
    /// Σ m W over people with a known velocity, then Σ m W v and Σ m W |v| over the same people.
    moving: f64,
    momentum: Vector,
    speed: f64,
    /// Number of positions in the cell.
    people: u64,
}

/// Mean over time for one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// ρ, P/m².
    pub density: f64,
    /// J/ρ, m/s; `None` if no person with a known velocity came near.
    pub velocity: Option<Vector>,
    /// Mean speed with the same weights, m/s.
    pub speed: Option<f64>,
    /// Mean number of people in the cell.
    pub people: f64,
}

/// Fields while they are summed.
pub struct Fields {
    /// The grid.
    pub grid: Grid,
    kernel: Kernel,
    sums: Vec<Sums>,
    views: Vec<Option<View>>,
}

impl Fields {
    /// Fields without any sums yet.
    pub fn new(grid: Grid, site: &Site, kernel: Kernel) -> Self {
        let view = |k| View::new(site, &kernel, grid.center(k));
        Self {
            views: (0..grid.len()).into_par_iter().map(view).collect(),
            sums: vec![Sums::default(); grid.len()],
            grid,
            kernel,
        }
    }

    /// Forgets all people.
    pub fn clear(&mut self) {
        self.sums.fill(Sums::default());
    }

    /// Adds people of some frames. Bands of cells are summed in parallel, each in the order of the people, so that the
    /// result is the same on any number of threads.
    pub fn add(&mut self, people: &[&Person], site: &Site) {
        let (grid, views, h) = (&self.grid, &self.views, self.kernel.support_radius);
        let bands = self.sums.par_chunks_mut(BAND * grid.columns).enumerate();
        bands.for_each(|(band, sums)| {
            let rows = band * BAND..(band * BAND + sums.len() / grid.columns);
            let edge = |row: usize| grid.min.y + row as f64 * grid.cell;
            let (low, high) = (edge(rows.start) - h, edge(rows.end) + h);
            let near = |person: &&&Person| (low..high).contains(&person.position.y);
            for person in people.iter().filter(near) {
                spread((grid, site, views), rows.clone(), sums, person, h);
            }
        });
    }

    /// The means over `frames` frames, cell by cell; `None` inside obstacles.
    pub fn means(&self, frames: u64) -> impl Iterator<Item = Option<Mean>> + '_ {
        self.sums.iter().zip(&self.views).map(move |(sums, view)| {
            let seen = view.as_ref()?.visible();
            let is_known = sums.moving > 0.0;
            Some(Mean {
                density: sums.mass / seen / frames as f64,
                velocity: is_known.then(|| sums.momentum / sums.moving),
                speed: is_known.then(|| sums.speed / sums.moving),
                people: sums.people as f64 / frames as f64,
            })
        })
    }
}

/// Adds a person's kernel to the cells in `rows` that it reaches and from which the person is visible.
fn spread(
    (grid, site, views): (&Grid, &Site, &[Option<View>]),
    rows: Range<usize>,
    sums: &mut [Sums],
    person: &Person,
    h: f64,
) {
    let place = (person.position - grid.min) / grid.cell;
    // Cells whose centers are within reach, and the person's own cell.
    let reach = (h / grid.cell).max(0.5);
    let first = |x: f64| (x - reach - 0.5).ceil().max(0.0) as usize;
    let end = |x: f64, most: usize| ((x + reach + 0.5).ceil().max(0.0) as usize).min(most);
    let own = [place.x, place.y].map(|x| x.floor());
    for row in first(place.y).max(rows.start)..end(place.y, rows.end) {
        let dy = (row as f64 + 0.5 - place.y) * grid.cell;
        for column in first(place.x)..end(place.x, grid.columns) {
            let dx = (column as f64 + 0.5 - place.x) * grid.cell;
            let weight = person.mass * kernel::density(dx * dx + dy * dy, h);
            let k = row * grid.columns + column;
            let sums = &mut sums[k - rows.start * grid.columns];
            sums.people += u64::from(own == [column as f64, row as f64]);
            let view = views[k].as_ref();
            let seen = view.is_some_and(|view| view.sees(site, grid.center(k), person.eye));
            if weight == 0.0 || !seen {
                continue;
            }
            sums.mass += weight;
            if let Some(velocity) = person.velocity {
                sums.moving += weight;
                sums.momentum += velocity * weight;
                sums.speed += velocity.norm() * weight;
            }
        }
    }
}
