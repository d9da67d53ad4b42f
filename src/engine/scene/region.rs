//! Rectangles.

use serde::{Deserialize, Serialize};

use crate::math::Vector;

/// An axis-aligned rectangle, borders included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// Lower left corner, meters.
    pub min: Vector,
    /// Upper right corner, meters.
    pub max: Vector,
}

impl Region {
    /// Whether `p` lies in the rectangle.
    pub fn contains(&self, p: Vector) -> bool {
        (self.min.x..=self.max.x).contains(&p.x) && (self.min.y..=self.max.y).contains(&p.y)
    }

    /// Square meters.
    pub fn area(&self) -> f64 {
        (self.max.x - self.min.x) * (self.max.y - self.min.y)
    }

    /// Its corners, counterclockwise.
    pub fn corners(&self) -> [Vector; 4] {
        let (low, high) = (self.min, self.max);
        [
            low,
            Vector::new(high.x, low.y),
            high,
            Vector::new(low.x, high.y),
        ]
    }
}
