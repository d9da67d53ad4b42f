//! Oscillations of a crowd: rotary spectra of mean velocities in boxes.
//!
//! A velocity (u, v) is the complex number u + i v. The Fourier transform of its values over time has counterclockwise
//! circular motion at positive frequencies and clockwise motion at negative ones; motion to and fro along a line has
//! equal parts of both (J. Gonella, A rotary-component method for analysing meteorological and oceanographic vector
//! time series, Deep-Sea Research 19, 1972).

use libm::{cos, sincos};
use std::f64::consts::{E, TAU};

use serde::{Deserialize, Serialize};

use super::statistics::vertex;

/// The shortest series with a spectrum.
const FEWEST_SAMPLES: usize = 16;
/// Half the width of the main lobe of a Hann window, in resolutions. It contains the power of a pure oscillation.
const LOBE: f64 = 2.0;

/// The density at a peak is at least this times that where the search begins.
const PROMINENCE: f64 = 2.0;

/// A velocity, m/s, or its Fourier transform: real and imaginary part.
type Complex = [f64; 2];

/// The power of a velocity by angular frequency and sense of rotation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spectrum {
    /// The distance between two frequencies, rad/s; the first frequency is 0.
    pub step: f64,
    /// 2π over the duration of the series, rad/s: peaks closer than this cannot be distinguished.
    pub resolution: f64,
    /// Power density at each frequency of counterclockwise motion, m²/s² per rad/s. Both densities together have the
    /// integral ⟨|v − ⟨v⟩|²⟩, weighted by the window.
    pub counterclockwise: Vec<f64>,
    /// The same of clockwise motion.
    pub clockwise: Vec<f64>,
}

impl Spectrum {
    /// The periodogram of a series without its mean, with a Hann window. `every` is the time between two values,
    /// seconds. `None` for fewer than 16 values.
    pub fn of(series: &[[f64; 2]], every: f64) -> Option<Self> {
        let count = series.len();
        if count < FEWEST_SAMPLES {
            return None;
        }
        let sum = |k: usize| series.iter().map(|v| v[k]).sum::<f64>();
        let mean = [0, 1].map(|k| sum(k) / count as f64);
        let window = |n: usize| 0.5 - 0.5 * cos(TAU * (n as f64 + 0.5) / count as f64);
        // Zero padding: the spectrum has more points, but no finer resolution.
        let mut windowed = vec![[0.0; 2]; (2 * count).next_power_of_two()];
        for (n, (to, v)) in windowed.iter_mut().zip(series).enumerate() {
            *to = [0, 1].map(|k| (v[k] - mean[k]) * window(n));
        }
        let squares: f64 = (0..count).map(|n| window(n).powi(2)).sum();
        let per_power = every / (TAU * squares);
        let transform = fourier(&windowed);
        let power = |k: usize| (transform[k][0].powi(2) + transform[k][1].powi(2)) * per_power;
        let all = transform.len();
        let backward = (1..all / 2).map(|k| power(all - k));
        Some(Self {
            step: TAU / (all as f64 * every),
            resolution: TAU / (count as f64 * every),
            counterclockwise: (0..all / 2).map(power).collect(),
            clockwise: [0.0].into_iter().chain(backward).collect(),
        })
    }

