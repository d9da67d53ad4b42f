//! The narrowest passage of the widest way to a place: no wider body can reach it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Floor;
use crate::math::Vector;

/// A passage between two walls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Its width, meters; infinite for routes that cross no closed passage.
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
    /// Whether the floor has closed passages.
    pub fn has_closed(&self) -> bool {
        let triangles = self.mesh.triangles().iter();
        triangles
            .flat_map(|of| of.closed)
            .any(|side| side.is_some())
    }

    /// For every triangle, the narrowest closed passage on the widest way to any of `points`; points off the floor are
    /// ignored. Uses Dijkstra's algorithm over the triangles: only closed passages limit the width of a way.
    pub fn passages(&self, points: impl Iterator<Item = Vector>) -> Passages {
        let mesh = &self.mesh;
        let mut search = Search {
            widest: vec![None; mesh.triangles().len()],
            queue: BinaryHeap::new(),
        };
        for t in points.filter_map(|p| self.locate(p)) {
            search.reach(t, Passage::OPEN);
        }
        while let Some((bits, Reverse(t))) = search.queue.pop() {
            let so_far = search.widest[t as usize].unwrap_or(Passage::OPEN);
            if so_far.width.to_bits() != bits {
                continue; // a wider way has come here since
            }
            let (triangle, corners) = (mesh.triangle(t), mesh.corners(t));
            for side in 0..3 {
                let ends = [corners[side], corners[(side + 1) % 3]];
                let width = (ends[1] - ends[0]).norm();
                let closed = triangle.closed[side];
                let closed = closed.map(|next| (next, so_far.or_narrower(Passage { width, ends })));
                let open = triangle.across[side].map(|next| (next, so_far));
                for (next, passage) in open.into_iter().chain(closed) {
                    search.reach(next, passage);
                }
            }
        }
        Passages(search.widest)
    }
}

/// What is known so far.
struct Search {
    /// For each triangle, the narrowest passage of the widest way.
    widest: Vec<Option<Passage>>,
    /// The bits of widths, which sort like the widths, and the triangles from which the search continues.
    queue: BinaryHeap<(u64, Reverse<u32>)>,
}

impl Search {
    /// Records that a way with this narrowest passage leads to triangle `t`.
    fn reach(&mut self, t: u32, passage: Passage) {
        let before = &mut self.widest[t as usize];
        if before.is_none_or(|before| before.width < passage.width) {
            *before = Some(passage);
            self.queue.push((passage.width.to_bits(), Reverse(t)));
        }
    }
}

impl Passages {
    /// The narrowest passage of the widest way from triangle `t`; `None` without a way.
    pub fn from(&self, t: u32) -> Option<Passage> {
        self.0[t as usize]
    }
}
