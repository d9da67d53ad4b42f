//! The speed of a front: a robust straight line through the times at which it reaches places.

use super::statistics::{Estimate, Line, jackknife};

/// The fewest points for a line.
const FEWEST: usize = 4;
/// A slowness at least this many standard errors from zero belongs to a front; a smaller one, to a simultaneous start.
const CLEAR: f64 = 2.0;

/// A front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Front {
    /// dt/dx, s/m.
    pub slowness: Estimate,
    /// dx/dt, m/s; `None` if the slowness is less than two standard errors from zero.
    pub speed: Option<Estimate>,
    /// The time at which it is at place 0, seconds.
    pub starts: f64,
}

impl Front {
    /// Fits a front to points (place in meters, time in seconds), in any order. The standard errors are those of a
    /// jackknife over six blocks of neighboring points. `None` for fewer than four points, or if they are in one place.
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        if points.len() < FEWEST {
            return None;
        }
        let mut points: Vec<(f64, f64)> = points.iter().map(|[x, t]| (*x, *t)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let slowness = jackknife(&points, |points| Some(Line::of_halves(points)?.slope))?;
        let size = slowness.value.abs();
        let speed = Estimate {
            value: 1.0 / slowness.value,
            error: slowness.error / (size * size),
        };
        Some(Self {
            slowness,
            speed: (size > CLEAR * slowness.error && speed.value.is_finite()).then_some(speed),
            starts: Line::of_halves(&points)?.offset,
        })
    }
}
