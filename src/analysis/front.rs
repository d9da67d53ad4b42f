//! The speed of a front: a robust straight line through the times at which it reaches places.

use super::statistics::{Estimate, Line, jackknife};

/// The fewest points for a line.
const FEWEST: usize = 4;
/// A slowness more than this many standard errors from zero, and this many time steps between the two halves of the
/// way, belongs to a front; a smaller one, to a simultaneous start.
const CLEAR: f64 = 2.0;

/// A front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Front {
    /// dt/dx, s/m.
    pub slowness: Estimate,
    /// dx/dt, m/s; `None` if all start at once, as far as standard errors and time steps tell.
    pub speed: Option<Estimate>,
    /// The time at which it is at place 0, seconds.
    pub starts: f64,
}

impl Front {
    /// Fits a front to points (place in meters, time in seconds), in any order. Times are multiples of `time_step`
    /// seconds. The standard errors are those of a jackknife over six blocks of neighboring points. `None` for fewer
    /// than four points, or if they are in one place.
    pub fn through(points: &[[f64; 2]], time_step: f64) -> Option<Self> {
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
        // A step between the medians of the two halves, which are half the way apart.
        let way = points[points.len() - 1].0 - points[0].0;
        let step = time_step / (0.5 * way);
        let is_clear = size > CLEAR * slowness.error.max(step) && speed.value.is_finite();
        Some(Self {
            slowness,
            speed: is_clear.then_some(speed),
            starts: Line::of_halves(&points)?.offset,
        })
    }
}
