//! Narrowings: places where the floor is narrower than before and behind, such as doors and gaps.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use super::mesh::Mesh;
use super::narrow::{End, Narrow, narrow};
use crate::engine::math::{Vector, bounds};

/// The side of a cell, meters.
const CELL: f64 = 4.0;

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
        let ends = |passage: Narrow| {
            let to = match passage.to {
                End::Corner(corner) => mesh.point(corner),
                End::Wall { at, .. } => at,
            };
            [mesh.point(passage.from), to]
        };
        let places: Vec<_> = narrow(mesh, widest).into_iter().map(ends).collect();
        let mut cells: BTreeMap<_, Vec<u32>> = BTreeMap::new();
        for (k, &place) in places.iter().enumerate() {
            for cell in cells_of(place) {
                cells.entry(cell).or_default().push(k as u32);
            }
        }
        Self { places, cells }
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

/// The cells of the rectangle around two points.
fn cells_of(points: [Vector; 2]) -> impl Iterator<Item = [i32; 2]> {
    // The casts saturate.
    let cell = |p: Vector| (p / CELL).map(|x| x.floor() as i32);
    let [low, high] = bounds(points).unwrap_or_default().map(cell);
    let columns: RangeInclusive<i32> = low.x..=high.x;
    columns.flat_map(move |x| (low.y..=high.y).map(move |y| [x, y]))
}
