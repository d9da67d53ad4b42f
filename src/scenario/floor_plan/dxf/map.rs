//! Maps of the plane: the coordinate systems of entities, and the places of blocks.

use libm::{hypot, sincos};

/// A point of a drawing.
pub type Point = [f64; 2];

/// Most points of one entity.
pub const MOST_POINTS: usize = 1_000_000;

/// The map (x, y) → (x₀ + xₓx + xᵧy, y₀ + yₓx + yᵧy).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Map {
    /// Where (1, 0) leads from the origin.
    along: Point,
    /// Where (0, 1) leads from the origin.
    across: Point,
    /// Where the origin leads.
    origin: Point,
}

impl Map {
    /// The map that changes nothing.
    pub const SAME: Self = Self {
        along: [1.0, 0.0],
        across: [0.0, 1.0],
        origin: [0.0, 0.0],
    };

    /// A shift.
    pub fn shift(by: Point) -> Self {
        Self {
            origin: by,
            ..Self::SAME
        }
    }

    /// Factors along both axes.
    pub fn scale(factors: Point) -> Self {
        Self {
            along: [factors[0], 0.0],
            across: [0.0, factors[1]],
            ..Self::SAME
        }
    }

    /// A turn around the origin, radians.
    pub fn turn(angle: f64) -> Self {
        let (sine, cosine) = sincos(angle);
        Self {
            along: [cosine, sine],
            across: [-sine, cosine],
            ..Self::SAME
        }
    }

    /// The coordinate system of an entity with this extrusion direction at this height, seen from above.
    pub fn plane(normal: [f64; 3], height: f64) -> Self {
        let Some(normal) = unit(normal) else {
            return Self::SAME;
        };
        // DXF's rule for near-vertical directions.
        let is_upright = normal[0].abs() < 1.0 / 64.0 && normal[1].abs() < 1.0 / 64.0;
        let axis = if is_upright {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 0.0, 1.0]
        };
        let along = unit(cross(axis, normal)).unwrap_or([1.0, 0.0, 0.0]);
        let across = cross(normal, along);
        Self {
            along: [along[0], along[1]],
            across: [across[0], across[1]],
            origin: [normal[0] * height, normal[1] * height],
        }
    }

    /// Where a point leads.
    pub fn at(&self, [x, y]: Point) -> Point {
        let one = |k: usize| self.origin[k] + self.along[k] * x + self.across[k] * y;
        [one(0), one(1)]
    }

    /// Where a direction leads.
    pub fn direction(&self, [x, y]: Point) -> Point {
        let one = |k: usize| self.along[k] * x + self.across[k] * y;
        [one(0), one(1)]
    }

    /// This map after another one.
    pub fn after(&self, first: &Self) -> Self {
        Self {
            along: self.direction(first.along),
            across: self.direction(first.across),
            origin: self.at(first.origin),
        }
    }

    /// The largest factor by which lengths grow, up to √2.
    pub fn growth(&self) -> f64 {
        let length = |v: Point| hypot(v[0], v[1]);
        hypot(length(self.along), length(self.across))
    }
}

/// The direction of a vector; `None` without one.
pub fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = hypot(hypot(v[0], v[1]), v[2]);
    let is_some = length.is_finite() && length > 0.0;
    is_some.then(|| v.map(|x| x / length))
}

/// The vector product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_seen_from_below_is_mirrored() {
        let below = Map::plane([0.0, 0.0, -1.0], 3.0);
        assert_eq!(below.at([2.0, 5.0]), [-2.0, 5.0]);
        assert_eq!(Map::plane([0.0, 0.0, 1.0], 3.0).at([2.0, 5.0]), [2.0, 5.0]);
    }

    #[test]
    fn maps_are_applied_from_right_to_left() {
        let turned = Map::shift([10.0, 0.0]).after(&Map::turn(std::f64::consts::FRAC_PI_2));
        let [x, y] = turned.after(&Map::scale([2.0, -1.0])).at([1.0, 3.0]);
        assert!((x - 13.0).abs() < 1e-12 && (y - 2.0).abs() < 1e-12);
    }
}
