//! Cells in which there may be room for bodies.

use rand::Rng;

use super::Space;
use super::taken::Taken;
use crate::math::Vector;

/// The most cells of a search, in addition to those per body. An area that needs more, because it has little room for
/// its extent, is not searched completely.
const MOST: usize = 1 << 14;
const MOST_PER_BODY: usize = 16;

/// Square cells of one size.
pub struct Cells {
    centers: Vec<Vector>,
    side: f64,
    most: usize,
}

impl Cells {
    /// Cells that cover all room for `bodies` bodies of this radius, with sides of at most `side` meters unless that
    /// takes too many cells.
    pub fn covering(
        space: &Space,
        taken: &Taken,
        (bodies, radius): (usize, f64),
        side: f64,
    ) -> Self {
        let [low, high] = space.bounds();
        let mut cells = Self {
            centers: vec![0.5 * (low + high)],
            side: (high - low).max(),
            most: MOST + MOST_PER_BODY * bodies,
        };
        while cells.side > side && cells.quarter(space, taken, radius) {}
        cells
    }

    pub fn len(&self) -> usize {
        self.centers.len()
    }

    /// The length of the sides, meters.
    pub fn side(&self) -> f64 {
        self.side
    }

    pub fn centers(&self) -> &[Vector] {
        &self.centers
    }

    pub fn remove(&mut self, k: usize) {
        self.centers.swap_remove(k);
    }

    /// A random point in cell `k`.
    pub fn point_in(&self, k: usize, random: &mut impl Rng) -> Vector {
        let mut along = || self.side * (random.random::<f64>() - 0.5);
        self.centers[k] + Vector::new(along(), along())
    }

    /// Quarters all cells and drops those without room for a body of this radius. Returns false, without quartering,
    /// if there are too many cells.
    pub fn quarter(&mut self, space: &Space, taken: &Taken, radius: f64) -> bool {
        if self.centers.len() > self.most / 4 {
            return false;
        }
        self.side *= 0.5;
        let quarter = 0.5 * self.side;
        let half = self.side * std::f64::consts::FRAC_1_SQRT_2;
        let corners = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
        let quarters = self.centers.iter().flat_map(|&center| {
            corners.map(|(x, y): (f64, f64)| center + Vector::new(x, y) * quarter)
        });
        let mut near = Vec::new();
        let may_have_room = |&center: &Vector| {
            if taken.covers(center, half, radius) {
                return false;
            }
            near.clear();
            if radius > half {
                space.walls.near(center, radius - half, &mut near);
            }
            if !near.is_empty() {
                return false;
            }
            space.borders.near(center, half, &mut near);
            !near.is_empty() || space.contains(center)
        };
        self.centers = quarters.filter(may_have_room).collect();
        true
    }
}
