//! Curves → points between which straight lines deviate by at most a tolerance.

use libm::{acos, atan, atan2, hypot, sincos};
use std::f64::consts::{FRAC_PI_4, TAU};

use super::map::{MOST_POINTS, Point};
use super::spline::Spline;

/// Most parts of one arc.
const MOST_PARTS: f64 = 4096.0;
/// Bulges smaller than this are straight.
const STRAIGHT: f64 = 1e-9;

/// A vertex of a polyline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Its place.
    pub at: Point,
    /// The tangent of a quarter of the angle of the arc to the next vertex, counterclockwise; 0 if straight.
    pub bulge: f64,
}

impl Vertex {
    /// The beginning of a straight line.
    pub fn straight(at: Point) -> Self {
        Self { at, bulge: 0.0 }
    }
}

/// The part of an ellipse or circle between two angles: center + major cos + minor sin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conic {
    /// The center.
    pub center: Point,
    /// The first half axis.
    pub major: Point,
    /// The second half axis.
    pub minor: Point,
    /// The angle of the beginning, radians.
    pub from: f64,
    /// The angle of the end, radians.
    pub to: f64,
}

impl Conic {
    /// A part of a circle, counterclockwise from one angle to the other, radians.
    pub fn arc(center: Point, radius: f64, [from, to]: [f64; 2]) -> Self {
        Self {
            center,
            major: [radius, 0.0],
            minor: [0.0, radius],
            from,
            to: to_after(from, to),
        }
    }

    fn at(&self, angle: f64) -> Point {
        let (sine, cosine) = sincos(angle);
        let one = |k: usize| self.center[k] + self.major[k] * cosine + self.minor[k] * sine;
        [one(0), one(1)]
    }

    /// The number of straight parts.
    fn parts(&self, tolerance: f64) -> f64 {
        let length = |v: Point| hypot(v[0], v[1]);
        let radius = hypot(length(self.major), length(self.minor)).max(tolerance);
        // A chord of this angle deviates by the tolerance.
        let step = 2.0 * acos(1.0 - tolerance / radius);
        let span = (self.to - self.from).abs();
        (span / step.clamp(TAU / MOST_PARTS, FRAC_PI_4))
            .ceil()
            .max(1.0)
    }

    /// Adds its points, the first and the last one only on demand.
    fn add(&self, tolerance: f64, with_ends: bool, points: &mut Vec<Point>) {
        let parts = self.parts(tolerance);
        let mut angles = (0..=parts as usize).map(|k| match k as f64 {
            k if k == parts => self.to,
            k => self.from + (self.to - self.from) * k / parts,
        });
        if !with_ends {
            angles.next();
            angles.next_back();
        }
        points.extend(angles.map(|angle| self.at(angle)));
    }
}

/// The angle `to` plus whole turns, after `from` by at most a turn, radians. Equal angles are a whole turn.
pub fn to_after(from: f64, to: f64) -> f64 {
    let span = (to - from).rem_euclid(TAU);
    let is_whole = !(1e-9..=TAU - 1e-9).contains(&span);
    from + if is_whole { TAU } else { span }
}

/// A part of a path.
#[derive(Debug, Clone, PartialEq)]
pub enum Piece {
    /// Straight lines and arcs between vertices.
    Chain(Vec<Vertex>),
    /// An arc of a circle or an ellipse.
    Conic(Conic),
    /// A spline.
    Spline(Spline),
}

/// A path of several pieces end to end.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// Its pieces.
    pub pieces: Vec<Piece>,
    /// Whether its end is its beginning.
    pub is_closed: bool,
}

impl Path {
    /// A path of straight lines.
    pub fn straight(points: impl IntoIterator<Item = Point>, is_closed: bool) -> Self {
        let vertices = points.into_iter().map(Vertex::straight).collect();
        Self {
            pieces: vec![Piece::Chain(vertices)],
            is_closed,
        }
    }

