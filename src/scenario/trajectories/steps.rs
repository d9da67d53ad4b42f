//! The steps from a person's row to the next, gaps, and the speeds on the way.

use libm::{log, log10};
use std::collections::BTreeMap;

use super::order::median;
use super::tracks::{TOO_FAST, Tracks};
use super::unit::Unit;
use engine::math::Vector;

/// A person has a step of its own if so many of its rows are this far from the next.
const FEWEST: u64 = 3;
/// A step of a person's own is at most this many times that of the others: longer ones are gaps.
const LONGEST: i64 = 16;
/// Speeds are means over at least this time, seconds, so that the noise of single positions counts little.
const LEAST_SECS: f64 = 0.4;
/// How fast people walk, m/s: the unit that makes a median speed most like it probably is the right one.
const WALK: f64 = 1.3;
/// Median speeds in the right unit, m/s.
const PLAUSIBLE: [f64; 2] = [0.2, 3.0];

impl Tracks {
    /// The step of person `p`: the usual difference between the frame numbers of its consecutive rows.
    pub fn step_of(&self, p: usize) -> i64 {
        self.steps.get(&(p as u32)).copied().unwrap_or(self.step)
    }

    /// Whether person `p` is missing between two rows whose frame numbers differ by this. A row may be late by half a
    /// step.
    pub fn is_gap(&self, p: usize, frames: i64) -> bool {
        2 * frames > 3 * self.step_of(p)
    }

    /// The number of steps from the first frame to the last, and one; at least the number of frames.
    pub fn span(&self) -> u64 {
        let (Some(first), Some(last)) = (self.frames.first(), self.frames.last()) else {
            return 0;
        };
        let steps = ((last - first) / self.step) as u64 + 1;
        steps.max(self.frames.len() as u64)
    }

    /// Finds the steps of all people.
    pub(super) fn find_steps(&mut self) {
        let of_people: Vec<BTreeMap<i64, u64>> =
            (0..self.ids.len()).map(|p| self.counted_steps(p)).collect();
        let mut all = BTreeMap::new();
        for (&step, count) in of_people.iter().flatten() {
            *all.entry(step).or_insert(0) += count;
        }
        self.step = most_common(&all).map_or(1, |(step, _)| step);
        let own = of_people.iter().enumerate().filter_map(|(p, steps)| {
            let (step, count) = most_common(steps)?;
            let is_usual = count >= FEWEST && 2 * count > steps.values().sum();
            let is_own = is_usual && step != self.step && step / LONGEST <= self.step;
            is_own.then_some((p as u32, step))
        });
        self.steps = own.collect();
    }

    /// Counts the differences between the frame numbers of a person's consecutive rows.
    fn counted_steps(&self, p: usize) -> BTreeMap<i64, u64> {
        let mut steps = BTreeMap::new();
        for [from, to] in self.moves(p) {
            let step = self.frame_of(to) - self.frame_of(from);
            *steps.entry(step).or_insert(0) += 1;
        }
        steps
    }

    /// The pairs of consecutive rows of a person.
    pub(super) fn moves(&self, p: usize) -> impl Iterator<Item = [usize; 2]> + '_ {
        let pairs = self.rows_of(p).windows(2);
        pairs.map(|pair| [pair[0] as usize, pair[1] as usize])
    }

    /// Adds notes on steps between frames and on gaps.
    pub(super) fn note_steps(&mut self) {
        if self.step != 1 {
            let note = format!("frames are numbered in steps of {}", self.step);
            self.notes.push(note);
        }
        let (mut gaps, mut longest) = (0, 0);
        for p in 0..self.ids.len() {
            let lengths = self
                .moves(p)
                .map(|[from, to]| self.frame_of(to) - self.frame_of(from));
            for length in lengths.filter(|&length| self.is_gap(p, length)) {
                (gaps, longest) = (gaps + 1, length.max(longest));
            }
        }
        if gaps > 0 {
            self.notes.push(format!(
                "{gaps} gap(s) in which a person is missing, the longest {:.2} s; no motion is measured across",
                self.time(longest)
            ));
        }
        let off = self.off_frames();
        let common = self.together();
        let empty = common.span() - common.frames.len() as u64;
        if off > 0 {
            self.notes.push(format!(
                "{off} of {} rows are in frames of their own: in the common frames places between rows are \
                 interpolated",
                self.len()
            ));
        }
        if empty > 0 {
            let note = format!("{empty} frame(s) contain no persons; they count as empty");
            self.notes.push(note);
        }
    }

    /// A note on a median speed that no crowd has: by which factor it is too fast, and the unit that fits.
    pub(super) fn note_speed(&self, speed: f64) -> Option<String> {
        if speed <= TOO_FAST {
            return None;
        }
        let taken = self.unit.unwrap_or(Unit::Meter);
        let in_unit = |unit: Unit| speed * unit.meters() / taken.meters();
        let fits = |unit: &Unit| (PLAUSIBLE[0]..=PLAUSIBLE[1]).contains(&in_unit(*unit));
        let off = |unit: &Unit| log(in_unit(*unit) / WALK).abs();
        let units = Unit::ALL
            .into_iter()
            .filter(|unit| *unit != taken && fits(unit));
        let advice = match units.min_by(|a, b| off(a).total_cmp(&off(b))) {
            Some(unit) => format!("with --unit {unit} it is {:.2} m/s", in_unit(unit)),
            None => "check the unit, the frame rate and the order of the columns".to_owned(),
        };
        Some(format!(
            "half of all steps are faster than {} m/s, {} times as fast as people walk: {advice}",
            brief(speed),
            brief(speed / WALK)
        ))
    }

    /// The median speed over all moves that take at least 0.4 s, or the whole way of people who are there for less,
    /// m/s; 0 without moves.
    pub fn median_speed(&self) -> f64 {
        let speeds = (0..self.ids.len()).flat_map(|p| self.speeds(p));
        median(speeds.collect()).unwrap_or(0.0)
    }

    fn speeds(&self, p: usize) -> Vec<f64> {
        let numbers = self.rows_of(p).iter().map(|&row| row as usize);
        let rows: Vec<(f64, Vector)> = numbers
            .map(|row| (self.time(self.frame_of(row)), self.position[row]))
            .collect();
        let (mut speeds, mut from) = (Vec::new(), 0);
        for to in 1..rows.len() {
            let secs = rows[to].0 - rows[from].0;
            let is_whole = from == 0 && to + 1 == rows.len();
            if secs >= LEAST_SECS || (is_whole && secs > 0.0) {
                speeds.push((rows[to].1 - rows[from].1).norm() / secs);
                from = to;
            }
        }
        speeds
    }
}

/// The most common step with its count, the shortest if there are several.
fn most_common(steps: &BTreeMap<i64, u64>) -> Option<(i64, u64)> {
    let most = steps.iter().max_by_key(|&(step, count)| (count, -step))?;
    Some((*most.0, *most.1))
}

/// A number of three digits.
fn brief(number: f64) -> String {
    let unit = 10_f64.powi(2 - log10(number).floor() as i32);
    let rounded = (number * unit).round() / unit;
    match rounded < 1e6 {
        true => rounded.to_string(),
        false => format!("{rounded:e}"),
    }
}
