//! The forces of people on walls: the reactions to the pressure (Eq. 12) and contact (Eq. 23) of walls.
//!
//! Each force acts at the point of the wall that is nearest to the agent. Its component normal to the wall is added to
//! a cell of at most 0.2 m of the wall; the force per meter is the mean over 1 m of the outline of the obstacle, around
//! corners, too.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::evaluated::Evaluated;
use super::exposure::{Spell, Weight};
use engine::geometry::Walls;
use engine::math::Vector;
use engine::simulation::Simulation;

/// The longest cell, meters.
const CELL: f64 = 0.2;
/// The length of outline over which forces are averaged, meters.
pub const WINDOW: f64 = 1.0;
/// The least design load of railings where crowds gather, N/m (EN 1991-1-1, Table 6.12, category C5: 3 to 5 kN/m). A
/// value from a code, not a safety limit.
pub const DESIGN_LOAD: f64 = 3000.0;

/// A part of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// The wall.
    pub wall: u32,
    /// Its ends, meters.
    pub ends: [Vector; 2],
}

impl Cell {
    fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }
}

/// The outlines of all obstacles, in cells.
#[derive(Debug, Clone, Default)]
pub struct Outlines {
    /// Wall by wall.
    cells: Vec<Cell>,
    /// The first cell of each wall, and the end.
    first: Vec<usize>,
    /// The cells of each outline.
    rings: Vec<Range<usize>>,
}

impl Outlines {
    /// The outlines of all walls.
    pub fn new(walls: &Walls) -> Self {
        let mut outlines = Self::default();
        let mut ring = 0;
        for (k, wall) in walls.iter().enumerate() {
            let count = (wall.length() / CELL).ceil().max(1.0) as usize;
            let way = wall.end - wall.start;
            let at = |part: usize| wall.start + way * (part as f64 / count as f64);
            outlines.first.push(outlines.cells.len());
            outlines.cells.extend((0..count).map(|part| Cell {
                wall: k as u32,
                ends: [at(part), at(part + 1)],
            }));
            // The walls of a ring follow each other; the first one comes after the last.
            if k + 1 == walls.len() || walls.wall(k as u32 + 1).previous as usize != k {
                outlines.rings.push(ring..outlines.cells.len());
                ring = outlines.cells.len();
            }
        }
        outlines.first.push(outlines.cells.len());
        outlines
    }

    /// All cells.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The ends of the cells with a force on them in an evaluated frame, meters, each with its force per meter, N/m.
    pub fn pressed(
        &self,
        simulation: &Simulation,
        body_mass: f64,
    ) -> impl Iterator<Item = ([Vector; 2], f64)> {
        let forces = self.per_meter(&self.forces(&Evaluated::new(simulation), body_mass));
        let cells = self.cells.iter().map(|cell| cell.ends).zip(forces);
        cells.filter(|&(_, force)| force > 0.0)
    }

    /// The force on each cell in an evaluated frame, newtons.
    pub fn forces(&self, evaluated: &Evaluated, body_mass: f64) -> Vec<f64> {
        let frame = evaluated.simulation.frame();
        let mut forces = vec![0.0; self.cells.len()];
        for push in evaluated.wall_pushes() {
            let (wall, own) = (frame.walls.wall(push.wall), self.first[push.wall as usize]);
            let count = self.first[push.wall as usize + 1] - own;
            let part = (push.nearest - wall.start).dot(&wall.tangent) / wall.length();
            let cell = ((part * count as f64) as usize).min(count - 1);
            // Contact counts both faces of a thin wall.
            let normal = push.push.dot(&wall.normal).abs();
            forces[own + cell] += normal * frame.agents.mass[push.agent] * body_mass;
        }
        forces
    }

    /// The mean of `forces` over [`WINDOW`] around the middle of each cell, N/m. An outline that is shorter counts as
    /// that long.
    pub fn per_meter(&self, forces: &[f64]) -> Vec<f64> {
        let mut means = vec![0.0; forces.len()];
        for ring in &self.rings {
            let (cells, forces) = (&self.cells[ring.clone()], &forces[ring.clone()]);
            let total: f64 = forces.iter().sum();
            if total == 0.0 {
                continue;
            }
            let sums = Sums::of(cells.iter().map(Cell::length), forces);
            let mut cells = [0; 2];
            for (k, mean) in means[ring.clone()].iter_mut().enumerate() {
                let middle = 0.5 * (sums.lengths[k] + sums.lengths[k + 1]);
                let low = sums.at(middle - 0.5 * WINDOW, &mut cells[0]);
                let high = sums.at(middle + 0.5 * WINDOW, &mut cells[1]);
                let within = if sums.length() > WINDOW {
                    high - low
                } else {
                    total
                };
                *mean = within / WINDOW;
            }
        }
        means
    }