    /// The mean of spectra with the same frequencies; `None` without spectra.
    fn mean<'a>(mut spectra: impl Iterator<Item = &'a Self>) -> Option<Self> {
        let mut mean = spectra.next()?.clone();
        let mut count = 1.0;
        for other in spectra {
            count += 1.0;
            let sums = mean.counterclockwise.iter_mut().chain(&mut mean.clockwise);
            let powers = other.counterclockwise.iter().chain(&other.clockwise);
            sums.zip(powers).for_each(|(sum, power)| *sum += power);
        }
        let both = mean.counterclockwise.iter_mut().chain(&mut mean.clockwise);
        both.for_each(|power| *power /= count);
        Some(mean)
    }

    /// The power density of both senses at each frequency, m²/s² per rad/s, with the frequency, rad/s.
    pub fn densities(&self) -> impl Iterator<Item = [f64; 2]> {
        let both = self.counterclockwise.iter().zip(&self.clockwise);
        both.enumerate()
            .map(|(k, (left, right))| [k as f64 * self.step, left + right])
    }

    /// ⟨|v − ⟨v⟩|²⟩, weighted by the window, m²/s².
    pub fn power(&self) -> f64 {
        self.densities().map(|[_, density]| density).sum::<f64>() * self.step
    }

    /// The part of the power at frequencies in a band, rad/s; `None` without power.
    pub fn share(&self, [low, high]: [f64; 2]) -> Option<f64> {
        let all = self.densities();
        let inside = all.filter(|[frequency, _]| (low..=high).contains(frequency));
        let part = inside.map(|[_, density]| density).sum::<f64>() * self.step / self.power();
        part.is_finite().then_some(part)
    }

    /// (P₊ − P₋)/(P₊ + P₋) with the powers of counterclockwise and clockwise motion in a band, rad/s: 1 for
    /// counterclockwise circles, −1 for clockwise ones, 0 for motion along a line. It is the mean of v × dv/dt over the
    /// mean of |v| |dv/dt| if the band is narrow. `None` without power.
    pub fn spin(&self, [low, high]: [f64; 2]) -> Option<f64> {
        let sum = |powers: &[f64]| -> f64 {
            let powers = powers.iter().enumerate();
            let inside = powers.filter(|(k, _)| (low..=high).contains(&(*k as f64 * self.step)));
            inside.map(|(_, power)| power).sum()
        };
        let (left, right) = (sum(&self.counterclockwise), sum(&self.clockwise));
        let spin = (left - right) / (left + right);
        spin.is_finite().then_some(spin)
    }

    /// The frequency with the most power, rad/s, above the trend, that is, from two resolutions on. `None` without
    /// power, and unless its density is twice that where the search begins: flat spectra and those that fall from there
    /// on, as of a crowd that comes to rest, have no peak.
    pub fn peak(&self) -> Option<f64> {
        let densities: Vec<[f64; 2]> = self.densities().collect();
        let lowest = LOBE * self.resolution;
        let mut inside =
            (1..densities.len().saturating_sub(1)).filter(|&k| densities[k][0] >= lowest);
        let start = inside.next()?;
        let top = inside.max_by(|&a, &b| densities[a][1].total_cmp(&densities[b][1]))?;
        let around = [top - 1, top, top + 1].map(|k| densities[k][1]);
        let shift = vertex(around).clamp(-0.5, 0.5);
        let stands_out = around[1] > PROMINENCE * densities[start][1];
        stands_out.then_some((top as f64 + shift) * self.step)
    }

    /// The band that holds the power of a pure oscillation with this frequency, rad/s.
    pub fn around(&self, frequency: f64) -> [f64; 2] {
        [-LOBE, LOBE].map(|resolutions| frequency + resolutions * self.resolution)
    }
}

/// The oscillations of the mean velocities in boxes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Oscillation {
    /// The mean spectrum over all boxes that were never empty.
    pub spectrum: Spectrum,
    /// Its peak, rad/s.
    pub peak: Option<f64>,
    /// The spin of each box around this peak; `None` where it was empty at some time, or does not move.
    pub spins: Vec<Option<f64>>,
}

impl Oscillation {
    /// Averages the spectra of all boxes; a box that was empty at some time is `None`. `every` is the time between two
    /// values, seconds. `None` without boxes or for fewer than 16 values.
    pub fn of(boxes: &[Option<Vec<[f64; 2]>>], every: f64) -> Option<Self> {
        let spectrum = |series: &Option<Vec<_>>| Spectrum::of(series.as_ref()?, every);
        let spectra: Vec<Option<Spectrum>> = boxes.iter().map(spectrum).collect();
        let spectrum = Spectrum::mean(spectra.iter().flatten())?;
        let peak = spectrum.peak();
        let band = peak.map(|peak| spectrum.around(peak));
        let spins = spectra.iter().map(|of| of.as_ref()?.spin(band?));
        Some(Self {
            spins: spins.collect(),
            peak,
            spectrum,
        })
    }

    /// The part of the power around the peak.
    pub fn peak_share(&self) -> Option<f64> {
        self.spectrum.share(self.spectrum.around(self.peak?))
    }
}

