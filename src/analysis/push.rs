//! A push that runs through a row of people: when it reaches each of them, how fast and how far they are moved.
//!
//! The same definitions hold for measured heads and for simulated people, both at some 25 samples per second: places
//! along the row are means over five samples, speeds are their central differences, and a speed counts as reached if
//! four samples in a row have it.

use crate::statistics::Range;

/// The speeds at which fronts are looked for, m/s.
pub const THRESHOLDS: [f64; 6] = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3];
/// The samples on either side that enter a mean.
const HALF: usize = 2;
/// The samples for which a speed must last.
const SUSTAINED: usize = 4;
/// The fewest people for the speed of a front.
const FEWEST: usize = 4;
/// Speeds that differ by less than this part of them are equal: the top speed may last for a while.
const ROUNDING: f64 = 1e-9;
/// The parts of a sample to which breaks are found.
const PARTS: usize = 10;

/// What a push does to one person.
#[derive(Debug, Clone, PartialEq)]
pub struct Pushed {
    /// The first place along the row, meters.
    pub place: f64,
    /// The speeds along the row, m/s.
    pub speeds: Vec<f64>,
    /// The largest one, m/s.
    pub top_speed: f64,
    /// The largest displacement, meters.
    pub reach: f64,
    /// When the speed first reaches each of the [`THRESHOLDS`] and keeps it, seconds.
    pub reached: [Option<f64>; THRESHOLDS.len()],
    /// Where two straight lines that join fit the places until the top speed best, seconds; `None` if the person is
    /// fastest at the start.
    pub starts: Option<f64>,
}

impl Pushed {
    /// A person with these places along the row, sampled every `every` seconds; `None` for fewer than two samples.
    pub fn of(places: &[f64], every: f64) -> Option<Self> {
        let last = places.len().checked_sub(1).filter(|last| *last > 0)?;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let smooth = |k: usize| mean(&places[k.saturating_sub(HALF)..=(k + HALF).min(last)]);
        let smooth: Vec<f64> = (0..=last).map(smooth).collect();
        let speed = |k: usize| {
            let [from, to] = [k.saturating_sub(1), (k + 1).min(last)];
            (smooth[to] - smooth[from]) / ((to - from) as f64 * every)
        };
        let speeds: Vec<f64> = (0..=last).map(speed).collect();
        let top_speed = speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let nearly = top_speed - ROUNDING * top_speed.abs();
        let top = speeds.iter().position(|speed| *speed >= nearly)?;
        let reached = |threshold: f64| {
            let keeps = |speeds: &[f64]| speeds.iter().all(|speed| *speed >= threshold);
            let first = speeds.windows(SUSTAINED).position(keeps);
            first.map(|k| k as f64 * every)
        };
        let farthest = smooth.iter().copied().fold(smooth[0], f64::max);
        Some(Self {
            place: smooth[0],
            top_speed,
            reach: farthest - smooth[0],
            reached: THRESHOLDS.map(reached),
            starts: break_of(&smooth[..=top]).map(|samples| samples * every),
            speeds,
        })
    }

    /// The speed of the front over the first places, m/s: from the median, over the thresholds, of the slowness of the
    /// straight line through the times at which people reach them; `None` if it reaches fewer than four people, or
    /// does not run forward.
    pub fn front(row: &[Self]) -> Option<f64> {
        let slopes = (0..THRESHOLDS.len()).filter_map(|k| slowness(row, |one| one.reached[k]));
        let lines: Vec<f64> = slopes.collect();
        let median = (!lines.is_empty()).then(|| Range::of(&lines).median);
        median.filter(|slowness| *slowness > 0.0).map(f64::recip)
    }

    /// The same from the times at which people [start](Self::starts), m/s.
    pub fn front_of_starts(row: &[Self]) -> Option<f64> {
        let slowness = slowness(row, |one| one.starts)?;
        (slowness > 0.0).then(|| slowness.recip())
    }

    /// The largest sum of the speeds of all people but the first, m/s: for equal masses, the momentum passed on.
    pub fn passed_on(row: &[Self]) -> Option<f64> {
        let (_, others) = row.split_first()?;
        let samples = others.iter().map(|one| one.speeds.len()).min()?;
        let sum = |k: usize| others.iter().map(|one| one.speeds[k]).sum::<f64>();
        (0..samples).map(sum).reduce(f64::max)
    }
}

/// dt/dx of the line of least squares through the times of people over their places, s/m.
fn slowness(row: &[Pushed], time: impl Fn(&Pushed) -> Option<f64>) -> Option<f64> {
    let known = row.iter().filter_map(|one| Some((one.place, time(one)?)));
    let points: Vec<(f64, f64)> = known.collect();
    if points.len() < FEWEST {
        return None;
    }
    let count = points.len() as f64;
    let sums = points
        .iter()
        .fold((0.0, 0.0), |(x, t), one| (x + one.0, t + one.1));
    let (x, t) = (sums.0 / count, sums.1 / count);
    let (both, own) = points.iter().fold((0.0, 0.0), |(both, own), one| {
        (both + (one.0 - x) * (one.1 - t), own + (one.0 - x).powi(2))
    });
    (own > 0.0).then(|| both / own)
}

/// The break, in samples, of the two joined straight lines that fit `values` best (least squares); `None` for fewer
/// than four values.
fn break_of(values: &[f64]) -> Option<f64> {
    if values.len() < FEWEST {
        return None;
    }
    // A hinge (t − b)₊ beside a straight line takes (v·h)²/(h·h) off the squares, v and h without their own lines.
    let rest = without_line(values);
    let candidates = (1..PARTS * (values.len() - 1)).map(|part| part as f64 / PARTS as f64);
    let gained = candidates.map(|at| {
        let bent = (0..values.len()).map(|k| (k as f64 - at).max(0.0));
        let kink: Vec<f64> = bent.collect();
        let hinge = without_line(&kink);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let own = product(&hinge, &hinge);
        let gained = if own > 1e-9 {
            product(&rest, &hinge).powi(2) / own
        } else {
            0.0
        };
        (at, gained)
    });
    let best = gained.reduce(|best, one| if one.1 > best.1 { one } else { best });
    best.map(|(at, _)| at)
}

/// What is left of values without their line of least squares.
fn without_line(values: &[f64]) -> Vec<f64> {
    let middle = (values.len() - 1) as f64 / 2.0;
    let off = |k: usize| k as f64 - middle;
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let all = || values.iter().enumerate();
    let moment = all().map(|(k, value)| off(k) * value).sum::<f64>();
    let rise = moment / all().map(|(k, _)| off(k).powi(2)).sum::<f64>();
    let rest = all().map(|(k, value)| value - mean - rise * off(k));
    rest.collect()
}
