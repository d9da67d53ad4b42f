//! The divergence of two crowds with almost equal starts.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::scenes::{by_id, continued, names, setting, simulation};
use crate::error::LabError;
use analysis::statistics::Line;
use engine::math::Vector;
use engine::simulation::Simulation;

/// The distance by which each agent is moved at the start, meters: far above rounding errors, far too small to change
/// the forces.
const SHIFT: f64 = 1e-8;
/// Simulated time of both crowds, seconds.
const DURATION: f64 = 2.0;
/// Start of the fit, seconds: before it, the shift still aligns with the fastest-growing direction.
const FIT_FROM: f64 = 0.4;
/// Number of shifts.
const SHIFTS: u32 = 3;
/// The fractional parts of its multiples fill [0, 1) evenly.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The largest Lyapunov exponent of a crowd's first seconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Lyapunov {
    /// Growth rate of the distance for each shift, 1/s.
    pub rates: Vec<f64>,
    /// The largest ratio of the final distance between the crowds to the initial one.
    pub growth: f64,
}

impl Lyapunov {
    /// The mean rate, 1/s.
    pub fn rate(&self) -> f64 {
        self.rates.iter().sum::<f64>() / self.rates.len().max(1) as f64
    }

    /// Time in which a distance grows e-fold, seconds; `None` if distances shrink.
    pub fn time(&self) -> Option<f64> {
        let rate = self.rate();
        (rate > 0.0).then(|| 1.0 / rate)
    }

    /// Measures a document in double precision, at a time step with a small integration error.
    ///
    /// # Errors
    /// The run fails.
    pub fn of(document: &Value) -> Result<Self, LabError> {
        let pairs = (0..SHIFTS).map(|shift| distances(document, shift));
        let all: Vec<_> = pairs.collect::<Result<_, _>>()?;
        let last = all.iter().filter_map(|distances| distances.last());
        Ok(Self {
            rates: all.iter().map(|distances| slope(distances)).collect(),
            growth: last.fold(0.0, |most, &(_, last)| most.max(last / SHIFT)),
        })
    }
}

/// Times, and root mean square distances between a crowd and a copy whose agents are moved by [`SHIFT`].
fn distances(document: &Value, shift: u32) -> Result<Vec<(f64, f64)>, LabError> {
    let settings = [
        setting("precision", &json!("double"))?,
        setting("time_step_secs", &json!(0.005))?,
    ];
    let first = simulation(document, &settings)?;
    let start = continued(document, &first, |_, _, _| ());
    let moved = continued(document, &first, |id, position, _| {
        let (sine, cosine) = (TAU * (f64::from(id + 1009 * shift) * GOLDEN).fract()).sin_cos();
        *position += SHIFT * Vector::new(cosine, sine);
    });
    let mut one = simulation(&start, &settings)?;
    let mut other = simulation(&moved, &settings)?;
    let mut distances = Vec::new();
    while one.frame().clock.time() < DURATION {
        for simulation in [&mut one, &mut other] {
            let stepped = simulation.step();
            stepped.map_err(|fault| LabError::of(names(&settings), fault))?;
        }
        distances.push((one.frame().clock.time(), distance(&one, &other)));
    }
    Ok(distances)
}

/// Root mean square distance between the agents of two crowds.
fn distance(one: &Simulation, other: &Simulation) -> f64 {
    let pairs = by_id(one).into_iter().zip(by_id(other));
    let period = one.scene().period;
    let [one, other] = [one, other].map(|crowd| &crowd.frame().agents.position);
    let squares = pairs.map(|(i, k)| {
        let way = one[i] - other[k];
        period
            .map_or(way, |period| period.shortest(way))
            .norm_squared()
    });
    (squares.sum::<f64>() / one.len().max(1) as f64).sqrt()
}

/// Slope of the logarithm of distances over time, by least squares.
fn slope(distances: &[(f64, f64)]) -> f64 {
    let all = distances.iter().copied();
    let later = all.filter(|&(time, d)| time >= FIT_FROM && d > 0.0);
    let points: Vec<(f64, f64)> = later.map(|(time, d)| (time, d.ln())).collect();
    Line::through(&points).map_or(f64::NAN, |line| line.slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_an_exponential_is_found_again() {
        let grown: Vec<(f64, f64)> = (0..300)
            .map(|k| f64::from(k) * 0.01)
            .map(|time| (time, 1e-8 * (2.5 * time).exp()))
            .collect();
        assert!((slope(&grown) - 2.5).abs() < 1e-9);
    }
}
