//! Axes.

use super::font::width_of;
use common::round;

/// The size of numbers and legends, points.
pub const NUMBER: f64 = 8.0;
/// The most numbers on an axis: more would not make it clearer.
const MOST_TICKS: i32 = 10;

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// The values at the two ends.
    pub range: [f64; 2],
    /// Whether it is logarithmic; then all values must be positive.
    pub is_log: bool,
    /// Values that get a tick, and their labels. If empty, ticks are chosen from the range.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: &str, range: [f64; 2]) -> Self {
        Self {
            label: label.to_owned(),
            range,
            is_log: false,
            ticks: Vec::new(),
        }
    }

    /// A linear axis without numbers.
    pub fn bare(range: [f64; 2]) -> Self {
        Self::linear("", range).ticked([(range[0], String::new())])
    }

    /// A logarithmic axis.
    pub fn log(label: &str, range: [f64; 2]) -> Self {
        Self {
            is_log: true,
            ..Self::linear(label, range)
        }
    }

    /// The axis with these values and labels as its ticks.
    pub fn ticked(mut self, ticks: impl IntoIterator<Item = (f64, String)>) -> Self {
        self.ticks = ticks.into_iter().collect();
        self
    }

    /// An axis for categories: names at 0.5, 1.5, … in a range from 0 to the number of names.
    pub fn names(label: &str, names: impl IntoIterator<Item = String>) -> Self {
        let places = (0..).map(|k| f64::from(k) + 0.5);
        let mut axis = Self::linear(label, [0.0; 2]).ticked(places.zip(names));
        axis.range[1] = axis.ticks.len() as f64;
        axis
    }

    /// The position of a value: 0 at the first end, 1 at the second.
    pub(super) fn place(&self, value: f64) -> f64 {
        let [first, last] = self.range;
        match self.is_log {
            false => (value - first) / (last - first),
            true => (value / first).ln() / (last / first).ln(),
        }
    }

    /// The axis with ticks that fit into this length, points. Numbers of horizontal axes need their width.
    pub(super) fn fitted(&self, length: f64, is_horizontal: bool) -> Self {
        let apart = if is_horizontal { 32.0 } else { 24.0 };
        let axis = self.with_ticks(((length / apart) as i32).min(MOST_TICKS));
        let needed = (axis.widest() + 8.0) * axis.ticks.len() as f64;
        if !is_horizontal || !self.ticks.is_empty() || needed <= length {
            return axis;
        }
        self.with_ticks((length / (axis.widest() + 12.0)) as i32)
    }

    /// The width of the widest number, points.
    pub(super) fn widest(&self) -> f64 {
        let widths = self.ticks.iter().map(|(_, text)| width_of(text, NUMBER));
        widths.fold(0.0, f64::max)
    }

    /// Whether the names on a horizontal axis of this length, points, fit only if they are turned.
    pub(super) fn is_crowded(&self, length: f64) -> bool {
        self.ticks.len() as f64 * (self.widest() + 4.0) > 1.1 * length
    }

    /// The axis with ticks; about `most` fit.
    fn with_ticks(&self, most: i32) -> Self {
        let mut axis = self.clone();
        let [first, last] = self.range;
        if axis.ticks.is_empty() && (last - first).is_finite() && first != last {
            let values = match self.is_log {
                false => {
                    // plotters' own lose the last tick to rounding errors.
                    let ticks = round::ticks(self.range, most.max(2));
                    // One number does not show the scale of the axis.
                    match ticks.len() {
                        0 | 1 => round::ticks(self.range, 2 * most.max(2)),
                        _ => ticks,
                    }
                }
                true => log_ticks(self.range, most),
            };
            axis.ticks = values.into_iter().map(|v| (v, round::text(v))).collect();
        }
        axis
    }
}

/// 1, 2 and 5 times every power of ten, or only powers of ten if there is little room. plotters' `LogCoord` has
/// powers of ten only, so that an axis of less than a decade may have no tick.
fn log_ticks([first, last]: [f64; 2], most: i32) -> Vec<f64> {
    let decades = first.log10().floor() as i32..=last.log10().ceil() as i32;
    let crowded = 2.0 * (last / first).log10() > f64::from(most);
    let factors = if crowded {
        &[1.0][..]
    } else {
        &[1.0, 2.0, 5.0]
    };
    let inside = first * (1.0 - 1e-9)..=last * (1.0 + 1e-9);
    let values = decades.flat_map(|decade| factors.iter().map(move |f| f * 10_f64.powi(decade)));
    values.filter(|value| inside.contains(value)).collect()
}
