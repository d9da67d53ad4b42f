//! Points beside straight lines.

use crate::math::Vector;

/// Positive if `p` lies on the left of the line from `a` to `b`. Swapping `a` and `b` negates it exactly.
pub fn side(a: Vector, b: Vector, p: Vector) -> f64 {
    if (a.x, a.y) <= (b.x, b.y) {
        (b - a).perp(&(p - a))
    } else {
        -(a - b).perp(&(p - b))
    }
}

/// The distance from `p` to a segment, meters.
pub fn to_segment(p: Vector, a: Vector, b: Vector) -> f64 {
    (nearest_on(p, a, b) - p).norm()
}

/// The point of a segment nearest to `p`.
pub fn nearest_on(p: Vector, a: Vector, b: Vector) -> Vector {
    let along = b - a;
    let squared = along.norm_squared();
    if squared == 0.0 {
        return a;
    }
    a + along * ((p - a).dot(&along) / squared).clamp(0.0, 1.0)
}

/// The distance of `p` from a line, meters, at most `most`; negative on its right.
pub fn from_line([a, b]: [Vector; 2], p: Vector, most: f64) -> f64 {
    part(side(a, b, p), b - a, most)
}

/// `product` divided by the length of a vector, clamped to `most`, which most quotients exceed.
#[inline]
pub fn part(product: f64, vector: Vector, most: f64) -> f64 {
    // These need neither a square root nor a division.
    if product > 0.0 && product * product >= most * most * vector.norm_squared() {
        most
    } else {
        product / vector.norm()
    }
}
