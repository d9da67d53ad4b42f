//! The crest of a wave in a space-time diagram: its time and its height at each place.

use libm::{hypot, pow};
use serde::{Deserialize, Serialize};

use super::space_time::SpaceTime;
use crate::statistics::{Estimate, Line, jackknife, vertex};

/// Range of wave speeds that are tried, m/s.
const SPEEDS: [f64; 2] = [2.0, 40.0];
/// Number of speeds tried, in geometric progression.
const TRIED: usize = 90;
/// The wave sets out within this time after the start, seconds.
const SETS_OUT: f64 = 1.0;
/// The crest is searched within this time of the straight line found first, seconds.
const ROUND: f64 = 0.6;
/// Within this distance of the obstacle, the arriving and the returning wave overlap, meters.
const OVERLAP: f64 = 4.0;
/// Length before this overlap over which amplitudes are compared, meters.
const COMPARED: f64 = 4.0;
/// The wave is measured from this distance ahead of its source, where it has formed, meters.
const FORMED: f64 = 2.5;

/// The source of a wave toward rising x, and the obstacle that reflects it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// Time of the start, seconds.
    pub start: f64,
    /// x of the front of the pushing agents, meters.
    pub source: f64,
    /// x of the front of the obstacle, meters.
    pub obstacle: f64,
}

/// The crest at one place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RidgePoint {
    /// Place, meters.
    pub x: f64,
    /// Time, seconds.
    pub time: f64,
    /// |v_x − mean v_x before the push|, m/s.
    pub amplitude: f64,
}

/// A crest and the straight line through it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ridge {
    /// Sorted by x.
    pub points: Vec<RidgePoint>,
    /// |dx/dt|, m/s.
    pub speed: Estimate,
    /// Time at which the line passes x = 0, seconds.
    pub offset: f64,
    /// dt/dx of the line, s/m; negative for a returning wave.
    pub slowness: f64,
}

impl Ridge {
    /// Time at which the line passes `x`, seconds.
    pub fn time_at(&self, x: f64) -> f64 {
        self.offset + self.slowness * x
    }

    /// Mean amplitude between two places, m/s.
    fn amplitude(&self, [from, to]: [f64; 2]) -> Option<Estimate> {
        let inside = self.points.iter().filter(|p| (from..=to).contains(&p.x));
        let amplitudes: Vec<f64> = inside.map(|p| p.amplitude).collect();
        Estimate::of_mean(&amplitudes)
    }
}

/// A wave and its reflection.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Wave {
    /// The wave toward the obstacle.
    pub arriving: Ridge,
    /// The wave back from the obstacle; `None` if it does not stand out from the noise.
    pub returning: Option<Ridge>,
    /// Mean height of the arriving crest from 8 m to 4 m before the obstacle, m/s.
    pub amplitude: Estimate,
    /// Ratio of the heights of the returning and the arriving crest, both in that range.
    pub reflection: Option<Estimate>,
}

/// A crest is a value between two others, so that a diagram needs this many times.
const LEAST_TIMES: usize = 3;

/// Finds the wave of `run` in a diagram; `None` if no crest stands out from the noise, or if there are fewer than three
/// times.
pub fn measure(diagram: &SpaceTime, run: &Run) -> Option<Wave> {
    if diagram.times.len() < LEAST_TIMES {
        return None;
    }
    let field = Field::new(diagram, run);
    let near = run.obstacle - OVERLAP;
    let measured = run.source + FORMED..=near;
    let columns = field.columns.iter();
    let places: Vec<&Column> = columns.filter(|(x, _)| measured.contains(x)).collect();
    let first = places.first()?.0;
    let begins = |slowness: f64| (run.start + slowness * (first - run.source), SETS_OUT);
    let arriving = field.ridge(&places, 1.0, SPEEDS, begins)?;

    let hits = arriving.time_at(run.obstacle);
    let speeds = [0.5, 1.5].map(|factor| factor * arriving.speed.value);
    let begins = |slowness: f64| {
        (
            hits - slowness * (run.obstacle - first) - ROUND / 2.0,
            ROUND,
        )
    };
    let returning = field.ridge(&places, -1.0, speeds, begins);
    let compared = [near - COMPARED, near];
    let amplitude = arriving.amplitude(compared)?;
    let reflection = returning
        .as_ref()
        .and_then(|ridge| ridge.amplitude(compared))
        .map(|back| ratio(back, amplitude));
    Some(Wave {
        arriving,
        returning,
        amplitude,
        reflection,
    })
}

fn ratio(a: Estimate, b: Estimate) -> Estimate {
    let value = a.value / b.value;
    Estimate {
        value,
        error: value * hypot(a.error / a.value, b.error / b.value),
    }
}

