//! What the times in a file say: the frame rate, and the frames if the file does not number them.

use libm::log10;
use std::collections::BTreeMap;

use super::FRAME_RATES;
use super::tracks::Entry;

/// Times whose distance is off by at most this part of a frame count as one frame apart or a whole number of them.
const OFF: f64 = 0.3;
/// Distances of more frames than this are not checked: the rounding of times adds up.
const NEAR: f64 = 10.0;
/// Ticks per second that number people's times if they have no frames in common.
const TICKS: f64 = 1000.0;
/// At least so many ticks lie between the rows of a person.
const FEWEST_TICKS: f64 = 20.0;

/// What times say of the frame rate: the first time of each frame, seconds.
#[derive(Default)]
pub struct Times(BTreeMap<i64, f64>);

impl Times {
    /// Adds the time of a row, seconds. A time that is no finite number makes no frame rate, which `rate` says.
    pub fn add(&mut self, frame: i64, time: f64) {
        self.0.entry(frame).or_insert(time);
    }

    /// The frame rate: the slope of the line through all times, or through frame 0 at 0 s if there is only one. Times
    /// are rounded: a whole number that fits them about as well is meant.
    pub fn rate(&self) -> Option<Result<f64, String>> {
        /// A whole rate may miss a time by this many times what the slope misses, and by rounding.
        const AS_WELL: f64 = 1.5;
        const ROUNDING: f64 = 1e-9;
        let (&last, &end) = self.0.last_key_value()?;
        let count = self.0.len() as f64;
        let times = || self.0.iter().map(|(&frame, &time)| (frame as f64, time));
        let [frame, time] = times().fold([0.0; 2], |[f, t], (frame, time)| {
            [f + frame / count, t + time / count]
        });
        let products = times().map(|(f, t)| [(f - frame) * (t - time), (f - frame).powi(2)]);
        let [both, square] = products.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
        let fps = match self.0.len() {
            1 if last <= 0 => return None,
            1 => last as f64 / end,
            _ => square / both,
        };
        if !FRAME_RATES.contains(&fps) {
            return Some(Err(format!(
                "frame {last} at {end:e} s makes {fps:e} frames per second: frame f is at f / fps; give --fps"
            )));
        }
        let misses = |fps: f64| {
            let miss = |(f, t): (f64, f64)| (t - time - (f - frame) / fps).abs();
            times().map(miss).fold(0.0, f64::max)
        };
        let whole = fps.round();
        if whole > 0.0 && misses(whole) <= AS_WELL * misses(fps) + ROUNDING {
            return Some(Ok(whole));
        }
        let unit = 10_f64.powi(8 - log10(fps).floor() as i32);
        Some(Ok((fps * unit).round() / unit))
    }
}

/// Numbers the frames of rows by their times, seconds, and returns the frame rate. Frame f is at about f / fps.
pub fn number(entries: &mut [Entry], times: &[f64]) -> Result<Option<f64>, String> {
    let mut distinct = times.to_vec();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    let place = |time: f64| distinct.partition_point(|&other| other < time);
    let Some(step) = step(entries, times) else {
        for (entry, &time) in entries.iter_mut().zip(times) {
            entry.frame = place(time) as i64;
        }
        return Ok(None);
    };
    let too_far = || format!("its times are {step:e} s apart, and too many such steps from 0 s");
    let is_far = |count: f64| count.is_nan() || count.abs() > 1e15;
    if distinct.iter().any(|time| is_far(time / step)) {
        return Err(too_far());
    }
    if let Some(frames) = in_common(&distinct, step) {
        let mut all = Times::default();
        frames
            .iter()
            .zip(&distinct)
            .for_each(|(&frame, &time)| all.add(frame, time));
        let fps = all.rate().ok_or_else(too_far)??;
        let first = (distinct[0] * fps).round() as i64;
        for (entry, &time) in entries.iter_mut().zip(times) {
            entry.frame = first + frames[place(time)];
        }
        return Ok(Some(fps));
    }
    let mut fps = TICKS;
    while fps * step < FEWEST_TICKS && fps < *FRAME_RATES.end() {
        fps *= 10.0;
    }
    for (entry, &time) in entries.iter_mut().zip(times) {
        if is_far(time * fps) {
            return Err(too_far());
        }
        entry.frame = (time * fps).round() as i64;
    }
    Ok(Some(fps))
}

/// The usual time between two rows of a person, seconds: the mean of those up to half above the median.
fn step(entries: &[Entry], times: &[f64]) -> Option<f64> {
    let mut rows: Vec<(i64, f64)> = entries
        .iter()
        .map(|e| e.id)
        .zip(times.iter().copied())
        .collect();
    rows.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let pairs = rows.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let mut steps: Vec<f64> = pairs
        .map(|pair| pair[1].1 - pair[0].1)
        .filter(|&step| step > 0.0)
        .collect();
    if steps.is_empty() {
        return None;
    }
    let middle = steps.len() / 2;
    let median = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let usual: Vec<f64> = steps
        .into_iter()
        .filter(|&step| step <= 1.5 * median)
        .collect();
    Some(usual.iter().sum::<f64>() / usual.len() as f64)
}

/// The number of each time's frame, from 0, if all times are whole numbers of steps apart.
fn in_common(times: &[f64], step: f64) -> Option<Vec<i64>> {
    let mut frames = vec![0];
    for pair in times.windows(2) {
        let count = (pair[1] - pair[0]) / step;
        let whole = count.round();
        if whole < 1.0 || (count < NEAR && (count - whole).abs() > OFF) {
            return None;
        }
        frames.push(frames.last()? + whole as i64);
    }
    Some(frames)
}
