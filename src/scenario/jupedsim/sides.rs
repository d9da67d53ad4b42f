//! The lines of an exit: the sides of its polygon through which people come in from the floor.

use super::floor::{Floor, Part};
use engine::math::{Vector, direction, sides};

/// A side is open where the floor goes on this far in front of it, meters: no person comes in from a narrower gap.
const ROOM: f64 = 0.5;
/// The distances in front of a side at which the floor is tested.
const TESTED: [f64; 4] = [0.02, 0.15, 0.3, ROOM];
/// The largest distance between the points of a side at which the floor is tested, meters.
const STEP: f64 = 0.05;
/// The length of the shortest line, meters: exits need this.
const SHORTEST: f64 = 0.3;
/// Corners that lie within this part of the polygon's length of a straight side are left out.
const ROUNDNESS: f64 = 0.05;

/// The open sides of an exit, counterclockwise; the longest first. If all are shorter than exits may be, the longest,
/// lengthened.
pub fn open_sides(part: &Part, floor: &Floor) -> Vec<[Vector; 2]> {
    let tolerance = ROUNDNESS * part.extent().0;
    let corners = straightened(part.area.exterior.points(), tolerance);
    let mut found: Vec<[Vector; 2]> = Vec::new();
    for (a, b) in sides(&corners) {
        found.extend(open_parts(a, b, floor));
    }
    let length = |[a, b]: &[Vector; 2]| (b - a).norm();
    let numbered = found.iter().enumerate();
    let longest = numbered.max_by(|(_, a), (_, b)| length(a).total_cmp(&length(b)));
    let Some((k, &[a, b])) = longest else {
        return Vec::new();
    };
    found.rotate_left(k);
    let missing = SHORTEST - length(&[a, b]);
    if missing > 0.0 {
        let more = direction(b - a) * (0.5 * missing);
        return vec![[a - more, b + more]];
    }
    found.retain(|side| length(side) >= SHORTEST);
    found
}

/// The parts of a side in front of which there is floor. The polygon is on its left.
fn open_parts(a: Vector, b: Vector, floor: &Floor) -> Vec<[Vector; 2]> {
    let way = direction(b - a);
    let outward = Vector::new(way.y, -way.x);
    let count = ((b - a).norm() / STEP).ceil().max(2.0) as usize;
    let point = |k: f64| a + (b - a) * (k / count as f64);
    let is_open = |k: usize| {
        let middle = point(k as f64 + 0.5);
        TESTED
            .iter()
            .all(|&far| floor.is_free(middle + outward * far))
    };
    let open: Vec<bool> = (0..count).map(is_open).collect();
    let runs = open.chunk_by(|one, next| one == next);
    let mut start = 0;
    let mut parts = Vec::new();
    for run in runs {
        let end = start + run.len();
        if run[0] {
            parts.push([point(start as f64), point(end as f64)]);
        }
        start = end;
    }
    parts
}

/// A ring without the corners that are near the straight lines between others.
fn straightened(ring: &[Vector], tolerance: f64) -> Vec<Vector> {
    let farthest = |from: Vector| {
        let distances = ring.iter().enumerate();
        let far =
            distances.max_by(|(_, a), (_, b)| (*a - from).norm().total_cmp(&(*b - from).norm()));
        far.map_or(0, |(k, _)| k)
    };
    // Two corners that are far from each other.
    let first = farthest(ring[0]);
    let mut turned = ring.to_vec();
    turned.rotate_left(first);
    let opposite = farthest(ring[first]);
    let second = (opposite + ring.len() - first) % ring.len();
    turned.push(turned[0]);
    let mut kept = Vec::new();
    keep(&turned[..=second], tolerance, &mut kept);
    keep(&turned[second..], tolerance, &mut kept);
    match kept.len() < 3 {
        true => ring.to_vec(),
        false => kept,
    }
}

/// Adds the first point of a chain and those after it that are far from the straight line to its last point (Douglas
/// and Peucker 1973). The last point is left out.
fn keep(chain: &[Vector], tolerance: f64, kept: &mut Vec<Vector>) {
    let (first, last) = (chain[0], chain[chain.len() - 1]);
    let way = direction(last - first);
    let between = chain
        .iter()
        .enumerate()
        .skip(1)
        .take(chain.len().saturating_sub(2));
    let off = between.map(|(k, p)| (k, way.perp(&(p - first)).abs()));
    let worst = off.max_by(|(_, a), (_, b)| a.total_cmp(b));
    match worst.filter(|&(_, off)| off > tolerance) {
        Some((k, _)) => {
            keep(&chain[..=k], tolerance, kept);
            keep(&chain[k..], tolerance, kept);
        }
        None => kept.push(first),
    }
}
