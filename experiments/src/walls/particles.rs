//! Walls made of boundary particles, as in fluids: fixed particles that fill the obstacles.

use super::integrals::Integrals;
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::kernel;
use sandbox::engine::math::{Vector, bounds};

/// Cells with a smaller fraction of their area inside an obstacle stay empty.
const LEAST_PART: f64 = 1e-9;

/// The positions of the particles in the cells of the lattice, and the area of solid that each stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Volumes {
    /// A particle at the center of every cell whose center is solid. It stands for the whole cell: *regularly sampled
    /// positions inside obstacles* (§3.4). Walls become stairs, and thin ones have holes.
    Whole,
    /// A particle at the centroid of the solid part of every cell. It stands for that part: a quadrature of the solid,
    /// and the choice that favors particles most.
    Cut,
    /// The same positions, with V_b = 1 / Σ W(x_b − x_c) over all boundary particles c, including b (Akinci, Ihmsen,
    /// Akinci, Solenthaler and Teschner 2012, *Versatile rigid-fluid coupling for incompressible SPH*, doi
    /// 10.1145/2185520.2185558). Deep in a solid it is the cell's area, at a straight wall up to twice that. A thin
    /// wall weighs even more than a thick one.
    Akinci,
}

/// A square lattice over all obstacles, with a particle in each solid cell.
///
/// The mass of a particle is ρ_i⁰ V_b and its pressure p_i (*pressure mirroring*), as for the other methods.
#[derive(Debug, Clone)]
pub struct Particles {
    spacing: f64,
    corner: Vector,
    columns: usize,
    rows: usize,
    /// Index of the first particle of each cell, row by row, and the number of particles.
    starts: Vec<u32>,
    position: Vec<Vector>,
    volume: Vec<f64>,
    h: f64,
}

impl Particles {
    /// Fills the obstacles; `spacing` in meters.
    pub fn fill(walls: &Walls, spacing: f64, volumes: Volumes, h: f64) -> Self {
        let obstacles = walls.obstacles().iter();
        let points = obstacles.flat_map(Polygon::points).copied();
        let [low, high] = bounds(points).unwrap_or_default();
        // All obstacles share one lattice.
        let corner = (low / spacing).map(f64::floor) * spacing;
        let cells = ((high - corner) / spacing).map(f64::ceil);
        let mut particles = Self {
            spacing,
            corner,
            columns: cells.x as usize,
            rows: cells.y as usize,
            starts: vec![0],
            position: Vec::new(),
            volume: Vec::new(),
            h,
        };
        for cell in 0..particles.columns * particles.rows {
            particles.fill_cell(walls, cell, volumes);
        }
        if volumes == Volumes::Akinci {
            let weight = |x: &Vector| -> f64 {
                let offsets = particles.near(*x).map(|c| particles.position[c] - x);
                offsets.map(|r| kernel::density(r.norm_squared(), h)).sum()
            };
            let volumes = particles.position.iter().map(|x| 1.0 / weight(x));
            particles.volume = volumes.collect();
        }
        particles
    }

    fn fill_cell(&mut self, walls: &Walls, cell: usize, volumes: Volumes) {
        let step = Vector::new((cell % self.columns) as f64, (cell / self.columns) as f64);
        let low = self.corner + step * self.spacing;
        let square = self.spacing * self.spacing;
        for obstacle in walls.obstacles() {
            let (volume, middle) = if volumes == Volumes::Whole {
                let middle = low + Vector::repeat(0.5 * self.spacing);
                (f64::from(obstacle.contains(middle)) * square, middle)
            } else {
                let high = low + Vector::repeat(self.spacing);
                let whole = [
                    low,
                    Vector::new(high.x, low.y),
                    high,
                    Vector::new(low.x, high.y),
                ];
                let whole = obstacle.is_unbounded().then_some(whole.to_vec());
                let rings = obstacle.rings().map(|ring| clipped(ring, low, high));
                area_and_middle(rings.chain(whole), low)
            };
            if volume > LEAST_PART * square {
                self.position.push(middle);
                self.volume.push(volume);
            }
        }
        self.starts.push(self.position.len() as u32);
    }

    /// The sums over the particles within reach of an agent at `r_i`.
    pub fn integrals(&self, r_i: Vector) -> Integrals {
        let piece = |b: usize| Integrals::of_piece(self.position[b] - r_i, self.volume[b], self.h);
        self.near(r_i).map(piece).sum()
    }

    /// All particles within reach of `x`, and few others: in each row of the lattice, the cells along the chord.
    fn near(&self, x: Vector) -> impl Iterator<Item = usize> {
        let from = (x - self.corner) / self.spacing;
        let reach = self.h / self.spacing;
        let within = |low: f64, high: f64, cells: usize| {
            let end = (high.floor() + 1.0).clamp(0.0, cells as f64) as usize;
            (low.floor().max(0.0) as usize).min(end)..end
        };
        within(from.y - reach, from.y + reach, self.rows).flat_map(move |row| {
            let below = row as f64 - from.y;
            let across = below.max(-below - 1.0).max(0.0);
            let half = (reach * reach - across * across).max(0.0).sqrt();
            let columns = within(from.x - half, from.x + half, self.columns);
            let start = |column: usize| self.starts[row * self.columns + column] as usize;
            start(columns.start)..start(columns.end)
        })
    }

    /// Memory of the particles and of the lattice that finds them, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.position) + size_of_val(&*self.volume) + size_of_val(&*self.starts)
    }
}

/// A polygon clipped to a cell, side by side (Sutherland and Hodgman 1974). Separate parts stay connected by edges that
/// enclose no area.
fn clipped(points: &[Vector], low: Vector, high: Vector) -> Vec<Vector> {
    let sides: [&dyn Fn(&Vector) -> f64; 4] = [
        &|p| p.x - low.x,
        &|p| high.x - p.x,
        &|p| p.y - low.y,
        &|p| high.y - p.y,
    ];
    sides.into_iter().fold(points.to_vec(), |kept, depth| {
        let mut next = Vec::with_capacity(kept.len() + 4);
        for (k, &a) in kept.iter().enumerate() {
            let b = kept[(k + 1) % kept.len()];
            let (before, after) = (depth(&a), depth(&b));
            if before >= 0.0 {
                next.push(a);
            }
            if (before >= 0.0) != (after >= 0.0) {
                next.push(a + (b - a) * (before / (before - after)));
            }
        }
        next
    })
}

/// Area in m² and centroid of the region that counterclockwise outlines enclose, without the clockwise ones, by
/// triangles from `origin`.
fn area_and_middle(outlines: impl Iterator<Item = Vec<Vector>>, origin: Vector) -> (f64, Vector) {
    let (mut area, mut moment) = (0.0, Vector::zeros());
    for outline in outlines {
        for (k, a) in outline.iter().enumerate() {
            let (a, b) = (a - origin, outline[(k + 1) % outline.len()] - origin);
            let triangle = 0.5 * a.perp(&b);
            area += triangle;
            moment += (a + b) * (triangle / 3.0);
        }
    }
    (area, origin + moment / area)
}