/// The root mean square over all times and boxes of the velocities minus their means over time, m/s; `None` if all
/// boxes were empty at some time.
pub fn speed(boxes: &[Option<Vec<[f64; 2]>>]) -> Option<f64> {
    let still = boxes.iter().flatten().map(|series| without_mean(series));
    let velocities: Vec<[f64; 2]> = still.flatten().collect();
    let squares = velocities.iter().map(|[x, y]| x * x + y * y);
    let count = velocities.len() as f64;
    (count > 0.0).then(|| (squares.sum::<f64>() / count).sqrt())
}

/// How far apart boxes move together along x and along y, meters: the distance along a row or column of boxes from
/// which on the correlation of velocities, minus their means over time, is below 1/e; between two distances it is
/// linear. If it never is, the largest distance between two boxes of a row or column. `boxes` go row by row, `None`
/// where one was empty at some time; `sides` of a box, meters. `None` without motion, and where no two boxes are in one
/// row or column.
pub fn correlation_lengths(
    boxes: &[Option<Vec<[f64; 2]>>],
    columns: usize,
    sides: [f64; 2],
) -> [Option<f64>; 2] {
    let rows = boxes.len().checked_div(columns).unwrap_or(0);
    let each = boxes.iter().map(|of| of.as_deref().map(without_mean));
    let still: Vec<_> = each.collect();
    let product = |a: usize, b: usize| -> Option<f64> {
        let (a, b) = (still[a].as_deref()?, still[b].as_deref()?);
        Some(
            a.iter()
                .zip(b)
                .map(|(a, b)| a[0] * b[0] + a[1] * b[1])
                .sum(),
        )
    };
    let mean = |products: Vec<f64>| {
        let count = products.len() as f64;
        (count > 0.0).then(|| products.iter().sum::<f64>() / count)
    };
    let square = mean((0..boxes.len()).filter_map(|k| product(k, k)).collect());
    let power = square.filter(|&power| power > 0.0);
    let along = |step: usize, place: fn(usize, usize) -> usize, count: usize| {
        let power = power?;
        let at = |distance: usize| {
            let inside = (0..boxes.len()).filter(|&k| place(k, columns) + distance < count);
            let products = inside.filter_map(|k| product(k, k + step * distance));
            Some((distance as f64, mean(products.collect())? / power))
        };
        // Distances at which no two boxes have people are skipped.
        let correlations: Vec<(f64, f64)> = (0..count).filter_map(at).collect();
        let below = correlations.iter().position(|&(_, part)| part < 1.0 / E);
        match (below, correlations.last()) {
            (Some(k), _) => {
                let ((near, before), (far, after)) = (correlations[k - 1], correlations[k]);
                Some(near + (far - near) * (before - 1.0 / E) / (before - after))
            }
            (None, Some(&(longest, _))) => (longest > 0.0).then_some(longest),
            (None, None) => None,
        }
    };
    let x = along(1, |k, columns| k % columns, columns);
    let y = along(columns, |k, columns| k / columns, rows);
    [x.map(|x| x * sides[0]), y.map(|y| y * sides[1])]
}

fn without_mean(series: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mean = [0, 1].map(|k| series.iter().map(|v| v[k]).sum::<f64>() / series.len() as f64);
    let rest = series.iter().map(|v| [v[0] - mean[0], v[1] - mean[1]]);
    rest.collect()
}

/// Σ_n z_n e^(−2πi kn/N) for all k; N is a power of two (Cooley and Tukey 1965).
fn fourier(values: &[Complex]) -> Vec<Complex> {
    let count = values.len();
    if count < 2 {
        return values.to_vec();
    }
    let every_other = |first: usize| {
        let values = values.iter().skip(first).step_by(2);
        fourier(&values.copied().collect::<Vec<_>>())
    };
    let (even, odd) = (every_other(0), every_other(1));
    let mut sums = vec![[0.0; 2]; count];
    for (k, ([a, b], [c, d])) in even.into_iter().zip(odd).enumerate() {
        let (sin, cos) = sincos(-TAU * k as f64 / count as f64);
        let [c, d] = [c * cos - d * sin, c * sin + d * cos];
        sums[k] = [a + c, b + d];
        sums[k + count / 2] = [a - c, b - d];
    }
    sums
}
