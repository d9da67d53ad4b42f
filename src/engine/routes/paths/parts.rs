//! Subdivides triangles, so that each part lists only the few entries that can be the shortest in it.

use rayon::prelude::*;

use super::list::Lists;
use super::region::{Candidate, Corners, best};
use super::targets::{Entry, Targets};
use crate::math::{Vector, bytes_of};
use crate::routes::floor::Floor;

/// Parts with more entries are halved if it pays.
const FEW: usize = 8;
/// Halving pays if the subdivision lists at most this many times the entries of the part.
const REPEATS: usize = 2;
/// To find the entries that can be the shortest, parts are halved until their longest side is no longer than this,
/// meters, but at most this many times.
const LEAST_SIZE: f64 = 0.3;
const MOST_HALVINGS: u32 = 12;
/// The number of triangles that are divided at once.
const CHUNK: usize = 1024;

/// Marks parts that are halved.
const HALVED: u32 = 1 << 31;
/// A part without entries.
const NONE: u32 = HALVED - 1;

/// The parts of all triangles.
#[derive(Debug, Clone)]
pub struct Parts {
    /// First the whole triangles, then the halves in pairs. Each is the number of its first entry, or `HALVED` combined
    /// with the number of its first half.
    parts: Vec<u32>,
    /// The entries of each part in the order of their targets.
    entries: Lists,
}

/// The two halves of a part, on the left and on the right of the line from the middle of its longest side to the
/// opposite corner.
fn halves([a, b, c]: Corners) -> [Corners; 2] {
    let [ab, bc, ca] = [b - a, c - b, a - c].map(|side| side.norm_squared());
    let [a, b, c] = if ab >= bc && ab >= ca {
        [a, b, c]
    } else if bc >= ca {
        [b, c, a]
    } else {
        [c, a, b]
    };
    let middle = (a + b) * 0.5;
    [[a, middle, c], [middle, b, c]]
}

/// A node of the subdivision during construction.
struct Part {
    /// The entries that can be the shortest in it, in order.
    entries: Vec<Entry>,
    /// The number of entries that its undivided parts list.
    listed: usize,
    halves: Option<Box<[Part; 2]>>,
}

impl Part {
    /// Keeps the candidates that can be the shortest in the part with these corners; `depth` counts the halvings so
    /// far.
    fn new(candidates: &[&Candidate], corners: Corners, depth: u32) -> Self {
        let mut best = best(candidates, corners);
        let sides = (0..3).map(|k| (corners[(k + 1) % 3] - corners[k]).norm());
        let size = sides.fold(0.0, f64::max);
        let mut halved = None;
        if best.len() > 2 && size > LEAST_SIZE && depth < MOST_HALVINGS {
            let both = halves(corners).map(|corners| Self::new(&best, corners, depth + 1));
            best.retain(|one| both.iter().any(|half| half.entries.contains(&one.entry)));
            let listed = both.iter().map(|half| half.listed).sum::<usize>();
            if best.len() > FEW && listed <= REPEATS * best.len() {
                halved = Some((listed, Box::new(both)));
            }
        }
        let (listed, halves) = match halved {
            Some((listed, halves)) => (listed, Some(halves)),
            None => (best.len(), None),
        };
        Self {
            entries: best.iter().map(|candidate| candidate.entry).collect(),
            listed,
            halves,
        }
    }
}

impl Parts {
    /// Subdivides the triangles of a floor; `found` gives the entries of each triangle in order.
    pub fn new(
        floor: &Floor,
        targets: &Targets,
        mut found: impl Iterator<Item = Vec<Entry>>,
    ) -> Self {
        let mut all = Self::empty(floor, targets);
        let count = all.parts.len();
        for from in (0..count).step_by(CHUNK) {
            let some: Vec<Vec<Entry>> = found.by_ref().take(CHUNK).collect();
            let some = some.into_par_iter().enumerate().map(|(k, entries)| {
                let look_up = |&entry: &Entry| Candidate::new(floor, targets, entry);
                let candidates: Vec<Candidate> = entries.iter().map(look_up).collect();
                let candidates: Vec<&Candidate> = candidates.iter().collect();
                Part::new(&candidates, floor.mesh.corners((from + k) as u32), 0)
            });
            for (k, part) in some.collect::<Vec<_>>().into_iter().enumerate() {
                all.add_part(from + k, part);
            }
        }
        all.parts.shrink_to_fit();
        all.entries.shrink();
        all
    }

    /// The whole triangles with all entries that are `found` for each, in order.
    pub fn undivided(
        floor: &Floor,
        targets: &Targets,
        found: impl Iterator<Item = Vec<Entry>>,
    ) -> Self {
        let mut all = Self::empty(floor, targets);
        for (number, entries) in found.enumerate() {
            all.add(number, &entries);
        }
        all
    }

    fn empty(floor: &Floor, targets: &Targets) -> Self {
        Self {
            parts: vec![NONE; floor.mesh.triangles().len()],
            entries: Lists::new(targets.len(), floor.borders() + targets.borders.len()),
        }
    }

    fn add_part(&mut self, number: usize, part: Part) {
        if let Some(halves) = part.halves {
            let first = self.parts.len();
            self.parts.extend([NONE; 2]);
            self.parts[number] = HALVED | first as u32;
            for (k, half) in halves.into_iter().enumerate() {
                self.add_part(first + k, half);
            }
        } else {
            self.add(number, &part.entries);
        }
    }

    /// Adds the entries of a part that is not halved.
    fn add(&mut self, number: usize, entries: &[Entry]) {
        if !entries.is_empty() {
            self.parts[number] = self.entries.len() as u32;
            self.entries.add(entries);
        }
    }

    /// Entry number `k`, if there is one.
    #[inline]
    pub fn entry(&self, k: usize) -> Option<Entry> {
        self.entries.get(k).map(|(entry, _)| entry)
    }

    /// The entries that can be the shortest at `p`, which lies in triangle `t`, with their numbers.
    #[inline]
    pub fn at(&self, floor: &Floor, p: Vector, t: u32) -> impl Iterator<Item = (usize, Entry)> {
        let mut part = self.parts[t as usize];
        if part & HALVED != 0 {
            let mut corners = floor.mesh.corners(t);
            while part & HALVED != 0 {
                let [a, b] = halves(corners);
                let [_, middle, top] = a;
                let is_left = (top - middle).perp(&(p - middle)) >= 0.0;
                corners = if is_left { a } else { b };
                part = self.parts[(part & !HALVED) as usize + usize::from(!is_left)];
            }
        }
        self.entries.from(part as usize)
    }

    /// Calls `take` for all parts of triangle `t` with each of their entries.
    pub fn each(&self, floor: &Floor, t: u32, mut take: impl FnMut(Corners, Entry)) {
        let mut waiting = vec![(floor.mesh.corners(t), self.parts[t as usize])];
        while let Some((corners, part)) = waiting.pop() {
            if part & HALVED != 0 {
                let first = (part & !HALVED) as usize;
                let both = halves(corners);
                waiting.extend([0, 1].map(|k| (both[k], self.parts[first + k])));
            } else {
                let entries = self.entries.from(part as usize);
                entries.for_each(|(_, entry)| take(corners, entry));
            }
        }
    }

    /// Whether triangle `t` has no entries.
    pub fn is_empty(&self, t: u32) -> bool {
        self.parts[t as usize] == NONE
    }

    /// All entries.
    pub fn all(&self) -> impl Iterator<Item = Entry> {
        self.entries.all()
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        bytes_of(&self.parts) + self.entries.bytes()
    }
}
