//! Statistics: mean and standard deviation, the standard error and the confidence interval of a mean, ranges of
//! repeated measurements, straight lines, and the jackknife.

use std::fmt;

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize, Serializer};
use statrs::distribution::{
    Beta, Binomial, ChiSquared, ContinuousCDF, DiscreteCDF, Normal, StudentsT, Uniform,
};
use statrs::statistics::{Data, Max, Min, OrderStatistics};
use statrs::stats_tests::NaNPolicy;
use statrs::stats_tests::ks_test::{KSOneSampleAlternativeMethod, ks_onesample};

/// The mean and the standard deviation of some values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MeanStd {
    /// Number of values.
    pub count: usize,
    /// The mean; 0 without values.
    pub mean: f64,
    /// Sum of the squared differences from the mean.
    squares: f64,
}

impl MeanStd {
    /// The mean and the standard deviation of `values`, in two passes; `None` without values.
    pub fn of(values: &[f64]) -> Option<Self> {
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares = values.iter().map(|value| (value - mean).powi(2)).sum();
        (count > 0).then_some(Self {
            count,
            mean,
            squares,
        })
    }

    /// Adds a value to a running mean and standard deviation (Welford 1962).
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let off = value - self.mean;
        self.mean += off / self.count as f64;
        self.squares += off * (value - self.mean);
    }

    /// The sample standard deviation (n − 1); `None` for fewer than two values.
    pub fn std(&self) -> Option<f64> {
        (self.count > 1).then(|| (self.squares / (self.count - 1) as f64).sqrt())
    }

    /// The population standard deviation (n); 0 for fewer than two values.
    pub fn population_std(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }

    /// The standard error of the mean; 0 for fewer than two values.
    pub fn error(&self) -> f64 {
        let count = self.count.max(1) as f64;
        (self.squares / (count - 1.0).max(1.0) / count).sqrt()
    }

    /// Half the width of the 95 % confidence interval of the mean (Student's t); `None` for fewer than two values.
    pub fn interval_95(&self) -> Option<f64> {
        student_95(self.count).map(|t| t * self.error())
    }
}

/// As `mean`, `deviation` (of the sample) and `count`.
impl Serialize for MeanStd {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Fields {
            mean: f64,
            deviation: Option<f64>,
            count: usize,
        }
        let fields = Fields {
            mean: self.mean,
            deviation: self.std(),
            count: self.count,
        };
        fields.serialize(serializer)
    }
}

/// Half the width of the 95 % confidence interval of a mean of `count` values, in standard errors of the mean: the
/// 97.5 % quantile of Student's t with `count` − 1 degrees of freedom. `None` for fewer than two values, which have no
/// sample standard deviation.
pub fn student_95(count: usize) -> Option<f64> {
    student(count.checked_sub(1)?, 0.95)
}

/// Half the width of an interval around 0 that holds Student's t with this probability. `None` without degrees of
/// freedom.
pub fn student(degrees: usize, probability: f64) -> Option<f64> {
    let distribution = StudentsT::new(0.0, 1.0, degrees as f64).ok()?;
    Some(distribution.inverse_cdf(0.5 + 0.5 * probability))
}

/// The factor by which a standard deviation with these degrees of freedom is smaller than an upper limit of the true
/// one, which holds with this probability for normal values. `None` without degrees of freedom.
pub fn upper_std(degrees: usize, probability: f64) -> Option<f64> {
    let distribution = ChiSquared::new(degrees as f64).ok()?;
    Some((degrees as f64 / distribution.inverse_cdf(1.0 - probability)).sqrt())
}

/// The tail of the bootstrap distribution of a mean at each end of its 95 % expanded percentile interval (Hesterberg
/// 2015): Φ(−√(n / (n − 1)) t), with the 97.5 % quantile t of Student's t. `None` for fewer than two values.
pub fn expanded_tail(count: usize) -> Option<f64> {
    let t = student_95(count)?;
    let of = count as f64;
    Some(Normal::standard().cdf(-(of / (of - 1.0)).sqrt() * t))
}

/// A share of runs, with its 95 % confidence interval (Clopper and Pearson 1934).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    /// The number of these runs.
    pub count: usize,
    /// The number of all runs.
    pub of: usize,
    /// The ends of the interval, between 0 and 1.
    pub interval: [f64; 2],
}

impl Share {
    /// The share `count` of `of`.
    pub fn of(count: usize, of: usize) -> Self {
        let [hits, misses] = [count as f64, of.saturating_sub(count) as f64];
        let end = |a: f64, b: f64, at: f64, otherwise: f64| {
            let beta = Beta::new(a, b).ok();
            beta.map_or(otherwise, |beta| beta.inverse_cdf(at))
        };
        let low = end(hits, misses + 1.0, 0.025, 0.0);
        let high = end(hits + 1.0, misses, 0.975, 1.0);
        let interval = [low, high];
        Self {
            count,
            of,
            interval,
        }
    }
}

/// As `3.3 % (0.1 to 17.2 %)`.
impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [low, high] = self.interval.map(|end| 100.0 * end);
        let part = 100.0 * self.count as f64 / self.of.max(1) as f64;
        write!(f, "{part:.1} % ({low:.1} to {high:.1} %)")
    }
}

