//! Vectors and walls in the plane.

use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Points closer to a wall than this lie on it, meters: rounding must not decide directions.
pub const ROUNDING: f64 = 1e-9;
/// Distance before a wall at which a move stops, meters.
const CLEARANCE: f64 = 1e-6;

/// A position, velocity or force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vector {
    pub x: f64,
    pub y: f64,
}

impl Vector {
    pub const ZERO: Self = Self { x: 0.0, y: 0.0 };

    /// The unit vector at an angle in radians.
    pub fn at(angle: f64) -> Self {
        let (y, x) = angle.sin_cos();
        Self { x, y }
    }

    pub fn dot(self, other: Self) -> f64 {
        self.x * other.x + self.y * other.y
    }

    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The unit vector, or zero for the zero vector.
    pub fn direction(self) -> Self {
        let norm = self.norm();
        if norm > 0.0 { self / norm } else { Self::ZERO }
    }

    /// The vector, shortened to a norm of at most `limit`.
    pub fn clamped(self, limit: f64) -> Self {
        self * (limit / self.norm()).min(1.0)
    }
}

impl Add for Vector {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
        }
    }
}

impl Mul<f64> for Vector {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self {
            x: self.x * factor,
            y: self.y * factor,
        }
    }
}

impl Div<f64> for Vector {
    type Output = Self;

    fn div(self, divisor: f64) -> Self {
        Self {
            x: self.x / divisor,
            y: self.y / divisor,
        }
    }
}

impl Neg for Vector {
    type Output = Self;

    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Vector {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Sum for Vector {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::ZERO, Add::add)
    }
}

impl From<[f64; 2]> for Vector {
    fn from([x, y]: [f64; 2]) -> Self {
        Self { x, y }
    }
}

impl From<Vector> for [f64; 2] {
    fn from(v: Vector) -> Self {
        [v.x, v.y]
    }
}

/// Wall O_k: an edge of an obstacle, which lies to the left of the way from start to end.
#[derive(Clone, Copy, Debug)]
pub struct Wall {
    pub start: Vector,
    pub end: Vector,
}

impl Wall {
    /// The edges of an obstacle with these corners, in either order.
    pub fn around(corners: &[[f64; 2]]) -> Vec<Self> {
        let mut corners: Vec<Vector> = corners.iter().map(|&corner| corner.into()).collect();
        let count = corners.len();
        let edges = |corners: &[Vector]| -> Vec<Self> {
            let ends = corners.iter().cycle().skip(1);
            let edges = corners.iter().zip(ends).take(count);
            edges.map(|(&start, &end)| Self { start, end }).collect()
        };
        let doubled_area: f64 = edges(&corners)
            .iter()
            .map(|wall| wall.start.x * wall.end.y - wall.start.y * wall.end.x)
            .sum();
        if doubled_area < 0.0 {
            corners[1..].reverse();
        }
        edges(&corners)
    }

    fn length(&self) -> f64 {
        (self.end - self.start).norm()
    }

    /// The unit vector from start to end.
    pub fn tangent(&self) -> Vector {
        (self.end - self.start).direction()
    }

    /// The unit normal on the free side.
    pub fn normal(&self) -> Vector {
        let Vector { x, y } = self.tangent();
        Vector { x: y, y: -x }
    }

    /// The distance of a point from the wall's line, meters; negative behind the wall.
    pub fn distance(&self, p: Vector) -> f64 {
        (p - self.start).dot(self.normal())
    }

    /// Whether a point is on the free side of the wall's line, or on the line.
    pub fn faces(&self, p: Vector) -> bool {
        self.distance(p) >= 0.0
    }

    /// r_k*: the point of the wall nearest to `p`.
    pub fn nearest_point(&self, p: Vector) -> Vector {
        let along = (p - self.start).dot(self.tangent()) / self.length();
        let along = along.clamp(0.0, 1.0);
        self.start * (1.0 - along) + self.end * along
    }

    /// The direction to `p` from the nearest point; from a point on the wall, the normal.
    pub fn away(&self, p: Vector) -> Vector {
        let r_ik = p - self.nearest_point(p);
        let is_on_wall = r_ik.norm() <= ROUNDING;
        if is_on_wall {
            self.normal()
        } else {
            r_ik.direction()
        }
    }

    /// When a point at `p`, moving at `velocity`, crosses the wall from its free side; `None` if never. The wall is
    /// longer by `slack` meters at both ends.
    fn time_to_cross(&self, p: Vector, velocity: Vector, slack: f64) -> Option<f64> {
        let approach = -velocity.dot(self.normal());
        if !self.faces(p) || approach <= 0.0 {
            return None;
        }
        let time = self.distance(p) / approach;
        let along = (p + velocity * time - self.start).dot(self.tangent());
        let reach = -slack..=self.length() + slack;
        reach.contains(&along).then_some(time)
    }

    /// When a disc at `p`, moving at `velocity`, first touches the wall or one of its ends; infinite if never.
    pub fn time_to_contact(&self, p: Vector, velocity: Vector, radius: f64) -> f64 {
        let ends = [self.start, self.end];
        let [start, end] = ends.map(|end| time_to_contact(end - p, velocity, radius));
        let edge = self.time_to_cross(p - self.normal() * radius, velocity, 0.0);
        edge.unwrap_or(f64::INFINITY).min(start).min(end)
    }
}

/// When a point, moving at `velocity`, comes within `reach` of the point at `offset`; infinite if never, and if it is
/// there already.
pub fn time_to_contact(offset: Vector, velocity: Vector, reach: f64) -> f64 {
    let (gap, approach) = (offset.dot(offset) - reach * reach, offset.dot(velocity));
    let discriminant = approach * approach - velocity.dot(velocity) * gap;
    if gap <= 0.0 || approach <= 0.0 || discriminant < 0.0 {
        return f64::INFINITY;
    }
    // The smaller root of |velocity|² t² − 2 approach t + gap = 0.
    gap / (approach + discriminant.sqrt())
}

/// Position and velocity after a move. A wall that would be crossed stops it, and takes the velocity toward the wall.
pub fn moved(p: Vector, velocity: Vector, time: f64, walls: &[Wall]) -> (Vector, Vector) {
    let crossings = walls.iter().filter_map(|wall| {
        let crossing = wall.time_to_cross(p, velocity, ROUNDING)?;
        (crossing < time).then_some((crossing, wall.normal()))
    });
    let first = crossings.min_by(|(a, _), (b, _)| a.total_cmp(b));
    first.map_or((p + velocity * time, velocity), |(crossing, normal)| {
        let inward = velocity.dot(normal);
        let stop = (crossing + CLEARANCE / inward).max(0.0);
        (p + velocity * stop, velocity - normal * inward)
    })
}
