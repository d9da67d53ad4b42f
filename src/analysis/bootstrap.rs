//! Confidence bands of mean curves, by resampling the runs.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::statistics::expanded_tail;

/// The number of resamples.
const RESAMPLES: usize = 2000;
/// The seed of their random numbers: bands of the same runs are the same bits.
const SEED: u64 = 1;

/// A point of a mean curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanPoint {
    /// The number of runs with a value here.
    pub runs: usize,
    /// The mean of their values.
    pub mean: f64,
    /// The ends of the 95 % confidence interval of the mean; both are the mean with a single run.
    pub band: [f64; 2],
}

/// The mean of several curves, point by point, with a 95 % band: each point's interval holds the true mean of this
/// point with this probability, not the whole curve. Whole curves are drawn with replacement (Efron 1979); the
/// quantiles of the drawn means are those of the expanded percentile interval (Hesterberg 2015), as wide as Student's t
/// for few curves. With fewer than five curves bands are too narrow. `None` where no curve has a value.
pub fn mean_curve(curves: &[Vec<Option<f64>>]) -> Vec<Option<MeanPoint>> {
    let points = curves.iter().map(Vec::len).max().unwrap_or(0);
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let count = curves.len();
    let draws: Vec<Vec<usize>> = (0..RESAMPLES)
        .map(|_| (0..count).map(|_| rng.random_range(0..count)).collect())
        .collect();
    let point = |k: usize| {
        let value = |curve: &Vec<Option<f64>>| curve.get(k).copied().flatten();
        let values: Vec<Option<f64>> = curves.iter().map(value).collect();
        let (runs, mean) = mean(values.iter())?;
        let drawn = draws
            .iter()
            .filter_map(|draw| Some(self::mean(draw.iter().map(|&run| &values[run]))?.1));
        let mut means: Vec<f64> = drawn.collect();
        means.sort_by(f64::total_cmp);
        let tail = expanded_tail(runs).unwrap_or(0.5);
        let place = (tail * (means.len() as f64 - 1.0)).round() as usize;
        let ends = [means.get(place), means.iter().rev().nth(place)];
        let band = ends.map(|end| {
            if runs > 1 {
                end.copied().unwrap_or(mean)
            } else {
                mean
            }
        });
        Some(MeanPoint { runs, mean, band })
    };
    (0..points).map(point).collect()
}

/// The number of values, and their mean.
fn mean<'v>(values: impl Iterator<Item = &'v Option<f64>>) -> Option<(usize, f64)> {
    let (count, sum) = values
        .flatten()
        .fold((0, 0.0), |(count, sum), value| (count + 1, sum + value));
    (count > 0).then(|| (count, sum / count as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twelve values, the sum of twelve uniform draws each: nearly normal with mean 6 and variance 1.
    fn drawn(rng: &mut ChaCha8Rng, curves: usize) -> Vec<Vec<Option<f64>>> {
        let value = |rng: &mut ChaCha8Rng| (0..12).map(|_| rng.random::<f64>()).sum();
        (0..curves).map(|_| vec![Some(value(rng))]).collect()
    }

    #[test]
    fn bands_hold_the_mean_as_often_as_they_say() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for curves in [6, 12] {
            let trials = 400;
            let held = (0..trials).filter(|_| {
                let found = mean_curve(&drawn(&mut rng, curves))[0].unwrap();
                (found.band[0]..=found.band[1]).contains(&6.0)
            });
            let share = held.count() as f64 / f64::from(trials);
            // Four standard deviations of the count below 95 %, and some more for the bootstrap itself.
            assert!((0.89..=0.995).contains(&share), "{curves}: {share}");
        }
    }

    #[test]
    fn bands_move_and_scale_with_the_curves_and_hold_their_mean() {
        let curves: Vec<Vec<Option<f64>>> = [[1.0, 4.0], [2.0, 6.0], [6.0, 5.0], [3.0, 9.0]]
            .map(|values| values.map(Some).to_vec())
            .to_vec();
        let lines = curves.iter().map(|curve| {
            let change = |value: &Option<f64>| value.map(|value| 3.0 * value + 1.0);
            curve.iter().map(change).collect()
        });
        let changed: Vec<Vec<Option<f64>>> = lines.collect();
        for (one, other) in mean_curve(&curves).into_iter().zip(mean_curve(&changed)) {
            let (one, other) = (one.unwrap(), other.unwrap());
            assert!(one.band[0] < one.mean && one.mean < one.band[1]);
            let pairs = [(one.mean, other.mean), (one.band[0], other.band[0])];
            for (a, b) in pairs.into_iter().chain([(one.band[1], other.band[1])]) {
                assert!((b - (3.0 * a + 1.0)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn single_curves_equal_curves_and_gaps_have_no_spread() {
        let same = vec![vec![Some(2.0), None]; 5];
        let found = mean_curve(&same);
        assert_eq!(found[0].unwrap().band, [2.0; 2]);
        assert_eq!(found[1], None);
        let single = mean_curve(&[vec![Some(1.0)]]);
        assert_eq!(single[0].unwrap().band, [1.0; 2]);
        assert!(mean_curve(&[]).is_empty());
    }
}
