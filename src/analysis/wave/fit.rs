//! Straight-line fits, with uncertainties that allow for correlated neighboring points.

use serde::{Deserialize, Serialize};

/// A value and its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

impl Estimate {
    /// Mean and standard error of the mean. `None` without values; the error of a single value is 0.
    pub fn of_mean(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
        Some(Self {
            value: mean,
            error: (squares / (count - 1.0).max(1.0) / count).sqrt(),
        })
    }
}

/// Number of jackknife blocks. Errors of neighboring points are correlated, so whole blocks are left out.
const BLOCKS: usize = 6;

/// y = slope · x + offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// dy/dx.
    pub slope: f64,
    /// y at x = 0.
    pub offset: f64,
}

impl Line {
    /// y at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.slope * x + self.offset
    }

    /// Least-squares fit; `None` for fewer than two different x.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let count = points.len() as f64;
        let mean_x = points.iter().map(|p| p.0).sum::<f64>() / count;
        let mean_y = points.iter().map(|p| p.1).sum::<f64>() / count;
        let (mut xx, mut xy) = (0.0, 0.0);
        for (x, y) in points {
            xx += (x - mean_x) * (x - mean_x);
            xy += (x - mean_x) * (y - mean_y);
        }
        let slope = xy / xx;
        (xx > 0.0 && slope.is_finite()).then_some(Self {
            slope,
            offset: mean_y - slope * mean_x,
        })
    }
}

/// A function of points, with its standard error from a jackknife over blocks of neighboring points.
pub fn jackknife<P: Copy>(points: &[P], value: impl Fn(&[P]) -> Option<f64>) -> Option<Estimate> {
    let all = value(points)?;
    let blocks = BLOCKS.min(points.len());
    let mut without = Vec::with_capacity(blocks);
    for block in 0..blocks {
        let (first, last) = (
            block * points.len() / blocks,
            (block + 1) * points.len() / blocks,
        );
        let kept: Vec<P> = [&points[..first], &points[last..]].concat();
        without.push(value(&kept)?);
    }
    let count = blocks as f64;
    let middle = without.iter().sum::<f64>() / count;
    let squares = without.iter().map(|v| (v - middle).powi(2)).sum::<f64>();
    Some(Estimate {
        value: all,
        error: (squares * (count - 1.0) / count).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_again() {
        let points: Vec<(f64, f64)> = (0..9)
            .map(|k| (f64::from(k), 3.0 - 0.5 * f64::from(k)))
            .collect();
        let line = Line::through(&points).unwrap();
        assert!((line.slope + 0.5).abs() < 1e-12 && (line.at(4.0) - 1.0).abs() < 1e-12);
        assert_eq!(Line::through(&[(1.0, 2.0), (1.0, 3.0)]), None);
    }

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let values = [1.0, 4.0, 2.0, 8.0, 5.0, 7.0];
        let average = |v: &[f64]| Estimate::of_mean(v).map(|m| m.value);
        let estimate = jackknife(&values, average).unwrap();
        let expected = Estimate::of_mean(&values).unwrap();
        assert!((estimate.error - expected.error).abs() < 1e-12);
    }
}