/// The place of a bin, and the disturbance there over time.
type Column = (f64, Vec<f64>);

/// The disturbance in all bins that were never empty.
struct Field {
    columns: Vec<Column>,
    first_time: f64,
    time_step: f64,
    noise: f64,
}

impl Field {
    fn new(diagram: &SpaceTime, run: &Run) -> Self {
        let columns: Vec<Column> = (0..diagram.strip.bins())
            .filter_map(|bin| {
                let disturbance = diagram.disturbance(bin, run.start)?;
                Some((diagram.strip.middle(bin), disturbance))
            })
            .collect();
        let before = diagram.times.iter().filter(|&&t| t < run.start).count();
        let quiet = columns.iter().flat_map(|(_, s)| &s[..before]);
        let squares = quiet.clone().map(|v| v * v).sum::<f64>();
        Self {
            first_time: diagram.times.first().copied().unwrap_or(0.0),
            time_step: diagram.time_step(),
            noise: (squares / quiet.count().max(1) as f64).sqrt(),
            columns,
        }
    }

    /// A series at `time`, interpolated linearly; 0 outside its times.
    fn at(&self, series: &[f64], time: f64) -> f64 {
        let along = (time - self.first_time) / self.time_step;
        if !(0.0..(series.len() - 1) as f64).contains(&along) {
            return 0.0;
        }
        let (k, part) = (along as usize, along.fract());
        series[k] * (1.0 - part) + series[k + 1] * part
    }

    /// Finds the crest with the given sign of v_x: first the straight line along which the disturbance has the greatest
    /// sum, then the highest value near this line at every place. For a slowness, `begins` gives the earliest time at
    /// the first place and the length of the interval to search, seconds.
    fn ridge(
        &self,
        places: &[&Column],
        sign: f64,
        speeds: [f64; 2],
        begins: impl Fn(f64) -> (f64, f64),
    ) -> Option<Ridge> {
        let first = places.first()?.0;
        let guess = self.brightest(places, sign, speeds, begins)?;
        let ridge: Vec<RidgePoint> = places
            .iter()
            .filter_map(|(x, series)| self.crest(*x, series, sign, guess.at(x - first)))
            .collect();
        // Most places must have a crest.
        if 2 * ridge.len() < places.len() || ridge.len() < 4 {
            return None;
        }
        let times: Vec<(f64, f64)> = ridge.iter().map(|p| (p.x, p.time)).collect();
        let line = Line::through(&times)?;
        let speed = jackknife(&times, |points| {
            Line::through(points).map(|line| 1.0 / line.slope.abs())
        })?;
        Some(Ridge {
            points: ridge,
            speed,
            offset: line.offset,
            slowness: line.slope,
        })
    }

    /// The line with the greatest sum through the diagram (a slant stack); its x counts from the first place.
    fn brightest(
        &self,
        places: &[&Column],
        sign: f64,
        [slowest, fastest]: [f64; 2],
        begins: impl Fn(f64) -> (f64, f64),
    ) -> Option<Line> {
        let first = places.first()?.0;
        let mut best: Option<(f64, Line)> = None;
        for k in 0..TRIED {
            let part = k as f64 / (TRIED - 1) as f64;
            let slowness = sign / (slowest * pow(fastest / slowest, part));
            let (from, lasting) = begins(slowness);
            for step in 0..=(lasting / self.time_step) as usize {
                let line = Line {
                    slope: slowness,
                    offset: from + step as f64 * self.time_step,
                };
                let values = places.iter().map(|(x, s)| self.at(s, line.at(x - first)));
                let sum = sign * values.sum::<f64>();
                if best.is_none_or(|(most, _)| sum > most) {
                    best = Some((sum, line));
                }
            }
        }
        best.map(|(_, line)| line)
    }

    /// The highest value near a time, refined by a parabola. `None` if it does not stand out from the noise or is at an
    /// end of the searched interval.
    fn crest(&self, x: f64, series: &[f64], sign: f64, time: f64) -> Option<RidgePoint> {
        let index =
            |time: f64| ((time - self.first_time) / self.time_step).round().max(1.0) as usize;
        let (from, to) = (
            index(time - ROUND),
            index(time + ROUND).min(series.len() - 2),
        );
        let top = (from..=to).max_by(|&a, &b| (sign * series[a]).total_cmp(&(sign * series[b])))?;
        if top == from || top == to || sign * series[top] < 3.0 * self.noise {
            return None;
        }
        let [a, b, c] = [series[top - 1], series[top], series[top + 1]].map(|v| sign * v);
        let shift = vertex([a, b, c]);
        Some(RidgePoint {
            x,
            time: self.first_time + (top as f64 + shift) * self.time_step,
            amplitude: b - 0.25 * (a - c) * shift,
        })
    }
}
