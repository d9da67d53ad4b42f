//! The narrowest passage of the widest way: how wide a body can be that reaches a place at all.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::floor::Floor;
use super::mesh::Mesh;
use crate::engine::math::Vector;

/// A passage between two walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Its width, meters; infinite where no walls are on both sides.
    pub width: f64,
    /// Its ends, meters.
    pub ends: [Vector; 2],
}

impl Passage {
    const OPEN: Self = Self {
        width: f64::INFINITY,
        ends: [Vector::new(0.0, 0.0); 2],
    };

    /// Its middle, meters.
    pub fn middle(&self) -> Vector {
        0.5 * (self.ends[0] + self.ends[1])
    }

    /// The narrower one of two.
    #[must_use]
    pub fn or_narrower(self, other: Self) -> Self {
        if other.width < self.width {
            other
        } else {
            self
        }
    }
}

/// For every triangle, the narrowest passage of the widest way to some points; `None` without a way.
#[derive(Debug, Clone)]
pub struct Passages(Vec<Option<Passage>>);

impl Floor {
    /// The passages on the widest ways to the nearest of `points`; points off the floor are left out. By Dijkstra's
    /// algorithm over the sides of triangles, with the widths of Demyen and Buro (2006).
    pub fn passages(&self, points: impl Iterator<Item = Vector>) -> Passages {
        let mesh = &self.mesh;
        let mut best = vec![None; mesh.triangles().len()];
        let mut queue = Queue {
            mesh,
            through: vec![None; 3 * mesh.triangles().len()],
            heap: BinaryHeap::new(),
        };
        for t in points.filter_map(|p| self.locate(p)) {
            if best[t as usize].replace(Passage::OPEN).is_none() {
                (0..3).for_each(|side| queue.leave(t, side, mesh.portal(t, side)));
            }
        }
        while let Some((bits, Reverse(entered))) = queue.heap.pop() {
            let Some(so_far) = queue.through[entered] else {
                continue;
            };
            if so_far.width.to_bits() != bits {
                continue;
            }
            let (t, side) = ((entered / 3) as u32, entered % 3);
            best[t as usize].get_or_insert(so_far); // the widest comes first
            // The way leaves through another side, around the corner between both.
            let (next, last) = ((side + 1) % 3, (side + 2) % 3);
            for (exit, corner) in [(next, next), (last, side)] {
                if mesh.triangle(t).across[exit].is_some() {
                    let around = mesh.around(t, corner);
                    queue.leave(t, exit, so_far.or_narrower(around));
                }
            }
        }
        Passages(best)
    }
}

impl Passages {
    /// The narrowest passage of the widest way from triangle `t`; `None` without a way.
    pub fn from(&self, t: u32) -> Option<Passage> {
        self.0[t as usize]
    }
}

/// What the search goes on from.
struct Queue<'a> {
    mesh: &'a Mesh,
    /// For each side of each triangle, the narrowest passage of the widest way that enters there.
    through: Vec<Option<Passage>>,
    /// The bits of widths, which are ordered as the widths are, and the numbers of the sides.
    heap: BinaryHeap<(u64, Reverse<usize>)>,
}

impl Queue<'_> {
    /// A way with this narrowest passage leaves triangle `t` through one of its sides.
    fn leave(&mut self, t: u32, side: usize, passage: Passage) {
        let Some(next) = self.mesh.triangle(t).across[side] else {
            return;
        };
        let entered = 3 * next as usize + self.mesh.side_along(next, t);
        let before = &mut self.through[entered];
        if before.is_none_or(|before| before.width < passage.width) {
            *before = Some(passage);
            self.heap.push((passage.width.to_bits(), Reverse(entered)));
        }
    }
}

impl Mesh {
    /// Side `side` of triangle `t` as a passage.
    fn portal(&self, t: u32, side: usize) -> Passage {
        let corners = self.corners(t);
        let ends = [corners[side], corners[(side + 1) % 3]];
        Passage {
            width: (ends[1] - ends[0]).norm(),
            ends,
        }
    }

    /// The passage around corner k of triangle `t`, from one of the sides there to the other.
    fn around(&self, t: u32, k: usize) -> Passage {
        let portals = self.portal(t, k).or_narrower(self.portal(t, (k + 2) % 3));
        match self.nearest_wall(t, k, portals.width) {
            Some((width, wall)) => Passage {
                width,
                ends: [self.corners(t)[k], wall],
            },
            None => portals,
        }
    }
}
