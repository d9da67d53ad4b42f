//! Narrowings: places where the floor is narrower than before and behind, such as doors and gaps.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use super::mesh::Mesh;
use super::narrow::narrow;
use crate::math::{Vector, bounds, direction};

/// The side of a cell, meters.
const CELL: f64 = 4.0;
/// Lengths that differ by less are equal, meters.
const EQUAL: f64 = 1e-6;
/// A way this near to the end of an opening crosses it, meters.
const AT_END: f64 = 1e-6;

/// The narrow places of a floor.
#[derive(Debug, Clone, Default)]
pub struct Narrowings {
    /// Their ends, meters.
    places: Vec<[Vector; 2]>,
    /// For each cell, the numbers of the places that may lie in it.
    cells: BTreeMap<[i32; 2], Vec<u32>>,
}

/// A narrowing that an agent walks to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Narrowing {
    /// How far it is, meters.
    pub distance: f64,
    /// How wide it is, meters.
    pub width: f64,
}

impl Narrowings {
    /// The passages of a floor up to `widest` meters wide: the diameters of circles between two walls into which no
    /// wall reaches.
    pub fn of(mesh: &Mesh, widest: f64) -> Self {
        Self::at(passages(mesh, widest))
    }

    /// These, such as doors, and after them the openings of a floor up to `widest` meters wide, the narrowest first: of
    /// the passages that end at one corner only the narrowest, and of two whose middles are nearer than the width of
    /// the narrower one, such as the two sides of a wall with a door, only the first.
    #[must_use]
    pub fn and_openings(self, mesh: &Mesh, widest: f64) -> Self {
        let width = |[a, b]: &[Vector; 2]| (b - a).norm();
        let order = |one: &[Vector; 2]| {
            let at = middle(*one);
            // Rounding must not decide which of two equal ones comes first.
            [width(one), at.x, at.y].map(|x| (x / EQUAL).round())
        };
        let mut found = passages(mesh, widest);
        found.sort_by(|a, b| {
            let ([a, x, y], [b, u, v]) = (order(a), order(b));
            a.total_cmp(&b).then(x.total_cmp(&u)).then(y.total_cmp(&v))
        });
        let mut kept = self.places;
        for &one in &found {
            // The way from a door into the room behind it is as wide as the room.
            let ends_there = |end: &Vector| one.iter().any(|own| (own - end).norm() < EQUAL);
            let mut narrower = found.iter();
            if narrower
                .any(|other| width(other) < width(&one) - EQUAL && other.iter().any(ends_there))
            {
                continue;
            }
            let is_near = |other: &[Vector; 2]| {
                (middle(one) - middle(*other)).norm() < width(&one).min(width(other))
            };
            if !kept.iter().any(is_near) {
                kept.push(one);
            }
        }
        Self::at(kept)
    }

    /// Those with these ends, meters.
    pub fn at(places: Vec<[Vector; 2]>) -> Self {
        let mut cells: BTreeMap<_, Vec<u32>> = BTreeMap::new();
        for (k, &place) in places.iter().enumerate() {
            for cell in cells_of(place) {
                cells.entry(cell).or_default().push(k as u32);
            }
        }
        Self { places, cells }
    }

    /// The ends of the narrowest one, meters.
    pub fn narrowest(&self) -> Option<[Vector; 2]> {
        let width = |[a, b]: &[Vector; 2]| (b - a).norm();
        let places = self.places.iter().copied();
        places.min_by(|one, other| width(one).total_cmp(&width(other)))
    }

    /// The middle of number `k`, meters.
    pub fn middle(&self, k: u32) -> Vector {
        middle(self.places[k as usize])
    }

    /// The numbers of those that the straight way from `from` to `to` crosses, each with its distance from `from`,
    /// meters. Routes bend at corners, where openings end: their ends count.
    pub fn crossed(&self, from: Vector, to: Vector) -> Vec<(u32, f64)> {
        let (length, heading) = ((to - from).norm(), direction(to - from));
        let pieces = (length / CELL).ceil().max(1.0);
        let mut found: Vec<(u32, f64)> = Vec::new();
        for piece in 0..pieces as u32 {
            let ends = [piece, piece + 1].map(|k| from + (to - from) * (f64::from(k) / pieces));
            let near = cells_of(ends).filter_map(|cell| self.cells.get(&cell));
            for &k in near.flatten() {
                let [a, b] = self.places[k as usize];
                let along = direction(b - a);
                let across = heading.perp(&along);
                let distance = (a - from).perp(&along) / across;
                let place = (a - from).perp(&heading) / across;
                let is_crossed = (-AT_END..=length + AT_END).contains(&distance)
                    && (-AT_END..=(b - a).norm() + AT_END).contains(&place);
                if is_crossed && found.iter().all(|&(other, _)| other != k) {
                    found.push((k, distance.clamp(0.0, length)));
                }
            }
        }
        found
    }

    /// The first narrowing on the straight way from `p` in this direction, of length 1, at most `far` meters away.
    pub fn next(&self, p: Vector, heading: Vector, far: f64) -> Option<Narrowing> {
        let cells = cells_of([p, p + heading * far]);
        let near = cells.filter_map(|cell| self.cells.get(&cell)).flatten();
        let crossed = near.filter_map(|&k| {
            let [a, b] = self.places[k as usize];
            let along = b - a;
            let across = heading.perp(&along);
            let from = a - p;
            let distance = from.perp(&along) / across;
            let share = from.perp(&heading) / across;
            let is_crossed = (0.0..=far).contains(&distance) && (0.0..=1.0).contains(&share);
            is_crossed.then(|| Narrowing {
                distance,
                width: along.norm(),
            })
        });
        crossed.min_by(|one, other| one.distance.total_cmp(&other.distance))
    }
}

/// The ends of the passages of a floor up to `widest` meters wide.
fn passages(mesh: &Mesh, widest: f64) -> Vec<[Vector; 2]> {
    let found = narrow(mesh, widest);
    found.iter().map(|passage| passage.ends(mesh)).collect()
}

fn middle([a, b]: [Vector; 2]) -> Vector {
    0.5 * (a + b)
}

/// The cells of the rectangle around two points.
fn cells_of(points: [Vector; 2]) -> impl Iterator<Item = [i32; 2]> {
    // The casts saturate.
    let cell = |p: Vector| (p / CELL).map(|x| x.floor() as i32);
    let [low, high] = bounds(points).unwrap_or_default().map(cell);
    let columns: RangeInclusive<i32> = low.x..=high.x;
    columns.flat_map(move |x| (low.y..=high.y).map(move |y| [x, y]))
}
