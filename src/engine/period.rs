//! Periodic scenes: the plane repeats itself along one axis, and agents that leave a period at one end reenter at the
//! other.

use serde::{Deserialize, Serialize};

use crate::math::Vector;

/// The direction in which a scene repeats itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// Along x.
    X,
    /// Along y.
    Y,
}

/// The part of the plane that is repeated: from `from` to `from` + `length` along an axis, without its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Period {
    /// The axis along which the scene repeats itself.
    pub axis: Axis,
    /// The coordinate at which the period begins, meters.
    pub from: f64,
    /// Meters.
    pub length: f64,
}

impl Period {
    /// The coordinate along the axis, meters.
    pub fn along(&self, p: Vector) -> f64 {
        p[self.axis as usize]
    }

    /// The coordinates at which the period begins and ends, meters.
    pub fn ends(&self) -> [f64; 2] {
        [self.from, self.from + self.length]
    }

    /// The way over this number of periods, meters.
    pub fn way(&self, laps: i32) -> Vector {
        let mut way = Vector::zeros();
        way[self.axis as usize] = self.length * f64::from(laps);
        way
    }

    /// Whether `p` lies in the period.
    pub fn contains(&self, p: Vector) -> bool {
        let [from, to] = self.ends();
        (from..to).contains(&self.along(p))
    }

    /// The image of `p` in the period, and the number of periods from there to `p`.
    pub fn wrapped(&self, p: Vector) -> (Vector, i32) {
        if self.contains(p) {
            return (p, 0);
        }
        let laps = ((self.along(p) - self.from) / self.length).floor() as i32;
        let mut image = p - self.way(laps);
        // Rounding may end just outside.
        let [from, to] = self.ends();
        let along = &mut image[self.axis as usize];
        if *along < from {
            *along = from;
        }
        if *along >= to {
            *along = from;
            return (image, laps + 1);
        }
        (image, laps)
    }

    /// A box, given by its lower left and upper right corners, with the period's ends along the axis.
    pub fn clipped(&self, [mut low, mut high]: [Vector; 2]) -> [Vector; 2] {
        let axis = self.axis as usize;
        [low[axis], high[axis]] = self.ends();
        [low, high]
    }

    /// The shortest of the differences between the images of two points that differ by `difference`, meters.
    pub fn shortest(&self, difference: Vector) -> Vector {
        let along = self.along(difference);
        if along.abs() < 0.4 * self.length {
            return difference;
        }
        let laps = (along / self.length).round();
        difference - self.way(laps as i32)
    }
}
