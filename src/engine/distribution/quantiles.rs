//! The normal and the gamma distribution, with the same bits on all machines: standard libraries compute logarithms
//! and exponentials in their own ways.

use std::f64::consts::SQRT_2;

use libm::{erfc, exp, lgamma, log};

/// A normal distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normal {
    pub mean: f64,
    /// The standard deviation, above 0.
    pub std: f64,
}

/// A rational function: the coefficients of numerator and denominator, the highest power first.
struct Ratio([[f64; 8]; 2]);

impl Ratio {
    fn at(&self, x: f64) -> f64 {
        let [above, below] = self
            .0
            .map(|c| c.into_iter().fold(0.0, |sum, c| sum * x + c));
        above / below
    }
}

/// Of 0.425² − (p − ½)², for |p − ½| up to 0.425; times p − ½.
const CENTER: Ratio = Ratio([
    [
        2_509.080_928_730_122_7,
        33_430.575_583_588_13,
        67_265.770_927_008_7,
        45_921.953_931_549_87,
        13_731.693_765_509_46,
        1_971.590_950_306_551_3,
        133.141_667_891_784_38,
        3.387_132_872_796_366_5,
    ],
    [
        5_226.495_278_852_854,
        28_729.085_735_721_943,
        39_307.895_800_092_71,
        21_213.794_301_586_597,
        5_394.196_021_424_751,
        687.187_007_492_057_9,
        42.313_330_701_600_91,
        1.0,
    ],
]);
/// Of √(−ln p) − 1.6, for roots up to 5.
const TAIL: Ratio = Ratio([
    [
        0.000_774_545_014_278_341_4,
        0.022_723_844_989_269_184,
        0.241_780_725_177_450_6,
        1.270_458_252_452_368_4,
        3.647_848_324_763_204_5,
        5.769_497_221_460_691,
        4.630_337_846_156_546,
        1.423_437_110_749_683_5,
    ],
    [
        1.050_750_071_644_416_9e-9,
        0.000_547_593_808_499_534_5,
        0.015_198_666_563_616_457,
        0.148_103_976_427_480_08,
        0.689_767_334_985_1,
        1.676_384_830_183_803_8,
        2.053_191_626_637_759,
        1.0,
    ],
]);
/// Of √(−ln p) − 5, beyond.
const FAR_TAIL: Ratio = Ratio([
    [
        2.010_334_399_292_288_1e-7,
        2.711_555_568_743_487_6e-5,
        0.001_242_660_947_388_078_4,
        0.026_532_189_526_576_124,
        0.296_560_571_828_504_87,
        1.784_826_539_917_291_3,
        5.463_784_911_164_114,
        6.657_904_643_501_103,
    ],
    [
        2.044_263_103_389_939_7e-15,
        1.421_511_758_316_446e-7,
        1.846_318_317_510_054_8e-5,
        0.000_786_869_131_145_613_3,
        0.014_875_361_290_850_615,
        0.136_929_880_922_735_8,
        0.599_832_206_555_888,
        1.0,
    ],
]);

impl Normal {
    /// The share of all draws up to `x`.
    pub fn share_up_to(&self, x: f64) -> f64 {
        0.5 * erfc((self.mean - x) / (self.std * SQRT_2))
    }

    /// The value below which a share of `p` of all draws lies; 0 < p < 1.
    ///
    /// M. J. Wichura, Algorithm AS 241: The percentage points of the normal distribution, Applied Statistics 37 (1988),
    /// PPND16: correct to about 16 digits.
    pub fn quantile(&self, p: f64) -> f64 {
        let from_middle = p - 0.5;
        let steps = if from_middle.abs() <= 0.425 {
            CENTER.at(0.180_625 - from_middle * from_middle) * from_middle
        } else {
            let root = (-log(p.min(1.0 - p))).sqrt();
            let distance = match root <= 5.0 {
                true => TAIL.at(root - 1.6),
                false => FAR_TAIL.at(root - 5.0),
            };
            distance.copysign(from_middle)
        };
        self.mean + self.std * steps
    }
}

/// A gamma distribution of scale 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gamma {
    /// Above 0.
    pub shape: f64,
}

/// Steps of Newton's method, of which a few suffice, or halvings.
const STEPS: usize = 200;

/// Terms of a series, or of a continued fraction: up to [`LARGEST_SHAPE`](super::LARGEST_SHAPE), some 700 suffice.
const TERMS: u32 = 10_000;

impl Gamma {
    /// The share of all draws up to `x` ≥ 0: the regularized incomplete gamma function P(a, x), with a the shape.
    ///
    /// NIST Digital Library of Mathematical Functions: equation 8.11.4, or beyond a + 1 the continued fraction 8.9.2,
    /// evaluated by Lentz's method.
    pub fn share_up_to(&self, x: f64) -> f64 {
        let a = self.shape;
        if x <= 0.0 {
            return 0.0;
        }
        if x == f64::INFINITY {
            return 1.0;
        }
        match x < a + 1.0 {
            true => exp(a * log(x) - x - lgamma(a + 1.0)) * series(a, x),
            false => 1.0 - exp(a * log(x) - x - lgamma(a)) / fraction(a, x),
        }
    }

    /// The value below which a share of `p` of all draws lies; 0 < p < 1. By Newton's method, or a halving of the
    /// interval that contains the value where a step leaves it.
    pub fn quantile(&self, p: f64) -> f64 {
        let (mut low, mut high) = (1.0, 2.0);
        while self.share_up_to(low) > p {
            (low, high) = (0.5 * low, low);
        }
        while self.share_up_to(high) < p {
            (low, high) = (high, 2.0 * high);
        }
        let mut x = 0.5 * (low + high);
        for _ in 0..STEPS {
            let excess = self.share_up_to(x) - p;
            match excess >= 0.0 {
                true => high = x,
                false => low = x,
            }
            let newton = x - excess / self.density(x);
            let is_inside = low < newton && newton < high;
            let next = if is_inside {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - x).abs() <= 2.0 * f64::EPSILON * x {
                return next;
            }
            x = next;
        }
        x
    }

    fn density(&self, x: f64) -> f64 {
        exp((self.shape - 1.0) * log(x) - x - lgamma(self.shape))
    }
}

/// Σ_k xᵏ/((a + 1)…(a + k)).
fn series(a: f64, x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..TERMS {
        term *= x / (a + f64::from(k));
        sum += term;
        if term < f64::EPSILON * sum {
            break;
        }
    }
    sum
}

/// x + 1 − a − 1(1 − a)/(x + 3 − a − 2(2 − a)/(x + 5 − a − …)).
fn fraction(a: f64, x: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let mut b = x + 1.0 - a;
    let (mut value, mut above, mut below) = (b, b, 0.0);
    for k in 1..TERMS {
        let k = f64::from(k);
        let numerator = -k * (k - a);
        b += 2.0;
        below = 1.0 / nonzero(b + numerator * below, TINY);
        above = nonzero(b + numerator / above, TINY);
        let factor = above * below;
        value *= factor;
        if (factor - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    value
}

fn nonzero(x: f64, tiny: f64) -> f64 {
    if x.abs() < tiny { tiny } else { x }
}