    /// The point where `forces` act on average within half a [`WINDOW`] of cell `k`, meters.
    fn center(&self, k: usize, forces: &[f64]) -> Vector {
        let middle = |cell: &Cell| (cell.ends[0] + cell.ends[1]) * 0.5;
        let here = middle(&self.cells[k]);
        let near = |cell: &Cell| (middle(cell) - here).norm() <= 0.5 * WINDOW;
        let own = self.rings.iter().find(|ring| ring.contains(&k));
        let ring = own.cloned().unwrap_or_default();
        let parts = self.cells[ring.clone()].iter().zip(&forces[ring]);
        let (mut sum, mut total) = (Vector::zeros(), 0.0);
        for (cell, &force) in parts.filter(|(cell, _)| near(cell)) {
            sum += middle(cell) * force;
            total += force;
        }
        if total > 0.0 { sum / total } else { here }
    }
}

/// Sums along an outline.
struct Sums {
    /// The lengths up to the ends of the cells, meters, from 0.
    lengths: Vec<f64>,
    /// The forces up to there, newtons, from 0.
    forces: Vec<f64>,
}

impl Sums {
    fn of(lengths: impl Iterator<Item = f64>, forces: &[f64]) -> Self {
        let mut sums = Self {
            lengths: vec![0.0],
            forces: vec![0.0],
        };
        let (mut length, mut force) = (0.0, 0.0);
        for (own, &more) in lengths.zip(forces) {
            length += own;
            force += more;
            sums.lengths.push(length);
            sums.forces.push(force);
        }
        sums
    }

    fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// The sum of the forces up to a place along the outline, which goes round and round. `k` is any cell, best one
    /// near this place, and becomes the cell of this place.
    fn at(&self, place: f64, k: &mut usize) -> f64 {
        let laps = (place / self.length()).floor();
        let place = place - laps * self.length();
        let last = self.lengths.len() - 2;
        while *k < last && self.lengths[*k + 1] <= place {
            *k += 1;
        }
        while *k > 0 && self.lengths[*k] > place {
            *k -= 1;
        }
        let k = *k;
        let part = (place - self.lengths[k]) / (self.lengths[k + 1] - self.lengths[k]);
        let total = self.forces[last + 1];
        laps * total + self.forces[k] + part * (self.forces[k + 1] - self.forces[k])
    }
}

/// The largest force per meter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// N/m.
    pub force: f64,
    /// Seconds.
    pub time: f64,
    /// The point where it acts on average, meters.
    pub place: Vector,
}

/// The largest force on a part of a wall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CellForce {
    /// The number of the wall.
    pub wall: u32,
    /// The ends of the part, meters.
    pub ends: [[f64; 2]; 2],
    /// The largest mean over 1 m around it, N/m.
    pub max_n_per_m: f64,
}

/// The observations of walls at several times.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct WallForces {
    /// Built from the walls at the first time.
    #[serde(skip)]
    outlines: Option<Outlines>,
    /// The largest force per meter so far.
    pub peak: Option<Peak>,
    /// By number: the largest force on each cell with a force above 0.
    most: BTreeMap<usize, CellForce>,
    /// The intervals with a force above [`DESIGN_LOAD`] somewhere.
    pub spell: Spell,
    weight: Weight,
    /// The most meters of wall above it at one time.
    pub meters: f64,
}

impl WallForces {
    /// Adds an evaluated frame.
    pub fn add(&mut self, evaluated: &Evaluated, body_mass: f64) {
        let frame = evaluated.simulation.frame();
        let known = self.outlines.take();
        let outlines = known.unwrap_or_else(|| Outlines::new(frame.walls));
        let forces = outlines.forces(evaluated, body_mass);
        let means = outlines.per_meter(&forces);
        let mut above = 0.0;
        for ((k, &force), cell) in means.iter().enumerate().zip(&outlines.cells) {
            if self.peak.is_none_or(|peak| force > peak.force) {
                let (time, place) = (frame.clock.time(), outlines.center(k, &forces));
                self.peak = Some(Peak { force, time, place });
            }
            above += if force > DESIGN_LOAD {
                cell.length()
            } else {
                0.0
            };
        }
        self.add_means(&outlines, &means);
        self.spell.add(above > 0.0, self.weight.of_next());
        self.meters = self.meters.max(above);
        self.outlines = Some(outlines);
    }

    /// Takes the means around all cells, N/m.
    fn add_means(&mut self, outlines: &Outlines, means: &[f64]) {
        let mut seen = self.most.iter_mut().peekable();
        let mut new = Vec::new();
        for ((k, &force), cell) in means.iter().enumerate().zip(&outlines.cells) {
            if let Some((_, most)) = seen.next_if(|(own, _)| **own == k) {
                most.max_n_per_m = most.max_n_per_m.max(force);
            } else if force > 0.0 {
                let most = CellForce {
                    wall: cell.wall,
                    ends: cell.ends.map(Into::into),
                    max_n_per_m: force,
                };
                new.push((k, most));
            }
        }
        self.most.extend(new);
    }

    /// The largest force on each part of the walls with a force above 0.
    pub fn of_cells(&self) -> impl Iterator<Item = &CellForce> {
        self.most.values()
    }
}