    /// A path of one curve.
    pub fn conic(conic: Conic) -> Self {
        let is_closed = (conic.to - conic.from).abs() > TAU - 1e-9;
        Self {
            pieces: vec![Piece::Conic(conic)],
            is_closed,
        }
    }

    /// Its points; somewhat more than [`MOST_POINTS`] if there are too many. A closed path does not repeat its first.
    pub fn points(&self, tolerance: f64) -> Vec<Point> {
        let mut points = Vec::new();
        for piece in &self.pieces {
            match piece {
                Piece::Chain(vertices) => chain(vertices, self.is_closed, tolerance, &mut points),
                Piece::Conic(conic) => conic.add(tolerance, true, &mut points),
                Piece::Spline(spline) => spline.add(tolerance, &mut points),
            }
            if points.len() > MOST_POINTS {
                break;
            }
        }
        points.dedup();
        while self.is_closed && points.len() > 1 && points.last() == points.first() {
            points.pop();
        }
        points
    }
}

fn chain(vertices: &[Vertex], is_closed: bool, tolerance: f64, points: &mut Vec<Point>) {
    let next = vertices.iter().skip(1).chain(vertices.first());
    for (k, (vertex, next)) in vertices.iter().zip(next).enumerate() {
        points.push(vertex.at);
        let is_last = k + 1 == vertices.len();
        if is_last && !is_closed || points.len() > MOST_POINTS {
            return;
        }
        if let Some(arc) = bulge(vertex, next.at) {
            arc.add(tolerance, false, points);
        }
    }
}

/// The arc from a vertex to the next one; `None` if it is straight.
fn bulge(vertex: &Vertex, next: Point) -> Option<Conic> {
    let ([x, y], bulge) = (vertex.at, vertex.bulge);
    let chord = [next[0] - x, next[1] - y];
    if bulge.abs() < STRAIGHT || chord == [0.0, 0.0] {
        return None;
    }
    let aside = (1.0 - bulge * bulge) / (4.0 * bulge);
    let center = [
        0.5 * (x + next[0]) - aside * chord[1],
        0.5 * (y + next[1]) + aside * chord[0],
    ];
    let radius = hypot(x - center[0], y - center[1]);
    let from = atan2(y - center[1], x - center[0]);
    Some(Conic {
        center,
        major: [radius, 0.0],
        minor: [0.0, radius],
        from,
        to: from + 4.0 * atan(bulge),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The area inside of a closed path.
    fn area(points: &[Point]) -> f64 {
        let next = points.iter().cycle().skip(1);
        let sides = points.iter().zip(next);
        let twice: f64 = sides.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        0.5 * twice
    }

    #[test]
    fn a_bulge_of_one_is_half_a_circle_within_the_tolerance() {
        let vertices = [[0.0, 0.0], [4.0, 0.0]].map(|at| Vertex { at, bulge: 1.0 });
        let path = Path {
            pieces: vec![Piece::Chain(vertices.to_vec())],
            is_closed: true,
        };
        let points = path.points(0.005);
        let off = |p: &Point| (hypot(p[0] - 2.0, p[1]) - 2.0).abs();
        assert!(points.iter().all(|p| off(p) < 1e-12));
        let exact = std::f64::consts::PI * 4.0;
        assert!(area(&points) < exact && area(&points) > exact - 0.005 * 4.0 * TAU);
    }

    #[test]
    fn arcs_wrap_around_and_equal_angles_are_a_circle() {
        assert!((to_after(6.0, 1.0) - (1.0 + TAU)).abs() < 1e-12);
        assert!((to_after(1.0, 1.0) - (1.0 + TAU)).abs() < 1e-12);
        let circle = Path::conic(Conic::arc([1.0, 1.0], 3.0, [0.0, TAU]));
        assert!(circle.is_closed);
        assert!((area(&circle.points(1e-4)) - 9.0 * std::f64::consts::PI).abs() < 2e-3);
    }
}
