//! Walls as a map: the effect of the solid on an agent, precomputed at the nodes of a grid.

use super::integrals::{Integrals, Region};
use sandbox::engine::geometry::Walls;
use sandbox::engine::math::{Vector, bounds};

/// Tolerance of the integrals at the nodes; the error of the interpolation is orders of magnitude larger.
const TOLERANCE: f64 = 1e-6;

/// What the nodes store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stored {
    /// ∫ W and ∫ ∇W over the solid, as the paper describes volume maps (§3.4) and as Koschier and Bender's
    /// density maps do (2017, *Density maps for improved SPH boundary handling*,
    /// doi 10.1145/3099564.3099565).
    Integrals,
    /// The solid's area a within reach and the nearest point r* of a wall. From them follow a W(r_i − r*) and a ∇W(r_i
    /// − r*): volume maps (Bender, Kugelstadt, Weiler and Koschier 2019, *Volume maps: an implicit boundary
    /// representation for SPH*, doi 10.1145/3359566.3360077). Their solid fades out into the free space; here it ends
    /// at the wall.
    Volume,
}

/// A square grid over the floor with bilinear interpolation.
#[derive(Debug, Clone)]
pub struct Map {
    stored: Stored,
    spacing: f64,
    corner: Vector,
    columns: usize,
    /// Row by row: ∫ W and ∫ ∇W, or a and r* − r_i.
    nodes: Vec<[f64; 3]>,
    h: f64,
}

impl Map {
    /// A map of the bounding box of `floor`; `spacing` in meters.
    pub fn over(walls: &Walls, floor: &[Vector], spacing: f64, stored: Stored, h: f64) -> Self {
        let [low, high] = bounds(floor.iter().copied()).unwrap_or_default();
        let corner = (low / spacing).map(f64::floor) * spacing;
        let cells = ((high - corner) / spacing).map(|cells| cells.floor() + 1.0);
        let (columns, rows) = (cells.x as usize + 1, cells.y as usize + 1);
        let node = |k: usize| {
            let step = Vector::new((k % columns) as f64, (k / columns) as f64);
            knowledge(stored, walls, corner + step * spacing, h)
        };
        Self {
            stored,
            spacing,
            corner,
            columns,
            nodes: (0..columns * rows).map(node).collect(),
            h,
        }
    }

    /// Interpolates between the four nodes around an agent on the floor.
    pub fn integrals(&self, r_i: Vector) -> Integrals {
        let place = (r_i - self.corner) / self.spacing;
        let cell = place.map(f64::floor);
        let (x, y) = (place.x - cell.x, place.y - cell.y);
        let first = cell.y as usize * self.columns + cell.x as usize;
        let [[a, b], [c, d]] =
            [first, first + self.columns].map(|k| [self.nodes[k], self.nodes[k + 1]]);
        let [scalar, u, v] = [0, 1, 2]
            .map(|n| (a[n] * (1.0 - x) + b[n] * x) * (1.0 - y) + (c[n] * (1.0 - x) + d[n] * x) * y);
        let vector = Vector::new(u, v);
        match self.stored {
            Stored::Integrals => Integrals {
                area: f64::NAN,
                kernel: scalar,
                gradient: vector,
            },
            Stored::Volume => Integrals::of_piece(vector, scalar, self.h),
        }
    }

    /// Memory of the nodes, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
    }
}

fn knowledge(stored: Stored, walls: &Walls, r_i: Vector, h: f64) -> [f64; 3] {
    let solid = Integrals::over(Region::Solid, walls, r_i, h, TOLERANCE);
    let (scalar, vector) = match stored {
        Stored::Integrals => (solid.kernel, solid.gradient),
        Stored::Volume => {
            let feet = walls.iter().map(|wall| wall.nearest_point(r_i).point - r_i);
            let nearest = feet.min_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
            (solid.area, nearest.unwrap_or_default())
        }
    };
    [scalar, vector.x, vector.y]
}
