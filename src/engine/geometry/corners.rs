//! Numbers for points: points closer together than a tolerance get the same number.

use std::collections::HashMap;

use crate::math::Vector;

/// Distinct points, hashed by the cells of a grid whose cell size is the tolerance. Cells are only looked up,
/// never iterated, so that the result does not depend on hash order.
pub(super) struct Corners {
    tolerance: f64,
    points: Vec<Vector>,
    /// The point added last to each cell.
    cells: HashMap<[i64; 2], u32>,
    /// For each point, the point added before it to the same cell.
    previous: Vec<Option<u32>>,
}

impl Corners {
    /// No points yet; `tolerance` in meters.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            points: Vec::new(),
            cells: HashMap::new(),
            previous: Vec::new(),
        }
    }

    /// The position of point `k`, meters.
    pub fn at(&self, k: u32) -> Vector {
        self.points[k as usize]
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The number of the nearest point within the tolerance of `p`; if there is none, adds `p` under a new number.
    pub fn number(&mut self, p: Vector) -> u32 {
        let cell = [p.x, p.y].map(|x| (x / self.tolerance).floor() as i64);
        let mut nearest: Option<(f64, u32)> = None;
        for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
            let around = [cell[0].saturating_add(dx), cell[1].saturating_add(dy)];
            let mut next = self.cells.get(&around).copied();
            while let Some(k) = next {
                let found = ((self.at(k) - p).norm(), k);
                if found.0 < self.tolerance && nearest.is_none_or(|nearest| found < nearest) {
                    nearest = Some(found);
                }
                next = self.previous[k as usize];
            }
        }
        if let Some((_, k)) = nearest {
            return k;
        }
        let k = self.points.len() as u32;
        self.points.push(p);
        self.previous.push(self.cells.insert(cell, k));
        k
    }
}
