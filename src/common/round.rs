//! Round numbers for readers: values in texts, ticks of axes and color bars, ends of ranges.

/// The decimals that texts have at most.
const DECIMALS: usize = 9;
/// The ends of ranges, as multiples of a power of ten.
const ENDS: [f64; 14] = [
    1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0,
];

/// A number with at most three significant digits; all digits before the point.
pub fn brief(value: f64) -> String {
    let digits = value.abs().log10().floor();
    let decimals = if digits.is_finite() {
        2.0 - digits
    } else {
        0.0
    };
    let unit = 10_f64.powf(decimals.max(0.0));
    let rounded = (value * unit).round() / unit;
    text(if rounded.is_finite() { rounded } else { value })
}

/// A number with commas between thousands and as many decimals as it needs.
pub fn text(value: f64) -> String {
    let size = value.abs();
    if size > 0.0 && size < 0.9e-3 {
        let text = format!("{value:.1e}").replace(".0e", "e");
        return text.replace('-', "\u{2212}");
    }
    let text = format!("{size:.DECIMALS$}");
    let (whole, decimals) = text.split_once('.').unwrap_or((&text, ""));
    let mut all = String::new();
    for (k, digit) in whole.chars().enumerate() {
        if k > 0 && (whole.len() - k).is_multiple_of(3) {
            all.push(',');
        }
        all.push(digit);
    }
    let decimals = decimals.trim_end_matches('0');
    if !decimals.is_empty() {
        all = all + "." + decimals;
    }
    match value < 0.0 {
        true => format!("\u{2212}{all}"),
        false => all,
    }
}

/// Multiples of 1, 2 or 5 times a power of ten in a range, in about `most` steps.
pub fn ticks([first, last]: [f64; 2], most: i32) -> Vec<f64> {
    let step = step(0.999 * (last - first) / f64::from(most.max(1)));
    let (from, to) = ((first / step - 1e-6).ceil(), (last / step + 1e-6).floor());
    (from as i64..=to as i64).map(|k| k as f64 * step).collect()
}

/// The least step of 1, 2 or 5 times a power of ten that is not less than a positive value.
pub fn step(least: f64) -> f64 {
    let decade = 10_f64.powf(least.log10().floor());
    let mut steps = [1.0, 2.0, 5.0, 10.0]
        .map(|factor| factor * decade)
        .into_iter();
    steps.find(|step| *step >= least).unwrap_or(least)
}

/// The least round number that is not less than a positive value.
pub fn end(value: f64) -> f64 {
    let decade = value.log10().floor();
    // Powers of ten below 1 have no exact value, their inverses have.
    let times = |factor: f64| match decade < 0.0 {
        true => factor / 10_f64.powf(-decade),
        false => factor * 10_f64.powf(decade),
    };
    let mut ends = ENDS.into_iter().map(times);
    ends.find(|&end| end >= value * (1.0 - 1e-9))
        .unwrap_or(value)
}
