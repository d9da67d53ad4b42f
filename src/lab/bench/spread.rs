//! Summaries of repeated measurements.

use serde::Serialize;

/// The minimum, median and maximum of some measurements.
///
/// The minimum is what the machine can do, the median what it usually does. If they are far apart, the machine was busy
/// with other work.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// The minimum.
    pub minimum: f64,
    /// The median: the middle value, or the mean of the two middle values.
    pub median: f64,
    /// The maximum.
    pub maximum: f64,
}

impl Spread {
    /// The spread of `values`; NaN without values.
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |k: usize| sorted.get(k).copied().unwrap_or(f64::NAN);
        let last = sorted.len().saturating_sub(1);
        Self {
            minimum: at(0),
            median: 0.5 * (at(last / 2) + at(last.div_ceil(2))),
            maximum: at(last),
        }
    }

    /// The same in another unit: all numbers times `factor`.
    pub fn times(&self, factor: f64) -> Self {
        Self {
            minimum: self.minimum * factor,
            median: self.median * factor,
            maximum: self.maximum * factor,
        }
    }

    /// The three numbers with `digits` decimals.
    pub fn cells(&self, digits: usize) -> [String; 3] {
        [self.minimum, self.median, self.maximum].map(|value| format!("{value:.digits$}"))
    }
}

/// Turn by turn, `values` divided by `base`.
pub fn ratios(values: &[f64], base: &[f64]) -> Vec<f64> {
    values.iter().zip(base).map(|(v, b)| v / b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_an_even_number_lies_between_two() {
        let spread = Spread::of(&[4.0, 1.0, 10.0, 2.0]);
        assert_eq!(spread.cells(1), ["1.0", "3.0", "10.0"]);
        assert_eq!(Spread::of(&[7.0, 1.0, 2.0]).median, 2.0);
        assert!(Spread::of(&[]).median.is_nan());
    }

    #[test]
    fn ratios_are_taken_turn_by_turn() {
        // A machine that is half as fast in the second turn changes no ratio.
        assert_eq!(ratios(&[3.0, 6.0], &[2.0, 4.0]), [1.5, 1.5]);
    }
}
