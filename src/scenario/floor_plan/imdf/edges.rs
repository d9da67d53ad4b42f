//! Lines on the edges of areas.

use crate::floor_plan::shape::Shape;
use engine::math::Vector;
use engine::routes::nearest_on;

/// A line this near to an edge lies on it, meters.
const ON_EDGE: f64 = 1e-3;

/// Whether a line lies on the edges of rings, from end to end.
pub fn is_on_edge(line: &Shape, rings: &[Vec<[f64; 2]>]) -> bool {
    let points: Vec<Vector> = line.rings.iter().flatten().map(|&p| p.into()).collect();
    let middles = points.windows(2).map(|pair| (pair[0] + pair[1]) / 2.0);
    points.len() > 1
        && points
            .iter()
            .copied()
            .chain(middles)
            .all(|p| is_at(p, rings))
}

/// Whether a point lies on an edge of rings.
fn is_at(p: Vector, rings: &[Vec<[f64; 2]>]) -> bool {
    rings.iter().any(|ring| {
        let first = ring.first().copied();
        let ends = ring.iter().skip(1).copied().chain(first);
        let mut edges = ring.iter().copied().zip(ends);
        edges.any(|(a, b)| (nearest_on(p, a.into(), b.into()) - p).norm() < ON_EDGE)
    })
}
