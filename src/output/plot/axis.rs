//! Axes: the position of a value, and the values that get a tick.

/// The scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Linear.
    #[default]
    Linear,
    /// Logarithmic; values must be positive.
    Log,
}

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// The values at the two ends.
    pub range: [f64; 2],
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Values that get a tick, and their labels. If empty, ticks are chosen from the range.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: &str, range: [f64; 2]) -> Self {
        Self {
            label: label.to_owned(),
            range,
            scale: Scale::Linear,
            ticks: Vec::new(),
        }
    }

    /// A logarithmic axis.
    pub fn log(label: &str, range: [f64; 2]) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label, range)
        }
    }

    /// An axis for categories: names at 0.5, 1.5, … in a range from 0 to the number of names.
    pub fn names(label: &str, names: impl IntoIterator<Item = String>) -> Self {
        let ticks: Vec<_> = names
            .into_iter()
            .enumerate()
            .map(|(k, name)| (k as f64 + 0.5, name))
            .collect();
        Self {
            ticks: ticks.clone(),
            ..Self::linear(label, [0.0, ticks.len() as f64])
        }
    }

    /// The position of a value: 0 at the first end, 1 at the second.
    pub(super) fn place(&self, value: f64) -> f64 {
        let [first, last] = self.range;
        match self.scale {
            Scale::Linear => (value - first) / (last - first),
            Scale::Log => (value / first).ln() / (last / first).ln(),
        }
    }

    /// The values that get a tick, and their labels; about `most` fit.
    pub(super) fn ticks(&self, most: usize) -> Vec<(f64, String)> {
        if !self.ticks.is_empty() {
            return self.ticks.clone();
        }
        match self.scale {
            Scale::Linear => linear_ticks(self.range, most),
            Scale::Log => log_ticks(self.range),
        }
    }
}

/// Ticks at multiples of 1, 2 or 5 times a power of ten.
fn linear_ticks([first, last]: [f64; 2], most: usize) -> Vec<(f64, String)> {
    let rough = (last - first) / most.max(1) as f64;
    let decade = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * decade)
        .into_iter()
        .find(|&step| step >= rough * (1.0 - 1e-9))
        .unwrap_or(rough);
    let digits = (-step.log10()).ceil().clamp(0.0, 9.0) as usize;
    let (from, to) = ((first / step - 1e-6).ceil(), (last / step + 1e-6).floor());
    (from as i64..=to as i64)
        .map(|k| k as f64 * step)
        .map(|value| (value, grouped(value, digits)))
        .collect()
}

/// Ranges of at most this many decades get more than one tick per decade.
const MOST_DECADES: f64 = 4.0;

/// Ticks at 1, 2 and 5 times every power of ten, or only at powers of ten if there are many.
fn log_ticks([first, last]: [f64; 2]) -> Vec<(f64, String)> {
    let many = (last / first).log10() > MOST_DECADES;
    let factors = if many { &[1.0][..] } else { &[1.0, 2.0, 5.0] };
    let mut ticks = Vec::new();
    for exponent in first.log10().floor() as i32..=last.log10().ceil() as i32 {
        for factor in factors {
            let value = factor * 10_f64.powi(exponent);
            if (first * (1.0 - 1e-9)..=last * (1.0 + 1e-9)).contains(&value) {
                let text = match exponent {
                    ..-3 => format!("{factor}e\u{2212}{}", -exponent),
                    _ => grouped(value, (-exponent).max(0) as usize),
                };
                ticks.push((value, text));
            }
        }
    }
    ticks
}

/// A number with `digits` decimals and commas between thousands.
fn grouped(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let (whole, rest) = text.split_at(text.find('.').unwrap_or(text.len()));
    let (sign, whole) = whole.split_at(usize::from(whole.starts_with('-')));
    let count = whole.len();
    let mut out = sign.replace('-', "\u{2212}");
    for (k, digit) in whole.chars().enumerate() {
        if k > 0 && (count - k).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(ticks: Vec<(f64, String)>) -> Vec<f64> {
        ticks.into_iter().map(|(value, _)| value).collect()
    }

    #[test]
    fn ticks_are_round_numbers_inside_the_range() {
        assert_eq!(
            values(linear_ticks([0.0, 8.0], 5)),
            [0.0, 2.0, 4.0, 6.0, 8.0]
        );
        assert_eq!(values(linear_ticks([-25.0, 25.0], 3)), [-20.0, 0.0, 20.0]);
        assert_eq!(
            values(log_ticks([2_500.0, 100_000.0])),
            [5e3, 1e4, 2e4, 5e4, 1e5]
        );
        let small: Vec<String> = log_ticks([1e-6, 1e-1]).into_iter().map(|t| t.1).collect();
        assert_eq!(
            small,
            [
                "1e\u{2212}6",
                "1e\u{2212}5",
                "1e\u{2212}4",
                "0.001",
                "0.01",
                "0.1"
            ]
        );
    }

    #[test]
    fn labels_are_as_long_as_they_must_be() {
        let labels: Vec<String> = linear_ticks([0.0, 0.6], 3)
            .into_iter()
            .map(|t| t.1)
            .collect();
        assert_eq!(labels, ["0.0", "0.2", "0.4", "0.6"]);
        assert_eq!(grouped(100_000.0, 0), "100,000");
        assert_eq!(grouped(-1234.5, 1), "\u{2212}1,234.5");
    }

    #[test]
    fn a_logarithmic_axis_has_equal_factors_at_equal_distances() {
        let axis = Axis::log("n", [10.0, 1000.0]);
        assert!((axis.place(100.0) - 0.5).abs() < 1e-12);
    }
}
