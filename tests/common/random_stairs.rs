//! Random stairs at random places: shafts of straight, folded, scissor and crossing flights.

use rand::Rng;
use rand_chacha::ChaCha8Rng;
use sandbox::engine::math::Vector;

use super::plans::Ring;
use super::vector;

/// How two storeys are joined.
#[derive(Debug, Clone, Copy)]
pub enum Link {
    /// One flight.
    Straight,
    /// A flight, a landing, and a flight back.
    Folded,
    /// Two flights beside each other in one shaft, in opposite directions.
    Scissor,
    /// Two flights that cross at a right angle.
    Crossing,
}

/// A rectangle: its ends along x and along y, meters.
type Sides = [[f64; 2]; 2];

pub fn rectangle([[x0, x1], [y0, y1]]: Sides) -> Ring {
    vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
}

/// A place of stairs: its origin, and the directions along the lower flight and across.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    origin: Vector,
    along: Vector,
    across: Vector,
}

impl Frame {
    pub fn random(rng: &mut ChaCha8Rng) -> Self {
        let axes = [
            vector(1.0, 0.0),
            vector(0.0, 1.0),
            vector(-1.0, 0.0),
            vector(0.0, -1.0),
        ];
        let k = rng.random_range(0..4);
        let side = if rng.random_bool(0.5) { 1 } else { 3 };
        Self {
            origin: vector(rng.random_range(0.0..26.0), rng.random_range(0.0..20.0)),
            along: axes[k],
            across: axes[(k + side) % 4],
        }
    }

    pub fn at(&self, u: f64, v: f64) -> Vector {
        self.origin + self.along * u + self.across * v
    }

    /// The line across at `u`.
    pub fn line(&self, u: f64, [from, to]: [f64; 2]) -> [Vector; 2] {
        [self.at(u, from), self.at(u, to)]
    }

    pub fn ring(&self, [[u0, u1], [v0, v1]]: Sides) -> Ring {
        [(u0, v0), (u1, v0), (u1, v1), (u0, v1)]
            .map(|(u, v)| self.at(u, v).into())
            .to_vec()
    }
}

/// Stairs at their place.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    pub frame: Frame,
    pub stairs: Stairs,
}

impl Place {
    pub fn random(rng: &mut ChaCha8Rng, height: f64) -> Self {
        Self {
            frame: Frame::random(rng),
            stairs: Stairs::random(rng, height),
        }
    }

    /// The outline of the shaft.
    pub fn ring(&self, link: Link) -> Ring {
        let shaft = self.stairs.shaft(link).into_iter();
        shaft.map(|[u, v]| self.frame.at(u, v).into()).collect()
    }
}

/// The widths and lengths of stairs, meters.
#[derive(Debug, Clone, Copy)]
pub struct Stairs {
    pub width: f64,
    /// The length of a straight flight; those of folded stairs have half of it.
    pub length: f64,
    /// Between the two flights of folded stairs.
    pub well: f64,
    pub landing: f64,
}

impl Stairs {
    /// Stairs that rise by `height`.
    pub fn random(rng: &mut ChaCha8Rng, height: f64) -> Self {
        let width = rng.random_range(1.1..1.9);
        Self {
            width,
            length: rng.random_range(1.5..1.9) * height,
            well: [0.0, rng.random_range(0.1..0.7)][rng.random_range(0..2)],
            landing: width + rng.random_range(0.0..0.5),
        }
    }

    /// The outline of their shaft.
    pub fn shaft(&self, link: Link) -> Ring {
        let (width, length) = (self.width, self.length);
        match link {
            Link::Straight => rectangle([[0.0, length], [0.0, width]]),
            Link::Scissor => rectangle([[0.0, length], [0.0, 2.0 * width]]),
            Link::Folded => {
                let length = 0.5 * length + self.landing;
                rectangle([[0.0, length], [0.0, 2.0 * width + self.well]])
            }
            Link::Crossing => {
                let [low, high] = [0.5 * (length - width), 0.5 * (length + width)];
                let lower = [
                    [0.0, low],
                    [low, low],
                    [low, 0.0],
                    [high, 0.0],
                    [high, low],
                    [length, low],
                ];
                let upper = lower.map(|[u, v]| [length - u, length - v]);
                [lower, upper].concat()
            }
        }
    }
}
