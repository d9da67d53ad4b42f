//! How fast two crowds part that began almost alike.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::scenes::simulation;
use crate::analysis::wave::Line;
use crate::engine::simulation::Simulation;
use crate::lab::reproduce::ReproduceError;

/// How far somebody is moved at the start, metres: far above rounding, far below what forces notice.
const SHIFT: f64 = 1e-8;
/// How long both crowds are followed, seconds.
const DURATION: f64 = 1.92;
/// The fit begins here, seconds: until then the shift turns into the fastest growing one.
const FIT_FROM: f64 = 0.48;
/// So many different shifts.
const SHIFTS: u32 = 3;

/// The largest Lyapunov exponent of a crowd's first seconds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Lyapunov {
    /// Growth of the distance, 1/s, of every shift that was tried.
    pub rates: Vec<f64>,
    /// How many times farther apart the crowds are at the end than at the start, at most.
    pub growth: f64,
}

impl Lyapunov {
    /// The mean rate, 1/s.
    pub fn rate(&self) -> f64 {
        self.rates.iter().sum::<f64>() / self.rates.len().max(1) as f64
    }

    /// In which a distance grows e-fold, seconds; `None` where it shrinks.
    pub fn time(&self) -> Option<f64> {
        let rate = self.rate();
        (rate > 0.0).then(|| 1.0 / rate)
    }

    /// Measures a document in double precision, at a step at which integration adds little.
    ///
    /// # Errors
    /// The run cannot go on.
    pub fn of(document: &Value) -> Result<Self, ReproduceError> {
        let (mut rates, mut growth) = (Vec::new(), 0.0_f64);
        for shift in 0..SHIFTS {
            let distances = distances(document, shift)?;
            rates.push(slope(&distances));
            let last = distances.last().map_or(0.0, |&(_, distance)| distance);
            growth = growth.max(last / SHIFT);
        }
        Ok(Self { rates, growth })
    }
}

/// Numbers in [0, 1) that fill it evenly.
pub fn golden(k: u32) -> f64 {
    (f64::from(k) * 0.618_033_988_749_895).fract()
}

/// Times and root mean square distances of a crowd from one whose people are moved by [`SHIFT`].
fn distances(document: &Value, shift: u32) -> Result<Vec<(f64, f64)>, ReproduceError> {
    let settings = ["precision=double", "time_step_secs=0.005"].map(str::to_owned);
    let one = simulation(document, &settings)?;
    let start = super::scenes::continued(document, &one);
    let mut moved = start.clone();
    let people = moved["agents"].as_array_mut().into_iter().flatten();
    for (agent, id) in people.zip(0_u32..) {
        let (sine, cosine) = (std::f64::consts::TAU * golden(id + 1009 * shift)).sin_cos();
        for (k, part) in [cosine, sine].into_iter().enumerate() {
            let place = agent["position"][k].as_f64().unwrap_or_default();
            agent["position"][k] = json!(place + SHIFT * part);
        }
    }
    let mut one = simulation(&start, &settings)?;
    let mut other = simulation(&moved, &settings)?;
    let mut distances = Vec::new();
    while one.frame().clock.time() < DURATION {
        for simulation in [&mut one, &mut other] {
            simulation.step().map_err(|fault| ReproduceError::Fault {
                case: document["name"].to_string(),
                fault,
            })?;
        }
        distances.push((one.frame().clock.time(), distance(&one, &other)));
    }
    Ok(distances)
}

fn distance(one: &Simulation, other: &Simulation) -> f64 {
    let place = |simulation: &Simulation| {
        let agents = simulation.frame().agents;
        let mut places: Vec<_> = agents.id.iter().zip(&agents.position).collect();
        places.sort_by_key(|(id, _)| **id);
        places
            .into_iter()
            .map(|(_, place)| *place)
            .collect::<Vec<_>>()
    };
    let (one, other) = (place(one), place(other));
    let squares = one.iter().zip(&other).map(|(a, b)| (a - b).norm_squared());
    (squares.sum::<f64>() / one.len().max(1) as f64).sqrt()
}

/// Of the logarithms of distances over time, by least squares.
fn slope(distances: &[(f64, f64)]) -> f64 {
    let points = distances
        .iter()
        .filter(|&&(time, d)| time >= FIT_FROM && d > 0.0);
    let points: Vec<(f64, f64)> = points.map(|&(time, d)| (time, d.ln())).collect();
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