/// The probability that as many uniform draws between 0 and 1 are as far from uniform as `shares` (Kolmogorov–Smirnov
/// test, two-sided). `None` without values.
pub fn uniform_probability(shares: &[f64]) -> Option<f64> {
    let uniform = Uniform::standard();
    let method = KSOneSampleAlternativeMethod::TwoSidedAsymptotic;
    let found = ks_onesample(shares.to_vec(), &uniform, method, NaNPolicy::Error);
    found.ok().map(|(_, probability)| probability)
}

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
        MeanStd::of(values).map(|of| Self {
            value: of.mean,
            error: of.error(),
        })
    }
}

/// The minimum, median and maximum of repeated measurements.
///
/// The minimum of times shows the machine without other load, the median its usual load. If they are far apart, the
/// machine was busy with other work.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Range {
    /// The minimum.
    pub minimum: f64,
    /// The median: the middle value, or the mean of the two middle values.
    pub median: f64,
    /// The maximum.
    pub maximum: f64,
}

impl Range {
    /// The range of `values`; NaN without values.
    pub fn of(values: &[f64]) -> Self {
        let mut values = Data::new(values.to_vec());
        Self {
            minimum: values.min(),
            median: values.median(),
            maximum: values.max(),
        }
    }

    /// The range of `values` divided by `base`, run by run: what affects both values of a pair cancels.
    pub fn of_ratios(values: &[f64], base: &[f64]) -> Self {
        let ratios: Vec<f64> = values.iter().zip(base).map(|(v, b)| v / b).collect();
        Self::of(&ratios)
    }

    /// The same in another unit: all numbers times `factor`.
    pub fn times(&self, factor: f64) -> Self {
        Self {
            minimum: self.minimum * factor,
            median: self.median * factor,
            maximum: self.maximum * factor,
        }
    }
}

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

    /// Least-squares fit through (x, y); `None` for fewer than two different x.
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

    /// A robust line through (x, y), sorted by x: the median slope of lines from each point of the first half to its
    /// counterpart in the second half (Theil's incomplete method, 1950), and the median offset. Up to a quarter of the
    /// points may be anywhere. `None` without points in both halves that differ in x.
    pub fn of_halves(points: &[(f64, f64)]) -> Option<Self> {
        let far = points.len().div_ceil(2);
        let pairs = points.iter().zip(points.get(far..)?);
        let ordered = pairs.filter(|(a, b)| a.0 < b.0);
        let slopes: Vec<f64> = ordered.map(|(a, b)| (b.1 - a.1) / (b.0 - a.0)).collect();
        if slopes.is_empty() {
            return None;
        }
        let slope = Range::of(&slopes).median;
        let offsets: Vec<f64> = points.iter().map(|(x, y)| y - slope * x).collect();
        Some(Self {
            slope,
            offset: Range::of(&offsets).median,
        })
    }
}

/// The probability that the value with this rank among `draws` (1 is the smallest) is not below the quantile `share` of
/// their distribution, whatever it is (Wilks 1941): that fewer than `rank` draws are below this quantile.
pub fn probability_above(rank: usize, draws: usize, share: f64) -> f64 {
    let below = Binomial::new(share, draws as u64).ok();
    match (rank, below) {
        (0, _) | (_, None) => 0.0,
        (rank, Some(below)) => below.cdf(rank as u64 - 1),
    }
}

/// The number of draws whose largest is not below the quantile `share` with this probability: 1 − shareⁿ ≥ probability.
pub fn draws_above(share: f64, probability: f64) -> usize {
    let draws = ((1.0 - probability).ln() / share.ln()).ceil().max(1.0) as usize;
    // A logarithm that is rounded up costs one draw too many.
    let fewer = draws - 1;
    match fewer > 0 && 1.0 - share.powi(fewer as i32) >= probability {
        true => fewer,
        false => draws,
    }
}

/// The numbers from 0 to `count` − 1 in random order.
pub fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut numbers: Vec<usize> = (0..count).collect();
    numbers.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
    numbers
}

/// The place of the highest point of the parabola through three values at −1, 0 and 1; 0 if the parabola has none.
pub fn vertex([before, here, after]: [f64; 3]) -> f64 {
    let bend = before - 2.0 * here + after;
    match bend < 0.0 {
        true => 0.5 * (before - after) / bend,
        false => 0.0,
    }
}

/// A function of points, with its standard error from a jackknife over blocks of neighboring points: their errors are
/// correlated, so whole blocks are left out. `None` if `value` is `None` for all points or without one of the blocks.
pub fn jackknife<P: Copy>(points: &[P], value: impl Fn(&[P]) -> Option<f64>) -> Option<Estimate> {
    const BLOCKS: usize = 6;
    let all = value(points)?;
    let blocks = BLOCKS.min(points.len());
    let leaving_out = (0..blocks).map(|block| {
        let [first, last] = [block, block + 1].map(|block| block * points.len() / blocks);
        value(&[&points[..first], &points[last..]].concat())
    });
    let without = leaving_out.collect::<Option<Vec<f64>>>()?;
    let count = blocks as f64;
    let error = MeanStd::of(&without).map_or(0.0, |of| (of.squares * (count - 1.0) / count).sqrt());
    Some(Estimate { value: all, error })
}
